#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// The reduced motion of one mode: v = Z z + Y u with the locked slips gone. docs/theory/multipliers.md.
namespace clutchwork {

inline constexpr int small_speeds = 4, small_states = 4;

/// The mass-weighted directions without their zeros, and the mobility of the contacts: their products.
template <class T>
void compress_directions(Workspace<T>& ws) {
  const int nv = int(ws.sys.speeds), ne = int(ws.sys.elements), nc = int(ws.sys.contacts);
  int at = 0;
  for (int d = 0; d < ws.n_directions; ++d) {
    ws.white_first[d] = at;
    for (int i = 0; i < nv; ++i) {
      if (value(ws.direction[d * nv + i]) == 0) continue;
      ws.white_col[at] = i;
      ws.white[at++] = ws.direction[d * nv + i];
    }
  }
  ws.white_first[ws.n_directions] = at;
  for (int a = 0; a < nc; ++a) {
    for (int b = 0; b <= a; ++b) {
      const T s = dot(nv, ws.direction + (ne + a) * nv, ws.direction + (ne + b) * nv);
      ws.mobility[a * nc + b] = ws.mobility[b * nc + a] = s;
    }
  }
}

/// Once per run: mass-weighted directions L^-1 D' and prescribed momentum L^-1 M_p. False when M is not positive
/// definite.
template <class T>
bool prepare_geometry(Workspace<T>& ws) {
  const System& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed);
  for (int i = 0; i < nv * nv; ++i) ws.factor[i] = T(sys.mass[i]);
  for (int i = 0; i < nv; ++i) ws.factor[i * nv + i] += T(sys.massless[i] ? 1.0 : 0.0);
  if (!cholesky(nv, ws.factor, nv)) return false;
  for (int d = 0; d < ws.n_directions; ++d) {
    const bool element = d < sys.elements;
    const double* row = element ? sys.element_rate + d * nv : sys.contact_rate + (d - sys.elements) * nv;
    for (int i = 0; i < nv; ++i) ws.direction[d * nv + i] = T(row[i]);
    forward_solve(nv, ws.factor, nv, ws.direction + d * nv);
  }
  for (int p = 0; p < np; ++p) {
    for (int i = 0; i < nv; ++i) ws.prescribed_momentum[p * nv + i] = T(sys.mass_prescribed[i * np + p]);
    forward_solve(nv, ws.factor, nv, ws.prescribed_momentum + p * nv);
  }
  compress_directions(ws);
  // without redundant contacts nothing is ever held by others
  const int nc = int(sys.contacts);
  T* rows = ws.scratch;
  for (int i = 0; i < nc * nv; ++i) rows[i] = ws.direction[sys.elements * nv + i];
  ws.redundant = orthonormal_split(nc, nv, rows, ws.envelope, ws.iscratch, ws.qp_f) < nc;
  return true;
}

/// Orthonormal directions whose first `rank` span the locked contacts, the others the motion that is left.
template <class T>
int split_locked(Workspace<T>& ws, T* basis) {
  const int nv = int(ws.sys.speeds), ne = int(ws.sys.elements);
  T* rows = ws.scratch;
  for (int a = 0; a < ws.n_locked; ++a) {
    for (int i = 0; i < nv; ++i) rows[a * nv + i] = ws.direction[(ne + ws.locked[a]) * nv + i];
  }
  return orthonormal_split(ws.n_locked, nv, rows, basis, ws.iscratch, ws.qp_f);
}

/// Factor of the mobility of the carriers.
template <class T>
bool factor_mobility(Workspace<T>& ws) {
  const int m = ws.n_locked, nc = int(ws.sys.contacts);
  for (int a = 0; a < m; ++a) {
    for (int b = 0; b <= a; ++b) ws.mobility_factor[a * m + b] = ws.mobility[ws.locked[a] * nc + ws.locked[b]];
    if (is_rigid(ws, ws.locked[a])) ws.mobility_factor[a * m + a] = T(1);
  }
  return cholesky(m, ws.mobility_factor, m);
}

/// Torques x of the carriers for slip accelerations b: mobility x = b.
template <class T>
void solve_locked(const Workspace<T>& ws, const T* b, T* x) {
  const int m = ws.n_locked;
  for (int a = 0; a < m; ++a) x[a] = b[a];
  forward_solve(m, ws.mobility_factor, m, x);
  backward_solve(m, ws.mobility_factor, m, x);
}

/// Multipliers as a linear map of branch torques and prescribed accelerations; few contacts only.
template <class T>
void map_multipliers(Workspace<T>& ws) {
  const int m = ws.n_locked, nv = int(ws.sys.speeds), ne = int(ws.sys.elements), np = int(ws.sys.prescribed);
  T *b = ws.qp_g + 2 * ws.sys.contacts, *x = ws.qp_g + 3 * ws.sys.contacts;
  for (int k = 0; k < ws.n_branches; ++k) {
    for (int a = 0; a < m; ++a) {
      b[a] = -dot(nv, ws.direction + (ne + ws.locked[a]) * nv, ws.direction + ws.branch[k].direction * nv);
    }
    solve_locked(ws, b, x);
    for (int a = 0; a < m; ++a) ws.reach[a * ws.n_branches + k] = x[a];
  }
  for (int p = 0; p < np; ++p) {
    for (int a = 0; a < m; ++a) {
      const int d = ne + ws.locked[a];
      b[a] = dot(nv, ws.direction + d * nv, ws.prescribed_momentum + p * nv) - prescribed_share(ws, d, p);
    }
    solve_locked(ws, b, x);
    for (int a = 0; a < m; ++a) ws.reach_prescribed[a * np + p] = x[a];
  }
}

/// Y: what prescribed speeds do to v inside the mode, momentum along Z untouched.
template <class T>
void map_prescribed(Workspace<T>& ws, const T* basis) {
  const System& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed), ne = int(sys.elements), m = ws.n_locked;
  for (int p = 0; p < np; ++p) {
    T* x = ws.scratch;
    const T* momentum = ws.prescribed_momentum + p * nv;
    for (int i = 0; i < nv; ++i) x[i] = T(0);
    for (int j = ws.rank; j < nv; ++j) {
      T s = T(0);
      for (int i = 0; i < nv; ++i) s += basis[i * nv + j] * momentum[i];
      for (int i = 0; i < nv; ++i) x[i] -= s * basis[i * nv + j];
    }
    T *share = ws.qp_g + 2 * sys.contacts, *size = ws.qp_g + 3 * sys.contacts;
    for (int a = 0; a < m; ++a) share[a] = prescribed_share(ws, ne + ws.locked[a], p);
    solve_locked(ws, share, size);
    for (int a = 0; a < m; ++a) axpy(nv, -size[a], ws.direction + (ne + ws.locked[a]) * nv, x);
    backward_solve(nv, ws.factor, nv, x);
    for (int i = 0; i < nv; ++i) ws.y_basis[i * np + p] = x[i];
  }
}

/// Add a branch to the list.
template <class T>
void pack(Workspace<T>& ws, int d, int sign, int& block) {
  const Branch<T> b = make_branch(ws, d, sign);
  ws.branch_of[d] = ws.n_rates;
  ws.block[ws.n_rates] = block;
  block += b.states * b.states;
  ws.branch[ws.n_rates++] = b;
}

/// Branches whose laws switch or jump.
template <class T>
void list_laws(Workspace<T>& ws) {
  ws.n_switching = ws.n_chattering = ws.n_bounded = 0;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (ws.loaded[c] && is_bounded_law(ws.sys.contact_law[c])) ws.bounded[ws.n_bounded++] = c;
  }
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<T>& b = ws.branch[k];
    if (is_switching(b)) ws.switching[ws.n_switching++] = k;
    if (b.law < 0) continue;
    if (is_chattering_law(b.law)) ws.chattering[ws.n_chattering++] = k;
  }
}

/// Active components: all elements and slipping contacts.
/// Behind them, without torque, the open contacts: only their rates are followed.
template <class T>
void pack_branches(Workspace<T>& ws) {
  const System& sys = ws.sys;
  const int ne = int(sys.elements), nc = int(sys.contacts);
  ws.n_rates = ws.n_undirected = 0;
  int block = 0;
  for (int d = 0; d < ne; ++d) pack(ws, d, 0, block);
  for (int c = 0; c < nc; ++c) {
    ws.branch_of[ne + c] = -1;
    // a law that never sticks works beside a freewheel that is locked
    if (ws.loaded[c] && (ws.mode[c] != locked || ws.compliant[c])) pack(ws, ne + c, ws.mode[c], block);
  }
  ws.n_branches = ws.n_rates;
  list_laws(ws);
  for (int c = 0; c < nc; ++c) {
    if (ws.loaded[c] || ws.compliant[c]) continue;
    pack(ws, ne + c, ws.mode[c] == open ? 0 : ws.mode[c], block);
    ws.n_undirected += ws.mode[c] == open;
  }
}

/// Guard of the slip of a contact: where it may lock.
template <class T>
void list_slip(Workspace<T>& ws, int k) {
  const Branch<T>& b = ws.branch[k];
  const int c = b.direction - int(ws.sys.elements);
  const double slip = value(rate_of(ws, b.direction));
  if (may_stick(ws, c) && ws.mode[c] != locked) {
    // what prescribed speeds drive cannot be stopped
    const double level = ws.forced[c] == 0 && !is_rigid(ws, c) ? ws.sys.contact_tolerance[c] : 0.0;
    const bool outside = abs(slip) >= level * (1 - 1e-9);
    ws.line[ws.n_lines++] = {LineGuard::slip, k, ws.mode[c], outside ? level * ws.mode[c] : 0.0};
  }
}

/// Guard of a rate whose change of sign matters to the law or the element behind it.
template <class T>
void list_turn(Workspace<T>& ws, int k) {
  const Branch<T>& b = ws.branch[k];
  if ((b.law >= 0 && !b.compliant) || !law_turns(b)) return;
  const double rate = value(rate_of(ws, b.direction));
  int& heading = ws.heading[b.direction];
  if (abs(rate) > slip_tolerance(ws)) heading = rate > 0 ? forward : backward;
  ws.line[ws.n_lines++] = {LineGuard::turn, k, heading, 0.0};
}

/// Guards that are linear in the state.
template <class T>
void list_lines(Workspace<T>& ws) {
  ws.n_lines = 0;
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<T>& b = ws.branch[k];
    const bool contact = b.law >= 0;
    if (contact) list_slip(ws, k);
    list_turn(ws, k);
    const int edges = edge_count(ws, b.direction), sign = contact ? b.sign : 1;
    if (b.piece < edges) ws.line[ws.n_lines++] = {LineGuard::edge, k, -sign, sign * edge_at(ws, b.direction, b.piece)};
    if (edges > 0 && b.piece > 0)
      ws.line[ws.n_lines++] = {LineGuard::edge, k, sign, sign * edge_at(ws, b.direction, b.piece - 1)};
  }
  for (int k = ws.n_branches; k < ws.n_rates; ++k) {
    // an open contact has passed zero when it is clear of it on the other side
    const int sign = ws.branch[k].sign;
    if (sign != 0) ws.line[ws.n_lines++] = {LineGuard::pass, k, sign, -sign * slip_tolerance(ws)};
  }
}

/// Rates of the branches in reduced coordinates: rate = row_z z + offset u.
template <class T>
void reduce_rates(Workspace<T>& ws) {
  const System& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed), nz = ws.nz;
  for (int k = 0; k < ws.n_rates; ++k) {
    const int d = ws.branch[k].direction;
    const double* row = d < sys.elements ? sys.element_rate + d * nv : sys.contact_rate + (d - sys.elements) * nv;
    for (int p = 0; p < np; ++p) {
      T s = prescribed_share(ws, d, p);
      for (int i = 0; i < nv; ++i) s += T(row[i]) * ws.y_basis[i * np + p];
      ws.offset[k * np + p] = s;
    }
    if (ws.sparse) continue;
    for (int j = 0; j < nz; ++j) {
      T s = T(0);
      for (int i = 0; i < nv; ++i) s += T(row[i]) * ws.z_basis[i * nz + j];
      ws.row_z[k * nz + j] = s;
    }
  }
}

/// Dense reduced coordinates: Z with Z' M Z = 1, and z = Z'(M v + M_p u).
template <class T>
void reduce_dense(Workspace<T>& ws, const T* basis) {
  const int nv = int(ws.sys.speeds), nz = ws.nz, np = int(ws.sys.prescribed);
  T* x = ws.scratch;
  for (int i = 0; i < nv; ++i) {
    T s = T(0);
    for (int j = i; j < nv; ++j) s += ws.factor[j * nv + i] * ws.v[j];
    for (int p = 0; p < np; ++p) s += ws.prescribed_momentum[p * nv + i] * ws.prescribed[p];
    x[i] = s;
  }
  T* column = ws.scratch + nv;
  for (int j = 0; j < nz; ++j) {
    for (int i = 0; i < nv; ++i) column[i] = basis[i * nv + ws.rank + j];
    ws.y[j] = dot(nv, column, x);
    backward_solve(nv, ws.factor, nv, column);
    for (int i = 0; i < nv; ++i) ws.z_basis[i * nz + j] = column[i];
  }
}

}  // namespace clutchwork

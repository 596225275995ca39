#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// The reduced motion of one mode: v = Z z + Y u with the locked slips gone. docs/theory/multipliers.md.
namespace clutchwork {

/// Sizes of the exact forms: one speed to small_speeds, no state to small_states.
inline constexpr int small_speeds = 4, small_states = 2;
constexpr bool is_small_size(std::int64_t speeds, std::int64_t states) {
  return speeds >= 1 && speeds <= small_speeds && states <= small_states;
}

/// Orthonormal directions in held.basis whose first ones, as many as returned, span the carriers; the others the motion
/// that is left.
template <class T>
int split_locked(Workspace<T>& ws) {
  for (int a = 0; a < ws.held.n; ++a) ws.held.all[a] = ws.held.contact[a];
  return split_held(ws, ws.held.n);
}

/// Factor of the mobility of the carriers.
template <class T>
bool factor_mobility(Workspace<T>& ws) {
  const int m = ws.held.n, nc = int(ws.sys.contacts);
  for (int a = 0; a < m; ++a) {
    for (int b = 0; b <= a; ++b)
      ws.held.factor[a * m + b] = ws.geometry.mobility[ws.held.contact[a] * nc + ws.held.contact[b]];
    if (is_rigid(ws, ws.held.contact[a])) ws.held.factor[a * m + a] = T(1);
  }
  return cholesky(m, ws.held.factor, m);
}

/// Torques x of the carriers for slip accelerations b: mobility x = b.
template <class T>
void solve_locked(const Workspace<T>& ws, const T* b, T* x) {
  const int m = ws.held.n;
  for (int a = 0; a < m; ++a) x[a] = b[a];
  forward_solve(m, ws.held.factor, m, x);
  backward_solve(m, ws.held.factor, m, x);
}

/// Multipliers as a linear map of branch torques and prescribed accelerations; few contacts only.
template <class T>
void map_multipliers(Workspace<T>& ws) {
  const int m = ws.held.n, nv = int(ws.sys.speeds), ne = int(ws.sys.elements), np = int(ws.sys.prescribed);
  T *b = ws.held.rhs, *x = ws.held.solved;
  for (int k = 0; k < ws.n_branches; ++k) {
    for (int a = 0; a < m; ++a) {
      b[a] = -dot(nv, ws.geometry.direction + (ne + ws.held.contact[a]) * nv,
                  ws.geometry.direction + ws.branch[k].direction * nv);
    }
    solve_locked(ws, b, x);
    for (int a = 0; a < m; ++a) ws.held.reach[a * ws.n_branches + k] = x[a];
  }
  for (int p = 0; p < np; ++p) {
    for (int a = 0; a < m; ++a) {
      const int d = ne + ws.held.contact[a];
      b[a] = dot(nv, ws.geometry.direction + d * nv, ws.geometry.prescribed_momentum + p * nv) -
             prescribed_share(ws, d, p);
    }
    solve_locked(ws, b, x);
    for (int a = 0; a < m; ++a) ws.held.reach_prescribed[a * np + p] = x[a];
  }
}

/// Y: what prescribed speeds do to v inside the mode, momentum along Z untouched.
template <class T>
void map_prescribed(Workspace<T>& ws) {
  const System& sys = ws.sys;
  const T* basis = ws.held.basis;
  const int nv = int(sys.speeds), np = int(sys.prescribed), ne = int(sys.elements), m = ws.held.n;
  for (int p = 0; p < np; ++p) {
    T* x = ws.reduced.column;
    const T* momentum = ws.geometry.prescribed_momentum + p * nv;
    for (int i = 0; i < nv; ++i) x[i] = T(0);
    for (int j = ws.reduced.rank; j < nv; ++j) {
      T s = T(0);
      for (int i = 0; i < nv; ++i) s += basis[i * nv + j] * momentum[i];
      for (int i = 0; i < nv; ++i) x[i] -= s * basis[i * nv + j];
    }
    T *share = ws.held.rhs, *size = ws.held.solved;
    for (int a = 0; a < m; ++a) share[a] = prescribed_share(ws, ne + ws.held.contact[a], p);
    solve_locked(ws, share, size);
    for (int a = 0; a < m; ++a) axpy(nv, -size[a], ws.geometry.direction + (ne + ws.held.contact[a]) * nv, x);
    backward_solve(nv, ws.geometry.factor, nv, x);
    for (int i = 0; i < nv; ++i) ws.reduced.y_basis[i * np + p] = x[i];
  }
}

/// Rates of the branches in reduced coordinates: rate = row_z z + offset u.
template <class T>
void reduce_rates(Workspace<T>& ws) {
  const System& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed), nz = ws.reduced.nz;
  for (int k = 0; k < ws.n_rates; ++k) {
    const int d = ws.branch[k].direction;
    const double* row = rate_row(sys, d);
    for (int p = 0; p < np; ++p) {
      T s = prescribed_share(ws, d, p);
      for (int i = 0; i < nv; ++i) s += T(row[i]) * ws.reduced.y_basis[i * np + p];
      ws.reduced.offset[k * np + p] = s;
    }
    if (ws.reduced.is_sparse) continue;
    for (int j = 0; j < nz; ++j) {
      T s = T(0);
      for (int i = 0; i < nv; ++i) s += T(row[i]) * ws.reduced.z_basis[i * nz + j];
      ws.reduced.row_z[k * nz + j] = s;
    }
  }
}

/// Dense reduced coordinates: Z with Z' M Z = 1, and z = Z'(M v + M_p u).
template <class T>
void reduce_dense(Workspace<T>& ws) {
  const T* basis = ws.held.basis;
  const int nv = int(ws.sys.speeds), nz = ws.reduced.nz, np = int(ws.sys.prescribed);
  T* x = ws.reduced.momentum;
  for (int i = 0; i < nv; ++i) {
    T s = T(0);
    for (int j = i; j < nv; ++j) s += ws.geometry.factor[j * nv + i] * ws.v[j];
    for (int p = 0; p < np; ++p) s += ws.geometry.prescribed_momentum[p * nv + i] * ws.in.prescribed[p];
    x[i] = s;
  }
  T* column = ws.reduced.column;
  for (int j = 0; j < nz; ++j) {
    for (int i = 0; i < nv; ++i) column[i] = basis[i * nv + ws.reduced.rank + j];
    ws.reduced.y[j] = dot(nv, column, x);
    backward_solve(nv, ws.geometry.factor, nv, column);
    for (int i = 0; i < nv; ++i) ws.reduced.z_basis[i * nz + j] = column[i];
  }
}

}  // namespace clutchwork

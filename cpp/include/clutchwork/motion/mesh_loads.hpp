#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/geometry.hpp>
#include <clutchwork/workspace.hpp>

/// Loads as linear functions of torques, and what contacts that follow them can hold: docs/theory/load-dependent.md.
namespace clutchwork {

/// Once per run: the loads by the torques of all directions and by prescribed accelerations.
/// docs/theory/load-dependent.md (6)
template <class T>
void prepare_loads(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed), ne = int(sys.elements), nc = int(sys.contacts);
  for (int c = 0; c < nc; ++c) ws.loads.of[c] = -1;
  T* momentum = ws.geometry.column;
  for (int l = 0; l < sys.loads; ++l) {
    ws.loads.of[sys.load_contact[l]] = l;
    for (int i = 0; i < nv; ++i) momentum[i] = T(0);
    for (int p = 0; p < np; ++p) ws.loads.by_slope[l * np + p] = T(0);
    for (int n = 0; n < sys.nodes; ++n) {
      const Given<T> share = sys.load_motion[l * sys.nodes + n] * sys.inertia[n];
      if (is_zero(share)) continue;
      const auto row = basis_row(sys, n);
      for (int e = 0; e < row.n; ++e) momentum[row.column[e]] += T(share * row.value[e]);
      for (int p = 0; p < np; ++p) ws.loads.by_slope[l * np + p] += T(share * sys.basis_prescribed[n * np + p]);
    }
    forward_solve(nv, ws.geometry.inertia, ws.geometry.factor, momentum);
    for (int i = 0; i < nv; ++i) ws.loads.momentum[l * nv + i] = momentum[i];
    for (int d = 0; d < ws.n_directions; ++d) {
      const T rate = T(d < ne ? sys.load_element_rate[l * ne + d] : sys.load_contact_rate[l * nc + d - ne]);
      ws.loads.by_torque[l * ws.n_directions + d] = ws.geometry.mass_weighted.times(d, momentum) - rate;
    }
    for (int p = 0; p < np; ++p)
      ws.loads.by_slope[l * np + p] -= dot(nv, momentum, ws.geometry.prescribed_momentum + p * nv);
  }
}

/// The same in the present mode, by the torques of its branches: those of the independent contacts follow from them.
/// docs/theory/load-dependent.md (7)
template <class T>
void map_loads(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  const int nd = ws.n_directions, np = int(sys.prescribed), ne = int(sys.elements), nv = int(sys.speeds),
            m = ws.held.n_fixed;
  const Compressed<T>& mass_weighted = ws.geometry.mass_weighted;
  T *b = ws.held.rhs, *share = ws.held.solved;
  for (int l = 0; l < sys.loads; ++l) {
    const T* by_torque = ws.loads.by_torque + l * nd;
    for (int a = 0; a < m; ++a) b[a] = by_torque[ne + ws.held.contact[a]];
    solve_locked(ws, b, share);
    for (int k = 0; k < ws.n_branches; ++k) {
      const int d = ws.branch[k].direction;
      T s = by_torque[d];
      for (int a = 0; a < m; ++a) s -= share[a] * product(mass_weighted, ne + ws.held.contact[a], d);
      ws.loads.by_branch[l * nd + k] = s;
    }
    for (int c = m; c < ws.held.n; ++c) {
      const int d = ne + ws.held.contact[c];
      T s = by_torque[d];
      for (int a = 0; a < m; ++a) s -= share[a] * product(mass_weighted, ne + ws.held.contact[a], d);
      ws.loads.by_held[l * sys.contacts + c - m] = s;
    }
    for (int p = 0; p < np; ++p) {
      T s = ws.loads.by_slope[l * np + p];
      for (int a = 0; a < m; ++a) {
        const int d = ne + ws.held.contact[a];
        s -= share[a] * (prescribed_share(ws, d, p) - mass_weighted.times(d, ws.geometry.prescribed_momentum + p * nv));
      }
      ws.loads.by_prescribed[l * np + p] = s;
    }
  }
  ws.loads.n_sliding = 0;
  for (int l = 0; l < sys.loads; ++l) {
    const int k = ws.branch_of[ne + sys.load_contact[l]];
    if (k < 0 || k >= ws.n_branches) continue;
    ws.loads.sliding[ws.loads.n_sliding] = l, ws.loads.branch[ws.loads.n_sliding++] = k;
  }
}

/// The loads of given branch torques; `moving`: with the prescribed accelerations. `held` gives the torque of a locked
/// contact whose direction varies.
template <class T, class Held>
void loads_of(const Workspace<T>& ws, const T* torque, bool moving, T* out, Held&& held) {
  const int np = moving ? int(ws.sys.prescribed) : 0;
  for (int l = 0; l < ws.sys.loads; ++l) {
    out[l] = dot(ws.n_branches, ws.loads.by_branch + l * ws.n_directions, torque);
    for (int c = 0; c < ws.held.n - ws.held.n_fixed; ++c) out[l] += ws.loads.by_held[l * ws.sys.contacts + c] * held(c);
    for (int p = 0; p < np; ++p)
      out[l] += ws.loads.by_prescribed[l * ws.sys.prescribed + p] * ws.in.prescribed_slope[p];
  }
}

/// The loads where torques were looked at last.
template <class T>
void loads_seen(Workspace<T>& ws) {
  loads_of(ws, ws.observed.torque, true, ws.loads.now, [&](int c) { return ws.observed.carried[ws.held.n_fixed + c]; });
}

/// Whether the torques of the contacts that slip and follow loads answer what drives them the right way round where
/// they were evaluated last: the determinant of their system is positive. docs/theory/load-dependent.md, rule 4
template <class T>
bool is_balanced(const Workspace<T>& ws) {
  const int m = ws.loads.n_sliding;
  bool positive = true;
  for (int i = 0; i < m; ++i) {
    const double own = value(ws.full.plain.coupling[i * m + i]);
    if (!(abs(own) > 0)) return false;
    positive = positive == ((own > 0) == (ws.full.plain.pivot[i] == i));
  }
  return positive;
}

/// The contact that slips with a load whose torque grows beyond all bounds where it was evaluated last, for its own
/// friction feeds it: the determinant of their system has come down to zero; -1: none. docs/theory/load-dependent.md,
/// rule 4
template <class T>
int runs_away(const Workspace<T>& ws) {
  constexpr double much = 1e3;
  const int m = ws.loads.n_sliding;
  int found = -1;
  double largest = much;
  for (int i = 0; i < m; ++i) {
    // the factor has the inverses of its pivots
    const double inverse = abs(value(ws.full.plain.coupling[i * m + i]));
    if (inverse > largest) largest = inverse, found = int(ws.sys.load_contact[ws.loads.sliding[i]]);
  }
  return found;
}

/// A contact that slips with a load of which next to nothing goes on, for its efficiency has come down to zero where it
/// was evaluated last; -1: none. docs/theory/load-dependent.md, rule 4
template <class T>
int takes_all(const Workspace<T>& ws) {
  constexpr double much = 1e6;
  for (int i = 0; i < ws.loads.n_sliding; ++i) {
    const int c = ws.sys.load_contact[ws.loads.sliding[i]], sign = ws.contact.mode[c];
    const T slip = T(sign) * ws.full.plain.rate[ws.loads.branch[i]];
    const Bound<T> bound = bound_of(ws, c, sign, slip, ws.piece[ws.sys.elements + c]);
    if (larger(abs(value(bound.slope[0])), abs(value(bound.slope[1]))) > much) return c;
  }
  return -1;
}

/// Size of the torques of the branches where they were looked at last.
template <class T>
double torque_size(const Workspace<T>& ws) {
  double size = 0;
  for (int k = 0; k < ws.n_branches; ++k) size += abs(value(ws.observed.torque[k]));
  return size;
}

/// The loads of the torques along all directions.
template <class T>
void loads_of_all(const Workspace<T>& ws, const T* torque, T* out) {
  const int np = int(ws.sys.prescribed), nd = ws.n_directions;
  for (int l = 0; l < ws.sys.loads; ++l) {
    out[l] = dot(nd, ws.loads.by_torque + l * nd, torque);
    for (int p = 0; p < np; ++p) out[l] += ws.loads.by_slope[l * np + p] * ws.in.prescribed_slope[p];
  }
}

/// How far the line with which the contact of a load slips is above the other, at a slip; its derivative by the load.
template <class T>
T line_clearance(const Workspace<T>& ws, int l, T rate, T& by_load) {
  const int c = ws.sys.load_contact[l], line = ws.loads.line[l], sign = ws.contact.mode[c];
  const Bound<T> bound = bound_of(ws, c, sign, T(sign) * rate, ws.piece[ws.sys.elements + c]);
  by_load = bound.slope[line] - bound.slope[1 - line];
  if (value(by_load) == 0 && value(bound.offset[line] - bound.offset[1 - line]) == 0) return T(1);
  return bound.on(line, ws.loads.now[l]) - bound.on(1 - line, ws.loads.now[l]);
}

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/contacts/problem.hpp>
#include <clutchwork/contacts/ratios.hpp>
#include <clutchwork/workspace.hpp>

/// How the slips accelerate without the torques of the contacts, and the problem that finds those.
namespace clutchwork {

/// Mass-weighted acceleration without contacts that may stick: L^-1 (forces - M_p du/dt).
/// ws.decision.effort: sum of the sizes of all contributions, what round-off of q is measured against; pull: of
/// torques; missed: of what the rows of transmissions leave of them where that does not count.
template <class T>
void free_motion(Workspace<T>& ws, const int* candidate, T* q) {
  const auto& sys = ws.sys;
  const int nv = int(sys.speeds);
  for (int i = 0; i < nv; ++i) q[i] = T(0);
  ws.decision.effort = ws.decision.pull = ws.decision.missed = 0;
  for (int l = 0; l < sys.loads; ++l) {
    ws.coupled.given[l] = T(0);
    for (int p = 0; p < sys.prescribed; ++p)
      ws.coupled.given[l] += ws.loads.by_slope[l * sys.prescribed + p] * ws.in.prescribed_slope[p];
  }
  auto add = [&](T size, int d) {
    ws.geometry.mass_weighted.add(d, size, q);
    for (int l = 0; l < sys.loads; ++l) ws.coupled.given[l] += ws.loads.by_torque[l * ws.n_directions + d] * size;
    ws.decision.effort += abs(value(size)) * sqrt(value(ws.geometry.own[d]));
    ws.decision.pull += abs(value(size));
    if (ws.ratios.inside) ws.decision.missed += abs(value(size)) * value(ws.ratios.missed[d]);
  };
  for (int p = 0; p < sys.prescribed; ++p)
    axpy(nv, -ws.in.prescribed_slope[p], ws.geometry.prescribed_momentum + p * nv, q);
  for (int d = 0; d < ws.n_directions; ++d) {
    const int c = d - int(sys.elements);
    int sign = 0;
    if (c >= 0 && (!ws.contact.loaded[c] || ws.loads.of[c] >= 0)) continue;
    if (c >= 0 && !ws.contact.compliant[c]) {
      if (candidate[c]) continue;
      sign = ws.contact.mode[c];
      if (sign != forward && sign != backward) continue;
    }
    const Branch<T> b = make_branch(ws, d, sign);
    if (b.ways != 1) {
      T torque[most_ways];
      const PresentRates<T> rate(ws, b);
      if (b.ways > 0) element_torques(ws, b, rate.at, ws.state + b.state, b.input, ws.observed.state_rates, torque);
      for (int i = 0; i < b.ways; ++i) add(torque[i], d + i);
      continue;
    }
    add(branch_torque_once(ws, b, rate_of(ws, d), ws.state, ws.observed.state_rates), d);
  }
  if (!ws.ratios.inside) return;
  accelerate_rows(ws, q);
  for (int l = 0; l < sys.loads; ++l)
    ws.coupled.given[l] += dot(ws.ratios.rank, ws.loads.by_drawn + l * ws.ratios.n, ws.ratios.drawn);
}

/// Acceleration along a direction for mass-weighted acceleration q; that of the slip of a contact.
template <class T>
T acceleration_along(const Workspace<T>& ws, int d, const T* q) {
  T a = ws.geometry.mass_weighted.times(d, q);
  for (int p = 0; p < ws.sys.prescribed; ++p) a += prescribed_share(ws, d, p) * ws.in.prescribed_slope[p];
  return ws.ratios.inside ? a + pulled(ws, d) : a;
}
template <class T>
T slip_acceleration(const Workspace<T>& ws, int c, const T* q) {
  return acceleration_along(ws, int(ws.sys.elements) + c, q);
}

/// Acceleration of a slip that the prescribed speeds give.
template <class T>
T slip_slope(const Workspace<T>& ws, int c) {
  T a = T(0);
  for (int p = 0; p < ws.sys.prescribed; ++p) {
    a += prescribed_share(ws, int(ws.sys.elements) + c, p) * ws.in.prescribed_slope[p];
  }
  return a;
}

/// Gather the problem of the contacts in list[0..n): matrix and views.
template <class T>
BoundedProblem<T> gather(Workspace<T>& ws, const int* list, int n) {
  const Geometry<T>& g = ws.geometry;
  ProblemMemory<T>& p = ws.problem;
  for (int c = 0; c < ws.sys.contacts; ++c) p.slot[c] = -1;
  for (int a = 0; a < n; ++a) p.slot[g.place[list[a]]] = a, p.diagonal[a] = g.own[ws.sys.elements + list[a]];
  const Neighbours<T> matrix{n, g.near, g.mobility, p.diagonal, list, g.place, g.last, p.slot, p.row};
  return {n, matrix, p.gradient, p.lower, p.upper, p.weight, p.x, p.slope, p.trial, p.near, p.factor, p.bound, p.free};
}

}  // namespace clutchwork

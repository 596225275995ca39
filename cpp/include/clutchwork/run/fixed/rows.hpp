#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/fixed/prepare.hpp>
#include <clutchwork/run/output.hpp>

/// Rows of fixed steps, and what is summed over them: docs/theory/fixed-steps.md
namespace clutchwork::fixed {

/// A step, or none that has passed: where a row is.
struct Look {
  double t = 0;                ///< [s] start of the step
  real h = 0;                  ///< [s] its length
  const real *change, *given;  ///< change of the speeds and of the prescribed ones over h
  const real *state, *torque;  ///< change of the states; mean torque of each direction
  real taken = 0;              ///< share of the step that is in the present state already
};

/// Rate of direction d at the share s of a step.
inline real rate_at(const Run& ws, const Look& look, real s, int d) {
  return ws.fixed.start_rate[d] + (s + look.taken) * ws.fixed.rate_change[d];
}

/// Power that supply i gives over a step in its middle: work on the shaft, and heat.
inline real supply_power(const Run& ws, int i, real torque, real rate, const real* state) {
  const Branch<real>& b = ws.branch[ws.sys.supply_element[i]];
  return torque * rate + branch_heat(ws, b, rate, state, Dual<real, 1>(torque)).v;
}

/// Energies since the start of a step up to its share s, given one after another: directions, sources, supplies,
/// meters. docs/theory/fixed-steps.md (9)
template <class Add>
void energies_until(const Run& ws, const Look& look, real s, Add&& add) {
  const auto& sys = ws.sys;
  const Fixed<real>& f = ws.fixed;
  const int np = int(sys.prescribed), nv = int(sys.speeds), nd = ws.n_directions;
  const real span = s * look.h;
  int at = 0;
  for (int d = 0; d < nd; ++d) add(at++, span * look.torque[d] * (f.start_rate[d] + 0.5 * s * f.rate_change[d]));
  for (int p = 0; p < np; ++p) {
    real impulse = 0;
    for (int i = 0; i < nv; ++i) impulse += sys.mass_prescribed[i * np + p] * look.change[i];
    for (int n = 0; n < sys.nodes; ++n) {
      for (int o = 0; o < np; ++o)
        impulse += sys.basis_prescribed[n * np + p] * sys.inertia[n] * sys.basis_prescribed[n * np + o] * look.given[o];
    }
    for (int d = 0; d < nd; ++d) impulse -= look.h * look.torque[d] * prescribed_share(ws, d, p);
    add(at++, s * impulse * (f.given[p] + 0.5 * s * look.given[p]));
  }
  for (int i = 0; i < sys.supplies; ++i) {
    const int d = sys.supply_element[i];
    for (int k = 0; k < sys.states; ++k) f.state_ahead[k] = ws.state[k] + 0.5 * s * look.state[k];
    add(at++, span * supply_power(ws, i, look.torque[d], f.start_rate[d] + 0.5 * s * f.rate_change[d], f.state_ahead));
  }
  for (int m = 0; m < sys.meters; ++m) {
    const real impulse = meter_sum<real>(
        sys, m, [&](int n) { return node_value(sys, n, look.change, look.given); },
        [&](int d) { return look.h * look.torque[d]; });
    const int n = sys.meter_node[m];
    const real start = node_value(sys, n, ws.v, f.given), gain = node_value(sys, n, look.change, look.given);
    add(at++, s * impulse * (start + 0.5 * s * gain));
  }
}

/// What all nodes turn up to the share s of a step, as f(node, angle).
template <class F>
void angles_until(const Run& ws, const Look& look, real s, F&& turned) {
  const Fixed<real>& f = ws.fixed;
  nodes_by(ws, ws.v, f.given, f.node_start), nodes_by(ws, look.change, look.given, f.node_gain);
  for (int n = 0; n < ws.sys.nodes; ++n) turned(n, s * look.h * (f.node_start[n] + 0.5 * s * f.node_gain[n]));
}

/// Speeds, accelerations and angles of the nodes, and the states; `length`: that of the step by which accelerations are
/// told.
inline void fill_motion(const Run& ws, const Look& look, real s, real length, real* row) {
  const auto& sys = ws.sys;
  const Fixed<real>& f = ws.fixed;
  const RowLayout& at = ws.row;
  // as they are behind the step, to the last bit
  for (int i = 0; i < sys.speeds; ++i) f.ahead[i] = ws.v[i] + s * look.change[i];
  for (int p = 0; p < sys.prescribed; ++p) f.given_ahead[p] = f.given[p] + s * look.given[p];
  nodes_by(ws, f.ahead, f.given_ahead, row + at.speed);
  nodes_by(ws, look.change, look.given, row + at.acceleration);
  for (int n = 0; n < sys.nodes; ++n) {
    row[at.acceleration + n] = length > 0 ? row[at.acceleration + n] / length : 0;
    row[at.angle + n] = ws.angle[n];
  }
  if (ws.options.angles && s > 0) angles_until(ws, look, s, [&](int n, real angle) { row[at.angle + n] += angle; });
  for (int i = 0; i < sys.states; ++i) row[at.state + i] = ws.state[i] + s * look.state[i];
}

/// Torques and energies.
inline void fill_energies(Run& ws, const Look& look, real s, real* row) {
  const auto& sys = ws.sys;
  const RowLayout& at = ws.row;
  const int nd = ws.n_directions, ne = int(sys.elements);
  auto copy = [&](std::int64_t to, const real* from, std::int64_t n) {
    for (std::int64_t i = 0; i < n; ++i) row[to + i] = from[i];
  };
  copy(at.element_torque, look.torque, ne), copy(at.contact_torque, look.torque + ne, sys.contacts);
  copy(at.element_work, ws.work, ne), copy(at.contact_work, ws.work + ne, sys.contacts);
  copy(at.prescribed_work, ws.prescribed_work, sys.prescribed);
  copy(at.supply_energy, ws.supplied, sys.supplies), copy(at.meter_energy, ws.metered, sys.meters);
  if (!ws.options.work || s == 0) return;
  auto place = [&](int i) -> real& {
    const int source = i - nd, supply = source - int(sys.prescribed), meter = supply - int(sys.supplies);
    if (i < nd) return row[i < ne ? at.element_work + i : at.contact_work + i - ne];
    if (supply < 0) return row[at.prescribed_work + source];
    return row[meter < 0 ? at.supply_energy + supply : at.meter_energy + meter];
  };
  energies_until(ws, look, s, [&](int i, real energy) { place(i) += energy; });
}

/// Flows and powers of supplies, at the inputs of the row.
inline void fill_flows(Run& ws, const Look& look, real s, real* row) {
  const auto& sys = ws.sys;
  const Fixed<real>& f = ws.fixed;
  const RowLayout& at = ws.row;
  if (sys.flows > 0) {
    // as they are with the torques of the step
    for (int d = 0; d < ws.n_directions; ++d) f.predicted[d] = rate_at(ws, look, s, d);
    shared_rates(ws, f.predicted, look.torque, row + at.state, ws.observed.state_rates);
    for (int i = 0; i < sys.flows; ++i) row[at.flow + i] = flow_value(ws, i);
  }
  for (int i = 0; i < sys.supplies; ++i) {
    const int d = sys.supply_element[i];
    row[at.supply_power + i] = supply_power(ws, i, look.torque[d], rate_at(ws, look, s, d), row + at.state);
  }
}

/// Mode of contact c as a row tells it; one that never sticks moves the way it slips.
inline int shown_mode(const Run& ws, const Look& look, int c, int mode, real s) {
  if (!ws.contact.loaded[c]) return open;
  if (!ws.contact.compliant[c] || mode == locked) return mode;
  return rate_at(ws, look, s, int(ws.sys.elements) + c) < 0 ? backward : forward;
}

/// The numbers of one row at the share s of a step.
inline void fill_row(Run& ws, const Look& look, real s, real length, const int* mode, real* row) {
  const auto& sys = ws.sys;
  const double t = look.t + double(s * look.h);
  fill_motion(ws, look, s, length, row);
  fill_energies(ws, look, s, row);
  inputs_at(ws, t);
  if (ws.in.n_shared_refs > 0) shared_inputs(ws, row + ws.row.state);
  fill_flows(ws, look, s, row);
  for (int c = 0; c < sys.contacts; ++c) {
    const int resisted = look.torque[sys.elements + c] > 0 ? backward : forward;
    row[ws.row.contact_mode + c] = shown_mode(ws, look, c, mode[c], s);
    row[ws.row.contact_capacity + c] = static_torque(ws, c, resisted);
  }
  for (int i = 0; i < sys.inputs; ++i) row[ws.row.input + i] = signal_value(ws, i, t);
}

}  // namespace clutchwork::fixed

#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/fixed/contacts.hpp>
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

/// Energy that direction d gives since the start of a step up to its share s. docs/theory/fixed-steps.md (9)
template <class V = real>
CLUTCHWORK_INLINE V direction_energy(const Run& ws, const Look& look, real s, int d) {
  const Fixed<real>& f = ws.fixed;
  return s * look.h * take<V>(look.torque + d) * (take<V>(f.start_rate + d) + 0.5 * s * take<V>(f.rate_change + d));
}

/// The same of sources, supplies and meters, given one after another with the numbers behind those of the directions.
template <class Add>
void other_energies_until(const Run& ws, const Look& look, real s, Add&& add) {
  const auto& sys = ws.sys;
  const Fixed<real>& f = ws.fixed;
  const int np = int(sys.prescribed), nv = int(sys.speeds), nd = ws.n_directions;
  const real span = s * look.h;
  int at = nd;
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

/// Speeds of all nodes at the end of the step that was taken, and what they have gained.
inline void see_nodes(const Run& ws, const Look& look) {
  nodes_by(ws, ws.v, ws.fixed.given, ws.fixed.node_end);
  nodes_by(ws, look.change, look.given, ws.fixed.node_gain);
}

/// Angles of all nodes at the share s of a step that is not taken yet.
inline void angles_at(const Run& ws, const Look& look, real s, real* angle) {
  const Fixed<real>& f = ws.fixed;
  nodes_by(ws, ws.v, f.given, f.node_end), nodes_by(ws, look.change, look.given, f.node_gain);
  for (int n = 0; n < ws.sys.nodes; ++n)
    angle[n] = ws.angle[n] + s * look.h * (f.node_end[n] + 0.5 * s * f.node_gain[n]);
}

/// Speeds, accelerations and angles of the nodes, and the states; `length`: that of the step by which accelerations are
/// told.
inline void fill_motion(const Run& ws, const Look& look, real s, real length, real* row) {
  const auto& sys = ws.sys;
  const Fixed<real>& f = ws.fixed;
  const RowLayout& at = ws.row;
  real *speed = row + at.speed, *acceleration = row + at.acceleration, *angle = row + at.angle;
  if (look.taken != 1) {
    // as they are behind the step, to the last bit
    for (int i = 0; i < sys.speeds; ++i) f.ahead[i] = ws.v[i] + s * look.change[i];
    for (int p = 0; p < sys.prescribed; ++p) f.given_ahead[p] = f.given[p] + s * look.given[p];
    nodes_by(ws, f.ahead, f.given_ahead, f.node_end);
    nodes_by(ws, look.change, look.given, f.node_gain);
  } else if (!ws.options.angles) {
    see_nodes(ws, look);
  }
  for (int n = 0; n < sys.nodes; ++n) {
    speed[n] = f.node_end[n];
    acceleration[n] = length > 0 ? f.node_gain[n] / length : 0;
    angle[n] = ws.angle[n];
  }
  if (ws.options.angles && s > 0) angles_at(ws, look, s, angle);
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
  real *torque = row + at.element_torque, *work = row + at.element_work;
  for (int d = 0; d < ne; ++d) torque[d] = look.torque[d], work[d] = ws.work[d];
  torque = row + at.contact_torque - ne, work = row + at.contact_work - ne;
  for (int d = ne; d < nd; ++d) torque[d] = look.torque[d], work[d] = ws.work[d];
  copy(at.prescribed_work, ws.prescribed_work, sys.prescribed);
  copy(at.supply_energy, ws.supplied, sys.supplies), copy(at.meter_energy, ws.metered, sys.meters);
  if (!ws.options.work || s == 0) return;
  auto place = [&](int i) -> real& {
    const int source = i - nd, supply = source - int(sys.prescribed), meter = supply - int(sys.supplies);
    if (i < nd) return row[i < ne ? at.element_work + i : at.contact_work + i - ne];
    if (supply < 0) return row[at.prescribed_work + source];
    return row[meter < 0 ? at.supply_energy + supply : at.meter_energy + meter];
  };
  for (int d = 0; d < nd; ++d) place(d) += direction_energy(ws, look, s, d);
  other_energies_until(ws, look, s, [&](int i, real energy) { place(i) += energy; });
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

/// Static torque of contact c against the slip that a torque resists.
inline real shown_capacity(Run& ws, int c, real torque) {
  const int l = ws.loads.of[c];
  if (l >= 0 && ws.fixed.plan.n_unsteady == 0)
    return bound_at(ws, l, torque > 0 ? backward : forward).at(ws.loads.now[l]);
  if (l >= 0) return static_torque(ws, c, torque > 0 ? backward : forward);
  return hold_of(ws, c).torque[torque > 0 ? 0 : 1];
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
    row[ws.row.contact_mode + c] = shown_mode(ws, look, c, mode[c], s);
    row[ws.row.contact_capacity + c] = shown_capacity(ws, c, look.torque[sys.elements + c]);
  }
  for (int i = 0; i < sys.inputs; ++i) row[ws.row.input + i] = signal_value(ws, i, t);
}

}  // namespace clutchwork::fixed

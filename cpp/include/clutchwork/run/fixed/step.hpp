#pragma once
#include <clutchwork/run/clamp_loads.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/fixed/contacts.hpp>
#include <clutchwork/run/fixed/pieces.hpp>
#include <clutchwork/run/fixed/rows.hpp>
#include <clutchwork/run/fixed/shared.hpp>
#include <clutchwork/run/fixed/torques.hpp>
#include <clutchwork/run/snapshot.hpp>

/// One fixed step: docs/theory/fixed-steps.md
namespace clutchwork::fixed {

/// Speeds, states and rates that are expected in the middle of the step, from the last one; what round-off makes of a
/// shaft at rest is no rate. docs/theory/fixed-steps.md (3)
inline void predict(Run& ws, real h, real tolerance) {
  const auto& sys = ws.sys;
  Fixed<real>& f = ws.fixed;
  const real share = f.time == ws.time && f.before > 0 ? 0.5 * h / f.before : 0;
  for (int i = 0; i < sys.speeds; ++i) f.ahead[i] = ws.v[i] + share * f.gain[i];
  for (int i = 0; i < sys.states; ++i) f.state_ahead[i] = ws.state[i] + share * f.state_gain[i];
  rates_by(ws, f.ahead, f.predicted), rates_by(ws, ws.v, f.start_rate), sum_slips(ws, f.start_rate);
  for (int d = 0; d < ws.n_directions; ++d) {
    for (int p = 0; p < sys.prescribed; ++p) {
      f.predicted[d] += prescribed_share(ws, d, p) * ws.in.prescribed[p];
      f.start_rate[d] += prescribed_share(ws, d, p) * f.given[p];
    }
    if (abs(f.predicted[d]) <= tolerance) f.predicted[d] = 0;
  }
}

/// Signals at time t, beyond their knots where they have passed one.
inline void read_signals(Run& ws, double t) {
  // which contacts are pressed and which fail is seen in every step
  ws.in.next_knot > t ? inputs_at(ws, t) : load_inputs(ws, t);
}

/// Inputs that are states or rates, as they are predicted for the middle.
inline void see_middle(Run& ws) {
  if (ws.in.n_shared_refs > 0) shared_inputs(ws, ws.fixed.state_ahead);
  for (int i = 0; i < ws.in.n_rate_refs; ++i) {
    const int ref = ws.in.rate_ref[i];
    ws.in.u[ref] = ws.fixed.predicted[element_behind(ws, ref)];
  }
}

/// What a step changes beside its results: segments of signals, faults and their events.
inline void keep_outside(Run& ws) {
  Fixed<real>& f = ws.fixed;
  for (int i = 0; i < ws.sys.inputs; ++i) f.segment[i] = ws.in.signal[i].segment;
  for (int c = 0; c < ws.sys.contacts; ++c) f.fault[c] = ws.contact.fault[c];
  f.failed = ws.contact.failed, f.events = ws.events.n, f.counted = ws.statistics.events;
}
/// Signals as they were before the step.
inline void rewind_signals(Run& ws) {
  for (int i = 0; i < ws.sys.inputs; ++i) ws.in.signal[i].segment = ws.fixed.segment[i];
  load_inputs(ws, ws.time);
  refresh_loads(ws);
}
/// All of it: the step that was made is none.
inline void rewind(Run& ws) {
  Fixed<real>& f = ws.fixed;
  for (int c = 0; c < ws.sys.contacts; ++c) ws.contact.fault[c] = f.fault[c];
  ws.contact.failed = f.failed, ws.events.n = f.events, ws.statistics.events = f.counted;
  rewind_signals(ws);
}

/// Contacts fail whose fault is there now.
inline void see_faults(Run& ws) {
  for (int i = 0; i < ws.guard.n_faulty; ++i) {
    const int c = ws.guard.faulty[i];
    if (ws.contact.fault[c] == sound && fault_trigger(ws, c) > 0) fail(ws, c);
  }
}

/// Prescribed speeds at the end of the step.
inline void follow_prescribed(Run& ws, double t) {
  Fixed<real>& f = ws.fixed;
  if (ws.in.next_knot < t) load_inputs(ws, t);
  for (int p = 0; p < ws.sys.prescribed; ++p)
    f.given_change[p] = signal_value(ws, int(ws.sys.prescribed_input[p]), t) - f.given[p];
}

/// The change of the speeds without the impulses of contacts, and the slips at the end with it.
/// docs/theory/fixed-steps.md (5)
inline void move_freely(Run& ws, real h) {
  const auto& sys = ws.sys;
  Fixed<real>& f = ws.fixed;
  const int nv = int(sys.speeds), np = int(sys.prescribed), ne = int(sys.elements), nc = int(sys.contacts);
  real* x = f.change;
  for (int i = 0; i < nv; ++i) {
    x[i] = 0;
    for (int p = 0; p < np; ++p) x[i] -= sys.mass_prescribed[i * np + p] * f.given_change[p];
  }
  for (int d = 0; d < ws.n_directions; ++d) {
    real given = 0;
    for (int p = 0; p < np; ++p) given += prescribed_share(ws, d, p) * f.given_change[p];
    f.rate_change[d] = given;
    if (!is_smooth(ws, d)) continue;
    const real impulse = h * (f.force[d] + f.kept[d] * (f.start_rate[d] + 0.5 * given));
    const auto row = rate_row(sys, d);
    for (int k = 0; k < row.n; ++k) x[row.column[k]] += impulse * row.value[k];
  }
  forward_solve(nv, f.factor, nv, x), backward_solve(nv, f.factor, nv, x);
  rates_by(ws, x, f.gained);
  for (int c = 0; c < nc; ++c) f.gradient[c] = f.start_rate[ne + c] + f.rate_change[ne + c] + f.gained[ne + c];
}

/// Speeds without inertia follow torques at once, of which a step knows those in its middle: they go on from the
/// middles of two steps, and rates with them. docs/theory/fixed-steps.md, rule 5
inline void settle_massless(Run& ws, real h) {
  const auto& sys = ws.sys;
  Fixed<real>& f = ws.fixed;
  for (int i = 0; i < sys.speeds; ++i) {
    if (sys.massless[i] == 0) continue;
    const real middle = 0.5 * f.change[i], last = -0.5 * f.gain[i];
    f.change[i] = middle + h / (h + f.before) * (middle - last);
  }
  for (int d = 0; d < ws.n_directions; ++d) {
    if (f.massless[d] == 0) continue;
    f.rate_change[d] = rate_row(sys, d).times(f.change);
    for (int p = 0; p < sys.prescribed; ++p) f.rate_change[d] += prescribed_share(ws, d, p) * f.given_change[p];
  }
}

/// Speeds, torques and states with the impulses.
inline void move(Run& ws, real h) {
  const auto& sys = ws.sys;
  Fixed<real>& f = ws.fixed;
  const int nv = int(sys.speeds), ne = int(sys.elements);
  for (int c = 0; c < sys.contacts; ++c) axpy(nv, f.impulse[c], f.answer + c * nv, f.change);
  rates_by(ws, f.change, f.gained);
  for (int d = 0; d < ws.n_directions; ++d) {
    f.rate_change[d] += f.gained[d];
    f.mean[d] = is_smooth(ws, d) ? f.force[d] + f.kept[d] * (f.start_rate[d] + 0.5 * f.rate_change[d]) : 0;
    if (d >= ne) f.mean[d] += f.impulse[d - ne] / h;
  }
  end_states(ws);
  if (sys.shared > 0) change_shared(ws, h);
  // the first step has no middle before its own
  if (f.has_massless && f.before > 0) settle_massless(ws, h);
}

/// Contacts that only join prescribed shafts: their torque moves nothing. False: a freewheel is turned backward.
inline bool hold_rigid(Run& ws, real h, real tolerance) {
  Fixed<real>& f = ws.fixed;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (!is_rigid(ws, c) || !ws.contact.loaded[c] || ws.loads.of[c] >= 0) continue;
    const real slip = f.end_slip[c];
    if (free_way(ws, c) * slip < -1e3 * tolerance) return ws.detail.component = int(ws.sys.elements) + c, false;
    if (abs(slip) > tolerance && free_way(ws, c) * slip <= 0)
      f.impulse[c] = slip > 0 ? -h * f.kinetic[2 * c + 1] : h * f.kinetic[2 * c];
  }
  return true;
}

/// Whether the laws of the contacts know the slips at the end of the step; else `detail` tells which does not.
inline bool are_known(Run& ws) {
  for (int c = 0; c < ws.sys.contacts; ++c) {
    real seen = 0;
    if (!ws.contact.loaded[c] || table_room(ws, c, ws.fixed.end_slip[c], seen) >= 0) continue;
    ws.detail.component = int(ws.sys.elements) + c, ws.detail.value = double(seen);
    return false;
  }
  return true;
}

/// Freewheels that hold no more give way for good: whether there are any. docs/theory/contacts.md, rule 3
inline bool gives_way(Run& ws, real tolerance) {
  const Fixed<real>& f = ws.fixed;
  bool any = false;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const bool held = ws.contact.loaded[c] && f.side[c] == 1 && f.lower[c] < f.upper[c];
    if (!held || free_way(ws, c) <= 0 || f.end_slip[c] >= -tolerance) continue;
    fail(ws, c);
    any = true;
  }
  return any;
}

/// Everything of one step but its taking over, again without each freewheel that gives way. `running`: it is there.
inline Status make_step(Run& ws, const double t, const real h, const double end) {
  Fixed<real>& f = ws.fixed;
  const real tolerance = slip_tolerance(ws);
  read_signals(ws, t + 0.5 * double(h));
  predict(ws, h, tolerance);
  see_middle(ws);
  if (ws.guard.n_faulty > 0) see_faults(ws);
  if (ws.contact.failed >= 0) return ws.detail.component = int(ws.sys.elements) + ws.contact.failed, Status::fault;
  see_loads(ws);
  if (!see_torques(ws, h)) return Status::no_mode;
  for (int c = 0; c < ws.sys.contacts; ++c) see_contact(ws, c);
  see_bounds_of_loads(ws);
  follow_prescribed(ws, end);
  move_freely(ws, h);
  if (ws.sys.loads > 0) see_free_loads(ws, h);
  if (!find_impulses(ws, h, tolerance)) return Status::no_mode;
  if (!hold_rigid(ws, h, tolerance)) return Status::jammed;
  if (gives_way(ws, tolerance)) return rewind_signals(ws), make_step(ws, t, h, end);
  for (int l = 0; l < ws.sys.loads; ++l) ws.loads.now[l] = load_impulse(ws, l) / h;
  move(ws, h);
  if (!are_known(ws)) return Status::out_of_table;
  for (int c = 0; c < ws.sys.contacts; ++c) f.mode[c] = mode_behind(ws, c, tolerance);
  real sum = 0;
  for (int i = 0; i < ws.sys.speeds; ++i) sum += f.change[i] * 0;
  for (int i = 0; i < ws.sys.states; ++i) sum += f.state_change[i] * 0;
  return sum == 0 ? Status::running : Status::not_finite;
}

/// The step is taken: speeds, states, angles, work and history.
inline void take_over(Run& ws, const Look& look) {
  const auto& sys = ws.sys;
  Fixed<real>& f = ws.fixed;
  if (ws.options.work)
    energies_until(ws, look, 1.0, [&](int i, real energy) { add(work_of(ws, i), f.energy_low, i, energy); });
  if (ws.options.angles)
    angles_until(ws, look, 1.0, [&](int n, real angle) { add(ws.angle[n], f.angle_low, n, angle); });
  for (int i = 0; i < sys.speeds; ++i) add(ws.v[i], f.speed_low, i, f.change[i]), f.gain[i] = f.change[i];
  for (int i = 0; i < sys.states; ++i)
    add(ws.state[i], f.state_low, i, f.state_change[i]), f.state_gain[i] = f.state_change[i];
  for (int p = 0; p < sys.prescribed; ++p) f.given[p] += f.given_change[p], f.given_gain[p] = f.given_change[p];
  f.before = look.h;
  ++ws.statistics.steps;
}

/// What led to a change of mode.
inline Cause cause_of(const Run& ws, int c, int from) {
  if (!ws.contact.loaded[c]) return from == locked ? Cause::input : Cause::passing;
  if (from == open) return Cause::input;
  return from == locked ? Cause::torque_limit : Cause::slip_zero;
}

/// Report the contacts that have changed, in the order of their instants, and give them their modes.
inline void report(Run& ws, const Look& look, double end) {
  Fixed<real>& f = ws.fixed;
  const int ne = int(ws.sys.elements), nc = int(ws.sys.contacts);
  int n = 0;
  for (int c = 0; c < nc; ++c) {
    if (f.mode[c] == ws.contact.mode[c]) continue;
    const bool was_locked = ws.contact.mode[c] == locked;
    const real s = was_locked ? larger(0.0, f.box[c] == slips_on ? f.share[c] : 0) : share_at_zero(ws, c, look.h);
    f.instant[c] = smaller(look.t + double(s * look.h), end);
    int at = n++;
    for (; at > 0 && f.instant[f.list[at - 1]] > f.instant[c]; --at) f.list[at] = f.list[at - 1];
    f.list[at] = c;
  }
  if (n == 0) return;
  inputs_at(ws, end);
  const real energy = kinetic_energy(ws);
  for (int k = 0; k < n; ++k) {
    const int c = f.list[k], from = ws.contact.mode[c], to = f.mode[c];
    ws.contact.mode[c] = to;
    if (is_stop(ws, c)) ws.contact.side[c] = 0;
    // what was open and slips now without a load tells nothing
    if (from == open && to != locked) continue;
    ws.time = f.instant[c];
    const real acceleration = f.rate_change[ne + c] / look.h;
    record(ws, {c, from, to, cause_of(ws, c, from), double(acceleration), double(f.torque[ne + c]),
                double(f.mean[ne + c]), double(energy), double(energy)});
  }
}

}  // namespace clutchwork::fixed

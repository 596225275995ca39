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
  in_pairs(int(sys.speeds), [&](int i, auto as) {
    using V = decltype(as);
    put(f.ahead + i, take<V>(ws.v + i) + share * take<V>(f.gain + i));
  });
  for (int i = 0; i < sys.states; ++i) f.state_ahead[i] = ws.state[i] + share * f.state_gain[i];
  // nobody reads those of elements where all are linear
  const int first = f.plan.n_bent + ws.in.n_rate_refs > 0 ? 0 : int(sys.elements);
  rates_by(ws, f.ahead, f.predicted, first), rates_by(ws, ws.v, f.start_rate), sum_slips(ws, f.start_rate);
  for (int d = 0; sys.prescribed > 0 && d < ws.n_directions; ++d) {
    for (int p = 0; p < sys.prescribed; ++p) {
      if (d >= first) f.predicted[d] += prescribed_share(ws, d, p) * ws.in.prescribed[p];
      f.start_rate[d] += prescribed_share(ws, d, p) * f.given[p];
    }
  }
  for (int d = first; d < ws.n_directions; ++d) {
    if (abs(f.predicted[d]) <= tolerance) f.predicted[d] = 0;
  }
}

/// Take the value of a signal that was set, where that is all that has changed; whether it is.
inline bool take_alone(Run& ws, double t) {
  const int i = ws.in.alone;
  if (i < 0 || !(ws.in.knot_behind > t) || ws.in.signal[i].varying || !is_held(ws, i)) return false;
  seek(ws, i, t);
  const real held = ws.in.signal[i].held;
  for (int ref = 0; ref < ws.in.n_refs; ++ref) {
    if (ws.in.ref_signal[ref] == i) ws.in.u[ref] = held, ws.in.du[ref] = 0;
  }
  ws.in.next_knot = ws.in.knot_behind, ws.in.alone = -1;
  if (ws.sys.input_count[i] == 0) return true;
  // its own knots count no more
  ws.in.next_knot = infinity;
  for (int k = 0; k < ws.sys.inputs; ++k) ws.in.next_knot = smaller(ws.in.next_knot, double(ws.in.signal[k].knot));
  return true;
}

/// Signals at time t, beyond their knots where they have passed one.
inline void read_signals(Run& ws, double t) {
  // which contacts are pressed and which fail is seen in every step
  if (ws.in.next_knot > t) return inputs_at(ws, t);
  take_alone(ws, t) ? inputs_at(ws, t) : load_inputs(ws, t);
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

/// Prescribed speeds at the end of the step; everything else still reads its middle.
inline void follow_prescribed(Run& ws, double t) {
  Fixed<real>& f = ws.fixed;
  for (int p = 0; p < ws.sys.prescribed; ++p) {
    const int i = int(ws.sys.prescribed_input[p]);
    auto& signal = ws.in.signal[i];
    const auto present = signal;
    if (signal.knot < t) seek(ws, i, t);
    f.given_change[p] = signal_value(ws, i, t) - f.given[p];
    signal = present;
  }
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
    f.rate_change[d] = 0;
    for (int p = 0; p < np; ++p) f.rate_change[d] += prescribed_share(ws, d, p) * f.given_change[p];
  }
  auto push = [&](int d) {
    add_direction(ws, d, h * (f.force[d] + f.kept[d] * (f.start_rate[d] + 0.5 * f.rate_change[d])), x);
  };
  for (int k = 0; k < f.plan.n_linear; ++k) push(f.plan.linear[k]);
  for (int k = 0; k < f.plan.n_bent; ++k) push(f.plan.bent[k]);
  solve_step(nv, f.factor, x);
  rates_by(ws, x, f.gained, sys.loads > 0 ? 0 : ne);
  in_pairs(nc, [&](int c, auto as) {
    using V = decltype(as);
    put(f.gradient + c, take<V>(f.start_rate + ne + c) + take<V>(f.rate_change + ne + c) + take<V>(f.gained + ne + c));
  });
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
  const int nv = int(sys.speeds), ne = int(sys.elements), nc = int(sys.contacts);
  for (int c = 0; c < nc; ++c) {
    in_pairs(nv, [&](int i, auto as) {
      using V = decltype(as);
      put(f.change + i, take<V>(f.change + i) + f.impulse[c] * take<V>(f.answer + c * nv + i));
    });
  }
  rates_by(ws, f.change, f.gained);
  // forces and slopes of what sticks are zero
  in_pairs(ws.n_directions, [&](int d, auto as) {
    using V = decltype(as);
    const V change = take<V>(f.rate_change + d) + take<V>(f.gained + d);
    put(f.rate_change + d, change);
    put(f.mean + d, take<V>(f.force + d) + take<V>(f.kept + d) * (take<V>(f.start_rate + d) + 0.5 * change));
  });
  in_pairs_alone(nc, [&](int c, auto as) {
    using V = decltype(as);
    put(f.mean + ne + c, take<V>(f.mean + ne + c) + take<V>(f.impulse + c) / h);
  });
  end_states(ws, h);
  if (sys.shared > 0) change_shared(ws, h);
  // the first step has no middle before its own
  if (f.has_massless && f.before > 0) settle_massless(ws, h);
}

/// Contacts that only join prescribed shafts: their torque moves nothing. False: a freewheel is turned backward.
inline bool hold_rigid(Run& ws, real h, real tolerance) {
  Fixed<real>& f = ws.fixed;
  for (int k = 0; k < f.plan.n_rigid; ++k) {
    const int c = f.plan.rigid[k];
    if (!ws.contact.loaded[c] || ws.loads.of[c] >= 0) continue;
    const real slip = f.end_slip[c];
    if (free_way(ws, c) * slip < -1e3 * tolerance) return ws.detail.component = int(ws.sys.elements) + c, false;
    if (abs(slip) > tolerance && free_way(ws, c) * slip <= 0)
      f.impulse[c] = slip > 0 ? -h * f.kinetic[2 * c + 1] : h * f.kinetic[2 * c];
  }
  return true;
}

/// Whether the laws of the contacts know the slips at the end of the step; else `detail` tells which does not.
inline bool are_known(Run& ws) {
  for (int k = 0; k < ws.fixed.plan.n_bounded; ++k) {
    const int c = ws.fixed.plan.bounded[k];
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
  for (int k = 0; k < f.plan.n_one_way; ++k) {
    const int c = f.plan.one_way[k];
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
  share_over_step(ws, h);
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
CLUTCHWORK_INLINE void take_over(Run& ws, const Look& look) {
  const auto& sys = ws.sys;
  Fixed<real>& f = ws.fixed;
  if (ws.options.work) {
    in_pairs(ws.n_directions, [&](int d, auto as) {
      add_at(ws.work, f.energy_low, d, direction_energy<decltype(as)>(ws, look, 1.0, d));
    });
    if (sys.prescribed + sys.supplies + sys.meters > 0)
      other_energies_until(ws, look, 1.0, [&](int i, real energy) { add(work_of(ws, i), f.energy_low, i, energy); });
  }
  auto gain = [](int n, const real* change, real* now, real* low, real* gained) {
    in_pairs(n, [&](int i, auto as) {
      const auto x = take<decltype(as)>(change + i);
      add_at(now, low, i, x), put(gained + i, x);
    });
  };
  gain(int(sys.speeds), f.change, ws.v, f.speed_low, f.gain);
  gain(int(sys.states), f.state_change, ws.state, f.state_low, f.state_gain);
  for (int p = 0; p < sys.prescribed; ++p) f.given[p] += f.given_change[p], f.given_gain[p] = f.given_change[p];
  if (ws.options.angles) {
    see_nodes(ws, look);
    in_pairs(int(sys.nodes), [&](int n, auto as) {
      using V = decltype(as);
      add_at(ws.angle, f.angle_low, n, look.h * (take<V>(f.node_end + n) - 0.5 * take<V>(f.node_gain + n)));
    });
  }
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
[[gnu::noinline]] inline void report_changes(Run& ws, const Look& look, double end) {
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

CLUTCHWORK_INLINE void report(Run& ws, const Look& look, double end) {
  bool any = false;
  for (int c = 0; c < ws.sys.contacts; ++c) any = any || ws.fixed.mode[c] != ws.contact.mode[c];
  if (any) report_changes(ws, look, end);
}

}  // namespace clutchwork::fixed

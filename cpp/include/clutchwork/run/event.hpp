#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/acceleration.hpp>
#include <clutchwork/contacts/decision.hpp>
#include <clutchwork/contacts/impulses.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/workspace.hpp>

/// What happens at an instant: decide the modes anew and report every change.
namespace clutchwork {

/// Torque of a contact right after the decision.
template <class T>
T torque_after(const Workspace<T>& ws, int c) {
  const int d = int(ws.sys.elements) + c;
  if (!ws.loaded[c]) return T(0);
  const T held = ws.mode[c] == locked ? ws.torque[d] : T(0);
  if (ws.mode[c] == locked && !ws.compliant[c]) return held;
  const Branch<T> b = make_branch(ws, d, ws.mode[c]);
  return held + contact_torque(ws, b, rate_of(ws, d), ws.state, ws.scratch);
}

/// Slip acceleration of every contact right after the decision, into `out`.
template <class T>
void accelerations_after(Workspace<T>& ws, T* out) {
  const int nc = int(ws.sys.contacts), ne = int(ws.sys.elements), nv = int(ws.sys.speeds);
  int* stuck = ws.iscratch;
  T* q = ws.scratch + ws.sys.states + 1;
  for (int c = 0; c < nc; ++c) stuck[c] = ws.mode[c] == locked;
  free_motion(ws, stuck, q);
  for (int c = 0; c < nc; ++c) {
    if (ws.mode[c] == locked && ws.loaded[c]) axpy(nv, ws.torque[ne + c], ws.direction + (ne + c) * nv, q);
  }
  for (int c = 0; c < nc; ++c) out[c] = ws.mode[c] == locked ? T(0) : slip_acceleration(ws, c, q);
}

/// Append one event to the buffer.
template <class T>
void record(Workspace<T>& ws, int c, int from, int to, Cause cause, double acceleration, double before, double after,
            double energy_before, double energy_after) {
  double* e = ws.events + event_size * ws.n_events++;
  const double values[event_size] = {ws.time,      double(c), double(from), double(to),    double(int(cause)),
                                     acceleration, before,    after,        energy_before, energy_after};
  for (int i = 0; i < event_size; ++i) e[i] = values[i];
  ++ws.statistics.events;
}

/// Torques and slip accelerations of the contacts at the end of a phase, for the report.
template <class Form>
void note_before(Form& form, Step<Form>& step, double s) {
  auto& ws = form.ws;
  const int nc = int(ws.sys.contacts), ne = int(ws.sys.elements);
  const auto shot = take_snapshot(form, step, s);
  for (int c = 0; c < nc; ++c) {
    const int k = ws.branch_of[ne + c];
    ws.torque_before[c] = ws.output_torque[ne + c];
    ws.slip_slope[c] = k >= 0 ? form.rate(k, shot.d) + offset_slope(ws, k) : 0.0;
    ws.mode_before[c] = ws.mode[c];
  }
}

/// Whether something happens more than 50 times within a microsecond; `count` is its own of ws.crowd.
template <class T>
bool crowds(Workspace<T>& ws, std::int64_t count) {
  constexpr int most = 50;
  if (ws.time - ws.crowd_time > 1e-6) {
    ws.crowd_time = ws.time;
    for (std::int64_t i = 0; i < ws.n_directions + ws.sys.inputs; ++i) ws.crowd[i] = 0;
  }
  return ++ws.crowd[count] > most;
}

/// Whether a direction has events that crowd; they are told by its number.
template <class T>
bool events_crowd(Workspace<T>& ws, int direction) {
  if (!crowds(ws, direction)) return false;
  ws.detail_component = direction;
  return true;
}

/// Whether the knots of a signal crowd; told by the number of the signal, without a component.
template <class T>
bool knots_crowd(Workspace<T>& ws) {
  for (std::int64_t i = 0; i < ws.sys.inputs; ++i) {
    if (ws.signal[i].knot > ws.time || !crowds(ws, ws.n_directions + i)) continue;
    ws.detail_component = -1;
    ws.detail_value = double(i);
    return true;
  }
  return false;
}

/// Whether the load of a contact can pass zero before the next knot. A load is monotonic in each of its inputs while
/// the others are held, so its extremes are at the corners of their ranges.
template <class T>
bool load_may_turn(Workspace<T>& ws, int c) {
  const System& sys = ws.sys;
  ws.load_size[c] = 0;
  return visit_contact(sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    double low[E::inputs > 0 ? E::inputs : 1], high[E::inputs > 0 ? E::inputs : 1];
    for (int i = 0; i < E::inputs; ++i) {
      signal_range(ws, sys.input_refs[sys.contact_input[c] + i], ws.time, low[i], high[i]);
      if (high[i] - low[i] == infinity || high[i] - low[i] != high[i] - low[i]) return true;
    }
    bool below = false, above = false;
    double size = 0;
    for (unsigned corner = 0; corner < 1u << E::inputs; ++corner) {
      T at[E::inputs > 0 ? E::inputs : 1];
      for (int i = 0; i < E::inputs; ++i) at[i] = T(corner >> i & 1 ? high[i] : low[i]);
      const T load = contact_load(sys.contact_kind[c], ws.params + sys.contact_param[c], &at[0], sys.points);
      (load < T(0) ? below : above) = true;
      size = larger(size, abs(value(load)));
    }
    ws.load_size[c] = size;
    return below && above;
  });
}

/// Forced break-aways last while time stands.
template <class T>
void forget_forced(Workspace<T>& ws) {
  if (ws.time - ws.forced_time <= 1e-9 + 1e-12 * abs(ws.time)) return;
  for (int c = 0; c < ws.sys.contacts; ++c) ws.forced[c] = 0;
  ws.forced_time = ws.time;
}

/// A contact fails: for good, and told as an event without a change of mode.
template <class T>
void fail(Workspace<T>& ws, int c) {
  int kind, report;
  fault_of(ws, c, kind, report);
  // a freewheel that gave way transmits nothing more
  if (kind == sound) kind = cannot_transmit;
  ws.fault[c] = kind;
  const double e = kinetic_energy(ws), torque = value(ws.torque_before[c]);
  record(ws, c, ws.mode[c], ws.mode[c], Cause::fault, 0.0, torque, torque, e, e);
  if (report == 2) ws.failed = c;
  if (kind == cannot_transmit) ws.loaded[c] = ws.pressed[c] = 0;
}

/// Flags that follow from the signals: which contacts are closed, which loads vary, which fail.
template <class T>
bool refresh_loads(Workspace<T>& ws) {
  const System& sys = ws.sys;
  bool changed = false;
  ws.n_watch = ws.n_faulty = 0;
  for (int c = 0; c < sys.contacts; ++c) {
    int kind, report;
    fault_of(ws, c, kind, report);
    if (kind != sound && ws.fault[c] == sound) {
      ws.faulty[ws.n_faulty++] = c;
      if (fault_trigger(ws, c) > 0) fail(ws, c), changed = true;
    }
    const int pressed = is_pressed(ws, c), was = ws.pressed[c];
    ws.pressed[c] = pressed;
    const int closed = is_closed(ws, c);
    changed = changed || closed != ws.loaded[c] || pressed != was;
    ws.loaded[c] = closed;
    if (load_may_turn(ws, c)) ws.watch[ws.n_watch++] = c;
  }
  return changed;
}

/// Decide the modes; freewheels that would have to hold more than they can give way for good on the way. `running`:
/// they are decided.
template <class T>
Status settle(Workspace<T>& ws, int located) {
  for (int round = 0; round <= ws.sys.contacts; ++round) {
    int who = located;
    const Settled settled = settle_contacts(ws, who);
    if (settled == Settled::jams) {
      ws.detail_component = int(ws.sys.elements) + who;
      return Status::jammed;
    }
    if (settled != Settled::gives_way) return settled == Settled::yes ? Status::running : Status::no_mode;
    fail(ws, who);
  }
  return Status::no_mode;
}

/// A freewheel that runs backward although everything is decided; -1: none.
template <class T>
int backward_freewheel(const Workspace<T>& ws) {
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (!ws.loaded[c] || !contact_one_way(ws, c)) continue;
    if (value(rate_of(ws, int(ws.sys.elements) + c)) < -1e3 * slip_tolerance(ws)) return c;
  }
  return -1;
}

/// Decide the modes at the present instant and report what changed.
template <class T>
Status switch_modes(Workspace<T>& ws) {
  const System& sys = ws.sys;
  const int nc = int(sys.contacts), ne = int(sys.elements);
  const bool at_start = ws.cause == Cause::initial;
  if (ws.located >= 0 && events_crowd(ws, ne + ws.located)) return Status::zeno;
  ws.detail_component = ws.located >= 0 ? ne + ws.located : -1;
  if (ws.statistics.events > ws.options.max_events) return Status::too_many_events;

  forget_forced(ws);
  if (ws.cause == Cause::slip_zero && ws.located >= 0) ws.forced[ws.located] = 0;

  if (!at_start) prescribed_jump(ws);
  const double before = kinetic_energy(ws);
  if (!settle_impulses(ws, at_start)) return Status::no_mode;
  if (at_start) {
    for (int c = 0; c < nc; ++c) ws.impulse[c] = ws.mode[c] == locked && ws.mode_before[c] != locked;
  }
  const Status first = settle(ws, ws.located);
  if (first != Status::running) return first;
  if (stops_short(ws, ws.located)) {
    if (!stop_within_tolerance(ws, ws.located)) return Status::no_mode;
    // its impulse may bring others to rest, or break them loose
    const Status again = settle(ws, -1);
    if (again != Status::running) return again;
  }
  const int jammed = backward_freewheel(ws);
  if (jammed >= 0) {
    ws.detail_component = ne + jammed;
    return Status::jammed;
  }
  for (int d = 0; d < ne; ++d) {
    if (edge_count(ws, d) > 0) ws.piece[d] = piece_of(ws, d, value(rate_of(ws, d)));
  }
  ws.fresh_phase = true;
  if (ws.failed >= 0) {
    ws.detail_component = ne + ws.failed;
    return Status::fault;
  }

  list_locked(ws);
  share_decided(ws);
  const double after = kinetic_energy(ws);
  T* acceleration = ws.qp_w;
  accelerations_after(ws, acceleration);
  for (int c = 0; c < nc; ++c) {
    if (ws.mode[c] == ws.mode_before[c] || (at_start && !ws.impulse[c])) continue;
    const Cause cause = at_start ? Cause::impulse : c == ws.located || ws.located < 0 ? ws.cause : Cause::consequence;
    const double hits = value(ws.mode[c] == locked ? ws.slip_slope[c] : acceleration[c]);
    record(ws, c, ws.mode_before[c], ws.mode[c], cause, hits, value(ws.torque_before[c]), value(torque_after(ws, c)),
           before, after);
  }
  return Status::running;
}

}  // namespace clutchwork

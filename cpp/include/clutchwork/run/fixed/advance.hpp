#pragma once
#include <clutchwork/run/advance.hpp>
#include <clutchwork/run/fixed/single.hpp>
#include <clutchwork/run/fixed/step.hpp>
#ifndef CLUTCHWORK_SINGLE
#include <clutchwork/run/fixed/stops.hpp>
#endif

/// A run with fixed steps: docs/theory/fixed-steps.md
namespace clutchwork::fixed {

/// Whether all numbers of a row and its kinetic energy are finite for sure: the sum of all of them is.
inline bool is_sound(const Run& ws, const real* row) {
  if constexpr (!has_few_sizes) return false;
  const real* speed = row + ws.row.speed;
  Two sum = {}, energy = {};
  real rest = 0;
  auto add = [&](int i, auto as) {
    if constexpr (sizeof(as) == sizeof(Two))
      sum += take<Two>(row + i);
    else
      rest += row[i];
  };
  auto add_energy = [&](int n, auto as) {
    using V = decltype(as);
    const V w = take<V>(speed + n), part = take<V>(ws.sys.inertia + n) * w * w;
    if constexpr (sizeof(as) == sizeof(Two))
      energy += part;
    else
      rest += part;
  };
  in_pairs_alone(int(ws.row.size), add), in_pairs_alone(int(ws.sys.nodes), add_energy);
  sum += energy;
  return (rest + sum[0] + sum[1]) * 0 == 0;
}

/// Where a row is computed, and how it comes to the caller.
inline double* row_behind(const Workspace<double>&, double* shown) { return shown; }
inline void show_row(const Workspace<double>&, const double*, double*) {}
inline Single* row_behind(const Workspace<Single>& ws, double*) { return ws.fixed.row; }
inline void show_row(const Workspace<Single>& ws, const Single* row, double* shown) { carry(row, ws.row.size, shown); }

/// One row, at the share s of a step; `length`, `mode`: as in fill_row.
inline Status emit(Run& ws, const Look& look, double t, real s, real length, const int* mode, Sink& sink) {
  double* shown = sink.rows + ws.row.size * sink.at;
  real* row = row_behind(ws, shown);
  fill_row(ws, look, s, length, mode, row);
  if (!is_sound(ws, row) && !is_finite(ws, row)) return Status::not_finite;
  show_row(ws, row, shown);
  if (sink.steps > 0) sink.times[sink.at] = t;
  ++sink.at;
  return Status::running;
}

/// Rows of the step that fall before its end.
inline Status emit_inside(Run& ws, const Look& look, double end, Sink& sink) {
  Status status = Status::running;
  for (std::int64_t k = 1; status == Status::running && k < sink.steps; ++k) {
    const real s = real(k) / real(sink.steps);
    status = emit(ws, look, look.t + double(s * look.h), s, look.h, ws.contact.mode, sink);
  }
  while (status == Status::running && sink.steps == 0 && sink.at < sink.count && sink.times[sink.at] < end) {
    const double t = sink.times[sink.at];
    const real s = smaller(real(1), larger(real(0), real(t - look.t) / look.h));
    status = emit(ws, look, t, s, look.h, ws.contact.mode, sink);
  }
  return status;
}

/// Rows at its end, which the present state is.
inline Status emit_end(Run& ws, const Look& step, double end, Sink& sink) {
  const Look look{end, 0, step.change, step.given, step.state, step.torque, 1};
  Status status = Status::running;
  if (sink.steps > 0) return emit(ws, look, end, 0, step.h, ws.fixed.mode, sink);
  while (status == Status::running && sink.at < sink.count && sink.times[sink.at] <= end)
    status = emit(ws, look, end, 0, step.h, ws.fixed.mode, sink);
  return status;
}

/// One row of the present.
inline Status show_present(Run& ws, Sink& sink) {
  Fixed<real>& f = ws.fixed;
  for (int d = 0; d < ws.n_directions; ++d) {
    f.start_rate[d] = rate_row(ws.sys, d).times(ws.v), f.rate_change[d] = 0;
    for (int p = 0; p < ws.sys.prescribed; ++p) f.start_rate[d] += prescribed_share(ws, d, p) * f.given[p];
  }
  const Look look{ws.time, 0, f.gain, f.given_gain, f.state_gain, f.torque};
  return emit(ws, look, ws.time, 0, f.before, ws.contact.mode, sink);
}

/// Rows that are wanted at the present time, the end of the last step.
inline Status emit_present(Run& ws, Sink& sink) {
  while (sink.steps == 0 && sink.at < sink.count && sink.times[sink.at] <= ws.time) {
    if (show_present(ws, sink) != Status::running) return Status::not_finite;
  }
  return Status::running;
}

/// The modes of the present instant, and the torque of a contact in them, as for steps between events.
inline Status decide_start(Workspace<double>& ws, Sink& sink) {
  return advance_by_events(ws, ws.started ? ws.time : ws.options.t_start, sink);
}
inline double start_torque(const Workspace<double>& ws, int c) { return torque_after(ws, c); }
/// Of a run of single precision these are those of the run behind it.
inline Status decide_start(Workspace<Single>& ws, Sink& sink) {
  Workspace<double>& outer = *ws.moved.outer;
  outer.params_changed = ws.params_changed;
  join_parts(outer);
  const Status status = decide_start(outer, sink);
  const Sizes n(ws.sys);
  carry_state(outer, ws), take_whole(outer, ws);
  Fixed<Single>& f = ws.fixed;
  split(outer.v, n.speeds, ws.v, f.speed_low), split(outer.state, n.states, ws.state, f.state_low);
  split(outer.angle, n.nodes, ws.angle, f.angle_low), split(outer.work, n.directions, ws.work, f.energy_low);
  Single* low = f.energy_low + n.directions;
  split(outer.prescribed_work, n.prescribed, ws.prescribed_work, low);
  split(outer.supplied, n.supplies, ws.supplied, low + n.prescribed);
  split(outer.metered, n.meters, ws.metered, low + n.prescribed + n.supplies);
  ws.params_changed = outer.params_changed;
  if (ws.started) load_inputs(ws, ws.time);
  return status;
}
inline Single start_torque(const Workspace<Single>& ws, int c) { return Single(torque_after(*ws.moved.outer, c)); }

/// Where a run begins, or goes on from steps of another method: the modes of that instant, decided as for these.
inline Status begin(Run& ws, Sink& sink) {
  const Status status = decide_start(ws, sink);
  if (status != Status::done) return status;
  Fixed<real>& f = ws.fixed;
  f.time = f.origin = ws.time;
  f.before = 0, f.count = f.impacts = 0, f.fresh = 1;
  for (int p = 0; p < ws.sys.prescribed; ++p) f.given[p] = ws.in.prescribed[p];
  for (int i = 0; i < ws.sys.speeds; ++i) f.gain[i] = 0;
  for (int i = 0; i < ws.sys.states; ++i) f.state_gain[i] = 0;
  for (int p = 0; p < ws.sys.prescribed; ++p) f.given_gain[p] = 0;
  for (int d = 0; d < ws.n_directions; ++d) f.kept[d] = f.torque[d] = 0;
  // what follows loads begins with them
  for (int l = 0; l < ws.sys.loads; ++l) {
    const int c = int(ws.sys.load_contact[l]);
    f.torque[ws.sys.elements + c] = start_torque(ws, c);
  }
  for (int i = 0; i < 2 * ws.sys.contacts; ++i) f.held[i] = 0;
  f.length = 0, f.ready = false;
  return Status::running;
}

/// What must be there before a step.
inline Status make_ready(Run& ws, Sink& sink) {
  Fixed<real>& f = ws.fixed;
  if (!f.ready && !takes(ws)) return Status::refused;
  // its first row is there once, where rows are those of steps
  const bool begun = ws.started && f.time == ws.time;
  if (!begun || (f.fresh != 0 && sink.steps == 0)) {
    const Status status = begin(ws, sink);
    if (status != Status::running) return status;
  }
  if (ws.params_changed) ws.params_changed = f.ready = false, f.length = 0;
  if (!f.ready) pack_all(ws);
  return Status::running;
}

inline Status what_is_spent(const Run& ws, const Sink& sink) {
  if (sink.steps > 0 && sink.at + sink.steps + 2 > sink.count) return Status::rows_full;
  if (ws.events.n >= EventBuffer::room) return Status::events_full;
  if (ws.statistics.steps + ws.statistics.rejected >= ws.options.max_steps) return Status::too_many_steps;
  if (ws.statistics.events > ws.options.max_events) return Status::too_many_events;
  return ws.poll.stops() ? Status::interrupted : Status::running;
}

/// The step that was made becomes the present: its rows, its energies, its modes and pieces.
inline Status finish_step(Run& ws, real h, double end, Sink& sink) {
  Fixed<real>& f = ws.fixed;
  const Look look{ws.time, h, f.change, f.given_change, f.state_change, f.mean};
  if (ws.in.next_knot < end) load_inputs(ws, end);
  Status shown = emit_inside(ws, look, end, sink);
  if (shown != Status::running) return shown;
  take_over(ws, look);
  shown = emit_end(ws, look, end, sink);
  if (shown != Status::running) return shown;
  report(ws, look, end);
  cross_pieces(ws);
  auto copy = [](int n, const real* from, real* to) {
    in_pairs(n, [&](int i, auto as) { put(to + i, take<decltype(as)>(from + i)); });
  };
  copy(ws.n_directions, f.mean, f.torque), copy(2 * int(ws.sys.contacts), f.limit, f.held);
  ws.time = f.time = end, f.fresh = 0;
  return Status::running;
}

#ifndef CLUTCHWORK_SINGLE
/// The part of a step that ends where a stop is met: its motion is one of its own, and meets the end beside where the
/// whole step did. A secant from there. `running`: the part is made.
inline Status make_part(Run& ws, const Meeting& met, real h, real& part) {
  const double start = ws.time;
  real before = h, gap_before = gap_behind(ws, met.contact, met.side, h);
  for (int round = 0; round < most_tries; ++round) {
    rewind(ws);
    const Status status = make_step(ws, start, part, start + part);
    if (status != Status::running) return status;
    const real gap = gap_behind(ws, met.contact, met.side, part);
    if (abs(gap) <= stop_noise(ws, met.contact) || round + 1 == most_tries) break;
    const real next = part - gap * (part - before) / (gap - gap_before);
    if (!(next > 0) || next > h || next == part) break;
    before = part, gap_before = gap, part = next;
  }
  return Status::running;
}

/// Up to a meeting inside the step that was made, which is none then, and the impact there.
inline Status take_impact(Run& ws, const Meeting& met, real h, Sink& sink) {
  const double start = ws.time;
  real part = met.share * h;
  if (part > 1e-9 * ws.options.step) {
    const Status made = make_part(ws, met, h, part);
    if (made != Status::running) return made;
    const Status shown = finish_step(ws, part, start + part, sink);
    if (shown != Status::running) return shown;
  } else {
    rewind(ws);
  }
  const Status status = strike(ws, met);
  return status == Status::running && sink.steps > 0 ? show_present(ws, sink) : status;
}

#endif

/// One step onto the grid, onto the end where that comes before, or up to an impact. `running`: the run goes on.
inline Status take_step(Run& ws, double t_end, Sink& sink) {
  Fixed<real>& f = ws.fixed;
  const double step = ws.options.step, grid = f.origin + double(f.count + 1) * step;
  const bool last = grid > t_end - 1e-9 * step, cut = grid > t_end + 1e-9 * step;
  const double end = last ? t_end : grid;
  const real h = real(cut || f.impacts > 0 ? end - ws.time : step);
  // others are made once
  if (f.plan.n_one_way > 0) keep_outside(ws);
  Status status = make_step(ws, ws.time, h, end);
  if (status != Status::running) return status;
#ifdef CLUTCHWORK_SINGLE
  // stops are refused
  constexpr bool strikes = false;
  status = finish_step(ws, h, end, sink);
#else
  const Meeting met = first_meeting(ws, h, slip_tolerance(ws));
  const bool strikes = met.contact >= 0 && f.impacts < most_bounces + ws.sys.contacts;
  status = strikes ? take_impact(ws, met, h, sink) : finish_step(ws, h, end, sink);
#endif
  // what an impact leaves of a step may be none
  if (status != Status::running || end - ws.time > 1e-9 * step) return status;
  ws.time = f.time = end;
  ++f.count, f.impacts = 0;
  if (cut) f.origin = end, f.count = 0;
  return strikes ? emit_present(ws, sink) : Status::running;
}

/// Steps up to t_end, or to the one in which an event is.
inline Status advance_steps(Run& ws, double t_end, Sink& sink, bool to_event) {
  const int waiting = ws.events.n;
  Status status = make_ready(ws, sink);
  if (status == Status::running) status = emit_present(ws, sink);
  while (status == Status::running && ws.time < t_end && !(to_event && ws.events.n > waiting)) {
    status = what_is_spent(ws, sink);
    if (status == Status::running) status = take_step(ws, t_end, sink);
  }
  return status == Status::running ? Status::done : status;
}

}  // namespace clutchwork::fixed

namespace clutchwork {

template <class T>
Status advance_fixed(Workspace<T>& ws, double t_end, Sink& sink, bool to_event) {
#ifdef CLUTCHWORK_SINGLE
  fixed::Run& run = fixed::take_down(ws);
  const Status status = fixed::advance_steps(run, t_end, sink, to_event);
  fixed::take_up(run, ws);
#else
  const Status status = fixed::advance_steps(ws, t_end, sink, to_event);
#endif
  // whatever else goes on from here begins a phase
  if (ws.started) ws.fresh_phase = true, inputs_at(ws, ws.time), shared_inputs(ws, ws.state);
  return status;
}

}  // namespace clutchwork

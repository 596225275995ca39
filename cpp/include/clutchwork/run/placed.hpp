#pragma once
#include <clutchwork/components/input.hpp>
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/contacts/stops.hpp>
#include <clutchwork/run/advance.hpp>
#include <clutchwork/run/guards/torques.hpp>
#include <clutchwork/run/power.hpp>
#include <clutchwork/run/processes.hpp>
#include <clutchwork/workspace.hpp>

/// A run whose state and time another solver gives, the modes of all contacts held: rates, margins, and the decision
/// where a margin has ended. docs/theory/model-exchange.md
namespace clutchwork {

/// Numbers of the state: speeds, states, angles, works.
template <class T>
std::int64_t count_placed(const Workspace<T>& ws) {
  return ws.sys.speeds + ws.sys.states + ws.sys.nodes + fitted_powers(ws);
}

/// Numbers of the margins: one of each direction, then of each process and flow.
template <class T>
std::int64_t count_margins(const Workspace<T>& ws) {
  return ws.n_directions + ws.sys.processes + ws.sys.flows;
}

/// Call f(number in the state, place of it) for the whole state.
template <class T, class F>
void each_placed(Workspace<T>& ws, F&& f) {
  std::int64_t at = 0;
  for (int i = 0; i < ws.sys.speeds; ++i) f(at++, ws.v[i]);
  for (int i = 0; i < ws.sys.states; ++i) f(at++, ws.state[i]);
  for (int n = 0; n < ws.sys.nodes; ++n) f(at++, ws.angle[n]);
  for (int i = 0; i < fitted_powers(ws); ++i) f(at++, work_of(ws, i));
}

/// A value that signal i has, with its time derivative, without a knot.
template <class T>
void place_input(Workspace<T>& ws, int i, double value, double slope) {
  auto& signal = ws.in.signal[i];
  ws.linearized = false;
  signal.held = value;
  if (!is_held(ws, i)) signal.given = true, seek(ws, i, ws.time);
  for (int ref = 0; ref < ws.in.n_refs; ++ref) {
    if (ws.in.ref_signal[ref] == i) ws.in.u[ref] = value, ws.in.du[ref] = slope;
  }
#ifdef CLUTCHWORK_SINGLE
  // steps have signals of their own, which are to take it
  if (ws.options.method == Method::fixed) ws.in.next_knot = -infinity;
#endif
}

/// Take time and state; signals stay on their segments.
template <class T>
void take_placed(Workspace<T>& ws, double t, const double* x) {
  ws.time = t;
  ws.linearized = false;
  each_placed(ws, [&](std::int64_t i, T& place) { place = x[i]; });
  ws.in.time = -infinity;
  inputs_at(ws, t);
  input_slopes_at(ws, t);
  shared_inputs(ws, ws.state);
  present_rates(ws);
}

/// The motion of the present modes at the present point, with its row: where a phase stands that has just begun, and
/// takes no step. The speeds are brought onto what is locked. `decided`: the modes are new, and the phase begins.
template <class T>
Status look_placed(Workspace<T>& ws, double* row, bool decided = false) {
  ws.guard.is_placed = !decided;
  const bool entered = enter_mode(ws, !decided);
  ws.guard.is_placed = false;
  if (!entered) return Status::no_mode;
  const double knot = ws.in.next_knot, last = ws.last_step;
  double t = ws.time;
  Sink sink;
  sink.times = &t, sink.rows = row, sink.count = 1;
  ws.in.next_knot = infinity;
  // as where a phase goes on with another method: nothing is decided
  ws.fresh_phase = ws.stiffened = true;
  const Status status = dispatch(ws, ws.time, sink);
  ws.in.next_knot = knot, ws.last_step = last;
  return status == Status::running ? Status::no_mode : status;
}

/// Numbers of the state rates where the motion was looked at.
template <class T>
const T* placed_state_rates(const Workspace<T>& ws) {
  const std::int64_t n = ws.reduced.nz + ws.sys.states;
  return ws.stages.rows + StepRow::f0 * n + ws.reduced.nz;
}

/// Time derivative of the state where the motion was looked at.
template <class T>
void placed_rates(const Workspace<T>& ws, double* dx) {
  const auto& sys = ws.sys;
  const int nd = ws.n_directions, np = int(sys.prescribed);
  const T* rates = placed_state_rates(ws);
  for (int i = 0; i < sys.speeds; ++i) *dx++ = ws.out.dv[i];
  for (int i = 0; i < sys.states; ++i) *dx++ = rates[i];
  for (int n = 0; n < sys.nodes; ++n) *dx++ = node_value(sys, n, ws.out.v, ws.in.prescribed);
  Snapshot<T> shot{nullptr, nullptr, ws.observed.rate, ws.out.v, ws.out.dv};
  for (int d = 0; d < nd; ++d) dx[d] = 0;
  for (int k = 0; k < ws.n_branches; ++k) dx[ws.branch[k].direction] = ws.observed.torque[k] * ws.observed.rate[k];
  dx += nd;
  for (int p = 0; p < np; ++p) *dx++ = source_torque(ws, shot, p) * ws.in.prescribed[p];
  for (int i = 0; i < sys.supplies; ++i) *dx++ = supply_power(ws, i, ws.state);
  for (int m = 0; m < sys.meters; ++m) *dx++ = metered_power(ws, shot, m);
}

// ------------------------------------------------------------------------------------------------------------ margins

/// By how much a margin must be missed, of its size: more than round-off, and what is behind it starts as far inside.
inline constexpr double placed_slack = 1e-10;

/// Margin of the load of a contact: on its side of zero.
template <class T>
double load_margin(const Workspace<T>& ws, int c) {
  const double load = load_of(ws, c), size = larger(ws.guard.load_size[c], 1.0);
  return (ws.contact.pressed[c] ? load : -load) / (abs(load) + size) + 10 * placed_slack;
}

/// Whether a load has passed zero, or a fault is due, which steps cannot see where signals are held.
template <class T>
bool inputs_decide(const Workspace<T>& ws) {
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (!(load_margin(ws, c) > 0)) return true;
    if (ws.contact.fault[c] == sound && fault_trigger(ws, c) > 0) return true;
  }
  return false;
}

/// Takes the least margin of each direction, and of each process behind them.
struct LeastMargins {
  double* z;

  void operator()(int d, double margin) const { z[d] = smaller(z[d], margin + placed_slack); }
};

/// Rates on their sides of levels.
template <class T>
void line_margins(const Workspace<T>& ws, const LeastMargins& take) {
  const double size = slip_tolerance(ws) * 1e10;
  for (int i = 0; i < ws.guard.n_lines; ++i) {
    const LineGuard& g = ws.guard.line[i];
    // an open contact that turns decides nothing
    if (g.kind == LineGuard::pass) continue;
    // one that has just begun to slip is known no better than its solver knows it, and neither is a kink
    const int d = ws.branch[g.branch].direction;
    const bool is_slip = g.kind == LineGuard::slip;
    const bool is_fresh = is_slip && ws.contact.forced[d - int(ws.sys.elements)] != 0;
    // a slip is missed by half of what counts as zero, so that the decision takes it for zero
    const double missed = !is_slip ? 0.1 * ws.options.rtol : is_fresh ? ws.options.rtol : -0.5 * placed_slack;
    take(d, g.sign * (ws.step_start.rate[g.branch] - g.level) / (size + abs(g.level)) + missed);
  }
}

/// What is locked within its limits.
template <class T>
void held_margins(const Workspace<T>& ws, const LeastMargins& take) {
  const int ne = int(ws.sys.elements);
  const auto& edge = ws.step_start;
  const double torques = larger(torque_size(ws), 1e-6);
  for (int a = 0; a < ws.held.n; ++a) {
    const int c = ws.held.contact[a];
    if (is_rigid(ws, c)) {
      take(ne + c, 1 - abs(rate_of(ws, ne + c)) / ws.guard.zero);
    } else if (ws.held.in_set[a] == 0) {
      const double torque = edge.multiplier[a], capacity = edge.capacity[a];
      const double whole = abs(torque) + 1e-3 * torques + (capacity < infinity ? capacity : 0.0);
      take(ne + c, smaller(margin(ws, a, torque, capacity) / whole, 1.0));
    }
  }
  for (int i = 0; i < ws.held.n_driven; ++i) {
    const int d = ne + ws.held.redundant[ws.held.driven[i]];
    take(d, 1 - abs(rate_of(ws, d)) / ws.guard.zero);
  }
  for (int k = 0; k < ws.held.n_sets; ++k) take(ne + ws.held.set_member[ws.held.set_first[k]], edge.room[k]);
  for (int i = 0; i < ws.loads.n_sliding; ++i) {
    const int l = ws.loads.sliding[i];
    take(ne + int(ws.sys.load_contact[l]), edge.clearance[l] / torques);
  }
}

/// Loads on their sides of zero, sound contacts, plays between their ends.
template <class T>
void contact_margins(const Workspace<T>& ws, const LeastMargins& take) {
  const int ne = int(ws.sys.elements);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    take(ne + c, load_margin(ws, c));
    if (ws.contact.fault[c] == sound) take(ne + c, -fault_trigger(ws, c));
  }
  for (int i = 0; i < ws.guard.n_bounded; ++i) {
    const int c = ws.guard.bounded[i], k = ws.branch_of[ne + c];
    T seen = T(0);
    take(ne + c, table_room(ws, c, k < 0 ? T(0) : ws.step_start.rate[k], seen));
  }
  for (int i = 0; i < ws.guard.n_gaps; ++i) {
    const int c = ws.guard.gap[i];
    for (int side = -1; side <= 1; side += 2) {
      const double end = stop_end(ws, c, side);
      if (abs(end) < infinity) take(ne + c, side * (end - ws.state[place_of(ws, c)]) / larger(1e-3, abs(end)));
    }
  }
}

/// Laws, elements and processes on their pieces.
template <class T>
void piece_margins(Workspace<T>& ws, const LeastMargins& take) {
  const auto& edge = ws.step_start;
  const T *rates = placed_state_rates(ws), still[most_ways] = {};
  int who = 0;
  for (int i = 0; i < ws.guard.n_switching; ++i) {
    const int k = ws.guard.switching[i];
    take(ws.branch[k].direction, law_margin(ws, ws.branch[k], edge.rate + k, still, ws.state, rates, who).v);
  }
  for (int i = 0; i < ws.guard.n_bending; ++i) {
    const int d = int(ws.sys.elements) + ws.guard.bending[i];
    take(d, law_margin(ws, make_branch(ws, d, forward), still, still, ws.state, rates, who).v);
  }
  for (int i = 0; i < ws.guard.n_processes; ++i) {
    const int c = ws.guard.process[i];
    auto rate = [&](int d, T&) {
      const int k = ws.branch_of[d];
      return k < 0 || k >= ws.n_branches ? T(0) : edge.rate[k];
    };
    take(ws.n_directions + c, process_margin(ws, c, ws.time, ws.state, rates, rate, who).v);
  }
}

/// Margins where the motion was looked at: above zero while nothing needs a decision, below where something does.
template <class T>
void placed_margins(Workspace<T>& ws, double* z) {
  for (std::int64_t i = 0; i < count_margins(ws); ++i) z[i] = 1;
  const LeastMargins take{z};
  line_margins(ws, take);
  held_margins(ws, take);
  contact_margins(ws, take);
  piece_margins(ws, take);
}

// ----------------------------------------------------------------------------------------------------------- decision

/// Open contacts move the way they do, which nothing has watched: it is no event. So does one that slips, where its
/// solver has located the zero of its slip too late for the core to take it for zero.
template <class T>
void direct_placed(Workspace<T>& ws) {
  const int ne = int(ws.sys.elements);
  const double zero = slip_tolerance(ws);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (ws.contact.compliant[c] || is_stop(ws, c)) continue;
    const double slip = rate_of(ws, ne + c);
    const int mode = ws.contact.mode[c];
    const bool passed = (mode == forward || mode == backward) && free_way(ws, c) == 0 && slip * mode < 0;
    if ((ws.contact.loaded[c] && !passed) || abs(slip) <= zero) continue;
    ws.contact.mode[c] = slip > 0 ? forward : backward;
    if (passed) ws.contact.forced[c] = 0;
  }
}

/// Whether all margins where the motion was looked at are above a limit.
template <class T>
bool all_hold(Workspace<T>& ws, double* margins, double limit) {
  placed_margins(ws, margins);
  bool hold = true;
  for (std::int64_t i = 0; i < count_margins(ws); ++i) hold = hold && margins[i] > limit;
  return hold;
}

/// Decide at the present point: the run goes on by itself, by as little as its own guards need to see what is due.
/// `anew`: signals may have jumped. `done` at the same time, with another state where something was due.
template <class T>
Status decide_placed(Workspace<T>& ws, bool anew, double* row, double* margins) {
  // a solver that has located its zero has seen it below by less than round-off
  constexpr double least = 1e-12, most = 1e-6, round_off = 1e-3 * placed_slack;
  const double t = ws.time, grain = 1 + abs(t);
  // a knot that is as good as reached is reached
  const bool due = ws.in.next_knot - t <= 1e3 * least * grain;
  const double start = due ? larger(t, ws.in.next_knot) : t;
  direct_placed(ws);
  Status status = look_placed(ws, row);
  if (status != Status::done || (!anew && !due && !ws.params_changed && all_hold(ws, margins, round_off)))
    return status;
  constexpr int rounds = 64;
  double span = least * grain;
  for (int round = 0; round < rounds && span <= most * grain; ++round) {
    ws.fresh_phase = true;
    if (anew || inputs_decide(ws)) ws.in.next_knot = -infinity, ws.in.alone = -1;
    anew = false;
    Sink sink;
    const int events = ws.events.n;
    status = advance_by_events(ws, start + span, sink, true);
    if (status != Status::done) return status;
    if (ws.events.n == events) span *= 10;
    ws.time = t;
    ws.in.time = -infinity;
    inputs_at(ws, t);
    status = look_placed(ws, row, ws.fresh_phase);
    if (status != Status::done || all_hold(ws, margins, 0)) return status;
  }
  return status;
}

}  // namespace clutchwork

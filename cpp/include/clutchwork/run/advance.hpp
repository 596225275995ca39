#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/ratios.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/form.hpp>
#include <clutchwork/motion/geometry.hpp>
#include <clutchwork/motion/reduce.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/clamp_loads.hpp>
#include <clutchwork/run/enter.hpp>
#include <clutchwork/run/methods.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/run/phase.hpp>
#include <clutchwork/run/processes.hpp>
#include <clutchwork/run/settle.hpp>
#include <clutchwork/run/switch.hpp>
#include <clutchwork/workspace.hpp>

/// The whole run: modes, smooth phase, switch, until the end time.
namespace clutchwork {

template <class Form>
Status run_phase(Workspace<typename Form::Scalar>& ws, double t_end, Sink& sink) {
  Status status = Status::no_mode;
  visit_method(ws.reduced.method, [&](auto tag) {
    using Integrator = typename decltype(tag)::type;
    // derivatives are carried by one method, which is made for any motion
    if constexpr (Integrator::stiff || !has_tangents<typename Form::Scalar>)
      status = Phase<Form>(ws, t_end, sink, tag).run();
  });
  return status;
}

/// The full form for systems that need it, the small one for few speeds, a sparse one for the rest.
template <class T>
Status dispatch(Workspace<T>& ws, double t_end, Sink& sink) {
  if constexpr (has_full_form) {
    if (ws.sys.full[0] != 0) return run_phase<FullForm<T>>(ws, t_end, sink);
  }
  if constexpr (has_sparse_form) {
    if (ws.reduced.is_sparse) return run_phase<SparseForm<T>>(ws, t_end, sink);
  }
  if constexpr (has_small_forms && !has_tangents<T>) return run_phase<SmallForm<T>>(ws, t_end, sink);
  return Status::no_mode;
}

/// Speeds, states, angles and work as they start.
template <class T>
void take_initial(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  for (int i = 0; i < sys.speeds; ++i) ws.v[i] = T(sys.initial_speed[i]);
  for (int i = 0; i < sys.states; ++i) ws.state[i] = T(sys.initial_state[i]);
  for (int i = 0; i < sys.nodes; ++i) ws.angle[i] = T(sys.initial_angle[i]);
  for (int d = 0; d < ws.n_directions; ++d) ws.work[d] = T(0), ws.piece[d] = 0;
  for (int i = 0; i < sys.processes + sys.flows; ++i) ws.shared.piece[i] = 0;
  for (int d = 0; d < ws.n_directions; ++d) ws.heading[d] = forward, ws.branch_of[d] = -1;
  for (int p = 0; p < sys.prescribed; ++p) ws.prescribed_work[p] = T(0);
  for (int i = 0; i < sys.supplies; ++i) ws.supplied[i] = T(0);
  for (int m = 0; m < sys.meters; ++m) ws.metered[m] = T(0);
}

/// Every contact before the first decision: it slips, or is open.
template <class T>
void start_contacts(Workspace<T>& ws) {
  for (int c = 0; c < ws.sys.contacts; ++c) {
    ws.contact.compliant[c] = is_compliant_law(ws.sys.contact_law[c]);
    ws.contact.fault[c] = sound;
    ws.contact.forced[c] = ws.contact.loaded[c] = ws.contact.pressed[c] = 0;
    ws.guard.turned_at[c] = -infinity;
    const double slip = value(rate_of(ws, int(ws.sys.elements) + c));
    ws.contact.mode[c] = abs(slip) <= slip_tolerance(ws) ? open : slip > 0 ? forward : backward;
    ws.contact.side[c] = ws.contact.struck[c] = 0;
    ws.contact.met_at[c] = -infinity;
    if (is_stop(ws, c)) ws.contact.mode[c] = open;
    ws.event_context.mode[c] = ws.contact.mode[c];
  }
}

/// Prescribed speeds that are integrals begin where the run does, with the value that they have at 0.
template <class T>
void begin_sums(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  for (int p = 0; p < sys.prescribed && ws.options.t_start != 0; ++p) {
    const int i = sys.prescribed_input[p];
    auto& signal = ws.in.signal[i];
    if (sys.prescribed_sums[p] == 0 || signal.set > 0 || is_held(ws, i)) continue;
    auto value_at = [&](double t) { return signal.segment = 0, seek(ws, i, t), signal_value(ws, i, t); };
    const auto gained = value_at(ws.options.t_start) - value_at(0);
    const auto [start, coef] = segments_of(ws, i);
    const std::int64_t first = sys.input_first[i];
    for (std::int64_t k = 0; k < start.n; ++k) {
      ws.in.set_time[first + k] = start.times[k];
      Given<T>* to = ws.in.set_coef + segment_size * (first + k);
      for (int c = 0; c < segment_size; ++c) to[c] = coef[segment_size * k + c];
      to[0] -= gained;
    }
    signal.set = int(start.n), signal.segment = 0;
  }
}

/// The speeds at a start that is later than at 0, where transmissions have other ratios: what their rows miss of those
/// at 0 is that much of the rate behind each.
template <class T>
void follow_start_ratios(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  Ratios<T>& r = ws.ratios;
  const int n = r.n, nv = int(sys.speeds);
  T *matrix = r.triangle, *miss = r.wanted, *change = r.share;
  for (int a = 0; a < n; ++a) {
    change[a] = ratio_now(ws, a).v - r.before[a];
    miss[a] = change[a] * rate_of(ws, first_of(ws, a) + 1);
    const auto row = rate_row(sys, first_of(ws, a) + 1);
    for (int b = 0; b < n; ++b) {
      T answer = T(0);
      for (int e = 0; e < row.n; ++e) answer += T(row.value[e] * sys.initial_by_ratio[row.column[e] * n + b]);
      matrix[a * n + b] = T(a == b ? 1 : 0) - change[a] * answer;
    }
  }
  if (!factor_lu(n, matrix, r.order)) return;
  solve_lu(n, matrix, r.order, miss);
  for (int i = 0; i < nv; ++i) {
    for (int a = 0; a < n; ++a) ws.v[i] += T(sys.initial_by_ratio[i * n + a]) * miss[a];
  }
}

/// States that follow a command begin with what it is where a run begins; it may be such a state itself, of a process
/// that stands anywhere.
template <class T>
void begin_with_commands(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  const int n = int(sys.processes);
  for (int k = 0; k < n * n; ++k) {
    const int i = k % n;
    if (sys.process_begins[i] < 0) continue;
    const int at = int(sys.process_state[i]);
    const T unit(sys.shared_scale[at - (sys.states - sys.shared)]);
    ws.state[at] = ws.in.u[sys.process_input[i] + sys.process_begins[i]] / unit;
    shared_inputs(ws, ws.state);
  }
}

/// The inputs at the start, and the speeds there: where that is later than at 0, what nobody gave follows from what is
/// prescribed then. docs/theory/reduction.md (13)
template <class T>
void begin_inputs(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed);
  const bool later = ws.time != 0 && (np > 0 || ws.ratios.n > 0);
  if (later) {
    load_inputs(ws, 0);
    shared_inputs(ws, ws.state);
    keep_prescribed(ws), keep_ratios(ws);
  }
  load_inputs(ws, ws.time);
  shared_inputs(ws, ws.state);
  if (ws.time != 0) begin_with_commands(ws);
  if (!later) return;
  for (int p = 0; p < np; ++p) {
    // an integral begins where the run does
    if (sys.prescribed_sums[p] != 0) continue;
    const T change = ws.in.prescribed[p] - ws.in.prescribed_before[p];
    for (int i = 0; i < nv; ++i) ws.v[i] += T(sys.initial_by_prescribed[i * np + p]) * change;
  }
  if (ws.ratios.n > 0) follow_start_ratios(ws);
}

/// The first transmission whose speeds at a later start are not those of its ratio there, because they were given, or
/// none are; -1: each has them. docs/theory/reduction.md (13)
template <class T>
int contradicted_at_start(Workspace<T>& ws) {
  if (ws.time == 0) return -1;
  double fastest = 1;
  for (int i = 0; i < ws.sys.speeds; ++i) fastest = larger(fastest, abs(value(ws.v[i])));
  for (int a = 0; a < ws.ratios.n; ++a) {
    const int front = first_of(ws, a);
    const T missed = rate_of(ws, front) - ratio_now(ws, a).v * rate_of(ws, front + 1);
    // given speeds are rounded when they are written
    if (abs(value(missed)) > 2e-6 * fastest) return a;
  }
  return -1;
}

/// State at the start. False when the mass matrix is not positive definite.
template <class T>
bool start(Workspace<T>& ws) {
  if (!prepare_geometry(ws)) return false;
  prepare_loads(ws);
  ws.time = ws.options.t_start;
  ws.statistics = {};
  ws.events.n = 0;
  ws.out.skipped = false;
  ws.contact.failed = -1;
  ws.params_changed = false;
  take_initial(ws);
  begin_sums(ws);
  begin_inputs(ws);
  present_rates(ws);
  keep_prescribed(ws);
  input_slopes_at(ws, ws.time);
  start_contacts(ws);
  find_pieces(ws);
  list_processes(ws);
  find_process_pieces(ws);
  refresh_loads(ws);
  ws.event_context.cause = Cause::initial;
  ws.event_context.contact = -1;
  if constexpr (has_tangents<T>) ws.moved.here_time = ws.moved.last_time = ws.time, forget_sizes(ws), floor_sizes(ws);
  ws.started = true;
  return true;
}

/// Torques of all contacts in the present modes.
template <class T>
void note_torques(Workspace<T>& ws) {
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int k = ws.branch_of[ws.sys.elements + c];
    ws.event_context.mode[c] = ws.contact.mode[c];
    ws.event_context.torque[c] = ws.event_context.slope[c] = T(0);
    if (k < 0 || k >= ws.n_branches) continue;
    const Branch<T>& b = ws.branch[k];
    ws.event_context.torque[c] = contact_torque(ws, b, rate_of(ws, b.direction), ws.state, ws.observed.state_rates);
  }
  locked_torques(ws, ws.step_start.multiplier, [&](int c, T x) { ws.event_context.torque[c] += x; });
}

/// Parameters were set from outside: decide the modes anew.
template <class T>
Status take_outside(Workspace<T>& ws) {
  ws.params_changed = false;
  note_torques(ws);
  keep_prescribed(ws);
  keep_ratios(ws);
  load_inputs(ws, ws.time);
  input_slopes_at(ws, ws.time);
  find_process_pieces(ws);
  find_pieces(ws);
  refresh_loads(ws);
  ws.event_context.cause = Cause::input;
  ws.event_context.contact = -1;
  return switch_modes(ws);
}

/// Up to where the next phase starts, or goes on. `running`: it is ready.
template <class T>
Status reach_phase(Workspace<T>& ws) {
  if (!ws.started) {
    if (!start(ws)) return Status::bad_system;
    const int broken = contradicted_at_start(ws);
    if (broken >= 0) ws.detail.component = first_of(ws, broken);
    const Status status = broken >= 0 ? Status::jammed : switch_modes(ws);
    ws.started = status == Status::running;
    if (!ws.started) return status;
  }
  if (ws.events.n >= EventBuffer::room) return Status::events_full;
  if (ws.params_changed) {
    // the torques before are those of the present modes
    if (ws.fresh_phase && !enter_mode(ws)) return Status::no_mode;
    const Status status = take_outside(ws);
    if (status != Status::running) return status;
  }
  return ws.fresh_phase && !enter_mode(ws) ? Status::no_mode : Status::running;
}

/// Integrate to t_end, or up to the first event, by phases between events, filling rows and events on the way.
template <class T>
Status advance_by_events(Workspace<T>& ws, double t_end, Sink& sink, bool to_event = false) {
  ws.fixed.ready = false;
  Status status = reach_phase(ws);
  while (status == Status::running) {
    status = dispatch(ws, t_end, sink);
    if (status == Status::running && !ws.stiffened) status = switch_modes(ws);
    if (status == Status::running && to_event && ws.events.n > 0) return Status::done;
    if (status == Status::running) status = reach_phase(ws);
  }
  // a phase that follows at the same instant shows the row that counts, in the next call
  if (status == Status::events_full && ws.fresh_phase) sink.restart(ws.time);
  return status;
}

/// Steps of one length: run/fixed/advance.hpp.
template <class T>
Status advance_fixed(Workspace<T>& ws, double t_end, Sink& sink, bool to_event);

/// What sums of steps of single precision have not taken yet joins them: in double both parts are one number.
inline void join_parts(Workspace<double>& ws) {
  auto& f = ws.fixed;
  auto join = [](double* sum, std::int64_t n, double* low) {
    for (std::int64_t i = 0; i < n; ++i) sum[i] += low[i], low[i] = 0;
  };
  const Sizes n(ws.sys);
  double* low = f.energy_low + n.directions;
  join(ws.v, n.speeds, f.speed_low), join(ws.state, n.states, f.state_low), join(ws.angle, n.nodes, f.angle_low);
  join(ws.work, n.directions, f.energy_low), join(ws.prescribed_work, n.prescribed, low);
  join(ws.supplied, n.supplies, low + n.prescribed), join(ws.metered, n.meters, low + n.prescribed + n.supplies);
}

/// Integrate to t_end by the method that is wanted; `to_event`: no farther than the first event, or the end of the step
/// of one length in which it is.
template <class T>
Status advance(Workspace<T>& ws, double t_end, Sink& sink, bool to_event = false) {
  // other scalars, which tests compute with, have no steps of one length
  if constexpr (std::is_same_v<T, double>) {
    if (ws.options.method == Method::fixed) return advance_fixed(ws, t_end, sink, to_event);
#ifdef CLUTCHWORK_SINGLE
    if (ws.started && ws.fixed.time == ws.time) join_parts(ws);
#endif
    // what fixed steps have left is decided anew
    if (ws.started && ws.fixed.time == ws.time) ws.params_changed = true, ws.fixed.time = -infinity;
  }
  return advance_by_events(ws, t_end, sink, to_event);
}

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/form.hpp>
#include <clutchwork/motion/reduce.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/integrator/dopri5.hpp>
#include <clutchwork/run/integrator/rodas5p.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/run/phase.hpp>
#include <clutchwork/workspace.hpp>

/// The whole run: modes, smooth phase, switch, until the end time.
namespace clutchwork {

template <class Form>
Status run_phase(Workspace<typename Form::Scalar>& ws, double t_end, Sink& sink) {
  // the explicit method serves soft models of any size; only the sparse form carries it
  if constexpr (!Form::small) {
    if (ws.is_explicit) return Phase<Form, Dopri5>(ws, t_end, sink).run();
  }
  return Phase<Form, Rodas5P>(ws, t_end, sink).run();
}

/// Exact sizes for small systems, one sparse form for the rest.
template <class T, int NZ = 0, int NS = 0>
Status dispatch(Workspace<T>& ws, double t_end, Sink& sink) {
  if (ws.sparse) return run_phase<SparseForm<T>>(ws, t_end, sink);
  if constexpr (NZ > small_speeds) {
    return Status::no_mode;
  } else if constexpr (NS > small_states) {
    return dispatch<T, NZ + 1, 0>(ws, t_end, sink);
  } else {
    if (ws.nz == NZ && ws.sys.states == NS) return run_phase<SmallForm<T, NZ, NS>>(ws, t_end, sink);
    return dispatch<T, NZ, NS + 1>(ws, t_end, sink);
  }
}

/// State at time zero. False when the mass matrix is not positive definite.
template <class T>
bool start(Workspace<T>& ws) {
  const System& sys = ws.sys;
  if (!prepare_geometry(ws)) return false;
  ws.statistics = {};
  ws.n_events = 0;
  ws.failed = -1;
  ws.input_changed = false;
  for (int i = 0; i < sys.speeds; ++i) ws.v[i] = T(sys.initial_speed[i]);
  for (int i = 0; i < sys.states; ++i) ws.state[i] = T(sys.initial_state[i]);
  for (int i = 0; i < sys.nodes; ++i) ws.angle[i] = T(sys.initial_angle[i]);
  for (int d = 0; d < ws.n_directions; ++d) ws.work[d] = T(0), ws.piece[d] = 0;
  for (int d = 0; d < ws.n_directions; ++d) ws.heading[d] = forward, ws.branch_of[d] = -1;
  for (int p = 0; p < sys.prescribed; ++p) ws.prescribed_work[p] = T(0);
  load_inputs(ws, ws.time);
  shared_inputs(ws, ws.state);
  for (int p = 0; p < sys.prescribed; ++p) ws.prescribed_before[p] = ws.prescribed[p];
  input_slopes_at(ws, ws.time);
  for (int c = 0; c < sys.contacts; ++c) {
    ws.compliant[c] = is_compliant_law(sys.contact_law[c]);
    ws.fault[c] = sound;
    ws.forced[c] = ws.loaded[c] = ws.pressed[c] = 0;
    ws.turned_at[c] = -infinity;
    const double slip = value(rate_of(ws, int(sys.elements) + c));
    ws.mode[c] = abs(slip) <= slip_tolerance(ws) ? open : slip > 0 ? forward : backward;
    ws.mode_before[c] = ws.mode[c];
  }
  for (int d = 0; d < sys.elements; ++d) {
    if (edge_count(ws, d) > 0) ws.piece[d] = piece_of(ws, d, value(rate_of(ws, d)));
  }
  refresh_loads(ws);
  ws.located = -1;
  ws.cause = Cause::initial;
  ws.started = true;
  return true;
}

/// Parameters were set from outside: decide the modes anew.
template <class T>
Status take_outside(Workspace<T>& ws) {
  ws.input_changed = false;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int k = ws.branch_of[ws.sys.elements + c];
    ws.mode_before[c] = ws.mode[c];
    ws.torque_before[c] = ws.slip_slope[c] = T(0);
    if (k >= 0 && k < ws.n_branches)
      ws.torque_before[c] = contact_torque(ws, ws.branch[k], rate_of(ws, ws.branch[k].direction), ws.state, ws.scratch);
  }
  locked_torques(ws, ws.here.multiplier, [&](int c, T x) { ws.torque_before[c] += x; });
  for (int p = 0; p < ws.sys.prescribed; ++p) ws.prescribed_before[p] = ws.prescribed[p];
  load_inputs(ws, ws.time);
  input_slopes_at(ws, ws.time);
  refresh_loads(ws);
  ws.located = -1;
  ws.cause = Cause::input;
  return switch_modes(ws);
}

/// Integrate to t_end, filling rows and events on the way.
template <class T>
Status advance(Workspace<T>& ws, double t_end, Sink& sink) {
  if (!ws.started) {
    if (!start(ws)) return Status::bad_system;
    const Status status = switch_modes(ws);
    ws.started = status == Status::running;
    if (!ws.started) return status;
  }
  while (true) {
    if (ws.n_events >= Workspace<T>::event_room) return Status::events_full;
    if (ws.input_changed) {
      // the torques before are those of the present modes
      if (ws.fresh_phase && !enter_mode(ws)) return Status::no_mode;
      const Status status = take_outside(ws);
      if (status != Status::running) return status;
    }
    if (ws.fresh_phase && !enter_mode(ws)) return Status::no_mode;
    Status status = dispatch(ws, t_end, sink);
    if (status != Status::running) return status;
    status = switch_modes(ws);
    if (status != Status::running) return status;
  }
}

}  // namespace clutchwork

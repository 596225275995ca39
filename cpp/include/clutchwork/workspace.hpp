#pragma once
#include <clutchwork/workspace/contacts.hpp>
#include <clutchwork/workspace/fixed.hpp>
#include <clutchwork/workspace/loads.hpp>
#include <clutchwork/workspace/motion.hpp>
#include <clutchwork/workspace/moved.hpp>
#include <clutchwork/workspace/ratios.hpp>
#include <clutchwork/workspace/run.hpp>

/// Everything that changes during a run, carved once from memory of the caller.
namespace clutchwork {

template <class T>
struct Workspace {
  // what runs between events read in addition
  EventContext<T> event_context;
  Held<T> held;
  CoupledMemory<T> coupled;
  SetMemory<T> set;
  ProblemMemory<T> problem;
  Decision<T> decision;
  Reduced<T> reduced;
  SparseRows<T> rows;
  Shared<T> shared;
  Stages<T> stages;
  Full<T> full;
  Ratios<T> ratios;
  StepEnd<T> step_start{}, step_end{};
  Output<T> out;
  [[no_unique_address]] Moved<T> moved;

  // from here on what steps of one length read is close together: where many runs go on side by side, less of each
  // passes through the caches
  Guards guard;
  Detail detail;
  EventBuffer events;
  Poll poll;
  SystemOf<Given<T>> sys{};
  RowLayout row{System{}};
  Options options;
  Statistics statistics;
  T* params = nullptr;
  bool params_changed = false;  ///< from outside

  // the state of the run
  double time = 0;
  double last_step = 0;  ///< [s] last step that was not cut short
  bool started = false, fresh_phase = true;
  bool stiffened = false;   ///< the phase goes on with another method
  bool linearized = false;  ///< the derivatives are those where the run stands, since the end of the last call
  T *v = nullptr, *state = nullptr, *angle = nullptr, *work = nullptr, *prescribed_work = nullptr;
  T* supplied = nullptr;                     ///< [J] that each supply has given
  T* metered = nullptr;                      ///< [J] that has gone through each rigid line that is metered
  int *piece = nullptr, *heading = nullptr;  ///< of each direction: smooth piece; sign of its rate

  // active components, then open contacts, whose rates alone are followed
  int n_directions = 0, n_branches = 0, n_rates = 0;
  Branch<T>* branch = nullptr;
  int* branch_of = nullptr;  ///< of each direction, -1: none

  Signals<T> in;
  Contacts<T> contact;
  Loads<T> loads;
  Geometry<T> geometry;
  Jacobian<T> jacobian;
  Fixed<T> fixed;
  Observed<T> observed;
};

/// The points of the curves that components read.
template <class T>
CLUTCHWORK_HOT const Point<T>* points_of(const Workspace<T>& ws) {
  if constexpr (has_tangents<T> || NumberOf<T>::single)
    return ws.moved.points;
  else
    return ws.sys.points;
}

/// The arrays of a workspace, for the memory and for saved states: numbers that are taken are saved, indices are made
/// anew from the modes; what is kept are integers that a saved state holds too, within bounds; scratch is never saved.
template <class W, class A>
void lay_out(W& ws, A& a) {
  const Sizes n(ws.sys);
  a.take(ws.params, ws.sys.n_params);
  a.take(ws.v, n.speeds), a.take(ws.state, n.states), a.take(ws.angle, n.nodes), a.take(ws.work, n.directions);
  a.take(ws.prescribed_work, n.prescribed), a.take(ws.supplied, n.supplies), a.take(ws.metered, n.meters);
  a.keep(ws.piece, n.directions, -(1ll << 31), (1ll << 31) - 1), a.keep(ws.heading, n.directions, backward, forward);
  a.take(ws.branch, n.directions), a.take(ws.branch_of, n.directions);
  auto each = [&](auto&... part) { (std::remove_reference_t<decltype(part)>::lay_out(part, a, n), ...); };
  // what steps of one length read comes first, so that it is close together
  each(ws.in, ws.contact, ws.loads, ws.fixed, ws.observed, ws.jacobian, ws.geometry, ws.event_context, ws.held,
       ws.coupled, ws.set, ws.problem, ws.decision, ws.reduced, ws.rows, ws.shared, ws.stages, ws.full, ws.ratios,
       ws.step_start, ws.step_end, ws.guard, ws.out, ws.events, ws.moved);
}

/// The same of a run of single precision, which takes steps of one length and does nothing else.
template <class W, class A>
  requires requires(W& ws) { ws.moved.outer; }
void lay_out(W& ws, A& a) {
  const Sizes n(ws.sys);
  a.take(ws.params, ws.sys.n_params);
  a.take(ws.v, n.speeds), a.take(ws.state, n.states), a.take(ws.angle, n.nodes), a.take(ws.work, n.directions);
  a.take(ws.prescribed_work, n.prescribed), a.take(ws.supplied, n.supplies), a.take(ws.metered, n.meters);
  a.take(ws.piece, n.directions), a.take(ws.heading, n.directions);
  a.take(ws.branch, n.directions), a.take(ws.branch_of, n.directions), a.take(ws.geometry.own, n.directions);
  a.take(ws.reduced.span, n.states);
  auto each = [&](auto&... part) { (std::remove_reference_t<decltype(part)>::lay_out(part, a, n), ...); };
  each(ws.in, ws.contact, ws.event_context, ws.loads, ws.jacobian, ws.shared, ws.fixed, ws.guard, ws.observed);
}

/// Lay the arrays of a workspace into memory; returns the size needed.
template <class T>
std::int64_t carve(Workspace<T>& ws, unsigned char* memory) {
  ws.in.n_refs = int(ws.sys.n_input_refs + ws.sys.prescribed);
  ws.n_directions = int(ws.sys.elements + ws.sys.contacts);
  ws.ratios.n = int(ws.sys.transmissions);
  Arena a(memory);
  lay_out(ws, a);
  ws.in.prescribed = ws.in.u + ws.sys.n_input_refs;
  ws.in.prescribed_slope = ws.in.du + ws.sys.n_input_refs;
  return a.size();
}

}  // namespace clutchwork

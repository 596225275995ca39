#pragma once
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/impulses.hpp>
#include <clutchwork/contacts/ratios.hpp>
#include <clutchwork/motion/lost_ratios.hpp>
#include <clutchwork/motion/mesh_loads.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/massless.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/run/passive_events.hpp>
#include <clutchwork/run/snapshot.hpp>
#include <clutchwork/run/step.hpp>
#include <clutchwork/workspace.hpp>

/// How a phase ends in which something seizes: a transmission, a lossy gear, what a locked contact stops.
namespace clutchwork {

/// A transmission whose speeds are prescribed otherwise than its ratio says.
template <class Phase>
void jam(Phase& phase, int transmission) {
  phase.ws().detail.component = first_of(phase.ws(), transmission);
  phase.leave(Status::jammed);
}

/// A locked contact has stopped what moved, as beside a dead point: its impulse is an event, and the modes are decided
/// with the speeds that it leaves. docs/theory/varying-ratios.md (10)
template <class Phase, class T = typename Phase::Scalar>
[[gnu::noinline]] void stop_at(Phase& phase, int c) {
  Workspace<T>& ws = phase.ws();
  auto& step = phase.step();
  const int d = int(ws.sys.elements) + c;
  const T before = energy_of_motion(ws);
  export_state(phase.form(), step.y0());
  const T lost = before - energy_of_motion(ws);
  ws.work[d] -= lost;
  take_heat(ws, d, lost, step.y0() + phase.form().nz());
  record(ws, {c, locked, locked, Cause::impulse, 0.0, 0.0, 0.0, value(before), value(before - lost)});
  phase.decide_again();
}

/// A gear whose torque grows beyond all bounds jams. Whether one does.
template <class Phase, class T = typename Phase::Scalar>
bool stops_running_away(Phase& phase) {
  Workspace<T>& ws = phase.ws();
  auto& form = phase.form();
  auto& step = phase.step();
  evaluate(form, ws.time, step.y0(), step.slope());
  const int c = runs_away(ws);
  if (c < 0) return false;
  // what is driven on cannot be stopped
  if (events_crowd(ws, int(ws.sys.elements) + c)) return phase.leave(Status::unbalanced), true;
  rest_step(form, step);
  export_state(form, step.y0());
  note_before(form, step, 0.0);
  keep_prescribed(ws), keep_ratios(ws);
  ws.loads.jammed = c;
  ws.last_step = 0;
  phase.decide(Cause::jam, c);
  return true;
}

/// Balances of speeds without inertia have met others and are none any more, as beside an eddy-current brake behind its
/// peak: these speeds go where they are driven. Whether any does. docs/theory/reduction.md (9)
template <class Phase, class T = typename Phase::Scalar>
bool leaves_fold(Phase& phase) {
  // in the last digits of the time both balances are this share of the speed apart
  constexpr double beside = 1e-4;
  Workspace<T>& ws = phase.ws();
  auto& form = phase.form();
  auto& step = phase.step();
  if (ws.guard.folded_at == ws.time) return false;
  ws.guard.folded_at = ws.time;
  rest_step(form, step);
  export_state(form, step.y0());
  note_before(form, step, 0.0);
  bool leaves = false, moved = false;
  for (int i = 0; i < form.nz(); ++i) {
    if (!is_massless(ws, i)) continue;
    const double from = beside * (1 + abs(value(step.y0()[i])));
    leaves = run_off(form, step, i, 1, from, moved) || run_off(form, step, i, -1, from, moved) || leaves;
  }
  if (!leaves) return false;
  keep_prescribed(ws), keep_ratios(ws);
  ws.last_step = 0;
  phase.decide_again();
  return true;
}

/// A step has become too short, at its start. `finite`: its error was a number. The inputs may be those of a stage.
template <class Phase, class T = typename Phase::Scalar>
[[gnu::noinline]] void end_collapsed(Phase& phase, bool finite) {
  Workspace<T>& ws = phase.ws();
  ws.in.time = -infinity;
  if constexpr (Phase::FormType::full) {
    auto& form = phase.taken_form();
    const auto& ratios = form.ws.ratios;
    int lost = -1;
    if (ratios.n > 0) {
      evaluate(form, ws.time, phase.taken_step().y0(), phase.taken_step().slope());
      lost = vanished_row(form.ws);
      if (lost < 0) lost = passes_at_once(ratios);
    }
    if (lost >= 0) return jam(phase, lost);
    if (ws.loads.n_sliding > 0 && stops_running_away(phase)) return;
    if (const int c = takes_all(ws); c >= 0) {
      ws.detail.component = int(ws.sys.elements) + c;
      return phase.leave(Status::unbalanced);
    }
  }
  if constexpr (!Phase::FormType::small && !has_tangents<T>) {
    if (finite && leaves_fold(phase)) return;
  }
  blame(phase.form(), phase.step());
  phase.leave(ws.detail.component >= 0 || !finite ? Status::not_finite : Status::step_collapse);
}

}  // namespace clutchwork

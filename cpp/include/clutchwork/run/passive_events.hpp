#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/impulses.hpp>
#include <clutchwork/contacts/ratios.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/clamp_loads.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/guards/torques.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/massless.hpp>
#include <clutchwork/run/processes.hpp>
#include <clutchwork/run/settle.hpp>
#include <clutchwork/run/snapshot.hpp>
#include <clutchwork/run/step.hpp>
#include <clutchwork/run/watch.hpp>
#include <clutchwork/workspace.hpp>

/// What a phase passes without a decision: knots, pieces of laws and tables, open contacts at zero; and where it ends
/// in chatter.
namespace clutchwork {

/// Present state from reduced coordinates to the workspace.
template <class Form, class T = typename Form::Scalar>
void export_state(Form& form, const T* y) {
  Workspace<T>& ws = form.ws;
  for (int i = 0; i < form.n(); ++i) ws.reduced.y[i] = y[i];
  for (int i = 0; i < form.ns(); ++i) ws.state[i] = y[form.nz() + i];
  inputs_with(ws, ws.time, ws.state);
  expand(form, y, ws.v);
  present_rates(ws);
  ws.guard.zero = slip_tolerance(ws);
}

/// Whether torques that have jumped are beyond what locked contacts hold, or take a load to the other line of the bound
/// with which its contact slips: where they were looked at last. docs/theory/events.md, rule 16
template <class T>
bool is_beyond(Workspace<T>& ws) {
  for (int a = 0; a < ws.held.n; ++a) {
    const T torque = ws.step_start.multiplier[a], capacity = ws.step_start.capacity[a];
    if (!is_rigid(ws, ws.held.contact[a]) && ws.held.in_set[a] == 0 && margin(ws, a, torque, capacity) < 0) return true;
  }
  for (int k = 0; k < ws.held.n_sets; ++k) {
    if (value(ws.step_start.room[k]) < 0) return true;
  }
  const double noise = ws.loads.n_sliding > 0 ? 1e-12 * torque_size(ws) : 0;
  for (int i = 0; i < ws.loads.n_sliding; ++i) {
    if (value(ws.step_start.clearance[ws.loads.sliding[i]]) < -noise) return true;
  }
  return false;
}

/// After a knot: right limits of the signals; true when the modes must be decided again. docs/theory/events.md, rule 1
template <class T>
bool knot_decides(Workspace<T>& ws) {
  keep_prescribed(ws);
  keep_ratios(ws);
  load_inputs(ws, ws.time);
  if (settle_pieces(ws)) list_lines(ws);
  bool decide = refresh_loads(ws) || ratios_jump(ws);
  for (int p = 0; p < ws.sys.prescribed; ++p)
    decide = decide || differ(ws.in.prescribed[p], ws.in.prescribed_before[p]);
  return decide;
}

/// The same for what is held, where the motion has been looked at.
template <class T>
bool knot_lets_go(Workspace<T>& ws) {
  for (int a = 0; a < ws.held.n; ++a) {
    if (is_rigid(ws, ws.held.contact[a])) return true;
  }
  return ws.held.n_driven > 0 || is_beyond(ws) || stays_below_jump(ws);
}

/// The law of a contact goes to its next piece; it may move its states. False: it does so without end.
template <class Form>
bool pass_law(Form& form, Step<Form>& step, int k, int who) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  Branch<T>& b = ws.branch[k];
  T* state = step.y0() + form.nz();
  int& heading = ws.heading[b.direction];
  const PresentRates<T> rate(ws, b);
  const T freed = law_freed(ws, b, rate.at, who, state);
  b.piece = law_cross(ws, b, rate.at, who, state);
  // a state that starts to slide does so the way the contact slips, however small the slip
  if (who == turned) {
    heading = -heading;
  } else if (b.law < 0) {
    heading = value(rate_of(ws, b.direction)) < 0 ? backward : forward;
  } else if (b.compliant && law_runs_on(b, who)) {
    heading = value(state[b.state + who]) < 0 ? backward : forward;
  }
  ws.piece[b.direction] = b.piece;
  for (int i = 0; i < b.states; ++i) ws.state[b.state + i] = state[b.state + i];
  if (value(freed) != 0) take_heat(ws, b.direction, freed, state), take_heat(ws, b.direction, freed, ws.state);
  list_lines(ws);
  return !events_crowd(ws, b.direction);
}

/// The law of a locked contact goes to its next piece. False: it does so without end.
template <class T>
bool pass_bend(Workspace<T>& ws, int c, int who) {
  const int d = int(ws.sys.elements) + c;
  const T still[most_ways] = {};
  ws.piece[d] = law_cross(ws, make_branch(ws, d, forward), still, who, ws.state);
  return !events_crowd(ws, d);
}

/// A process goes to its next piece. False: it does so without end. `moved`: it has set its states, which others may
/// read.
template <class Form>
bool pass_process(Form& form, Step<Form>& step, int c, int who, bool& moved) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  T* state = step.y0() + form.nz();
  moved = process_cross(ws, c, who, state);
  if (moved) {
    export_state(form, step.y0());
    shared_inputs(ws, ws.state);
    refresh_loads(ws);
  }
  return !process_crowds(ws, c);
}

/// Note that a slip has passed zero with which a torque jumps, where no event is: derivatives do not know of it.
template <class T>
void note_passed(Workspace<T>& ws, int component) {
  Moved<T>& m = ws.moved;
  if (m.n == Moved<T>::room) return;
  m.instant[m.n] = T(0);
  m.graze[m.n++] = {ws.time, double(passed_unseen), double(component), infinity, 0};
}

/// Whether a contact whose torque jumps with the sign of its slip reverses again and again within a few steps: it
/// cannot come to rest. docs/theory/events.md, rule 14
template <class T>
bool chatters(Workspace<T>& ws) {
  constexpr int window = 800, most = 40;
  const std::int64_t steps = ws.statistics.steps + ws.statistics.rejected;
  if (steps - ws.guard.reversals_since > window) ws.guard.reversals_since = steps, ws.guard.reversals = 0;
  for (int i = 0; i < ws.guard.n_chattering; ++i) {
    const int k = ws.guard.chattering[i];
    const double rate = value(ws.step_start.rate[k]);
    int& heading = ws.heading[ws.branch[k].direction];
    if constexpr (has_tangents<T>) {
      // what has been at rest for a step has not slipped either way
      const double zero = slip_tolerance(ws);
      if (abs(rate) <= zero && abs(value(ws.step_end.rate[k])) <= zero) {
        heading = 0;
        continue;
      }
    }
    const int before = heading;
    if (rate == 0 || rate * before > 0) continue;
    heading = rate > 0 ? forward : backward;
    if (before == 0) continue;
    if constexpr (has_tangents<T>) note_passed(ws, ws.branch[k].direction);
    // a slip that was driven through zero goes on; one that chatters is pushed back
    if (rate * value(ws.step_start.slope[k]) >= 0) continue;
    ws.detail.component = ws.branch[k].direction;
    ws.detail.value = rate;
    if (++ws.guard.reversals > most) return true;
  }
  return false;
}

/// Move the state to where a harmless guard was hit: next piece of a table, or an open contact passing zero.
template <class Form>
void pass_line(Form& form, const LineGuard& guard) {
  auto& ws = form.ws;
  auto& b = ws.branch[guard.branch];
  if (guard.kind == LineGuard::edge) {
    const int inner = b.law >= 0 ? b.sign : 1;
    ws.piece[b.direction] += guard.sign == -inner ? 1 : -1;
    b.piece = ws.piece[b.direction];
  } else {
    const int c = b.direction - int(ws.sys.elements), from = ws.contact.mode[c];
    ws.contact.mode[c] = b.sign = -from;
    const double e = kinetic_energy(ws);
    record(ws, {c, from, ws.contact.mode[c], Cause::passing, value(ws.step_start.slope[guard.branch]), 0.0, 0.0, e, e});
  }
  list_lines(ws);
}

/// Open contacts that were at rest and have started to move get their direction. docs/theory/events.md, rule 5
template <class Form>
void direct_open(Form& form, const StepEnd<typename Form::Scalar>& edge) {
  auto& ws = form.ws;
  bool changed = false;
  for (int k = ws.n_branches; k < ws.n_rates; ++k) {
    auto& b = ws.branch[k];
    const double rate = value(edge.rate[k]);
    if (b.sign != 0 || abs(rate) <= 1e-10) continue;
    b.sign = rate > 0 ? forward : backward;
    ws.contact.mode[b.direction - int(ws.sys.elements)] = b.sign;
    --ws.guard.n_undirected;
    changed = true;
  }
  if (changed) list_lines(ws);
}

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/acceleration.hpp>
#include <clutchwork/contacts/decision.hpp>
#include <clutchwork/contacts/impulses.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/ratio_jumps.hpp>
#include <clutchwork/contacts/ratios.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/contacts/stops.hpp>
#include <clutchwork/run/clamp_loads.hpp>
#include <clutchwork/run/corners.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/settle.hpp>
#include <clutchwork/run/snapshot.hpp>
#include <clutchwork/workspace.hpp>

/// What happens at an instant: decide the modes anew and report every change.
namespace clutchwork {

/// Torque of a contact right after the decision.
template <class T>
T torque_after(const Workspace<T>& ws, int c) {
  const int d = int(ws.sys.elements) + c;
  if (!ws.contact.loaded[c]) return T(0);
  if (ws.loads.of[c] >= 0) return ws.decision.torque[c];
  const T held = ws.contact.mode[c] == locked ? ws.decision.torque[c] : T(0);
  if (ws.contact.mode[c] == locked && !ws.contact.compliant[c]) return held;
  const Branch<T> b = make_branch(ws, d, ws.contact.mode[c]);
  return held + contact_torque(ws, b, rate_of(ws, d), ws.state, ws.observed.state_rates);
}

/// Stops that were forced to open and are driven back may hold after all: whether there are such ones. What a decision
/// leaves out drives none. docs/theory/play.md, rule 5
template <class T>
bool takes_back_stops(Workspace<T>& ws) {
  const int ne = int(ws.sys.elements);
  auto forced = [&](int c) { return is_stop(ws, c) && ws.contact.side[c] * ws.contact.forced[c] != 0; };
  bool any = false;
  for (int c = 0; c < ws.sys.contacts; ++c) any = any || (forced(c) && !is_rigid(ws, c));
  if (!any) return false;
  accelerations_after(ws);
  any = false;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const double noise = (1e-12 * ws.decision.effort + ws.decision.missed) * value(sqrt(ws.geometry.own[ne + c]));
    if (!forced(c) || ws.contact.side[c] * value(ws.decision.acceleration[c]) <= noise) continue;
    ws.contact.forced[c] = 0, ws.contact.mode[c] = locked;
    any = true;
  }
  return any;
}

/// The piece that element d enters in the motion that was decided, of which decision.motion is the acceleration: the
/// one behind a kink at which its rate is, where its torque jumps there; else its own.
template <class T>
int entered_piece(Workspace<T>& ws, int d) {
  const int piece = ws.piece[d], edges = edge_count(ws, d), interval = piece % (edges + 1);
  const double rate = value(rate_of(ws, d)), zero = slip_tolerance(ws);
  // one that others hold at rest moves by round-off alone: what does not leave within a second stays
  const double noise = larger(1e-12 * ws.decision.effort * value(sqrt(ws.geometry.own[d])), zero);
  for (int side = -1; side <= 1; side += 2) {
    const int i = side < 0 ? interval - 1 : interval;
    if (i < 0 || i >= edges || abs(rate - value(edge_at(ws, d, i))) > zero) continue;
    const double leaving = side * value(acceleration_along(ws, d, ws.decision.motion));
    const bool leaves = leaving > noise || (leaving >= -noise && side * breaks_away(ws, d) > 0);
    if (leaves && jumps_between(ws, d, piece, side)) return piece + side;
  }
  return piece;
}

/// Elements go to the pieces that the decided motion enters: whether a torque jumps with that, so that the modes must
/// be decided anew. docs/theory/events.md, rule 17
template <class T>
bool enter_pieces(Workspace<T>& ws) {
  bool looked = false, any = false;
  for (int d = 0; d < ws.sys.elements; ++d) {
    if (!may_jump(ws, d)) continue;
    if (!looked) accelerations_after(ws), looked = true;
    const int piece = entered_piece(ws, d);
    if (piece == ws.piece[d]) continue;
    any = true, ws.piece[d] = piece;
    // what else of its piece follows the torque there
    if (!is_settling(ws.sys.element_kind[d])) continue;
    const Branch<T> b = make_branch(ws, d, 0);
    ws.piece[d] = law_cross(ws, b, PresentRates<T>(ws, b).at, turned, ws.state);
  }
  return any;
}

/// Decide the modes; freewheels that would have to hold more than they can give way for good on the way. `running`:
/// they are decided.
template <class T>
Status settle_once(Workspace<T>& ws, int located) {
  const bool stops = has_stops(ws);
  if (stops) close_stops(ws);
  for (int round = 0; round <= ws.sys.contacts; ++round) {
    const Verdict verdict = settle_contacts(ws, located);
    switch (verdict.how) {
      case Settled::yes:
        if (stops && takes_back_stops(ws)) continue;
        if (stops) open_stops(ws);
        return Status::running;
      case Settled::no:
        return Status::no_mode;
      case Settled::unbalanced:
        ws.detail.component = verdict.contact < 0 ? -1 : int(ws.sys.elements) + verdict.contact;
        return Status::unbalanced;
      case Settled::jams:
        ws.detail.component = int(ws.sys.elements) + verdict.contact;
        if (!(value(freewheel_limit(ws, verdict.contact)) < infinity)) return Status::jammed;
        [[fallthrough]];
      case Settled::gives_way:
        fail(ws, verdict.contact);
    }
  }
  return Status::no_mode;
}

/// The same with the torques behind the kinks at which elements are.
template <class T>
Status settle_at_kinks(Workspace<T>& ws, int located) {
  constexpr int most = 4;
  find_pieces(ws);
  for (int round = 0;; ++round) {
    const Status status = settle_once(ws, located);
    if (status != Status::running || round == most || !enter_pieces(ws)) return status;
  }
}

/// The same at the corners at which processes are.
template <class T>
Status settle(Workspace<T>& ws, int located) {
  const Status status = settle_at_kinks(ws, located);
  return status == Status::running ? settle_at_corners(ws, [&] { return settle_at_kinks(ws, located); }) : status;
}

/// A freewheel that runs backward although everything is decided, or that nothing keeps from starting to; -1: none.
template <class T>
int backward_freewheel(Workspace<T>& ws) {
  const double tolerance = slip_tolerance(ws);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (!ws.contact.loaded[c]) continue;
    const int way = free_way(ws, c);
    const double slip = way * value(rate_of(ws, int(ws.sys.elements) + c));
    if (slip < -1e3 * tolerance) return c;
    if (!(slip < -tolerance) || !is_rigid(ws, c) || ws.contact.mode[c] == locked) continue;
    accelerations_after(ws);
    if (way * value(ws.decision.acceleration[c]) < 0) return c;
  }
  return -1;
}

/// After a jump of the speeds: what contacts read of them, and which of them can transmit.
template <class T>
void see_speeds(Workspace<T>& ws) {
  if (ws.in.n_rate_refs == 0) return;
  present_rates(ws);
  refresh_loads(ws);
}

/// Whether a contact that has come to rest is moved again by an impulse at the same instant.
template <class T>
bool is_struck_off(const Workspace<T>& ws, int c, T slip_before) {
  const double tolerance = slip_tolerance(ws);
  const T slip = rate_of(ws, int(ws.sys.elements) + c);
  return abs(value(slip)) > tolerance && abs(value(slip - slip_before)) > tolerance;
}

/// Modes, where gears whose friction nothing balances stop at once.
template <class T>
Status settle_jams(Workspace<T>& ws, int located, bool at_start) {
  Status status = ws.loads.jammed < 0 ? settle(ws, located) : Status::unbalanced;
  for (int round = 0; status == Status::unbalanced && round < ws.sys.loads; ++round) {
    const int c = ws.loads.jammed >= 0 ? ws.loads.jammed : ws.detail.component - int(ws.sys.elements);
    ws.loads.jammed = -1;
    if (c < 0 || !stop_jammed(ws, c, round == 0 ? located : -1)) return status;
    ws.event_context.cause = Cause::jam, ws.event_context.contact = c;
    ws.contact.impulse[c] = at_start;
    status = settle(ws, -1);
  }
  return status;
}

/// Impulses, then modes; the impulse of a stop within a tolerance may bring others to rest, or break them loose.
/// `running`: all is decided. docs/theory/contacts.md, rule 9
template <class T>
Status decide(Workspace<T>& ws, bool at_start) {
  int located = ws.event_context.contact;
  const bool stops = has_stops(ws);
  const T slip = located >= 0 ? rate_of(ws, int(ws.sys.elements) + located) : T(0);
  if (!settle_impulses(ws, at_start) || (stops && !collide(ws))) return Status::no_mode;
  if (located >= 0 && is_struck_off(ws, located, slip)) located = -1;
  see_speeds(ws);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    ws.contact.impulse[c] = at_start && ws.contact.mode[c] == locked && ws.event_context.mode[c] != locked;
  }
  Status status = settle_jams(ws, located, at_start);
  const bool much = status == Status::running && stops_much(ws, located, kinetic_energy(ws));
  if (status == Status::running && (much || stops_short(ws, located))) {
    if (!stop_within_tolerance(ws, located, much ? 0.0 : slip_tolerance(ws)) || (stops && !collide(ws)))
      return Status::no_mode;
    see_speeds(ws);
    // one that others drive on cannot be stopped before its slip is zero
    if (ws.contact.mode[located] != locked) ws.contact.forced[located] = ws.contact.mode[located];
    status = settle(ws, -1);
    ws.contact.impulse[located] = 1;
  }
  const int jammed = status == Status::running ? backward_freewheel(ws) : -1;
  if (jammed < 0) return status;
  ws.detail.component = int(ws.sys.elements) + jammed;
  return Status::jammed;
}

/// Report every contact that has changed its mode; at the start, those alone that an impulse has locked.
template <class T>
void report_changes(Workspace<T>& ws, bool at_start, double energy_before) {
  list_locked(ws);
  share_decided(ws);
  const double energy_after = kinetic_energy(ws);
  accelerations_after(ws);
  const EventContext<T>& before = ws.event_context;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int mode = ws.contact.mode[c];
    // one that jams, or is stopped within its tolerance, may slip on as before
    const bool stopped = before.cause == Cause::jam || ws.contact.impulse[c] != 0;
    const bool struck = ws.contact.struck[c] != 0, again = !at_start && c == before.contact && stopped;
    if (!struck && !again && (mode == before.mode[c] || (at_start && !ws.contact.impulse[c]))) continue;
    const bool own = c == before.contact || before.contact < 0;
    const Cause cause = at_start ? Cause::impulse : struck ? Cause::impact : own ? before.cause : Cause::other_event;
    const double hits = value(mode == locked ? before.slope[c] : ws.decision.acceleration[c]);
    const double torque_before = value(before.torque[c]), torque = value(torque_after(ws, c));
    record(ws, {c, before.mode[c], mode, cause, hits, torque_before, torque, energy_before, energy_after});
  }
}

/// Prescribed speeds jump while the ratios are still those before.
template <class T>
void jump_prescribed(Workspace<T>& ws) {
  const BesideRatios<T> beside(ws, Written::before);
  prescribed_jump(ws);
}

/// What jumps at an instant: prescribed speeds, then the ratios. It does so once, however often the modes are decided.
template <class T>
void jump(Workspace<T>& ws) {
  jump_prescribed(ws);
  if (ws.ratios.n > 0) jump_ratios(ws, slip_tolerance(ws)), keep_ratios(ws);
  keep_prescribed(ws);
}

/// When contacts were let go from rest last; one that an impulse has turned since then has left it.
/// docs/theory/contacts.md, rule 10
template <class T>
void note_let_go(Workspace<T>& ws) {
  const double tolerance = slip_tolerance(ws);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int mode = ws.contact.mode[c];
    if (is_stop(ws, c) || (mode != forward && mode != backward)) continue;
    const bool rests = abs(value(rate_of(ws, int(ws.sys.elements) + c))) <= tolerance;
    if (rests || mode == -ws.event_context.mode[c]) ws.contact.met_at[c] = rests ? ws.time : -infinity;
  }
}

/// Decide the modes at the present instant and report what changed.
template <class T>
Status switch_modes(Workspace<T>& ws) {
  const int ne = int(ws.sys.elements), located = ws.event_context.contact;
  const bool at_start = ws.event_context.cause == Cause::initial;
  // bounces end by their own rule. docs/theory/play.md, rule 2
  const bool bounces = ws.event_context.cause == Cause::impact && ws.time > ws.contact.met_at[located];
  // and with them what they turn around again and again
  if (bounces) ws.events.crowd_time = -infinity;
  if (located >= 0 && !bounces && events_crowd(ws, ne + located)) return crowded(ws);
  for (int c = 0; c < ws.sys.contacts; ++c) ws.contact.struck[c] = 0;
  ws.detail.component = located >= 0 ? ne + located : -1;
  if (ws.statistics.events > ws.options.max_events) return Status::too_many_events;

  forget_forced(ws);
  rest_at_ends(ws);
  if (ws.event_context.cause == Cause::slip_zero && located >= 0) ws.contact.forced[located] = 0;
  if (!at_start) jump(ws);
  int stuck = leaves_zero_against(ws);
  if (stuck < 0 && !at_start) stuck = ws.ratios.jammed;
  const BesideRatios<T> beside(ws);
  if (const int lost = stuck >= 0 ? stuck : lost_follower(ws); lost >= 0) {
    ws.detail.component = first_of(ws, lost);
    return Status::jammed;
  }
  if (ws.ratios.n > 0) settle_rows(ws);
  if (!at_start) see_speeds(ws);
  if constexpr (has_tangents<T>) {
    if (ws.event_context.cause == Cause::slip_zero) note_others(ws, located);
  }
  const double energy_before = kinetic_energy(ws);
  const Status decided = decide(ws, at_start);
  if (decided != Status::running) return decided;
  if (ws.event_context.cause == Cause::impact) ws.contact.met_at[located] = ws.time;
  note_let_go(ws);
  ws.fresh_phase = true;
  ws.guard.jumped_at = ws.time;
  if (ws.contact.failed >= 0) {
    ws.detail.component = ne + ws.contact.failed;
    return Status::fault;
  }
  report_changes(ws, at_start, energy_before);
  return Status::running;
}

}  // namespace clutchwork

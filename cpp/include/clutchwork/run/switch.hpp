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
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/loads.hpp>
#include <clutchwork/run/snapshot.hpp>
#include <clutchwork/workspace.hpp>

/// What happens at an instant: decide the modes anew and report every change.
namespace clutchwork {

/// Torque of a contact right after the decision.
template <class T>
T torque_after(const Workspace<T>& ws, int c) {
  const int d = int(ws.sys.elements) + c;
  if (!ws.contact.loaded[c]) return T(0);
  const T held = ws.contact.mode[c] == locked ? ws.decision.torque[c] : T(0);
  if (ws.contact.mode[c] == locked && !ws.contact.compliant[c]) return held;
  const Branch<T> b = make_branch(ws, d, ws.contact.mode[c]);
  return held + contact_torque(ws, b, rate_of(ws, d), ws.state, ws.seen.state_rates);
}

/// Slip acceleration of every contact right after the decision, in decision.acceleration.
template <class T>
void accelerations_after(Workspace<T>& ws) {
  const int nc = int(ws.sys.contacts), ne = int(ws.sys.elements);
  int* stuck = ws.decision.candidate;
  T *q = ws.decision.motion, *out = ws.decision.acceleration;
  for (int c = 0; c < nc; ++c) stuck[c] = ws.contact.mode[c] == locked;
  free_motion(ws, stuck, q);
  for (int c = 0; c < nc; ++c) {
    const bool holds = ws.contact.mode[c] == locked && ws.contact.loaded[c];
    if (holds) ws.geometry.white.add(ne + c, ws.decision.torque[c], q);
  }
  for (int c = 0; c < nc; ++c) out[c] = ws.contact.mode[c] == locked ? T(0) : slip_acceleration(ws, c, q);
}

/// Decide the modes; freewheels that would have to hold more than they can give way for good on the way. `running`:
/// they are decided.
template <class T>
Status settle(Workspace<T>& ws, int located) {
  for (int round = 0; round <= ws.sys.contacts; ++round) {
    const Verdict verdict = settle_contacts(ws, located);
    switch (verdict.how) {
      case Settled::yes:
        return Status::running;
      case Settled::no:
        return Status::no_mode;
      case Settled::jams:
        ws.detail.component = int(ws.sys.elements) + verdict.contact;
        return Status::jammed;
      case Settled::gives_way:
        fail(ws, verdict.contact);
    }
  }
  return Status::no_mode;
}

/// A freewheel that runs backward although everything is decided; -1: none.
template <class T>
int backward_freewheel(const Workspace<T>& ws) {
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (!ws.contact.loaded[c] || !contact_one_way(ws, c)) continue;
    if (value(rate_of(ws, int(ws.sys.elements) + c)) < -1e3 * slip_tolerance(ws)) return c;
  }
  return -1;
}

/// Impulses, then modes; the impulse of a stop within a tolerance may bring others to rest, or break them loose.
/// `running`: all is decided. docs/theory/contacts.md, rule 9
template <class T>
Status decide(Workspace<T>& ws, bool at_start) {
  const int located = ws.happened.contact;
  if (!settle_impulses(ws, at_start)) return Status::no_mode;
  for (int c = 0; at_start && c < ws.sys.contacts; ++c) {
    ws.contact.impulse[c] = ws.contact.mode[c] == locked && ws.happened.mode[c] != locked;
  }
  Status status = settle(ws, located);
  if (status == Status::running && stops_short(ws, located)) {
    if (!stop_within_tolerance(ws, located)) return Status::no_mode;
    status = settle(ws, -1);
  }
  const int jammed = status == Status::running ? backward_freewheel(ws) : -1;
  if (jammed < 0) return status;
  ws.detail.component = int(ws.sys.elements) + jammed;
  return Status::jammed;
}

/// The elements are on the pieces that hold their rates.
template <class T>
void find_pieces(Workspace<T>& ws) {
  for (int d = 0; d < ws.sys.elements; ++d) {
    if (edge_count(ws, d) > 0) ws.piece[d] = piece_of(ws, d, value(rate_of(ws, d)));
  }
}

/// Report every contact that has changed its mode; at the start, those alone that an impulse has locked.
template <class T>
void report_changes(Workspace<T>& ws, bool at_start, double energy_before) {
  list_locked(ws);
  share_decided(ws);
  const double energy_after = kinetic_energy(ws);
  accelerations_after(ws);
  const Happened<T>& before = ws.happened;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int mode = ws.contact.mode[c];
    if (mode == before.mode[c] || (at_start && !ws.contact.impulse[c])) continue;
    const bool own = c == before.contact || before.contact < 0;
    const Cause cause = at_start ? Cause::impulse : own ? before.cause : Cause::other_event;
    const double hits = value(mode == locked ? before.slope[c] : ws.decision.acceleration[c]);
    const double torque_before = value(before.torque[c]), torque = value(torque_after(ws, c));
    record(ws, {c, before.mode[c], mode, cause, hits, torque_before, torque, energy_before, energy_after});
  }
}

/// Decide the modes at the present instant and report what changed.
template <class T>
Status switch_modes(Workspace<T>& ws) {
  const int ne = int(ws.sys.elements), located = ws.happened.contact;
  const bool at_start = ws.happened.cause == Cause::initial;
  if (located >= 0 && events_crowd(ws, ne + located)) return Status::zeno;
  ws.detail.component = located >= 0 ? ne + located : -1;
  if (ws.statistics.events > ws.options.max_events) return Status::too_many_events;

  forget_forced(ws);
  if (ws.happened.cause == Cause::slip_zero && located >= 0) ws.contact.forced[located] = 0;
  if (!at_start) prescribed_jump(ws);
  const double energy_before = kinetic_energy(ws);
  const Status decided = decide(ws, at_start);
  if (decided != Status::running) return decided;
  find_pieces(ws);
  ws.fresh_phase = true;
  if (ws.contact.failed >= 0) {
    ws.detail.component = ne + ws.contact.failed;
    return Status::fault;
  }
  report_changes(ws, at_start, energy_before);
  return Status::running;
}

}  // namespace clutchwork

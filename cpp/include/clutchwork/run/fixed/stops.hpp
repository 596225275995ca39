#pragma once
#include <clutchwork/contacts/stops.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/fixed/prepare.hpp>
#include <clutchwork/run/switch.hpp>

/// Stops that are met within a step, and the impacts there: docs/theory/fixed-steps.md, rule 7
namespace clutchwork::fixed {

/// So many impacts of one step bounce; as many more as there are contacts do not, and the rest waits for its end.
inline constexpr int most_bounces = 3;
/// So often the part of a step up to a meeting is made, at most.
inline constexpr int most_tries = 5;

/// Where in a step a stop meets an end.
struct Meeting {
  int contact = -1, side = 0;
  real share = 1;
};

/// Share of a step at which a distance `far` that closes by `speed`, which itself gains `gain`, is gone; 2: it is not.
inline real closing_share(real far, real speed, real gain) {
  const real square = speed * speed + 2 * far * gain;
  if (!(square >= 0)) return 2;
  if (speed > 0) return 2 * far / (speed + sqrt(square));
  return gain > 0 ? (sqrt(square) - speed) / gain : 2;
}

/// Share of the step that was made at which stop c meets its end on a side; 2: it does not.
inline real meeting_share(const Run& ws, int c, int side, real h) {
  const Fixed<real>& f = ws.fixed;
  const int d = int(ws.sys.elements) + c;
  const real far = side * (stop_end(ws, c, side) - ws.state[place_of(ws, c)]);
  if (!(far < infinity)) return 2;
  // one that has just left an end leaves it
  const real left = far <= stop_noise(ws, c) ? 0 : far;
  return closing_share(left, h * side * f.start_rate[d], h * side * f.rate_change[d]);
}

/// How far stop c is from its end on a side behind the step of the length h that was made.
inline real gap_behind(const Run& ws, int c, int side, real h) {
  const Fixed<real>& f = ws.fixed;
  const int d = int(ws.sys.elements) + c;
  return side * (stop_end(ws, c, side) - ws.state[place_of(ws, c)] - h * (f.start_rate[d] + 0.5 * f.rate_change[d]));
}

/// The first meeting in a step of the length h; a closed stop that opens in it may meet its other end.
inline Meeting first_meeting(const Run& ws, real h, real tolerance) {
  Meeting first;
  for (int k = 0; k < ws.fixed.plan.n_stops; ++k) {
    const int c = ws.fixed.plan.stops[k];
    const int closed = ws.contact.side[c];
    if (closed != 0 && !(free_way(ws, c) * ws.fixed.end_slip[c] > tolerance)) continue;
    for (int side = -1; side <= 1; side += 2) {
      const real share = side == closed ? 2 : meeting_share(ws, c, side, h);
      if (share < first.share || (share == 1 && first.contact < 0)) first = {c, side, share};
    }
  }
  return first;
}

/// Modes behind impacts, and their events; in `mode` those before.
inline void report_impacts(Run& ws, real before) {
  const int ne = int(ws.sys.elements);
  const real after = kinetic_energy(ws), tolerance = slip_tolerance(ws);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int from = ws.fixed.mode[c];
    const real slip = rate_of(ws, ne + c);
    int& mode = ws.contact.mode[c];
    if (is_stop(ws, c)) {
      mode = ws.contact.side[c] != 0 ? locked : open;
    } else if (ws.contact.loaded[c] && abs(slip) > tolerance) {
      mode = slip > 0 ? forward : backward;
    }
    const bool struck = ws.contact.struck[c] != 0;
    if (!struck && mode == from) continue;
    record(ws,
           {c, from, mode, struck ? Cause::impact : Cause::other_event, 0, ws.fixed.torque[ne + c], 0, before, after});
  }
}

/// The impacts at the present instant, which is a meeting. `running`: the next step predicts nothing from before.
inline Status strike(Run& ws, const Meeting& met) {
  Fixed<real>& f = ws.fixed;
  const real tolerance = slip_tolerance(ws);
  inputs_at(ws, ws.time);
  ws.detail.component = int(ws.sys.elements) + met.contact;
  if (is_rigid(ws, met.contact)) return Status::jammed;
  ws.state[place_of(ws, met.contact)] = stop_end(ws, met.contact, met.side);
  for (int c = 0; c < ws.sys.contacts; ++c) ws.contact.struck[c] = 0, f.mode[c] = ws.contact.mode[c];
  const real before = kinetic_energy(ws);
  int n = 0;
  const bool ends = ++f.impacts > most_bounces;
  if (ends) list_struck(ws, true, tolerance, ws.decision.list, n);
  if (ends ? !impact(ws, n, true, tolerance) : !collide(ws)) return Status::no_mode;
  if (ends) ws.contact.struck[met.contact] = 1;
  close_stops(ws);
  report_impacts(ws, before);
  f.before = 0;
  return Status::running;
}

}  // namespace clutchwork::fixed

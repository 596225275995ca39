#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/contacts/acceleration.hpp>
#include <clutchwork/contacts/impulses.hpp>
#include <clutchwork/contacts/problem.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// Stops: contacts that exist where a position is at an end, and the impacts there. docs/theory/play.md
namespace clutchwork {

/// Whether a contact is a stop.
template <class T>
CLUTCHWORK_HOT bool is_stop(const Workspace<T>& ws, int c) {
  return ws.sys.contact_place[c] >= 0;
}
template <class T>
bool has_stops(const Workspace<T>& ws) {
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (is_stop(ws, c)) return true;
  }
  return false;
}

/// Calls f with the kind of a stop and its parameters; zero for other contacts.
template <class T, class F>
T visit_stop(const Workspace<T>& ws, int c, F&& f) {
  return visit_contact(ws.sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (StopContact<E>)
      return f(tag, *reinterpret_cast<const typename E::template Params<T>*>(ws.params + ws.sys.contact_param[c]));
    return T(0);
  });
}

/// Position at which a stop blocks on a side; not finite where it has no such end.
template <class T>
T stop_end(const Workspace<T>& ws, int c, int side) {
  return visit_stop(ws, c, [&](auto tag, const auto& p) { return decltype(tag)::type::end(p, side); });
}
/// Slip below which a stop rests.
template <class T>
Real<T> rest_speed(const Workspace<T>& ws, int c) {
  return value(visit_stop(ws, c, [&](auto tag, const auto& p) { return decltype(tag)::type::rest_speed(p); }));
}

/// Where the position of a stop is among the states.
template <class T>
CLUTCHWORK_HOT int place_of(const Workspace<T>& ws, int c) {
  return ws.sys.element_state[ws.sys.contact_place[c]];
}

/// Round-off of a position against its ends.
template <class T>
Real<T> stop_noise(const Workspace<T>& ws, int c) {
  Real<T> size = abs(value(ws.state[place_of(ws, c)]));
  for (int side = -1; side <= 1; side += 2) {
    const Real<T> end = abs(value(stop_end(ws, c, side)));
    if (end < infinity) size = larger(size, end);
  }
  return roundoff<T>(1e-14, 1e-6) * size + roundoff<T>(1e-18, 1e-12);
}

/// Whether a stop that closes at a speed was left no further than round-off since it was met.
template <class T>
bool returns_unseen(const Workspace<T>& ws, int c, double closing) {
  return closing * (ws.time - ws.contact.met_at[c]) / 4 <= 4 * stop_noise(ws, c);
}

/// Speed at which a stop that is met on a side at a closing speed is left: none below the speed of rest, or after a
/// bounce that was no higher than round-off. docs/theory/play.md, rule 2
template <class T>
T rebound(const Workspace<T>& ws, int c, int side, T closing) {
  const T e = visit_stop(ws, c, [&](auto tag, const auto& p) { return decltype(tag)::type::restitution(p, side); });
  return value(e * closing) <= rest_speed(ws, c) || returns_unseen(ws, c, value(closing)) ? T(0) : e * closing;
}

/// The end at which the position of a stop is, or beyond which it is: -1 or 1; 0: it is between them.
template <class T>
int side_at(const Workspace<T>& ws, int c) {
  const double x = value(ws.state[place_of(ws, c)]), noise = stop_noise(ws, c);
  for (int side = -1; side <= 1; side += 2) {
    if (side * (x - value(stop_end(ws, c, side))) >= -noise) return side;
  }
  return 0;
}

/// The way in which a contact cannot be passed now: that of a closed freewheel, or away from the end that a stop is at.
template <class T>
int blocked_way(const Workspace<T>& ws, int c) {
  if (is_stop(ws, c)) return -side_at(ws, c);
  return ws.contact.loaded[c] ? free_way(ws, c) : 0;
}

/// List the contacts that an impact may reach: those that close or rest; `all`: those that part as well. Whether one
/// closes.
template <class T>
bool list_struck(const Workspace<T>& ws, bool all, double tolerance, int* list, int& n) {
  bool closes = false;
  n = 0;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int way = is_rigid(ws, c) ? 0 : blocked_way(ws, c);
    if (way == 0) continue;
    const double slip = way * value(rate_of(ws, int(ws.sys.elements) + c));
    if (!all && slip > tolerance) continue;
    closes = closes || slip < -tolerance;
    list[n++] = c;
  }
  return closes;
}

/// Stops that are at an end and do not leave it are closed, all others open.
template <class T>
void close_stops(Workspace<T>& ws) {
  const Real<T> tolerance = slip_tolerance(ws);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (!is_stop(ws, c)) continue;
    const int side = side_at(ws, c);
    const bool leaves = -side * value(rate_of(ws, int(ws.sys.elements) + c)) > tolerance;
    ws.contact.side[c] = leaves ? 0 : side;
    ws.contact.loaded[c] = ws.contact.side[c] != 0;
  }
}

/// Whether all that closes are stops that were left no further than round-off since an instant before, and close
/// slowly.
template <class T>
bool fades(const Workspace<T>& ws, int n, double tolerance) {
  for (int a = 0; a < n; ++a) {
    const int c = ws.decision.list[a];
    const double closing = -blocked_way(ws, c) * value(rate_of(ws, int(ws.sys.elements) + c));
    if (closing <= tolerance) continue;
    const bool left = is_stop(ws, c) && ws.time > ws.contact.met_at[c];
    if (!left || closing > 1e6 * tolerance || !returns_unseen(ws, c, closing)) return false;
  }
  return true;
}

/// The end of bounces that have become so small: what closes comes to rest, beside what is locked, which stays so.
/// Stops only push. docs/theory/play.md, rule 2
template <class T>
bool end_bounces(Workspace<T>& ws, int n, double tolerance) {
  int* rests = ws.decision.candidate;
  for (int c = 0; c < ws.sys.contacts; ++c) rests[c] = ws.contact.mode[c] == locked && !contact_one_way(ws, c);
  for (int a = 0; a < n; ++a) {
    const int c = ws.decision.list[a];
    if (-blocked_way(ws, c) * value(rate_of(ws, int(ws.sys.elements) + c)) <= tolerance) continue;
    ws.contact.struck[c] = 1, ws.contact.met_at[c] = ws.time;
  }
  close_stops(ws);
  return stop_by_impulses(ws, 0.0, rests, nullptr);
}

/// One impact of all that close, with those that rest: each is left at least at its rebound. `all`: without rebound.
/// docs/theory/play.md (3)
template <class T>
bool impact(Workspace<T>& ws, int n, bool all, double tolerance) {
  const int ne = int(ws.sys.elements), *list = ws.decision.list;
  T* back = ws.decision.acceleration;
  BoundedProblem<T> p = gather(ws, list, n);
  for (int a = 0; a < n; ++a) {
    const int c = list[a], way = blocked_way(ws, c);
    const T slip = rate_of(ws, ne + c), closing = T(-way) * slip;
    const bool closes = value(closing) > tolerance;
    // one that parts by less than counts is turned, which gives it no work
    back[a] = !closes && !all ? smaller(closing, T(0)) * T(way) : T(0);
    if (closes && !all && is_stop(ws, c)) back[a] = T(way) * rebound(ws, c, -way, closing);
    p.gradient[a] = slip - back[a];
    p.lower[a] = T(way > 0 ? 0.0 : -infinity), p.upper[a] = T(way > 0 ? infinity : 0.0);
    ws.problem.capacity[a] = T(infinity), p.x[a] = T(0);
    if (closes && is_stop(ws, c)) ws.contact.struck[c] = 1, ws.contact.met_at[c] = ws.time;
  }
  capacity_weights(p, ws.problem.capacity);
  if (!solve(p)) return false;
  for (int a = 0; a < n; ++a) p.gradient[a] += back[a], p.slope[a] += back[a];
  apply_impulses(ws, p, list);
  return true;
}

/// Closed stops are exactly at their ends: round-off of the steps since then does not tell that one has left it.
/// docs/theory/play.md, rule 5
template <class T>
void rest_at_ends(Workspace<T>& ws) {
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int side = ws.contact.side[c];
    if (is_stop(ws, c) && side != 0 && ws.contact.mode[c] == locked) ws.state[place_of(ws, c)] = stop_end(ws, c, side);
  }
}

/// Closed stops whose directions vary stay exactly at their ends. docs/theory/varying-ratios.md (18)
template <class T>
void stay_at_ends(const Workspace<T>& ws, T* state) {
  for (int a = ws.held.n_fixed; a < ws.held.n; ++a) {
    const int c = ws.held.contact[a];
    const int side = ws.contact.side[c];
    if (is_stop(ws, c) && side != 0) state[place_of(ws, c)] = stop_end(ws, c, side);
  }
}

/// What became of the impacts of an instant: none was there, or all of them were the end of bounces.
enum class Blows { none, faded, felt };

/// Impacts until nothing closes; after many of them, all at once without rebound. False: they have no solution.
/// docs/theory/play.md, rule 1
template <class T>
bool collide_all(Workspace<T>& ws, Blows& blows) {
  const Real<T> tolerance = slip_tolerance(ws);
  const int most = 20 + 4 * int(ws.sys.contacts);
  for (int round = 0; round < most + 2; ++round) {
    int n;
    const bool all = round >= most;
    if (!list_struck(ws, all, tolerance, ws.decision.list, n)) return true;
    const bool faded = fades(ws, n, tolerance);
    if (!(faded ? end_bounces(ws, n, tolerance) : impact(ws, n, all, tolerance))) return false;
    blows = faded && blows != Blows::felt ? Blows::faded : Blows::felt;
  }
  return true;
}

/// Whether a stop leaves an end so slowly that it stays there.
template <class T>
bool lingers(const Workspace<T>& ws, int c, double tolerance) {
  if (!is_stop(ws, c) || is_rigid(ws, c)) return false;
  const double leaving = blocked_way(ws, c) * value(rate_of(ws, int(ws.sys.elements) + c));
  return leaving > tolerance && leaving <= rest_speed(ws, c);
}

/// Impacts, and stops that these have left below the speed of rest brought to rest, beside what is locked where bounces
/// have ended. docs/theory/play.md, rule 2
template <class T>
bool collide(Workspace<T>& ws) {
  const Real<T> tolerance = slip_tolerance(ws);
  Blows blows = Blows::none;
  if (!collide_all(ws, blows)) return false;
  if (blows == Blows::none) return true;
  close_stops(ws);
  auto rests = [&](int c) {
    const bool held = blows == Blows::faded && ws.contact.mode[c] == locked && !contact_one_way(ws, c);
    return held || lingers(ws, c, tolerance);
  };
  return least_impulses(ws, tolerance, rests) && collide_all(ws, blows);
}

/// Stops that a decision has not locked are open, unless prescribed speeds drive them on.
template <class T>
void open_stops(Workspace<T>& ws) {
  const Real<T> tolerance = slip_tolerance(ws);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (!is_stop(ws, c) || (ws.contact.loaded[c] && ws.contact.mode[c] == locked)) continue;
    if (ws.contact.side[c] * value(rate_of(ws, int(ws.sys.elements) + c)) > tolerance) continue;
    ws.contact.side[c] = ws.contact.loaded[c] = 0;
    ws.contact.mode[c] = open;
  }
}

}  // namespace clutchwork

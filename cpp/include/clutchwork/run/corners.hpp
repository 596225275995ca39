#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/contacts/acceleration.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/clamp_loads.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/workspace.hpp>

/// What comes to rest at a corner, where a force jumps with the place: docs/theory/vehicle.md, rule 1.
namespace clutchwork {

/// Slip acceleration of every contact right after the decision, in decision.acceleration.
template <class T>
void accelerations_after(Workspace<T>& ws) {
  const int nc = int(ws.sys.contacts), ne = int(ws.sys.elements);
  int* stuck = ws.decision.candidate;
  T *q = ws.decision.motion, *out = ws.decision.acceleration;
  for (int c = 0; c < nc; ++c) stuck[c] = ws.contact.mode[c] == locked;
  free_motion(ws, stuck, q);
  for (int c = 0; c < nc; ++c) {
    const bool holds = (ws.contact.mode[c] == locked && ws.contact.loaded[c]) || ws.loads.of[c] >= 0;
    if (holds) ws.geometry.mass_weighted.add(ne + c, ws.decision.torque[c], q);
  }
  for (int c = 0; c < nc; ++c) out[c] = ws.contact.mode[c] == locked ? T(0) : slip_acceleration(ws, c, q);
}

/// How a contact that is at its limit and starts to slip moves direction d, however little there is to move it yet.
template <class T>
double breaks_away(Workspace<T>& ws, int d) {
  const int c = ws.event_context.contact, nv = int(ws.sys.speeds);
  if (c < 0 || ws.event_context.cause != Cause::torque_limit) return 0;
  const int sign = ws.contact.mode[c];
  if (sign != forward && sign != backward) return 0;
  T* x = ws.decision.speed;
  for (int i = 0; i < nv; ++i) x[i] = T(0);
  ws.geometry.mass_weighted.add(int(ws.sys.elements) + c, T(sign), x);
  return value(ws.geometry.mass_weighted.times(d, x));
}

/// The same of a set of contacts.
template <class T>
double set_breaks_away(Workspace<T>& ws, int d) {
  if (ws.event_context.contact >= 0 || ws.event_context.cause != Cause::torque_limit) return 0;
  T* x = ws.decision.speed;
  for (int i = 0; i < ws.sys.speeds; ++i) x[i] = T(0);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int sign = ws.contact.mode[c];
    const bool slips = ws.contact.forced[c] != 0 && (sign == forward || sign == backward);
    if (slips) ws.geometry.mass_weighted.add(int(ws.sys.elements) + c, T(sign), x);
  }
  return value(ws.geometry.mass_weighted.times(d, x));
}

/// What a decision may leave for good: events of contacts that fail in it.
template <class T>
struct Lasting {
  std::int64_t events;
  decltype(Workspace<T>::statistics) statistics;
  decltype(Workspace<T>::detail) detail;
  int failed;
};

/// A corner, the process that is there, its first state, and the direction of its speed; what was before it is decided.
template <class T>
struct AtCorner {
  Corner<T> corner;
  int process, state, direction;
  Lasting<T> before;
};

/// Note it.
template <class T>
Lasting<T> lasting(Workspace<T>& ws) {
  const auto& contact = ws.contact;
  for (int c = 0; c < ws.sys.contacts; ++c)
    contact.untried[c] = 4 * contact.fault[c] + 2 * contact.loaded[c] + contact.pressed[c];
  return {ws.events.n, ws.statistics, ws.detail, contact.failed};
}

/// Take back what failed in a trial.
template <class T>
void take_back(Workspace<T>& ws, const Lasting<T>& before) {
  auto& contact = ws.contact;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int was = contact.untried[c];
    contact.fault[c] = was / 4, contact.loaded[c] = was / 2 % 2, contact.pressed[c] = was % 2;
  }
  ws.events.n = before.events, ws.statistics = before.statistics, ws.detail = before.detail;
  contact.failed = before.failed;
}

/// Whether process c is at a corner, at rest.
template <class T>
bool rests_at_corner(const Workspace<T>& ws, int c, AtCorner<T>& out) {
  if (c >= ws.sys.processes) return false;
  return visit_process(ws.sys.process_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (CorneredProcess<E>) {
      const int first = int(ws.sys.process_input[c]), state = int(ws.sys.process_state[c]);
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + ws.sys.process_param[c]);
      const At<T> at = process_at<T, T>(ws, c, ws.state + state, ws.in.u + first);
      if (!E::corner(p, at, out.corner)) return false;
      const int d = element_behind(ws, first + out.corner.speed);
      out.process = c, out.state = state, out.direction = d;
      return d >= 0 && d < ws.n_directions && abs(value(rate_of(ws, d))) <= slip_tolerance(ws);
    }
    return false;
  });
}

/// Which way the motion that was decided leads; 0: it stays.
template <class T>
int way_from(Workspace<T>& ws, const AtCorner<T>& at) {
  accelerations_after(ws);
  const double leads = value(acceleration_along(ws, at.direction, ws.decision.motion));
  // what does not leave within a second stays
  const double noise =
      larger(1e-12 * ws.decision.effort * value(sqrt(ws.geometry.own[at.direction])), slip_tolerance(ws));
  return leads > noise ? forward : leads < -noise ? backward : 0;
}

/// The decision for one value of what jumps, on one piece, after others that were tried. `running`: it was made; then
/// it leads that way.
template <class T, class Decide>
Status decide_with(Workspace<T>& ws, const AtCorner<T>& at, const T& turned, int piece, Decide&& decide, int& way) {
  take_back(ws, at.before);
  ws.state[at.state + at.corner.moves] = at.corner.place;
  ws.state[at.state + at.corner.turns] = turned;
  ws.shared.piece[at.process] = piece;
  shared_inputs(ws, ws.state);
  refresh_loads(ws);
  const Status status = decide();
  way = status == Status::running ? way_from(ws, at) : 0;
  return status;
}

/// The same for the side of the corner that is that way.
template <class T, class Decide>
Status decide_on(Workspace<T>& ws, const AtCorner<T>& at, int side, Decide&& decide, int& way) {
  const T turned = side > 0 ? at.corner.behind : at.corner.before;
  return decide_with(ws, at, turned, at.corner.piece + (side > 0 ? 1 : 0), decide, way);
}

/// Of a trial without modes.
inline constexpr int unsettled = 2;

/// The value between both sides at which what rests there has least to hold, found by halving; motions lead forward
/// below it, backward above it. False: nothing holds.
template <class T, class Try>
bool find_balance(const AtCorner<T>& at, Try&& leads, T& balance) {
  constexpr int halvings = 50, finer = 20;
  double low = value(at.corner.before), high = value(at.corner.behind), middle = low;
  int way = forward;
  for (int k = 0; k < halvings && way != 0; ++k) {
    middle = 0.5 * (low + high), way = leads(T(middle));
    if (abs(way) > 1) return false;
    if (way != 0) (way > 0 ? low : high) = middle;
  }
  if (way != 0) return false;
  // to the middle of all that holds
  double most = middle, least = middle;
  for (int k = 0; k < finer; ++k) {
    const double below = 0.5 * (low + least), above = 0.5 * (high + most);
    (leads(T(below)) == 0 ? least : low) = below;
    (leads(T(above)) == 0 ? most : high) = above;
  }
  balance = T(0.5 * (least + most));
  return true;
}

/// Modes where both sides of a corner lead back to it: it rests with what jumps between them. If nothing holds it
/// there, those of the present value.
template <class T, class Decide>
Status settle_between(Workspace<T>& ws, const AtCorner<T>& at, const T& present, int piece, Decide&& decide) {
  // what breaks away on one side may be held between
  for (int c = 0; c < ws.sys.contacts; ++c) ws.contact.forced[c] = 0;
  int way = 0;
  // the other side may hold alone, or be left; the present one has given way, and holds again by round-off alone
  for (const int side : {forward, backward}) {
    if (value(present - (side > 0 ? at.corner.behind : at.corner.before)) == 0) continue;
    const Status status = decide_on(ws, at, side, decide, way);
    if (status == Status::running && (way == 0 || way == side)) return status;
  }
  T rests = present;
  // what has no modes holds nothing
  auto leads = [&](const T& turned) {
    return decide_with(ws, at, turned, piece, decide, way) == Status::running ? way : unsettled;
  };
  find_balance(at, leads, rests);
  return decide_with(ws, at, rests, piece, decide, way);
}

/// Whether what breaks away goes that way under a little more of what jumps: others do not hold it.
template <class T, class Decide>
bool gives_way(Workspace<T>& ws, const AtCorner<T>& at, const T& present, int piece, int side, Decide&& decide) {
  constexpr double little = 1e-3;
  const double more = side * little * abs(value(at.corner.behind - at.corner.before));
  int way = 0;
  return decide_with(ws, at, T(value(present) - more), piece, decide, way) == Status::running && way == side;
}

/// The modes are decided; where they lead over the corner they are decided with what jumps behind it.
/// docs/theory/vehicle.md, rule 1
template <class T, class Decide>
Status settle_at_corner(Workspace<T>& ws, const AtCorner<T>& at, Decide&& decide) {
  const T present = ws.state[at.state + at.corner.turns];
  const int piece = ws.shared.piece[at.process], leads = way_from(ws, at);
  // what breaks away has no acceleration yet
  const double breaks = leads != 0 ? 0 : breaks_away(ws, at.direction) + set_breaks_away(ws, at.direction);
  const double sets_off = leads != 0 ? leads : breaks;
  const int side = sets_off > 0 ? forward : backward;
  const T& ahead = side > 0 ? at.corner.behind : at.corner.before;
  if (sets_off == 0 || value(present - ahead) == 0) return Status::running;
  int way = 0;
  const bool goes = leads != 0 || gives_way(ws, at, present, piece, side, decide);
  if (!goes || decide_on(ws, at, side, decide, way) != Status::running)
    return decide_with(ws, at, present, piece, decide, way);
  const bool valley = value(at.corner.before) < value(at.corner.behind);
  return way == -side && valley ? settle_between(ws, at, present, piece, decide) : Status::running;
}

/// The same for all processes that are at rest at a corner.
template <class T, class Decide>
Status settle_at_corners(Workspace<T>& ws, Decide&& decide) {
  for (int i = 0; i < ws.guard.n_processes; ++i) {
    AtCorner<T> at;
    if (!rests_at_corner(ws, ws.guard.process[i], at)) continue;
    at.before = lasting(ws);
    const Status status = settle_at_corner(ws, at, decide);
    if (status != Status::running) return status;
  }
  return Status::running;
}

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/acceleration.hpp>
#include <clutchwork/contacts/problem.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// Which contacts stick, slip or are open, decided for all of them together: docs/theory/contacts.md.
namespace clutchwork {

/// Let a contact slip; one that still moves within its own tolerance goes on the way it moves.
template <class T>
void release(Workspace<T>& ws, int c, int sign) {
  const int d = int(ws.sys.elements) + c;
  const double slip = value(rate_of(ws, d));
  const bool moving = abs(slip) > slip_tolerance(ws);
  ws.contact.mode[c] = !moving ? sign : slip > 0 ? forward : backward;
  if (moving) ws.contact.forced[c] = ws.contact.mode[c];
  if (!ws.contact.compliant[c]) ws.piece[d] = piece_of(ws, d, moving ? abs(slip) : 0.0);
}

/// How a decision ended: all contacts have their mode, none was found, a freewheel gives way first, or prescribed
/// speeds turn one backward.
enum class Settled { yes, no, gives_way, jams };

/// An end of a decision, and the contact that gives way or jams (-1: none).
struct Verdict {
  Settled how;
  int contact = -1;
};

/// What a contact may do before the others are asked.
enum class Choice { slips, sticks, jams };

/// Choice of a contact that can transmit and whose law sticks; the mode of one that slips. `hit`: its guard was.
template <class T>
Choice choice_of(Workspace<T>& ws, int c, double slip, double tolerance, bool hit) {
  int &mode = ws.contact.mode[c], &forced = ws.contact.forced[c];
  const bool rigid = is_rigid(ws, c);
  // prescribed speeds have parted: there is no choice
  if (hit && ws.happened.cause == Cause::torque_limit && rigid) {
    const double parting = slip != 0 ? slip : value(slip_slope(ws, c));
    if (parting < 0 && contact_one_way(ws, c)) return Choice::jams;
    mode = forced = parting < 0 ? backward : forward;
    return Choice::slips;
  }
  const bool still = mode == locked && !rigid, arrived = hit && ws.happened.cause != Cause::input && !rigid;
  const bool rests = still || arrived || abs(slip) <= tolerance;
  if (rests && forced == 0) return Choice::sticks;
  mode = rests ? forced : slip > 0 ? forward : backward;
  return Choice::slips;
}

/// A contact that transmits nothing goes the way it slips.
template <class T>
void follow_slip(Workspace<T>& ws, int c, double slip, double tolerance) {
  int& mode = ws.contact.mode[c];
  if (abs(slip) > tolerance) {
    mode = slip > 0 ? forward : backward;
  } else if (mode == locked) {
    mode = open;
  }
}

/// List who may stick; all others get their mode. A freewheel that prescribed speeds turn backward ends it (-1: none).
/// docs/theory/contacts.md, rule 7
template <class T>
int choose_candidates(Workspace<T>& ws, int located, double tolerance) {
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int d = int(ws.sys.elements) + c;
    ws.decision.released[c] = ws.decision.candidate[c] = 0;
    if (!may_stick(ws, c)) {
      ws.contact.mode[c] = forward;
      continue;
    }
    const bool still = ws.contact.mode[c] == locked && !is_rigid(ws, c);
    const double slip = still ? 0.0 : value(rate_of(ws, d));
    if (!ws.contact.loaded[c]) {
      follow_slip(ws, c, slip, tolerance);
      continue;
    }
    const Choice choice = choice_of(ws, c, slip, tolerance, c == located);
    if (choice == Choice::jams) return c;
    ws.decision.candidate[c] = choice == Choice::sticks;
    const bool slides = choice == Choice::slips && !ws.contact.compliant[c];
    if (slides) ws.piece[d] = piece_of(ws, d, abs(slip) > tolerance ? abs(slip) : 0.0);
  }
  return -1;
}

/// The problem of the candidates: bounds from their static torques, accelerations from all other torques. `warm`: it
/// starts at the torques of the decision so far.
template <class T>
BoundedProblem<T> pose_problem(Workspace<T>& ws, bool warm) {
  int *list = ws.decision.list, n = 0;
  T *q = ws.decision.motion, *capacity = ws.problem.capacity;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (ws.decision.candidate[c]) list[n++] = c;
  }
  free_motion(ws, ws.decision.candidate, q);
  BoundedProblem<T> p = gather(ws, list, n);
  for (int a = 0; a < n; ++a) {
    const int c = list[a];
    const T resists_forward = usable_capacity(ws, c, forward), resists_backward = usable_capacity(ws, c, backward);
    p.gradient[a] = slip_acceleration(ws, c, q);
    p.lower[a] = -resists_forward;
    p.upper[a] = contact_one_way(ws, c) ? freewheel_limit(ws, c) : resists_backward;
    capacity[a] = larger(resists_forward, p.upper[a]);
    p.x[a] = warm ? ws.decision.torque[c] : T(0);
    if (is_rigid(ws, c)) p.matrix.diagonal[a] = T(1e-300);
  }
  capacity_weights(p, capacity);
  for (int a = 0; a < n; ++a) {
    if (is_rigid(ws, list[a])) p.lower[a] = p.upper[a] = T(0);
  }
  return p;
}

/// Acceleration of the slip of candidate a that counts as none: round-off. Between prescribed speeds only what leaves
/// zero within a microsecond is a departure; for a contact that has just come to rest, what leaves it within a
/// millisecond.
template <class T>
double slope_noise(const Workspace<T>& ws, const BoundedProblem<T>& p, int a, int located, double tolerance) {
  const int c = ws.decision.list[a];
  if (is_rigid(ws, c)) return 1e6 * tolerance;
  double scale = abs(value(p.gradient[a]));
  p.matrix.each(a, [&](int b, T g) { scale = larger(scale, abs(value(g * p.x[b]))); });
  const double mobility = value(sqrt(p.matrix.diagonal[a]));
  const double round_off = larger(1e-10 * scale, 1e-12 * ws.decision.effort * mobility);
  const bool arrived = c == located && ws.happened.cause == Cause::slip_zero;
  return arrived ? larger(round_off, 1e3 * tolerance) : round_off;
}

/// Whether candidate a is a freewheel that its torque cannot keep from running backward.
/// docs/theory/contacts.md, rule 3
template <class T>
bool overruns(const Workspace<T>& ws, const BoundedProblem<T>& p, int a) {
  return contact_one_way(ws, ws.decision.list[a]) && value(p.slope[a]) < 0;
}

/// Of the bound torques that cannot hold, the first of a freewheel, else the one that gives way most (-1: all hold).
/// Candidates on the way are locked. docs/theory/contacts.md, rule 1
template <class T>
int weakest(Workspace<T>& ws, const BoundedProblem<T>& p, int located, double tolerance) {
  int first = -1;
  double most = 0;
  for (int a = 0; a < p.n; ++a) {
    ws.contact.mode[ws.decision.list[a]] = locked;
    const double acceleration = abs(value(p.slope[a]));
    if (p.bound[a] == 0 || acceleration <= slope_noise(ws, p, a, located, tolerance)) continue;
    if (overruns(ws, p, a)) return a;
    const double size = acceleration / value(sqrt(p.matrix.diagonal[a]));
    if (size > most) first = a, most = size;
  }
  return first;
}

/// A candidate that no torque holds, for prescribed speeds turn it against freewheels alone (-1: none).
template <class T>
int unheld(const Workspace<T>& ws, const BoundedProblem<T>& p, double tolerance) {
  for (int a = 0; a < p.n; ++a) {
    const double left = abs(value(p.slope[a])), most = 1e6 * tolerance + 1e-6 * abs(value(p.gradient[a]));
    if (p.bound[a] == 0 && !is_rigid(ws, ws.decision.list[a]) && left > most) return ws.decision.list[a];
  }
  return -1;
}

/// A contact that was released and then, others having lost torque too, accelerates the other way (-1: none).
/// It may stick after all; only the first release of a contact is taken back. docs/theory/contacts.md, rule 2
template <class T>
int turned_back(Workspace<T>& ws, const BoundedProblem<T>& p) {
  const int ne = int(ws.sys.elements);
  T* q = ws.decision.motion;
  for (int a = 0; a < p.n; ++a) ws.geometry.white.add(ne + ws.decision.list[a], p.x[a], q);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (ws.decision.released[c] != 1) continue;
    const double noise = 1e-12 * ws.decision.effort * value(sqrt(ws.geometry.own[ne + c]));
    if (ws.contact.mode[c] * value(slip_acceleration(ws, c, q)) < -noise) return c;
  }
  return -1;
}

/// Give every contact at zero slip its torque or its direction of slip. `located`: the contact whose guard was hit.
template <class T>
Verdict settle_contacts(Workspace<T>& ws, int located) {
  const double tolerance = slip_tolerance(ws);
  int *candidate = ws.decision.candidate, *released = ws.decision.released;
  const int jammed = choose_candidates(ws, located, tolerance);
  if (jammed >= 0) return {Settled::jams, jammed};
  // rounds: those at a bound that accelerate start to slip with their kinetic torque
  for (int round = 0; round <= 4 * ws.sys.contacts + 4; ++round) {
    // among many contacts a release changes few torques
    const bool warm = round > 0 && !is_few(ws.sys);
    BoundedProblem<T> p = pose_problem(ws, warm);
    if (!solve(p, warm)) return {Settled::no};
    for (int a = 0; a < p.n; ++a) ws.decision.torque[ws.decision.list[a]] = p.x[a];
    const int weak = weakest(ws, p, located, tolerance);
    if (weak >= 0) {
      const int c = ws.decision.list[weak];
      if (overruns(ws, p, weak)) return {is_rigid(ws, c) ? Settled::jams : Settled::gives_way, c};
      release(ws, c, value(p.slope[weak]) > 0 ? forward : backward);
      candidate[c] = 0;
      released[c] = released[c] == 0 ? 1 : 2;
      continue;
    }
    const int driven = unheld(ws, p, tolerance);
    if (driven >= 0) return {Settled::jams, driven};
    const int back = turned_back(ws, p);
    if (back < 0) return {Settled::yes};
    released[back] = -1;
    candidate[back] = 1;
    ws.decision.torque[back] = T(0);
  }
  return {Settled::no};
}

}  // namespace clutchwork

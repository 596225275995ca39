#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/acceleration.hpp>
#include <clutchwork/contacts/coupled.hpp>
#include <clutchwork/contacts/locked.hpp>
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
  const bool moving = abs(slip) > slip_tolerance(ws) && !is_tied(ws, c);
  ws.contact.mode[c] = !moving ? sign : slip > 0 ? forward : backward;
  if (moving) ws.contact.forced[c] = ws.contact.mode[c];
  if (!ws.contact.compliant[c]) ws.piece[d] = sliding_piece(ws, d, moving ? abs(slip) : 0.0);
}

/// How a decision ended: all contacts have their mode, none was found, a freewheel gives way first, or prescribed
/// speeds turn one backward.
enum class Settled { yes, no, gives_way, jams, unbalanced };

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
  if (hit && ws.event_context.cause == Cause::torque_limit && rigid) {
    const double parting = slip != 0 ? slip : value(slip_slope(ws, c));
    if (parting * free_way(ws, c) < 0) return Choice::jams;
    mode = forced = parting < 0 ? backward : forward;
    return Choice::slips;
  }
  // where a load turns, or a contact fails, its slip has not vanished
  const Cause cause = ws.event_context.cause;
  const bool still = mode == locked && !rigid,
             arrived = hit && cause != Cause::input && cause != Cause::fault && (!rigid || is_tied(ws, c));
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
    if (slides) ws.piece[d] = sliding_piece(ws, d, abs(slip) > tolerance ? abs(slip) : 0.0);
  }
  return -1;
}

/// Bounds of the torque of a contact that follows no load.
template <class T>
T least_torque(const Workspace<T>& ws, int c) {
  return free_way(ws, c) < 0 ? T(-infinity) : -usable_capacity(ws, c, forward);
}
template <class T>
T most_torque(const Workspace<T>& ws, int c) {
  return free_way(ws, c) > 0 ? freewheel_limit(ws, c) : usable_capacity(ws, c, backward);
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
    p.gradient[a] = slip_acceleration(ws, c, q);
    p.lower[a] = least_torque(ws, c), p.upper[a] = most_torque(ws, c);
    capacity[a] = larger(-p.lower[a], p.upper[a]);
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
/// zero within a microsecond is a departure, of one that passes it what does within a second; for a contact that has
/// just come to rest, what leaves it within a millisecond; for one that has jammed, where its load is zero, what more
/// than the round-off of the load makes.
template <class T>
double slope_noise(const Workspace<T>& ws, const BoundedProblem<T>& p, int a, int located, double tolerance) {
  const int c = ws.decision.list[a];
  const bool arrived = c == located && ws.event_context.cause == Cause::slip_zero;
  if (is_rigid(ws, c)) return (arrived ? 1.0 : 1e6) * tolerance;
  double scale = abs(value(p.gradient[a]));
  p.matrix.each(a, [&](int b, T g) { scale = larger(scale, abs(value(g * p.x[b]))); });
  const double mobility = value(sqrt(p.matrix.diagonal[a]));
  const double round_off = larger(1e-10 * scale, 1e-12 * ws.decision.effort * mobility);
  // what comes back at the instant at which it was let go has not left
  if (arrived && stands_since(ws, ws.contact.met_at[c])) return infinity;
  const bool jammed = c == ws.event_context.contact && ws.event_context.cause == Cause::jam;
  // twice what the guard of the load concedes
  if (jammed) return larger(round_off, 2e-12 * ws.decision.pull * mobility * mobility);
  return arrived ? larger(round_off, 1e3 * tolerance) : round_off;
}

/// Whether candidate a is a freewheel that its torque cannot keep from running backward.
/// docs/theory/contacts.md, rule 3
template <class T>
bool overruns(const Workspace<T>& ws, const BoundedProblem<T>& p, int a) {
  return value(p.slope[a]) * free_way(ws, ws.decision.list[a]) < 0;
}

/// Of the bound torques that cannot hold and follow no load, the first of a freewheel, else the one that gives way most
/// (-1: all hold). Candidates on the way are locked. docs/theory/contacts.md, rule 1
template <class T>
int weakest(Workspace<T>& ws, const BoundedProblem<T>& p, int located, double tolerance) {
  int first = -1;
  double most = 0;
  for (int a = 0; a < p.n; ++a) {
    const int c = ws.decision.list[a];
    if (ws.loads.of[c] >= 0) continue;
    ws.contact.mode[c] = locked;
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
  for (int a = 0; a < p.n; ++a) ws.geometry.mass_weighted.add(ne + ws.decision.list[a], p.x[a], q);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (ws.decision.released[c] != 1) continue;
    const double noise = 1e-12 * ws.decision.effort * value(sqrt(ws.geometry.own[ne + c]));
    if (ws.contact.mode[c] * value(slip_acceleration(ws, c, q)) < -noise) return c;
  }
  return -1;
}

/// Whether a contact is let go and has not moved yet.
template <class T>
bool starts_to_slide(const Workspace<T>& ws, int c, int way) {
  return way != 0 && ws.contact.forced[c] == way &&
         abs(value(rate_of(ws, int(ws.sys.elements) + c))) <= slip_tolerance(ws);
}

/// As pose_problem where contacts follow loads: those that slip take part too, behind the candidates.
template <class T>
CoupledProblem<T> pose_coupled(Workspace<T>& ws, BoundedProblem<T>& p) {
  const auto& sys = ws.sys;
  int *list = ws.decision.list, n = 0;
  auto follows = [&](int c) { return ws.loads.of[c] >= 0; };
  auto slips = [&](int c) { return follows(c) && !ws.decision.candidate[c] && ws.contact.mode[c] != open; };
  for (int c = 0; c < sys.contacts; ++c) {
    if (ws.decision.candidate[c] || slips(c)) list[n++] = c;
  }
  // free_motion leaves the loads without these torques in coupled.given
  free_motion(ws, ws.decision.candidate, ws.decision.motion);
  p = gather(ws, list, n);
  CoupledProblem<T> q{ws.coupled, n, int(sys.loads)};
  for (int a = 0; a < n; ++a) {
    const int c = list[a];
    const bool rigid = is_rigid(ws, c);
    for (int b = 0; b < n; ++b) q.mobility[a * n + b] = T(a == b && rigid ? 1 : 0);
    if (!rigid) p.matrix.each(a, [&](int b, T g) { q.mobility[a * n + b] = g; });
    q.weight[a] = q.mobility[a * n + a] * T(1e-10);
    p.gradient[a] = slip_acceleration(ws, c, ws.decision.motion);
    q.gradient[a] = rigid ? T(0) : p.gradient[a];
    q.load[a] = ws.loads.of[c];
    // what slips goes on with its line where that fits
    q.line[a] = follows(c) ? ws.loads.line[ws.loads.of[c]] : 0;
    q.sliding[a] = ws.decision.candidate[c] ? 0 : ws.contact.mode[c];
    q.starts[a] = follows(c) && starts_to_slide(ws, c, q.sliding[a]);
    for (int l = 0; l < sys.loads; ++l) q.reach[l * n + a] = ws.loads.by_torque[l * ws.n_directions + sys.elements + c];
    q.lower[a] = q.upper[a] = T(0);
    if (follows(c)) {
      const T slip = abs(rate_of(ws, int(sys.elements) + c));
      const bool still = q.sliding[a] == 0 || ws.contact.forced[c] != 0;
      const int piece = still ? 0 : ws.piece[sys.elements + c];
      Bound<T>* bound = q.bound + 2 * q.load[a];
      bound[0] = bound_of(ws, c, backward, still ? T(0) : slip, piece);
      bound[1] = bound_of(ws, c, forward, still ? T(0) : slip, piece);
      // what moves nothing and is driven by nobody has no torque
      if (rigid && q.sliding[a] == 0) q.load[a] = -1;
    } else if (!rigid) {
      q.lower[a] = least_torque(ws, c), q.upper[a] = most_torque(ws, c);
    }
  }
  return q;
}

/// The solution as that of a bounded problem, for the rules of the rounds: those that follow loads have no bound of
/// their own, and those without inertia have the acceleration that is prescribed.
template <class T>
void take_solution(Workspace<T>& ws, const CoupledProblem<T>& q, BoundedProblem<T>& p) {
  for (int a = 0; a < q.n; ++a) {
    const int c = ws.decision.list[a];
    const bool rigid = is_rigid(ws, c);
    p.x[a] = q.x[a];
    p.slope[a] = rigid ? p.gradient[a] : q.slope[a];
    p.bound[a] = rigid ? 1 : -q.state[a];
    ws.decision.torque[c] = q.x[a];
    if (rigid) p.matrix.diagonal[a] = T(1e-300);
  }
}

/// Of the candidates that follow loads and let go one that still moves within its own tolerance (-1: none).
template <class T>
int moving_on(const Workspace<T>& ws, const BoundedProblem<T>& p, const CoupledProblem<T>& q, int located,
              double tolerance) {
  for (int a = 0; a < q.n; ++a) {
    const int c = ws.decision.list[a];
    if (ws.loads.of[c] < 0 || q.sliding[a] != 0 || p.bound[a] == 0 || is_tied(ws, c)) continue;
    const bool slips = abs(value(rate_of(ws, int(ws.sys.elements) + c))) > tolerance;
    if (slips && abs(value(p.slope[a])) > slope_noise(ws, p, a, located, tolerance)) return a;
  }
  return -1;
}

/// Modes and lines of the contacts that follow loads.
template <class T>
void settle_loads(Workspace<T>& ws, const BoundedProblem<T>& p, const CoupledProblem<T>& q, int located,
                  double tolerance) {
  for (int l = 0; l < q.loads; ++l) ws.loads.now[l] = q.now[l];
  for (int a = 0; a < q.n; ++a) {
    const int c = ws.decision.list[a], l = ws.loads.of[c];
    if (l < 0) continue;
    if (q.load[a] >= 0) ws.loads.line[l] = q.line[a];
    if (q.sliding[a] != 0) continue;
    const bool moves = p.bound[a] != 0 && abs(value(p.slope[a])) > slope_noise(ws, p, a, located, tolerance);
    ws.contact.mode[c] = !moves ? locked : value(p.slope[a]) > 0 ? forward : backward;
    if (!moves) continue;
    ws.piece[ws.sys.elements + c] = 0;
    const Bound<T> bound = bound_of(ws, c, ws.contact.mode[c], T(0), 0);
    ws.loads.line[l] = q.load[a] >= 0 ? q.line[a] : bound.line_at(q.now[l]);
  }
}

/// Of the contacts that slip and follow loads the one whose line falls most with its own friction: that which cannot be
/// balanced (-1: none slips).
template <class T>
int steepest(const Workspace<T>& ws) {
  int found = -1;
  double most = -infinity;
  for (int l = 0; l < ws.sys.loads; ++l) {
    const int c = ws.sys.load_contact[l], sign = ws.contact.mode[c];
    if (sign != forward && sign != backward) continue;
    const Bound<T> bound =
        bound_of(ws, c, sign, abs(rate_of(ws, int(ws.sys.elements) + c)), ws.piece[ws.sys.elements + c]);
    for (int line = 0; line < 2; ++line) {
      const double own =
          value(ws.loads.by_torque[l * ws.n_directions + ws.sys.elements + c] * bound.slope[line]) * -sign;
      if (own > most) most = own, found = c;
    }
  }
  return found;
}

/// Whether the contact that was let go would come back at once where all torques are decided, of which decision.motion
/// is the acceleration: what slips and follows loads does not answer the way it is let go.
/// docs/theory/load-dependent.md, rule 4
template <class T>
bool runs_against(Workspace<T>& ws, int located) {
  if (located < 0 || ws.event_context.cause != Cause::torque_limit || ws.loads.of[located] >= 0) return false;
  if (ws.contact.forced[located] == 0 || ws.contact.mode[located] != ws.contact.forced[located]) return false;
  const int d = int(ws.sys.elements) + located;
  if (abs(value(rate_of(ws, d))) > slip_tolerance(ws) || steepest(ws) < 0) return false;
  const double noise = 1e-9 * ws.decision.effort * value(sqrt(ws.geometry.own[d]));
  return ws.contact.mode[located] * value(slip_acceleration(ws, located, ws.decision.motion)) < -noise;
}

/// Candidates between prescribed speeds that part slip before the others are asked. A freewheel that is turned backward
/// ends it (-1: none).
template <class T>
int release_driven(Workspace<T>& ws, double tolerance) {
  int* candidate = ws.decision.candidate;
  free_motion(ws, candidate, ws.decision.motion);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (!candidate[c] || !is_rigid(ws, c)) continue;
    const double parting = value(slip_acceleration(ws, c, ws.decision.motion));
    if (abs(parting) <= 1e6 * tolerance) continue;
    if (parting * free_way(ws, c) < 0) return c;
    release(ws, c, parting > 0 ? forward : backward);
    candidate[c] = 0, ws.decision.released[c] = 1;
  }
  return -1;
}

/// Whether an independent contact of no set holds what it carries, in a decision.
template <class T>
bool holds_alone(const Workspace<T>& ws, int a) {
  const int c = ws.held.contact[a];
  if (is_rigid(ws, c)) return true;
  double noise = 0;
  for (int b = 0; b < ws.held.n; ++b) noise = larger(noise, 1e-11 * abs(value(ws.held.carried[b])));
  const double torque = value(ws.held.carried[a]);
  return torque >= value(least_torque(ws, c)) - noise && torque <= value(most_torque(ws, c)) + noise;
}

/// Whether all candidates together hold, where some depend on others and some follow loads: then they do. They cannot
/// where prescribed speeds part them. docs/theory/load-dependent.md, rule 3
template <class T>
bool hold_together(Workspace<T>& ws, double tolerance) {
  const auto& sys = ws.sys;
  int *candidate = ws.decision.candidate, *before = ws.decision.before;
  for (int l = 0; l < sys.loads; ++l) {
    if (!candidate[sys.load_contact[l]]) return false;
  }
  for (int c = 0; c < sys.contacts; ++c) {
    before[c] = ws.contact.mode[c];
    if (candidate[c]) ws.contact.mode[c] = locked;
  }
  list_locked(ws);
  Held<T>& h = ws.held;
  // no ratio moves in a decision
  h.n_fixed = h.n;
  bool holds = h.n_sets > 0 && factor_mobility(ws);
  if (holds) {
    free_motion(ws, candidate, ws.decision.motion);
    for (int a = 0; a < h.n; ++a) {
      h.rhs[a] = is_rigid(ws, h.contact[a]) ? T(0) : -slip_acceleration(ws, h.contact[a], ws.decision.motion);
    }
    solve_locked(ws, h.rhs, h.carried);
    for (int l = 0; l < sys.loads; ++l) {
      ws.loads.now[l] = ws.coupled.given[l];
      for (int a = 0; a < h.n; ++a)
        ws.loads.now[l] += ws.loads.by_torque[l * ws.n_directions + sys.elements + h.contact[a]] * h.carried[a];
    }
    holds = value(set_room(ws, 0, h.carried, T(0), ws.loads.now)) >= -1e-11;
    for (int a = 0; a < h.n; ++a) holds = holds && (h.in_set[a] != 0 || holds_alone(ws, a));
    for (int a = 0; a < h.n; ++a)
      ws.geometry.mass_weighted.add(int(sys.elements) + h.contact[a], h.carried[a], ws.decision.motion);
    for (int s = 0; s < h.n_redundant; ++s)
      holds = holds && abs(value(slip_acceleration(ws, h.redundant[s], ws.decision.motion))) <= 1e6 * tolerance;
  }
  for (int c = 0; !holds && c < sys.contacts; ++c) ws.contact.mode[c] = before[c];
  if (!holds) return false;
  for (int a = 0; a < h.n; ++a) ws.decision.torque[h.contact[a]] = h.carried[a];
  for (int s = 0; s < h.n_redundant; ++s) ws.decision.torque[h.redundant[s]] = T(0);
  return true;
}

/// Whether prescribed speeds have parted what was held together: the slip of a redundant contact has left zero, however
/// slowly.
template <class T>
bool has_parted(const Workspace<T>& ws, int located) {
  return located >= 0 && ws.event_context.cause == Cause::torque_limit && ws.contact.forced[located] == 0;
}

/// Torques of the candidates, and of what slips and follows loads. False: they were not found.
/// docs/theory/load-dependent.md, rule 2
template <class T>
bool solve_round(Workspace<T>& ws, int round, BoundedProblem<T>& p, CoupledProblem<T>& q) {
  if (ws.sys.loads > 0) {
    q = pose_coupled(ws, p);
    if (!solve(q)) return false;
    take_solution(ws, q, p);
    return true;
  }
  // among many contacts a release changes few torques
  const bool warm = round > 0 && !is_few(ws.sys);
  p = pose_problem(ws, warm);
  if (!solve(p, warm)) return false;
  for (int a = 0; a < p.n; ++a) ws.decision.torque[ws.decision.list[a]] = p.x[a];
  return true;
}

/// Candidate a slips; `for_good`: it is not taken back.
template <class T>
void let_go(Workspace<T>& ws, const BoundedProblem<T>& p, int a, bool for_good) {
  const int c = ws.decision.list[a];
  int& released = ws.decision.released[c];
  release(ws, c, value(p.slope[a]) > 0 ? forward : backward);
  ws.decision.candidate[c] = 0;
  released = for_good || released != 0 ? 2 : 1;
}

/// Give every contact at zero slip its torque or its direction of slip. `located`: the contact whose guard was hit.
template <class T>
Verdict settle_contacts(Workspace<T>& ws, int located) {
  const double tolerance = slip_tolerance(ws);
  const bool coupled = ws.sys.loads > 0;
  int jammed = choose_candidates(ws, located, tolerance);
  if (jammed < 0 && coupled && ws.geometry.redundant) {
    jammed = release_driven(ws, tolerance);
    if (jammed < 0 && !has_parted(ws, located) && hold_together(ws, tolerance)) return {Settled::yes};
  }
  if (jammed >= 0) return {Settled::jams, jammed};
  // rounds: those at a bound that accelerate start to slip with their kinetic torque
  for (int round = 0; round <= 4 * ws.sys.contacts + 4; ++round) {
    BoundedProblem<T> p{};
    CoupledProblem<T> q{};
    if (!solve_round(ws, round, p, q))
      return coupled ? Verdict{Settled::unbalanced, steepest(ws)} : Verdict{Settled::no};
    const int weak = weakest(ws, p, located, tolerance);
    const int moving = coupled && weak < 0 ? moving_on(ws, p, q, located, tolerance) : -1;
    if (weak >= 0 && overruns(ws, p, weak)) {
      const int c = ws.decision.list[weak];
      return {is_rigid(ws, c) ? Settled::jams : Settled::gives_way, c};
    }
    if (weak >= 0 || moving >= 0) {
      let_go(ws, p, larger(weak, moving), moving >= 0);
      continue;
    }
    const int driven = coupled ? -1 : unheld(ws, p, tolerance);
    if (driven >= 0) return {Settled::jams, driven};
    const int back = turned_back(ws, p);
    if (back < 0 && coupled && runs_against(ws, located)) return {Settled::unbalanced, steepest(ws)};
    if (back < 0) {
      if (coupled) settle_loads(ws, p, q, located, tolerance);
      return {Settled::yes};
    }
    ws.decision.released[back] = -1, ws.decision.candidate[back] = 1;
    ws.decision.torque[back] = T(0);
  }
  return {Settled::no};
}

}  // namespace clutchwork

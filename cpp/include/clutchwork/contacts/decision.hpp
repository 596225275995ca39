#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
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
  ws.mode[c] = !moving ? sign : slip > 0 ? forward : backward;
  if (moving) ws.forced[c] = ws.mode[c];
  if (!ws.compliant[c]) ws.piece[d] = piece_of(ws, d, moving ? abs(slip) : 0.0);
}

/// A contact that was released and then, others having lost torque too, accelerates the other way (-1: none).
/// It may stick after all; only the first release of a contact is taken back.
template <class T>
int turned_back(const Workspace<T>& ws, const int* list, int n, const T* x, const int* released, T* q) {
  const int nv = int(ws.sys.speeds), ne = int(ws.sys.elements);
  for (int a = 0; a < n; ++a) axpy(nv, x[a], ws.direction + (ne + list[a]) * nv, q);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (released[c] != 1) continue;
    const T* row = ws.direction + (ne + c) * nv;
    const double noise = 1e-12 * ws.effort * value(sqrt(dot(nv, row, row)));
    if (ws.mode[c] * value(slip_acceleration(ws, c, q)) < -noise) return c;
  }
  return -1;
}

/// How a decision ended: all contacts have their mode, none was found, a freewheel gives way first, or prescribed
/// speeds turn one backward.
enum class Settled { yes, no, gives_way, jams };

/// Give every contact at zero slip its torque or its direction of slip. `located`: the contact whose guard was hit, or
/// the freewheel that gives way.
template <class T>
Settled settle_contacts(Workspace<T>& ws, int& located) {
  const System& sys = ws.sys;
  const int nc = int(sys.contacts);
  const double tolerance = slip_tolerance(ws);
  int* candidate = ws.iscratch;
  int* list = ws.iscratch + nc;
  T* q = ws.scratch + ws.sys.states + 1;
  T* capacity = ws.qp_g + nc;
  int* released = ws.iscratch + 3 * nc;

  // who may stick
  for (int c = 0; c < nc; ++c) {
    const bool still = ws.mode[c] == locked && !is_rigid(ws, c);
    const double slip = still ? 0.0 : value(rate_of(ws, int(sys.elements) + c));
    released[c] = candidate[c] = 0;
    if (!may_stick(ws, c)) {
      ws.mode[c] = forward;
      continue;
    }
    const bool arrived = c == located && ws.cause != Cause::input;
    candidate[c] = ws.loaded[c] && (still || abs(slip) <= tolerance || (arrived && !is_rigid(ws, c)));
    if (!ws.loaded[c]) {
      if (abs(slip) > tolerance)
        ws.mode[c] = slip > 0 ? forward : backward;
      else if (ws.mode[c] == locked)
        ws.mode[c] = open;
    } else if (c == located && ws.cause == Cause::torque_limit && is_rigid(ws, c)) {
      // prescribed speeds have parted: there is no choice
      const double parting = slip != 0 ? slip : value(slip_slope(ws, c));
      if (parting < 0 && contact_one_way(ws, c)) {
        located = c;
        return Settled::jams;
      }
      candidate[c] = 0;
      ws.mode[c] = parting < 0 ? backward : forward;
      ws.forced[c] = ws.mode[c];
    } else if (candidate[c] && ws.forced[c] != 0) {
      candidate[c] = 0;
      ws.mode[c] = ws.forced[c];
    } else if (!candidate[c]) {
      ws.mode[c] = slip > 0 ? forward : backward;
    }
    if (!candidate[c] && ws.loaded[c] && !ws.compliant[c]) {
      const int d = int(sys.elements) + c;
      ws.piece[d] = piece_of(ws, d, abs(slip) > tolerance ? abs(slip) : 0.0);
    }
  }

  // rounds: those at a bound that accelerate start to slip with their kinetic torque
  for (int round = 0; round <= 4 * nc + 4; ++round) {
    int n = 0;
    for (int c = 0; c < nc; ++c) {
      if (candidate[c]) list[n++] = c;
    }
    free_motion(ws, candidate, q);
    BoundedProblem<T> p = gather(ws, list, n);
    for (int a = 0; a < n; ++a) {
      const int c = list[a];
      const T resists_forward = usable_capacity(ws, c, forward), resists_backward = usable_capacity(ws, c, backward);
      const bool one_way = contact_one_way(ws, c);
      p.gradient[a] = slip_acceleration(ws, c, q);
      p.lower[a] = -resists_forward;
      p.upper[a] = one_way ? freewheel_limit(ws, c) : resists_backward;
      capacity[a] = larger(resists_forward, p.upper[a]);
      p.x[a] = T(0);
      if (is_rigid(ws, c)) p.matrix[a * n + a] = T(1e-300);
    }
    capacity_weights(p, capacity);
    for (int a = 0; a < n; ++a) {
      if (is_rigid(ws, list[a])) p.lower[a] = p.upper[a] = T(0);
    }
    if (!solve(p)) return Settled::no;

    // of the bound torques that cannot hold, the one that gives way most starts to slip
    int first = -1;
    double most = 0;
    for (int a = 0; a < n; ++a) {
      const int c = list[a];
      ws.mode[c] = locked;
      const double mobility = value(sqrt(p.matrix[a * n + a]));
      double scale = abs(value(p.gradient[a]));
      for (int b = 0; b < n; ++b) scale = larger(scale, abs(value(p.matrix[a * n + b] * p.x[b])));
      const double acceleration = value(p.slope[a]), size = abs(acceleration) / mobility;
      // between prescribed speeds only what leaves zero within a microsecond is a departure; for one that has just come
      // to rest, what leaves it within a millisecond
      const bool arrived = c == located && ws.cause == Cause::slip_zero;
      const double round_off = larger(1e-10 * scale, 1e-12 * ws.effort * mobility);
      const double small = is_rigid(ws, c) ? 1e6 * tolerance : arrived ? larger(round_off, 1e3 * tolerance) : round_off;
      const bool noise = abs(acceleration) <= small;
      if (p.bound[a] == 0 || noise) continue;
      if (contact_one_way(ws, c) && acceleration < 0) {
        located = c;
        return is_rigid(ws, c) ? Settled::jams : Settled::gives_way;
      }
      if (size > most) first = a, most = size;
    }
    if (first >= 0) {
      const int c = list[first];
      release(ws, c, value(p.slope[first]) > 0 ? forward : backward);
      candidate[c] = 0;
      released[c] = released[c] == 0 ? 1 : 2;
      continue;
    }

    for (int a = 0; a < n; ++a) {
      ws.torque[sys.elements + list[a]] = p.x[a];
      // no torque holds what prescribed speeds turn against freewheels alone
      const double left = abs(value(p.slope[a])), most = 1e6 * tolerance + 1e-6 * abs(value(p.gradient[a]));
      if (p.bound[a] != 0 || is_rigid(ws, list[a]) || !(left > most)) continue;
      located = list[a];
      return Settled::jams;
    }
    const int back = turned_back(ws, list, n, p.x, released, q);
    if (back < 0) return Settled::yes;
    released[back] = -1;
    candidate[back] = 1;
  }
  return Settled::no;
}

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/contacts/acceleration.hpp>
#include <clutchwork/contacts/problem.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// Impulses: what comes to rest at once, and what jumps with prescribed speeds. docs/theory/contacts.md
namespace clutchwork {

/// Heat of an impulse goes where the heat of its direction goes.
template <class T>
void take_heat(Workspace<T>& ws, int direction, T heat) {
  const System& sys = ws.sys;
  T* shared = ws.state + sys.states - sys.shared;
  for (int h = 0; h < sys.heats; ++h) {
    if (sys.heat_direction[h] == direction) shared[sys.heat_to[h]] += T(sys.heat_share[h]) * heat;
  }
}

/// Apply the impulses of a solved problem over speeds: new speeds, and the work of each contact.
template <class T>
void apply_impulses(Workspace<T>& ws, const BoundedProblem<T>& p, const int* list) {
  const int nv = int(ws.sys.speeds), ne = int(ws.sys.elements);
  T* x = ws.decision.speed;
  for (int i = 0; i < nv; ++i) x[i] = T(0);
  for (int a = 0; a < p.n; ++a) {
    ws.geometry.white.add(ne + list[a], p.x[a], x);
    // work of an impulse: impulse times mean slip
    const T work = p.x[a] * (p.gradient[a] + p.slope[a]) * T(0.5);
    ws.work[ne + list[a]] += work;
    take_heat(ws, ne + list[a], -work);
  }
  backward_solve(nv, ws.geometry.inertia, ws.geometry.factor, x);
  for (int i = 0; i < nv; ++i) ws.v[i] += x[i];
  // the sources behind prescribed speeds take their share
  for (int k = 0; k < ws.sys.prescribed; ++k) {
    T impulse = T(0);
    for (int i = 0; i < nv; ++i) impulse += T(ws.sys.mass_prescribed[i * ws.sys.prescribed + k]) * x[i];
    for (int a = 0; a < p.n; ++a) impulse -= p.x[a] * prescribed_share(ws, ne + list[a], k);
    ws.prescribed_work[k] += impulse * ws.in.prescribed[k];
  }
  // friction transmits no impulse: what was locked and is moved now slips
  const double tolerance = slip_tolerance(ws);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const double slip = value(rate_of(ws, ne + c));
    if (ws.contact.mode[c] == locked && abs(slip) > tolerance) ws.contact.mode[c] = slip > 0 ? forward : backward;
  }
}

/// Contacts that an impulse must bring to rest, and all freewheels, which it must not turn backward.
/// docs/theory/contacts.md, rule 8
template <class T, class Stops>
int impulse_contacts(const Workspace<T>& ws, Stops&& stops, int* list) {
  int n = 0;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (is_rigid(ws, c)) continue;
    if (stops(c) || (contact_one_way(ws, c) && ws.contact.loaded[c])) list[n++] = c;
  }
  return n;
}

/// The impulses that change the kinetic energy least: some contacts come to rest, no freewheel turns backward; those
/// that had to stop lock. docs/theory/contacts.md (15)
template <class T, class Stops>
bool least_impulses(Workspace<T>& ws, Stops&& stops) {
  const int ne = int(ws.sys.elements);
  const double tolerance = slip_tolerance(ws);
  int* list = ws.decision.list;
  const int n = impulse_contacts(ws, stops, list);
  bool needed = false;
  for (int a = 0; a < n; ++a) {
    const double slip = value(rate_of(ws, ne + list[a]));
    needed = needed || slip < -tolerance || (stops(list[a]) && slip > tolerance);
  }
  if (!needed) return true;
  BoundedProblem<T> p = gather(ws, list, n);
  T* capacity = ws.problem.capacity;
  for (int a = 0; a < n; ++a) {
    p.gradient[a] = rate_of(ws, ne + list[a]);
    p.lower[a] = stops(list[a]) ? T(-infinity) : T(0);
    p.upper[a] = capacity[a] = T(infinity);
    p.x[a] = T(0);
  }
  capacity_weights(p, capacity);
  if (!solve(p)) return false;
  apply_impulses(ws, p, list);
  for (int a = 0; a < n; ++a) {
    // a freewheel that an impulse has closed is locked, one that it has left behind overruns
    const bool stopped = abs(value(p.slope[a])) <= tolerance;
    if (stopped && (stops(list[a]) || value(p.x[a]) > 0)) ws.contact.mode[list[a]] = locked;
  }
  return true;
}

/// Impulses at a decision: contacts declared locked, at the start, and freewheels that would run backward.
template <class T>
bool settle_impulses(Workspace<T>& ws, bool at_start) {
  return least_impulses(ws, [&](int c) { return at_start && ws.sys.contact_initial[c] == 1; });
}

/// Whether a contact has locked while it still slips within its own tolerance.
template <class T>
bool stops_short(const Workspace<T>& ws, int located) {
  return located >= 0 && ws.contact.mode[located] == locked && ws.sys.contact_tolerance[located] > 0;
}

/// A contact that may lock below a slip of its own is stopped by an impulse; the others that are locked stay so, but
/// for freewheels, which transmit no impulse that pulls.
template <class T>
bool stop_within_tolerance(Workspace<T>& ws, int located) {
  return least_impulses(
      ws, [&](int c) { return ws.contact.mode[c] == locked && (c == located || !contact_one_way(ws, c)); });
}

/// A jump of prescribed speeds: friction transmits no impulse, rigid parts follow.
template <class T>
void prescribed_jump(Workspace<T>& ws) {
  const System& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed);
  bool any = false;
  T* x = ws.decision.speed;
  for (int i = 0; i < nv; ++i) x[i] = T(0);
  for (int p = 0; p < np; ++p) {
    const T jump = ws.in.prescribed[p] - ws.in.prescribed_before[p];
    if (value(jump) == 0) continue;
    any = true;
    axpy(nv, -jump, ws.geometry.prescribed_momentum + p * nv, x);
  }
  if (!any) return;
  backward_solve(nv, ws.geometry.inertia, ws.geometry.factor, x);
  // impulse of each source: its column of inertia times the jumps of all node speeds
  for (int n = 0; n < sys.nodes; ++n) {
    T jump = basis_row(sys, n).times(x);
    for (int p = 0; p < np; ++p) {
      jump += T(sys.basis_prescribed[n * np + p]) * (ws.in.prescribed[p] - ws.in.prescribed_before[p]);
    }
    for (int p = 0; p < np; ++p) {
      const T impulse = T(sys.basis_prescribed[n * np + p] * sys.inertia[n]) * jump;
      ws.prescribed_work[p] += impulse * (ws.in.prescribed[p] + ws.in.prescribed_before[p]) * T(0.5);
    }
  }
  for (int i = 0; i < nv; ++i) ws.v[i] += x[i];
  const double tolerance = slip_tolerance(ws);
  for (int c = 0; c < sys.contacts; ++c) {
    const double slip = value(rate_of(ws, int(sys.elements) + c));
    if (abs(slip) > tolerance) ws.contact.mode[c] = slip > 0 ? forward : backward;
  }
}

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/contacts/acceleration.hpp>
#include <clutchwork/contacts/problem.hpp>
#include <clutchwork/contacts/ratios.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// Impulses: what comes to rest at once, and what jumps with prescribed speeds. docs/theory/contacts.md
namespace clutchwork {

/// Heat of an instant goes where the heat of its direction goes, among these states.
template <class T>
void take_heat(const Workspace<T>& ws, int direction, T heat, T* state) {
  const auto& sys = ws.sys;
  T* shared = state + sys.states - sys.shared;
  for (int h = 0; h < sys.heats; ++h) {
    if (sys.heat_direction[h] == direction) shared[sys.heat_to[h]] += T(sys.heat_share[h]) * heat;
  }
}

/// A branch leaves its piece; what its spring loses is heat.
template <class T>
[[gnu::noinline]] void leave_piece(Workspace<T>& ws, Branch<T>& b, const T* rate, int who) {
  const T freed = law_freed(ws, b, rate, who, ws.state);
  b.piece = law_cross(ws, b, rate, who, ws.state);
  if (value(freed) != 0) take_heat(ws, b.direction, freed, ws.state);
}

/// Energy of an impulse through metered lines, for jumps x of the independent speeds, before they are made.
template <class T, class Jump, class Torque>
void meter_impulse(Workspace<T>& ws, const T* x, Jump&& prescribed_jump, Torque&& impulse) {
  const auto& sys = ws.sys;
  auto jump = [&](int n) {
    T sum = basis_row(sys, n).times(x);
    for (int p = 0; p < sys.prescribed; ++p)
      sum += T(sys.basis_prescribed[n * sys.prescribed + p]) * prescribed_jump(p);
    return sum;
  };
  for (int m = 0; m < sys.meters; ++m) {
    const int n = sys.meter_node[m];
    const T after = node_value(sys, n, ws.v, ws.in.prescribed) + basis_row(sys, n).times(x);
    ws.metered[m] += meter_sum<T>(sys, m, jump, impulse) * (after - T(0.5) * jump(n));
  }
}

/// The impulses that transmissions take of those of contacts.
template <class T>
void take_impulses(Workspace<T>& ws, const BoundedProblem<T>& p, const int* list) {
  Ratios<T>& r = ws.ratios;
  const int ne = int(ws.sys.elements);
  for (int k = 0; k < r.rank; ++k) {
    r.share[k] = T(0);
    for (int a = 0; a < p.n; ++a) r.share[k] -= p.x[a] * r.part[(ne + list[a]) * r.n + k];
  }
  torques_of_rows(ws, [&](auto&& carry) {
    for (int a = 0; a < p.n; ++a) carry(ne + list[a], p.x[a]);
  });
}

/// What the impulses of a solved problem lose: each its size times its mean slip. None gives heat; where one does work,
/// the others lose less in proportion. docs/theory/energy.md (3)
template <class T>
void lose_energy(Workspace<T>& ws, const BoundedProblem<T>& p, const int* list) {
  auto work_of = [&](int a) { return p.x[a] * (p.gradient[a] + p.slope[a]) * T(0.5); };
  T sum = T(0), lost = T(0);
  for (int a = 0; a < p.n; ++a) {
    const T work = work_of(a);
    sum += work, lost += value(work) < 0 ? work : T(0);
  }
  const T share = value(lost) < 0 ? sum / lost : T(0);
  for (int a = 0; a < p.n; ++a) {
    const int d = int(ws.sys.elements) + list[a];
    const T work = value(work_of(a)) < 0 ? share * work_of(a) : T(0);
    ws.work[d] += work;
    take_heat(ws, d, -work, ws.state);
  }
}

/// Apply the impulses of a solved problem over speeds: new speeds, and the work of each contact.
template <class T>
void apply_impulses(Workspace<T>& ws, const BoundedProblem<T>& p, const int* list) {
  const int nv = int(ws.sys.speeds), ne = int(ws.sys.elements);
  T* x = ws.decision.speed;
  for (int i = 0; i < nv; ++i) x[i] = T(0);
  for (int a = 0; a < p.n; ++a) ws.geometry.mass_weighted.add(ne + list[a], p.x[a], x);
  lose_energy(ws, p, list);
  backward_solve(nv, ws.geometry.inertia, ws.geometry.factor, x);
  if (ws.ratios.inside) take_impulses(ws, p, list);
  meter_impulse(
      ws, x, [](int) { return T(0); },
      [&](int d) {
        for (int a = 0; a < p.n; ++a) {
          if (ne + list[a] == d) return p.x[a];
        }
        return impulse_of_row(ws, d);
      });
  for (int i = 0; i < nv; ++i) ws.v[i] += x[i];
  if (ws.ratios.inside) move_followers(ws);
  // the sources behind prescribed speeds take their share
  for (int k = 0; k < ws.sys.prescribed; ++k) {
    T impulse = T(0);
    for (int i = 0; i < nv; ++i) impulse += T(ws.sys.mass_prescribed[i * ws.sys.prescribed + k]) * x[i];
    for (int a = 0; a < p.n; ++a) impulse -= p.x[a] * prescribed_share(ws, ne + list[a], k);
    if (ws.ratios.inside) impulse -= impulse_on_source(ws, k);
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
template <class T>
int impulse_contacts(const Workspace<T>& ws, const int* stops, int* list) {
  int n = 0;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (is_rigid(ws, c)) continue;
    if (stops[c] != 0 || (contact_one_way(ws, c) && ws.contact.loaded[c])) list[n++] = c;
  }
  return n;
}

/// Of the contacts that impulses should have brought to rest but do not, as prescribed speeds and others that come to
/// rest keep them slipping, the one that holds least; -1: none.
template <class T>
int kept_slipping(const Workspace<T>& ws, const BoundedProblem<T>& p, const int* list, const int* stops) {
  double fastest = 0, least = infinity;
  for (int a = 0; a < p.n; ++a) {
    if (stops[list[a]] != 0) fastest = larger(fastest, abs(value(p.slope[a])));
  }
  if (!(fastest > 1e3 * slip_tolerance(ws))) return -1;
  int found = -1;
  for (int a = 0; a < p.n; ++a) {
    const int c = list[a];
    // impulses without bound leave round-off to all others
    if (stops[c] == 0 || !(abs(value(p.slope[a])) > 0.1 * fastest)) continue;
    const double holds = larger(value(capacity_of(ws, c, forward)), value(capacity_of(ws, c, backward)));
    if (found < 0 || holds < least) found = c, least = holds;
  }
  return found;
}

/// The impulses that change the kinetic energy least: some contacts come to rest, no freewheel turns backward; those
/// that had to stop lock. Slips up to `still` need none. `kept`: one that cannot come to rest, without an impulse then.
/// docs/theory/contacts.md (15)
template <class T>
[[gnu::noinline]] bool stop_by_impulses(Workspace<T>& ws, double still, const int* stops, int* kept) {
  const int ne = int(ws.sys.elements);
  const double tolerance = slip_tolerance(ws);
  int* list = ws.decision.list;
  const int n = impulse_contacts(ws, stops, list);
  bool needed = false;
  for (int a = 0; a < n; ++a) {
    const double slip = value(rate_of(ws, ne + list[a]));
    needed = needed || slip * free_way(ws, list[a]) < -tolerance || (stops[list[a]] != 0 && abs(slip) > still);
  }
  if (!needed) return true;
  BoundedProblem<T> p = gather(ws, list, n);
  T* capacity = ws.problem.capacity;
  for (int a = 0; a < n; ++a) {
    p.gradient[a] = rate_of(ws, ne + list[a]);
    const bool both = stops[list[a]] != 0;
    p.lower[a] = both || free_way(ws, list[a]) < 0 ? T(-infinity) : T(0);
    p.upper[a] = both || free_way(ws, list[a]) > 0 ? T(infinity) : T(0);
    capacity[a] = T(infinity);
    p.x[a] = T(0);
  }
  capacity_weights(p, capacity);
  if (!solve(p)) return false;
  if (kept != nullptr && (*kept = kept_slipping(ws, p, list, stops)) >= 0) return true;
  apply_impulses(ws, p, list);
  for (int a = 0; a < n; ++a) {
    // a freewheel that an impulse has closed is locked, one that it has left behind overruns
    const bool stopped = abs(value(p.slope[a])) <= tolerance;
    if (stopped && (stops[list[a]] != 0 || value(p.x[a]) * free_way(ws, list[a]) > 0))
      ws.contact.mode[list[a]] = locked;
  }
  return true;
}

/// The same of contacts for which stops(c) holds before.
template <class T, class Stops>
bool least_impulses(Workspace<T>& ws, double still, Stops&& stops, int* kept = nullptr) {
  int* stopped = ws.decision.candidate;
  for (int c = 0; c < ws.sys.contacts; ++c) stopped[c] = stops(c) ? 1 : 0;
  return stop_by_impulses(ws, still, stopped, kept);
}

/// Impulses at a decision: contacts declared locked, at the start, and freewheels that would run backward. Of contacts
/// that cannot all be locked the weakest slip. docs/theory/contacts.md, rule 8
template <class T>
bool settle_impulses(Workspace<T>& ws, bool at_start) {
  int* slips = ws.decision.before;
  for (int c = 0; c < ws.sys.contacts; ++c) slips[c] = 0;
  auto stops = [&](int c) { return at_start && ws.sys.contact_initial[c] == 1 && slips[c] == 0; };
  for (;;) {
    int kept = -1;
    if (!least_impulses(ws, slip_tolerance(ws), stops, at_start ? &kept : nullptr)) return false;
    if (kept < 0) return true;
    slips[kept] = 1;
  }
}

/// Whether a contact has locked while it still slips within its own tolerance.
template <class T>
bool stops_short(const Workspace<T>& ws, int located) {
  if (located < 0 || ws.contact.mode[located] != locked || !(ws.sys.contact_tolerance[located] > 0)) return false;
  return abs(value(rate_of(ws, int(ws.sys.elements) + located))) > slip_tolerance(ws);
}

/// Whether a contact has locked with a slip that counts as zero, but moves an inertia whose energy does not: beside a
/// dead point a shaft turns while what it drives stands. docs/theory/contacts.md, rule 9
template <class T>
bool stops_much(const Workspace<T>& ws, int located, double energy) {
  constexpr double least = 1e-10;
  if (ws.ratios.n == 0 || located < 0 || ws.contact.mode[located] != locked || is_rigid(ws, located)) return false;
  const int d = int(ws.sys.elements) + located;
  const double slip = value(rate_of(ws, d));
  return 0.5 * slip * slip > least * energy * value(ws.geometry.own[d]);
}

/// A contact that may lock below a slip of its own is stopped by an impulse; the others that are locked stay so, but
/// for freewheels, which transmit no impulse that pulls.
template <class T>
bool stop_within_tolerance(Workspace<T>& ws, int located, double still) {
  return least_impulses(
      ws, still, [&](int c) { return ws.contact.mode[c] == locked && (c == located || !contact_one_way(ws, c)); });
}

/// A contact that follows a load and jams stops at once; the others that are locked stay so, but for freewheels, and
/// what has come to rest within a tolerance of its own stops too. docs/theory/load-dependent.md, rule 4
template <class T>
bool stop_jammed(Workspace<T>& ws, int jammed, int located) {
  const bool rests = located >= 0 && ws.sys.contact_tolerance[located] > 0;
  // to round-off: torques of a slip that is left may be more than the friction without a load
  return least_impulses(ws, 0.0, [&](int c) {
    return c == jammed || (rests && c == located) || (ws.contact.mode[c] == locked && !contact_one_way(ws, c));
  });
}

/// Transmissions keep their rates together while prescribed speeds jump; x: mass-weighted.
template <class T>
void jump_beside(Workspace<T>& ws, T* x) {
  Ratios<T>& r = ws.ratios;
  const int nv = int(ws.sys.speeds);
  T *wanted = r.wanted, *taken = r.tied;
  for (int a = 0; a < r.n; ++a) {
    const int d = first_of(ws, a);
    wanted[a] = T(0);
    for (int p = 0; p < ws.sys.prescribed; ++p) {
      const T share = prescribed_share(ws, d, p) - r.value[a] * prescribed_share(ws, d + 1, p);
      wanted[a] -= share * (ws.in.prescribed[p] - ws.in.prescribed_before[p]);
    }
  }
  without_followers(ws, wanted);
  for (int k = 0; k < r.rank; ++k) taken[k] = dot(nv, r.span + k * nv, x);
  take_off_span(ws, x);
  follow_rows(ws, wanted, x);
  for (int k = 0; k < r.rank; ++k) r.share[k] -= taken[k];
  torques_of_rows(ws, [](auto&&) {});
}

/// A jump of prescribed speeds: friction transmits no impulse, rigid parts follow.
template <class T>
void prescribed_jump(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed);
  bool any = false;
  T* x = ws.decision.speed;
  for (int i = 0; i < nv; ++i) x[i] = T(0);
  for (int p = 0; p < np; ++p) {
    const T jump = ws.in.prescribed[p] - ws.in.prescribed_before[p];
    if (!differ(ws.in.prescribed[p], ws.in.prescribed_before[p])) continue;
    any = true;
    axpy(nv, -jump, ws.geometry.prescribed_momentum + p * nv, x);
  }
  if (!any) return;
  if (ws.ratios.inside) jump_beside(ws, x);
  backward_solve(nv, ws.geometry.inertia, ws.geometry.factor, x);
  meter_impulse(
      ws, x, [&](int p) { return ws.in.prescribed[p] - ws.in.prescribed_before[p]; },
      [&](int d) { return impulse_of_row(ws, d); });
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
  if (ws.ratios.inside) {
    move_followers(ws);
    for (int p = 0; p < np; ++p)
      ws.prescribed_work[p] -= impulse_on_source(ws, p) * (ws.in.prescribed[p] + ws.in.prescribed_before[p]) * T(0.5);
  }
  part_moved(ws, slip_tolerance(ws));
}

}  // namespace clutchwork

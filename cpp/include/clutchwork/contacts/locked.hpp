#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/envelope.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/contacts/dependent.hpp>
#include <clutchwork/contacts/eliminate.hpp>
#include <clutchwork/contacts/loaded_set.hpp>
#include <clutchwork/contacts/ratios.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// The locked contacts of the present mode: independent ones, redundant ones, and the sets that they make.
/// docs/theory/contacts.md
namespace clutchwork {

/// Factor of the mobility of the independent contacts, in the order of their places.
template <class T>
bool factor_mobility(Workspace<T>& ws) {
  Held<T>& h = ws.held;
  const Geometry<T>& g = ws.geometry;
  int *independent = h.at, *row = h.row, m = 0;
  const int nc = int(ws.sys.contacts);
  h.near.whole = g.near.whole;
  for (int q = 0; q < nc; ++q) independent[q] = -1;
  for (int a = 0; a < h.n_fixed; ++a) independent[g.place[h.contact[a]]] = a;
  for (int q = 0; q < nc; ++q) {
    row[q] = m;
    if (independent[q] < 0) continue;
    h.near.low[m] = h.near.whole ? 0 : row[g.near.low[q]];
    h.turn[m++] = independent[q];
  }
  h.near.lay(m);
  for (int a = 0; a < m; ++a) {
    const int c = h.contact[h.turn[a]], own = g.near.sky[g.place[c]];
    for (int b = h.near.low[a]; b <= a; ++b)
      h.factor[h.near.sky[a] + b] = g.mobility[own + g.place[h.contact[h.turn[b]]]];
    if (is_rigid(ws, c)) h.factor[h.near.sky[a] + a] = T(1);
  }
  return cholesky(m, h.near, h.factor);
}

/// Torques x of the independent contacts for slip accelerations b: mobility x = b.
template <class T>
void solve_locked(const Workspace<T>& ws, const T* b, T* x) {
  const Held<T>& h = ws.held;
  const int n = h.n_fixed;
  for (int a = 0; a < n; ++a) h.turned[a] = b[h.turn[a]];
  forward_solve(n, h.near, h.factor, h.turned);
  backward_solve(n, h.near, h.factor, h.turned);
  for (int a = 0; a < n; ++a) x[h.turn[a]] = h.turned[a];
}

/// Direction of row `own` of a split in terms of the pivot rows, in pivot order.
template <class T>
void resolve_direction(int rank, int nv, const T* rows, const int* order, const T* own, T* share) {
  for (int j = rank - 1; j >= 0; --j) {
    T s = own[j];
    for (int k = j + 1; k < rank; ++k) s -= share[k] * rows[order[k] * nv + j];
    share[j] = s / rows[order[j] * nv + j];
  }
}

/// Whether locked contacts follow loads.
template <class T>
bool holds_loads(const Workspace<T>& ws) {
  for (int l = 0; l < ws.sys.loads; ++l) {
    if (ws.contact.mode[ws.sys.load_contact[l]] == locked) return true;
  }
  return false;
}

/// Whether the torque of an independent contact depends on how redundant contacts share it.
template <class T>
bool is_shared(const Workspace<T>& ws, int a) {
  for (int s = 0; s < ws.held.n_redundant; ++s) {
    if (value(ws.held.tie[s * ws.sys.contacts + a]) != 0) return true;
  }
  return false;
}

/// Label each independent contact with the lowest one of its set; where some follow loads, these are one with all that
/// is shared.
template <class T>
void join_sets(Workspace<T>& ws, int* label) {
  const int nc = int(ws.sys.contacts);
  for (int a = 0; a < ws.held.n; ++a) label[a] = a;
  if (ws.held.n_redundant > 0 && holds_loads(ws)) {
    int lowest = -1;
    for (int a = 0; a < ws.held.n; ++a) {
      const int c = ws.held.contact[a];
      if (is_rigid(ws, c) || (ws.loads.of[c] < 0 && !is_shared(ws, a))) continue;
      if (lowest < 0) lowest = a;
      label[a] = lowest;
    }
    return;
  }
  for (int s = 0; s < ws.held.n_redundant; ++s) {
    int lowest = -1;
    for (int a = 0; a < ws.held.n; ++a) {
      if (value(ws.held.tie[s * nc + a]) == 0) continue;
      if (lowest < 0) lowest = label[a];
      const int from = larger(label[a], lowest), to = smaller(label[a], lowest);
      for (int b = 0; b < ws.held.n; ++b) {
        if (label[b] == from) label[b] = to;
      }
      lowest = to;
    }
  }
}

/// Write down the sets: independent contacts first, then redundant ones.
template <class T>
void list_sets(Workspace<T>& ws, const int* label) {
  const int nc = int(ws.sys.contacts);
  int at = 0;
  ws.held.n_sets = 0;
  auto add = [&](int contact, int place) { ws.held.set_member[at] = contact, ws.held.set_place[at++] = place; };
  // a redundant contact without independent ones is in no set
  auto label_of = [&](int s) {
    for (int a = 0; a < ws.held.n; ++a) {
      if (value(ws.held.tie[s * nc + a]) != 0) return label[a];
    }
    return -1;
  };
  for (int root = 0; root < ws.held.n; ++root) {
    int spares = 0;
    for (int s = 0; s < ws.held.n_redundant; ++s) spares += label_of(s) == root;
    if (spares == 0) continue;
    ws.held.set_first[ws.held.n_sets] = at;
    for (int a = 0; a < ws.held.n; ++a) {
      if (label[a] == root) add(ws.held.contact[a], a), ws.held.in_set[a] = 1;
    }
    ws.held.set_rank[ws.held.n_sets] = at - ws.held.set_first[ws.held.n_sets];
    ++ws.held.n_sets;
    for (int s = 0; s < ws.held.n_redundant; ++s) {
      if (label_of(s) == root) add(ws.held.redundant[s], s);
    }
    const int size = at - ws.held.set_first[ws.held.n_sets - 1];
    if (!is_few(ws.sys) && ws.sys.loads == 0 && size > ws.sys.set_size) ws.held.too_many = true;
  }
  ws.held.set_first[ws.held.n_sets] = at;
}

/// Share of prescribed speed p in the slip of redundant contact s while the independent contacts are locked.
template <class T>
double driven_share(const Workspace<T>& ws, int s, int p) {
  const int nc = int(ws.sys.contacts), ne = int(ws.sys.elements);
  double size = abs(value(prescribed_share(ws, ne + ws.held.redundant[s], p)));
  T share = prescribed_share(ws, ne + ws.held.redundant[s], p);
  for (int a = 0; a < ws.held.n; ++a) {
    const T part = ws.held.tie[s * nc + a] * prescribed_share(ws, ne + ws.held.contact[a], p);
    share -= part, size = larger(size, abs(value(part)));
  }
  return abs(value(share)) > 1e-12 * size ? value(share) : 0.0;
}

/// The directions of the n contacts in held.all, split; returns their rank. `enough`: of those that are so independent
/// the first ones are. For few speeds.
template <class T>
int split_held(Workspace<T>& ws, int n, double enough = 2.0) {
  const int nv = int(ws.sys.speeds), ne = int(ws.sys.elements);
  Held<T>& h = ws.held;
  for (int a = 0; a < n; ++a) {
    for (int i = 0; i < nv; ++i) h.rows[a * nv + i] = T(0);
    ws.geometry.mass_weighted.add(ne + h.all[a], T(1), h.rows + a * nv);
  }
  return orthonormal_split(n, nv, h.rows, h.basis, h.order, h.norms, -1, T(enough));
}

/// Of the n locked contacts in held.all the independent ones, whose held.number is not -1, and
/// rigid ones. Then held.number is the place among them.
template <class T>
void list_independent(Workspace<T>& ws, int n) {
  Held<T>& h = ws.held;
  h.n = 0;
  for (int a = 0; a < n; ++a) {
    if (h.number[a] < 0 && !is_rigid(ws, h.all[a])) continue;
    h.number[a] = h.n;
    h.contact[h.n++] = h.all[a];
  }
  h.n_fixed = h.n;
}

/// Whether the direction of a contact varies, for it moves a speed that follows from a transmission.
template <class T>
bool varies(const Workspace<T>& ws, int c) {
  const T* via = ws.ratios.via + (ws.sys.elements + c) * ws.ratios.n;
  for (int b = 0; b < ws.ratios.n; ++b) {
    if (value(via[b]) != 0) return true;
  }
  return false;
}

/// As list_independent beside transmissions, which come before all contacts: those whose directions vary are the last.
/// One that prescribed speeds turn through a transmission is none of them: its slip moves with the ratio.
template <class T>
void list_independent_beside(Workspace<T>& ws, int n) {
  Held<T>& h = ws.held;
  h.n = 0;
  for (int varying = 0; varying < 2; ++varying) {
    for (int a = 0; a < n; ++a) {
      const bool rigid = varying == 0 && value(ws.ratios.whole[ws.sys.elements + h.all[a]]) == 0;
      if ((h.number[a] < 0 && !rigid) || int(varies(ws, h.all[a])) != varying) continue;
      h.number[a] = h.n;
      h.contact[h.n++] = h.all[a];
    }
    if (varying == 0) h.n_fixed = h.n;
  }
}

/// The others are redundant: the direction of each in terms of the independent contacts.
template <class T>
void tie_redundant(Workspace<T>& ws, int n, int rank) {
  const int nc = int(ws.sys.contacts), ne = int(ws.sys.elements), nv = int(ws.sys.speeds);
  Held<T>& h = ws.held;
  for (int a = 0; a < n; ++a) {
    if (h.number[a] >= 0) continue;
    T* tie = h.tie + h.n_redundant * nc;
    for (int b = 0; b < nc; ++b) tie[b] = T(0);
    resolve_direction(rank, nv, h.rows, h.order, h.rows + a * nv, h.share);
    const double size = value(ws.geometry.own[ne + h.all[a]]);
    for (int j = 0; j < rank; ++j) {
      const T share = h.share[j];
      const int c = h.all[h.order[j]];
      const bool counts = value(share * share * ws.geometry.own[ne + c]) > 1e-18 * size;
      if (counts) tie[h.number[h.order[j]]] = share;
    }
    h.redundant[h.n_redundant++] = h.all[a];
  }
}

/// As tie_redundant for many speeds: the direction of a redundant contact is the sum of those of the independent
/// contacts that it has most in common with, solved twice because the mobility squares what is small.
template <class T>
void tie_far_redundant(Workspace<T>& ws, int n) {
  const int nc = int(ws.sys.contacts), ne = int(ws.sys.elements), nv = int(ws.sys.speeds);
  const Compressed<T>& mass_weighted = ws.geometry.mass_weighted;
  Held<T>& h = ws.held;
  for (int a = 0; a < n; ++a) {
    if (h.number[a] >= 0) continue;
    if (h.n_redundant >= ws.sys.spares) {
      h.too_many = true;
      return;
    }
    T *tie = h.tie + h.n_redundant * nc, *left = h.motion;
    for (int b = 0; b < nc; ++b) tie[b] = T(0);
    for (int i = 0; i < nv; ++i) left[i] = T(0);
    mass_weighted.add(ne + h.all[a], T(1), left);
    for (int round = 0; round < 3; ++round) {
      for (int b = 0; b < h.n; ++b) h.rhs[b] = mass_weighted.times(ne + h.contact[b], left);
      solve_locked(ws, h.rhs, h.solved);
      for (int b = 0; b < h.n; ++b) tie[b] += h.solved[b], mass_weighted.add(ne + h.contact[b], -h.solved[b], left);
    }
    const double size = value(ws.geometry.own[ne + h.all[a]]);
    for (int b = 0; b < h.n; ++b) {
      if (!(value(tie[b] * tie[b] * ws.geometry.own[ne + h.contact[b]]) > 1e-18 * size)) tie[b] = T(0);
    }
    h.redundant[h.n_redundant++] = h.all[a];
  }
}

/// Spares whose slip the prescribed speeds move.
template <class T>
void list_driven(Workspace<T>& ws) {
  for (int s = 0; s < ws.held.n_redundant; ++s) {
    // what transmissions hold moves when their ratios do
    bool driven = ws.ratios.n > 0;
    for (int p = 0; p < ws.sys.prescribed; ++p) driven = driven || driven_share(ws, s, p) != 0;
    if (driven) ws.held.driven[ws.held.n_driven++] = s;
  }
}

/// Bounds of the torque of a locked contact that follows no load.
template <class T>
[[gnu::noinline]] void bounds_of_held(const Workspace<T>& ws, int c, T& lower, T& upper) {
  const int way = free_way(ws, c);
  lower = way < 0 ? T(-infinity) : -capacity_of(ws, c, forward);
  upper = way > 0 ? freewheel_limit(ws, c) : capacity_of(ws, c, backward);
}

/// Contacts that hold more come first, each the way in which it holds most: what slips and follows a load moves with
/// the torques of the independent contacts, the first of a set. `again`: as they were sorted last, whatever they hold
/// by now. docs/theory/load-dependent.md, rule 3
template <class T>
[[gnu::noinline]] void sort_by_strength(const Workspace<T>& ws, int* contact, int n, bool again) {
  double* strength = ws.held.strength;
  for (int a = 0; a < n && !again; ++a) {
    T lower, upper;
    bounds_of_held(ws, contact[a], lower, upper);
    strength[contact[a]] = larger(value(-lower), value(upper));
  }
  for (int a = 1; a < n; ++a) {
    const int c = contact[a];
    int b = a;
    for (; b > 0 && strength[contact[b - 1]] < strength[c]; --b) contact[b] = contact[b - 1];
    contact[b] = c;
  }
}

/// Sort the locked contacts into independent and redundant ones; all of them are independent where no directions depend
/// on others. The torques of the independent ones make the loads: those that follow loads are the last of them.
/// `again`: in the order in which they were sorted last.
template <class T>
void list_locked(Workspace<T>& ws, bool again = false) {
  Held<T>& h = ws.held;
  int n = 0;
  const bool apart = ws.sys.loads > 0 && ws.geometry.redundant;
  for (int follow = 0; follow <= int(apart); ++follow) {
    for (int c = 0; c < ws.sys.contacts; ++c) {
      if (ws.contact.mode[c] != locked || (apart && int(ws.loads.of[c] >= 0) != follow)) continue;
      h.in_set[n] = 0, h.all[n++] = c;
    }
    if constexpr (!has_lanes<T>) {
      if (apart && follow == 0) sort_by_strength(ws, h.all, n, again);
    }
  }
  for (int a = 0; a < n; ++a) h.contact[a] = h.all[a];
  h.n = h.n_fixed = n;
  h.n_redundant = h.n_sets = h.n_driven = 0;
  h.too_many = h.vanished = false;
  if (ws.ratios.n == 0 && (!ws.geometry.redundant || n < 2)) return;
  if (is_few(ws.sys)) {
    const int rank = h.rank = split_held(ws, n, apart ? 1e-3 : 2.0);
    for (int a = 0; a < n; ++a) h.number[a] = -1;
    for (int j = 0; j < rank; ++j) h.number[h.order[j]] = 0;
    ws.ratios.n > 0 ? list_independent_beside(ws, n) : list_independent(ws, n);
    if (h.n == n) return;
    tie_redundant(ws, n, rank);
  } else {
    h.too_many = eliminate(ws, h.all, n) < 0;
    list_independent(ws, n);
    if (h.n == n || !factor_mobility(ws)) return;
    tie_far_redundant(ws, n);
  }
  list_driven(ws);
  join_sets(ws, h.order);
  list_sets(ws, h.order);
  if (h.too_many) h.n_sets = h.n_driven = 0;
}

/// The directions of the redundant contacts in terms of the independent contacts at the ratios of the point that was
/// evaluated last, and with them the loads by the torques of both: transmissions turn them as their ratios vary in a
/// phase. docs/theory/varying-ratios.md (21)
template <class T>
[[gnu::noinline]] void turn_redundant(Workspace<T>& ws) {
  const int nc = int(ws.sys.contacts), ne = int(ws.sys.elements), nv = int(ws.sys.speeds);
  Ratios<T>& r = ws.ratios;
  Held<T>& h = ws.held;
  bool same = true;
  for (int a = 0; a < r.n; ++a) same = same && value(r.present[a] - r.turned[a]) == 0;
  if (same) return;
  for (int a = 0; a < r.n; ++a) r.sorted[a] = r.value[a], r.value[a] = r.turned[a] = r.present[a];
  {
    const BesideRatios<T> beside(ws, Written::last, left_over_shared);
    auto lay = [&](int row, int c) {
      for (int i = 0; i < nv; ++i) h.rows[row * nv + i] = T(0);
      ws.geometry.mass_weighted.add(ne + c, T(1), h.rows + row * nv);
    };
    for (int a = 0; a < h.n; ++a) lay(a, h.contact[a]);
    for (int s = 0; s < h.n_redundant; ++s) lay(h.n + s, h.redundant[s]);
    const int rank = orthonormal_split(h.n + h.n_redundant, nv, h.rows, h.basis, h.order, h.norms, h.n);
    // one between prescribed speeds had no direction before
    h.vanished = rank < h.rank;
    for (int s = 0; s < h.n_redundant && !h.vanished; ++s) {
      resolve_direction(rank, nv, h.rows, h.order, h.rows + (h.n + s) * nv, h.share);
      const double size = value(ws.geometry.own[ne + h.redundant[s]]);
      for (int b = 0; b < nc; ++b) h.tie[s * nc + b] = T(0);
      for (int j = 0; j < rank; ++j) {
        const T share = h.share[j];
        const bool counts = value(share * share * ws.geometry.own[ne + h.contact[h.order[j]]]) > 1e-18 * size;
        if (counts) h.tie[s * nc + h.order[j]] = share;
      }
    }
  }
  for (int a = 0; a < r.n; ++a) r.value[a] = r.sorted[a];
}

/// Set number k under the torques of the independent contacts, its bounds widened by round-off.
template <class T>
DependentSet<T> dependent_set(Workspace<T>& ws, int k, const T* carried, T noise) {
  const int nc = int(ws.sys.contacts), first = ws.held.set_first[k], n = ws.held.set_first[k + 1] - first,
            rank = ws.held.set_rank[k];
  if constexpr (!has_lanes<T>) {
    if (ws.ratios.n > 0 && !ws.ratios.inside && is_few(ws.sys)) turn_redundant(ws);
  }
  const DependentSet<T> set{n, rank, ws.set.column, ws.set.load, ws.set.lower, ws.set.upper, ws.set.x};
  const int* place = ws.held.set_place + first;
  for (int r = 0; r < rank; ++r) set.load[r] = carried[place[r]];
  for (int i = 0; i < n; ++i) {
    const int c = ws.held.set_member[first + i];
    for (int r = 0; r < rank; ++r) {
      set.column[i * rank + r] = i < rank ? T(i == r ? 1 : 0) : ws.held.tie[place[i] * nc + place[r]];
    }
    if (ws.loads.of[c] >= 0) {
      // a bound over its load, which is not known before the torques are
      set.lower[i] = T(-infinity), set.upper[i] = T(infinity);
      continue;
    }
    bounds_of_held(ws, c, set.lower[i], set.upper[i]);
    set.lower[i] -= noise, set.upper[i] += noise;
  }
  return set;
}

/// The limit load of a set.
template <class T>
LimitLoad<T> limit_of(Workspace<T>& ws, const DependentSet<T>& set) {
  return {set, ws.set.tableau, ws.set.limit_x, ws.set.price, ws.set.basis, ws.set.place};
}

/// The loads without the torques of set k, from those with the torques of the independent contacts.
template <class T>
void outer_loads(Workspace<T>& ws, int k, const T* load, const T* carried) {
  const int first = ws.held.set_first[k], end = first + ws.held.set_rank[k];
  for (int l = 0; l < ws.sys.loads; ++l) {
    const T* by_torque = loads_by_shares(ws) + l * ws.n_directions + ws.sys.elements;
    ws.loads.outer[l] = load[l];
    for (int i = first; i < end; ++i)
      ws.loads.outer[l] -= by_torque[ws.held.set_member[i]] * carried[ws.held.set_place[i]];
  }
}

/// What set k has left of its limit load, as a share of the load: below zero it cannot hold. `load`: with the torques
/// of the independent contacts; `most`: a factor that counts as any larger one.
template <class T>
[[gnu::noinline]] T set_room(Workspace<T>& ws, int k, const T* carried, T noise, const T* load, double most = ample) {
  const DependentSet<T> set = dependent_set(ws, k, carried, noise);
  // the load of a contact of which nothing is left has no digits
  if (ws.held.vanished) return T(most - 1);
  if (ws.sys.loads == 0 || !holds_loads(ws)) {
    LimitLoad<T> limit = limit_of(ws, set);
    limit.most = most;
    return limit.solve() - T(1);
  }
  outer_loads(ws, k, load, carried);
  LoadedLimit<T> limit = loaded_limit(ws, set, ws.held.set_member + ws.held.set_first[k], noise);
  limit.most = most;
  return solve_loaded(limit) - T(1);
}

/// The largest factor of the load of a set that is at its limit. Members without friction of their own hold a multiple
/// of any size there or none: then with bounds widened by round-off, which is that of all torques, as far as it takes.
template <class T>
T solve_at_limit(LoadedLimit<T>& limit) {
  T factor = solve_loaded(limit);
  for (double share = 1e-11; share < 2e-8 && value(limit.size) > 0 && !(value(factor) >= 1); share *= 10) {
    const T noise = T(share) * limit.size;
    for (int i = 0; i < limit.set.n; ++i)
      limit.set.lower[i] -= noise - limit.noise, limit.set.upper[i] += noise - limit.noise;
    limit.noise = noise;
    factor = solve_loaded(limit);
  }
  return factor;
}

/// Whether a set goes on as it moves what slips and follows its torques: its independent contacts hold its load, which
/// alone count there, without the redundant ones. docs/theory/load-dependent.md, rule 3
template <class T>
bool holds_as_moved(const Workspace<T>& ws, const DependentSet<T>& set, const int* member) {
  bool slides = false;
  for (int l = 0; l < ws.sys.loads; ++l) {
    const int mode = ws.contact.mode[ws.sys.load_contact[l]];
    const T* by_torque = loads_by_shares(ws) + l * ws.n_directions + ws.sys.elements;
    for (int i = 0; i < set.n && (mode == forward || mode == backward); ++i)
      slides = slides || value(by_torque[member[i]]) != 0;
  }
  for (int i = 0; i < set.n && slides; ++i) {
    const int l = ws.loads.of[member[i]];
    auto most = [&](int way) { return bound_of(ws, member[i], way, T(0), 0).at(ws.loads.now[l]); };
    const T torque = i < set.rank ? set.load[i] : T(0);
    slides = torque >= (l < 0 ? set.lower[i] : -most(forward)) && torque <= (l < 0 ? set.upper[i] : most(backward));
  }
  return slides;
}

/// Torques of all contacts of set k, in the order of its members, in place of those of its independent contacts.
template <class T>
[[gnu::noinline]] const T* shares_of(Workspace<T>& ws, int k, const T* carried) {
  const DependentSet<T> set = dependent_set(ws, k, carried, T(0));
  const int* member = ws.held.set_member + ws.held.set_first[k];
  bool moved = ws.sys.loads > 0 && holds_as_moved(ws, set, member);
  if (!moved && ws.sys.loads > 0 && holds_loads(ws)) {
    outer_loads(ws, k, ws.loads.now, carried);
    LoadedLimit<T> limit = loaded_limit(ws, set, member, T(0));
    // what holds the largest multiple of the load holds the load in proportion
    const T factor = solve_at_limit(limit);
    moved = value(limit.size) > 0 && !(value(factor) > 0);
    for (int i = 0; i < set.n; ++i) set.x[i] = value(limit.size) > 0 ? limit.x[i] / factor : T(0);
  } else if (!moved) {
    Shares<T>{set, ws.set.deflection, ws.set.step, ws.set.residual, ws.set.matrix}.solve();
  }
  for (int i = 0; i < set.n && moved; ++i) set.x[i] = i < set.rank ? set.load[i] : T(0);
  return set.x;
}

/// The same by contact: `give` takes contact and torque.
template <class T, class Give>
void share_load(Workspace<T>& ws, int k, const T* carried, Give&& give) {
  const int first = ws.held.set_first[k], n = ws.held.set_first[k + 1] - first;
  const T* share = shares_of(ws, k, carried);
  for (int i = 0; i < n; ++i) give(ws.held.set_member[first + i], share[i]);
}

/// Torques of the locked contacts, independent contacts given, by contact: `give` takes contact and torque.
template <class T, class Give>
CLUTCHWORK_HOT void locked_torques(Workspace<T>& ws, const T* carried, Give&& give) {
  for (int a = 0; a < ws.held.n; ++a) {
    if (ws.held.in_set[a] == 0) give(ws.held.contact[a], carried[a]);
  }
  for (int k = 0; k < ws.held.n_sets; ++k) [[unlikely]]
    share_load(ws, k, carried, give);
}

/// Force the contacts of set k to slip the way in which the set gives way at its limit load. False, unless `anyway`:
/// to round-off it still holds any multiple of its load, and nothing tells how. docs/theory/contacts.md, rule 6
template <class T>
bool break_set(Workspace<T>& ws, int k, const T* carried, bool anyway) {
  const DependentSet<T> set = dependent_set(ws, k, carried, T(0));
  const int* member = ws.held.set_member + ws.held.set_first[k];
  auto force = [&](auto&& price, auto&& motion) {
    double most = 0;
    for (int i = 0; i < set.n; ++i) most = larger(most, abs(value(price(i))));
    for (int i = 0; i < set.n; ++i) {
      if (abs(value(price(i))) > 1e-9 * most) ws.contact.forced[member[i]] = value(motion(i)) > 0 ? backward : forward;
    }
  };
  if (ws.sys.loads > 0 && holds_loads(ws)) {
    outer_loads(ws, k, ws.loads.now, carried);
    LoadedLimit<T> limit = loaded_limit(ws, set, member, T(0));
    // with bounds as they are: where round-off widens them, it holds any multiple, and prices are round-off
    if (!(value(solve_loaded(limit)) < limit.most) && !anyway) return false;
    T* way = ws.set.deflection;
    const bool moves = limit.find_motion(way);
    auto motion = [&](int i) { return moves ? limit.moves(way, i) : value(limit.price_of(i)); };
    force(motion, motion);
    return true;
  }
  LimitLoad<T> limit = limit_of(ws, set);
  limit.solve();
  auto price = [&](int i) { return limit.price[i]; };
  force(price, price);
  return true;
}

/// Torques of the contacts that a decision has locked: what it gave them together, shared as everywhere else.
template <class T>
void share_decided(Workspace<T>& ws) {
  if (ws.held.n_sets == 0) return;
  const int nc = int(ws.sys.contacts);
  T* carried = ws.held.carried;
  for (int a = 0; a < ws.held.n; ++a) {
    carried[a] = ws.decision.torque[ws.held.contact[a]];
    for (int s = 0; s < ws.held.n_redundant; ++s)
      carried[a] += ws.held.tie[s * nc + a] * ws.decision.torque[ws.held.redundant[s]];
  }
  // as if the independent contacts held all of it
  for (int l = 0; l < ws.sys.loads; ++l) {
    const T* by_torque = ws.loads.by_torque + l * ws.n_directions + ws.sys.elements;
    for (int a = 0; a < ws.held.n; ++a)
      ws.loads.now[l] += by_torque[ws.held.contact[a]] * (carried[a] - ws.decision.torque[ws.held.contact[a]]);
    for (int s = 0; s < ws.held.n_redundant; ++s)
      ws.loads.now[l] -= by_torque[ws.held.redundant[s]] * ws.decision.torque[ws.held.redundant[s]];
  }
  for (int k = 0; k < ws.held.n_sets; ++k) share_load(ws, k, carried, [&](int c, T x) { ws.decision.torque[c] = x; });
}

}  // namespace clutchwork

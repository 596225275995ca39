#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/contacts/dependent.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// The locked contacts of the present mode: carriers, spares, and the sets that they make. docs/theory/contacts.md
namespace clutchwork {

/// Direction of row `own` of a split in terms of the pivot rows, in pivot order.
template <class T>
void resolve_direction(int rank, int nv, const T* rows, const int* order, const T* own, T* share) {
  for (int j = rank - 1; j >= 0; --j) {
    T s = own[j];
    for (int k = j + 1; k < rank; ++k) s -= share[k] * rows[order[k] * nv + j];
    share[j] = s / rows[order[j] * nv + j];
  }
}

/// Label each carrier with the lowest one of its set.
template <class T>
void join_sets(Workspace<T>& ws, int* label) {
  const int nc = int(ws.sys.contacts);
  for (int a = 0; a < ws.n_locked; ++a) label[a] = a;
  for (int s = 0; s < ws.n_spare; ++s) {
    int lowest = -1;
    for (int a = 0; a < ws.n_locked; ++a) {
      if (value(ws.tie[s * nc + a]) == 0) continue;
      if (lowest < 0) lowest = label[a];
      const int from = larger(label[a], lowest), to = smaller(label[a], lowest);
      for (int b = 0; b < ws.n_locked; ++b) {
        if (label[b] == from) label[b] = to;
      }
      lowest = to;
    }
  }
}

/// Write down the sets: carriers first, then spares.
template <class T>
void list_sets(Workspace<T>& ws, const int* label) {
  const int nc = int(ws.sys.contacts);
  int at = 0;
  ws.n_sets = 0;
  auto add = [&](int contact, int place) { ws.set_member[at] = contact, ws.set_place[at++] = place; };
  auto carrier_of = [&](int s) {
    for (int a = 0; a < ws.n_locked; ++a) {
      if (value(ws.tie[s * nc + a]) != 0) return a;
    }
    return -1;
  };
  for (int root = 0; root < ws.n_locked; ++root) {
    int spares = 0;
    for (int s = 0; s < ws.n_spare; ++s) spares += label[carrier_of(s)] == root;
    if (spares == 0) continue;
    ws.set_first[ws.n_sets] = at;
    for (int a = 0; a < ws.n_locked; ++a) {
      if (label[a] == root) add(ws.locked[a], a), ws.in_set[a] = 1;
    }
    ws.set_rank[ws.n_sets] = at - ws.set_first[ws.n_sets];
    ++ws.n_sets;
    for (int s = 0; s < ws.n_spare; ++s) {
      if (label[carrier_of(s)] == root) add(ws.spare[s], s);
    }
  }
  ws.set_first[ws.n_sets] = at;
}

/// Share of prescribed speed p in the slip of spare s while the carriers are locked.
template <class T>
double driven_share(const Workspace<T>& ws, int s, int p) {
  const int nc = int(ws.sys.contacts), ne = int(ws.sys.elements);
  double size = abs(value(prescribed_share(ws, ne + ws.spare[s], p)));
  T share = prescribed_share(ws, ne + ws.spare[s], p);
  for (int a = 0; a < ws.n_locked; ++a) {
    const T part = ws.tie[s * nc + a] * prescribed_share(ws, ne + ws.locked[a], p);
    share -= part, size = larger(size, abs(value(part)));
  }
  return abs(value(share)) > 1e-12 * size ? value(share) : 0.0;
}

/// Sort the locked contacts into carriers and spares; all of them are carriers where no directions depend on others.
template <class T>
void list_locked(Workspace<T>& ws) {
  const int nc = int(ws.sys.contacts), nv = int(ws.sys.speeds), ne = int(ws.sys.elements);
  int n = 0;
  for (int c = 0; c < nc; ++c) {
    if (ws.mode[c] == locked) ws.in_set[n] = 0, ws.locked[n++] = c;
  }
  ws.n_locked = n;
  ws.n_spare = ws.n_sets = ws.n_driven = 0;
  if (!ws.redundant || n < 2) return;
  T* rows = ws.scratch;
  for (int a = 0; a < n; ++a) {
    for (int i = 0; i < nv; ++i) rows[a * nv + i] = ws.direction[(ne + ws.locked[a]) * nv + i];
  }
  int *order = ws.iscratch, *all = order + nc, *number = all + nc;
  const int rank = orthonormal_split(n, nv, rows, ws.envelope, order, ws.qp_f);
  for (int a = 0; a < n; ++a) all[a] = ws.locked[a], number[a] = -1;
  for (int j = 0; j < rank; ++j) number[order[j]] = 0;
  ws.n_locked = 0;
  for (int a = 0; a < n; ++a) {
    if (number[a] < 0 && !is_rigid(ws, all[a])) continue;
    number[a] = ws.n_locked;
    ws.locked[ws.n_locked++] = all[a];
  }
  if (ws.n_locked == n) return;
  T* share = ws.qp_f;
  for (int a = 0; a < n; ++a) {
    if (number[a] >= 0) continue;
    T* tie = ws.tie + ws.n_spare * nc;
    for (int b = 0; b < nc; ++b) tie[b] = T(0);
    resolve_direction(rank, nv, rows, order, rows + a * nv, share);
    const double size = value(ws.mobility[all[a] * nc + all[a]]);
    for (int j = 0; j < rank; ++j) {
      const int carrier = all[order[j]];
      const bool counts = value(share[j] * share[j] * ws.mobility[carrier * nc + carrier]) > 1e-18 * size;
      if (counts) tie[number[order[j]]] = share[j];
    }
    ws.spare[ws.n_spare++] = all[a];
  }
  for (int s = 0; s < ws.n_spare; ++s) {
    bool driven = false;
    for (int p = 0; p < ws.sys.prescribed; ++p) driven = driven || driven_share(ws, s, p) != 0;
    if (driven) ws.driven[ws.n_driven++] = s;
  }
  join_sets(ws, order);
  list_sets(ws, order);
}

/// Set number k under the torques of the carriers, its bounds widened by round-off.
template <class T>
DependentSet<T> dependent_set(Workspace<T>& ws, int k, const T* carried, T noise) {
  const int nc = int(ws.sys.contacts), first = ws.set_first[k], n = ws.set_first[k + 1] - first, rank = ws.set_rank[k];
  T* at = ws.set_memory;
  DependentSet<T> set{n, rank, at, at + n * rank, nullptr, nullptr, nullptr};
  set.lower = set.load + rank, set.upper = set.lower + n, set.x = set.upper + n;
  const int* place = ws.set_place + first;
  for (int r = 0; r < rank; ++r) set.load[r] = carried[place[r]];
  for (int i = 0; i < n; ++i) {
    const int c = ws.set_member[first + i];
    for (int r = 0; r < rank; ++r) {
      set.column[i * rank + r] = i < rank ? T(i == r ? 1 : 0) : ws.tie[place[i] * nc + place[r]];
    }
    set.lower[i] = -capacity_of(ws, c, forward) - noise;
    set.upper[i] = (contact_one_way(ws, c) ? freewheel_limit(ws, c) : capacity_of(ws, c, backward)) + noise;
  }
  return set;
}

/// Memory behind a set for its limit load.
template <class T>
LimitLoad<T> limit_of(Workspace<T>& ws, const DependentSet<T>& set) {
  T* at = set.x + set.n;
  T *x = at + set.rank * (set.n + 1), *price = x + set.n + 1;
  return {set, at, x, price, ws.set_basis, ws.set_basis + set.rank};
}

/// What set k has left of its limit load, as a share of the load: below zero it cannot hold.
template <class T>
[[gnu::noinline]] T set_room(Workspace<T>& ws, int k, const T* carried, T noise) {
  const DependentSet<T> set = dependent_set(ws, k, carried, noise);
  return limit_of(ws, set).solve() - T(1);
}

/// Torques of all contacts of set k in place of those of its carriers: `give` takes contact and torque.
template <class T, class Give>
void share_load(Workspace<T>& ws, int k, const T* carried, Give&& give) {
  const DependentSet<T> set = dependent_set(ws, k, carried, T(0));
  T* at = set.x + set.n;
  Shares<T>{set, at, at + set.rank, at + 2 * set.rank, at + 3 * set.rank}.solve();
  for (int i = 0; i < set.n; ++i) give(ws.set_member[ws.set_first[k] + i], set.x[i]);
}

/// Torques of the locked contacts, carriers given, by contact: `give` takes contact and torque.
template <class T, class Give>
CLUTCHWORK_INLINE void locked_torques(Workspace<T>& ws, const T* carried, Give&& give) {
  for (int a = 0; a < ws.n_locked; ++a) {
    if (ws.in_set[a] == 0) give(ws.locked[a], carried[a]);
  }
  for (int k = 0; k < ws.n_sets; ++k) [[unlikely]]
    share_load(ws, k, carried, give);
}

/// Force the contacts of set k to slip the way in which the set gives way at its limit load.
template <class T>
void break_set(Workspace<T>& ws, int k, const T* carried) {
  const DependentSet<T> set = dependent_set(ws, k, carried, T(0));
  LimitLoad<T> limit = limit_of(ws, set);
  limit.solve();
  double most = 0;
  for (int i = 0; i < set.n; ++i) most = larger(most, abs(value(limit.price[i])));
  for (int i = 0; i < set.n; ++i) {
    const double price = value(limit.price[i]);
    if (abs(price) > 1e-9 * most) ws.forced[ws.set_member[ws.set_first[k] + i]] = price > 0 ? backward : forward;
  }
}

/// Torques of the contacts that a decision has locked: what it gave them together, shared as everywhere else.
template <class T>
void share_decided(Workspace<T>& ws) {
  if (ws.n_sets == 0) return;
  const int nc = int(ws.sys.contacts), ne = int(ws.sys.elements);
  T* carried = ws.qp_g + nc;
  for (int a = 0; a < ws.n_locked; ++a) {
    carried[a] = ws.torque[ne + ws.locked[a]];
    for (int s = 0; s < ws.n_spare; ++s) carried[a] += ws.tie[s * nc + a] * ws.torque[ne + ws.spare[s]];
  }
  for (int k = 0; k < ws.n_sets; ++k) share_load(ws, k, carried, [&](int c, T x) { ws.torque[ne + c] = x; });
}

}  // namespace clutchwork

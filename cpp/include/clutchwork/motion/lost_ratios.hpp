#pragma once
#include <clutchwork/motion/ratios.hpp>
#include <clutchwork/workspace.hpp>

/// Ratios at which a transmission can no longer be kept, between two points of a step. docs/theory/varying-ratios.md
namespace clutchwork {

/// Product of the row of transmission a at one ratio with its row at another, in the mobility of the reduced speeds.
template <class T>
double row_product(const Ratios<T>& r, int a, double one, double other) {
  const T* first = r.between + 2 * a * r.rows + 2 * a;
  return value(first[0]) - (one + other) * value(first[1]) + one * other * value(first[r.rows + 1]);
}

/// Whether both directions of transmission a are one and the same to the reduced speeds, or one of them is prescribed.
template <class T>
bool is_one_way(const Ratios<T>& r, int a) {
  const T* first = r.between + 2 * a * r.rows + 2 * a;
  const double product = value(first[0]) * value(first[r.rows + 1]), mixed = value(first[1]);
  return product - mixed * mixed <= 1e-12 * product;
}

/// A transmission whose ratio has passed, since the point that was linearized last, one at which nothing can keep it
/// against what is prescribed; -1: none. docs/theory/varying-ratios.md (9)
template <class T>
int turned_over(const Workspace<T>& ws) {
  const Ratios<T>& r = ws.ratios;
  const int np = int(ws.sys.prescribed);
  for (int t = 0; t < r.ties && r.tie[t] >= 0; ++t) {
    const int a = r.tie[t], k = r.place[2 * a];
    const double now = value(r.plain.ratio[a]);
    if (row_product(r, a, value(r.some.ratio[a]), now) >= 0 || !is_one_way(r, a)) continue;
    double miss = 0, size = 0;
    for (int p = 0; p < np; ++p) {
      const double first = value(ws.reduced.offset[k * np + p] * ws.in.prescribed[p]),
                   second = now * value(ws.reduced.offset[(k + 1) * np + p] * ws.in.prescribed[p]);
      miss += first - second, size += abs(first) + abs(second);
    }
    if (abs(miss) > ws.guard.zero + 1e-9 * size) return a;
  }
  return -1;
}

/// Product of tie t at one point with itself at another, in the mobility of the reduced speeds.
template <class T, class A, class B>
double tie_product(const Ratios<T>& r, const Tied<A>& one, const Tied<B>& other, int t) {
  double product = 0;
  for (int k = 0; k < r.rows; ++k) {
    const double share = value(one.share[t * r.rows + k]);
    for (int l = 0; l < r.rows && share != 0; ++l)
      product += value(r.between[k * r.rows + l]) * share * value(other.share[t * r.rows + l]);
  }
  return product;
}

/// Size of the terms of the product of tie t with itself.
template <class T>
double tie_terms(const Ratios<T>& r, const Tied<T>& one, int t) {
  const T* share = one.share + t * r.rows;
  double sum = 0;
  for (int k = 0; k < r.rows; ++k) {
    for (int l = 0; l < r.rows; ++l) sum += abs(value(r.between[k * r.rows + l] * share[k] * share[l]));
  }
  return sum;
}

/// Whether tie t is along what it was at the point that was linearized last, up to its sign and a round-off.
template <class T>
[[gnu::noinline]] bool is_parallel(const Ratios<T>& r, int t, double round_off) {
  const double mixed = tie_product(r, r.some, r.plain, t), before = tie_product(r, r.some, r.some, t);
  const double sizes = before * tie_product(r, r.plain, r.plain, t);
  return sizes - mixed * mixed <= 1e-12 * sizes + round_off * before;
}

/// A tie that has turned over, and nothing else, since the point that was linearized last: it has passed a ratio at
/// which nothing is left of it; -1: none. docs/theory/varying-ratios.md (22)
template <class T>
int turned_tie(const Ratios<T>& r) {
  for (int t = 0; t < r.ties; ++t) {
    if (tie_product(r, r.some, r.plain, t) < 0 && is_parallel(r, t, 0)) return t;
  }
  return -1;
}

/// The same where it may also be at that ratio, or within the round-off of its terms behind it.
template <class T>
int lost_tie(const Ratios<T>& r) {
  for (int t = 0; t < r.ties; ++t) {
    const int own = t * r.ties + t;
    const bool passed = tie_product(r, r.some, r.plain, t) <= 0 || value(r.plain.gram[own]) == 0;
    if (value(r.some.gram[own]) != 0 && passed && is_parallel(r, t, 1e-14 * tie_terms(r, r.plain, t))) return t;
  }
  return -1;
}

/// Whether the point that was evaluated last is before the ratio at which the step loses a tie.
template <class T>
bool keeps_ties(const Ratios<T>& r) {
  const int t = r.lost, own = t * r.ties + t;
  if (t < 0) return true;
  if (value(r.plain.gram[own]) == 0) return false;
  return value(r.some.gram[own]) == 0 || tie_product(r, r.some, r.plain, t) < 0;
}

/// A transmission that has passed, since the point that was linearized last, a ratio at which the speed without inertia
/// that follows from it is determined by nothing, or of whose share in its row round-off leaves too little; -1: none.
/// docs/theory/varying-ratios.md, shafts without inertia
template <class T>
int passed_over(const Ratios<T>& r) {
  constexpr double least = 1e-7;
  for (int a = 0; a < r.n; ++a) {
    if (r.column[a] < 0) continue;
    const double first = value(r.follows[2 * a * r.n + a]), second = value(r.follows[(2 * a + 1) * r.n + a]);
    const double before = first - value(r.some.ratio[a]) * second, along = value(r.plain.ratio[a]) * second;
    const double now = first - along;
    if (before * now <= 0 || abs(now) <= least * (abs(first) + abs(along))) return a;
  }
  return -1;
}

/// A transmission that, from the point that was evaluated last, reaches such a ratio at once; -1: none. Asked where
/// steps have collapsed, which they may do well before.
template <class T>
int passes_at_once(const Ratios<T>& r) {
  constexpr double soon = 1e-4;
  for (int a = 0; a < r.n; ++a) {
    if (r.column[a] < 0) continue;
    const double second = value(r.follows[(2 * a + 1) * r.n + a]);
    const double share = value(r.follows[2 * a * r.n + a]) - value(r.plain.ratio[a]) * second;
    if (!(abs(share) > soon * abs(value(r.plain.slope[a]) * second))) return a;
  }
  return -1;
}

/// A transmission of which nothing is left that could keep it at its ratio where a run stands still, at the point that
/// was evaluated last; -1: none. What others leave of it is nothing too, unless its rates are at its ratio without it.
template <class T>
int vanished_row(const Workspace<T>& ws) {
  constexpr double least = 1e-10, apart = 1e-3;
  const Ratios<T>& r = ws.ratios;
  for (int t = 0; t < r.ties && r.tie[t] >= 0; ++t) {
    const int a = r.tie[t], k = r.place[2 * a];
    const T* first = r.between + 2 * a * r.rows + 2 * a;
    const double ratio = value(r.some.ratio[a]), size = value(first[0]) + value(first[r.rows + 1]);
    if (row_product(r, a, ratio, ratio) <= least * size) return a;
    if (value(r.plain.gram[t * r.ties + t]) > least * tie_product(r, r.plain, r.plain, t)) continue;
    const double one = value(ws.full.plain.rate[k]), other = value(r.plain.ratio[a] * ws.full.plain.rate[k + 1]);
    if (abs(one - other) > apart * (abs(one) + abs(other))) return a;
  }
  return -1;
}

/// What a step whose ends were both linearized has lost of its transmissions. Whether it has passed a ratio at which a
/// speed without inertia follows from nothing.
template <class T>
bool note_lost(Workspace<T>& ws) {
  Ratios<T>& r = ws.ratios;
  if (r.n == 0) return false;
  const bool held = ws.held.n > 0;
  r.reversed = held ? turned_tie(r) : -1;
  r.lost = held ? lost_tie(r) : -1;
  if (r.jammed < 0) r.jammed = turned_over(ws);
  if (r.jammed >= 0) return false;
  r.jammed = passed_over(r);
  return r.jammed >= 0;
}

}  // namespace clutchwork

#pragma once
#include <clutchwork/contacts/dependent.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// What a set of locked contacts holds where some of them follow loads that the others make:
/// docs/theory/load-dependent.md.
namespace clutchwork {

/// Loads by the torques of all directions, with what transmissions carry of them.
template <class T>
const T* loads_by_shares(const Workspace<T>& ws) {
  return ws.ratios.n > 0 && !ws.ratios.inside ? ws.loads.beside_torque : ws.loads.by_torque;
}

/// The largest factor of the load that such a set can hold, for a choice of the lines of each bound. Variables: the
/// torques of the set, for each member with a load what its two bounds have left, then the factor.
template <class T>
struct LoadedLimit {
  Workspace<T>& ws;
  const DependentSet<T>& set;
  const int* member;  ///< contacts of the set
  T *tableau, *x, *price, *low, *high;
  int *basis, *place;
  int* follower;    ///< places in the set of the members with loads
  const int* line;  ///< of each of these: of its bound against slip backward, then forward
  int n_loads = 0;
  T noise = T(0), size = T(0);
  double most = ample;  ///< as in LimitLoad

  int width() const { return set.n + 2 * n_loads + 1; }
  int rows() const { return set.rank + 2 * n_loads; }
  T lower(int j) const { return low[j]; }
  T upper(int j) const { return high[j]; }
  int load_of_member(int f) const { return ws.loads.of[member[follower[f]]]; }
  T share(int l, int j) const { return loads_by_shares(ws)[l * ws.n_directions + ws.sys.elements + member[j]]; }

  /// Row of what the bound of follower f against slip in a direction has left: that, less what the torques of the set
  /// and the factor take of it.
  void lay_row(int row, int f, int direction) {
    const int l = load_of_member(f), own = follower[f], w = width();
    const Bound<T> bound = bound_of(ws, member[own], direction, T(0), 0);
    const int which = line[2 * f + (direction > 0)];
    const T slope = bound.slope[which];
    T* r = tableau + row * w;
    for (int j = 0; j < w; ++j) r[j] = T(0);
    for (int j = 0; j < set.n; ++j) r[j] = -slope * share(l, j);
    r[own] += T(-direction);
    r[w - 1] = -slope * ws.loads.outer[l] / size;
    // the independent contacts are basic in their own rows
    for (int c = 0; c < set.rank; ++c) {
      const T factor = r[c];
      for (int j = 0; j < w; ++j) r[j] -= factor * tableau[c * w + j];
    }
    const int slack = set.n + row - set.rank;
    r[slack] = T(1);
    basis[row] = slack, place[slack] = row;
    x[slack] = bound.offset[which] + noise;
    low[slack] = T(0), high[slack] = T(infinity);
  }

  void start() {
    const int w = width(), factor = w - 1;
    size = T(0);
    for (int r = 0; r < set.rank; ++r) size = larger(size, abs(set.load[r]));
    for (int f = 0; f < n_loads; ++f) size = larger(size, abs(ws.loads.outer[load_of_member(f)]));
    if (!(value(size) > 0)) return;
    for (int j = 0; j < w; ++j) x[j] = price[j] = T(0), place[j] = -1;
    for (int j = 0; j < set.n; ++j) low[j] = set.lower[j], high[j] = set.upper[j];
    for (int f = 0; f < n_loads; ++f) low[follower[f]] = T(-infinity), high[follower[f]] = T(infinity);
    price[factor] = T(1), low[factor] = T(0), high[factor] = T(most) * size;
    for (int r = 0; r < set.rank; ++r) {
      for (int j = 0; j < w; ++j) tableau[r * w + j] = j < set.n ? set.column[j * set.rank + r] : T(0);
      tableau[r * w + factor] = -set.load[r] / size;
      basis[r] = r, place[r] = r;
    }
    for (int f = 0; f < n_loads; ++f) {
      lay_row(set.rank + 2 * f, f, backward);
      lay_row(set.rank + 2 * f + 1, f, forward);
    }
  }

  /// Whether the torques still add up to the load: round-off of pivots spoils that.
  bool adds_up() const {
    const T factor = x[width() - 1] / size;
    double most = value(size), apart = 0;
    for (int r = 0; r < set.rank; ++r) {
      double left = value(factor * set.load[r]);
      for (int j = 0; j < set.n; ++j) {
        const double part = value(set.column[j * set.rank + r] * x[j]);
        left -= part, most = larger(most, abs(part));
      }
      apart = larger(apart, abs(left));
    }
    return apart <= 1e-8 * most;
  }

  /// The largest factor, none where it was not found. A member with a load slips the way whose bound has nothing left
  /// and a price.
  T solve() {
    start();
    if (!(value(size) > 0)) return T(most);
    raise(*this, 50 + 20 * width());
    return adds_up() ? x[width() - 1] / size : T(0);
  }
  /// As the price of a contact without load.
  T price_of(int i) const {
    for (int f = 0; f < n_loads; ++f) {
      if (follower[f] == i) return price[set.n + 2 * f + 1] - price[set.n + 2 * f];
    }
    return price[i];
  }
  /// The way in which the set gives way, for its independent contacts: that of the load, as far as it moves none of
  /// those that hold on, which have no price. Positive is backward. False: they leave none.
  /// docs/theory/load-dependent.md (14)
  bool find_motion(T* way) {
    constexpr double round_off = 1e-9;
    const int n = set.rank;
    double most = 0;
    for (int i = 0; i < set.n; ++i) most = larger(most, abs(value(price_of(i))));
    for (int r = 0; r < n; ++r) way[r] = T(value(set.load[r]));
    // the programme is solved: its memory takes directions at right angles to one another that do not move
    int held = 0;
    for (int i = 0; i < set.n && held < n; ++i) {
      T* own = tableau + held * n;
      if (abs(value(price_of(i))) > round_off * most) continue;
      for (int r = 0; r < n; ++r) own[r] = T(value(set.column[i * n + r]));
      held += leaves_direction(own, held) ? 1 : 0;
    }
    leave_out(way, held);
    double left = 0, whole = 0;
    for (int r = 0; r < n; ++r) left = larger(left, abs(value(way[r]))), whole = larger(whole, abs(value(set.load[r])));
    return left > round_off * whole;
  }
  /// How it moves member i.
  double moves(const T* way, int i) const {
    double sum = 0;
    for (int r = 0; r < set.rank; ++r) sum += value(set.column[i * set.rank + r] * way[r]);
    return sum;
  }

 private:
  /// What a direction has of the first ones that do not move, taken from it: twice, for round-off.
  void leave_out(T* own, int count) const {
    const int n = set.rank;
    for (int k = 0; k < 2 * count; ++k) {
      const T* held = tableau + k % count * n;
      const T along = dot(n, held, own);
      for (int r = 0; r < n; ++r) own[r] -= along * held[r];
    }
  }
  /// Whether a direction leaves something of length one behind those before it.
  bool leaves_direction(T* own, int before) const {
    constexpr double dependent = 1e-9;
    const int n = set.rank;
    auto length = [&] {
      double square = 0;
      for (int r = 0; r < n; ++r) square += value(own[r]) * value(own[r]);
      return sqrt(square);
    };
    const double whole = length();
    leave_out(own, before);
    const double left = length();
    for (int r = 0; r < n && left > 0; ++r) own[r] = own[r] / T(left);
    return left > dependent * whole;
  }
};

/// That of set `set`, whose members are given.
template <class T>
LoadedLimit<T> loaded_limit(Workspace<T>& ws, const DependentSet<T>& set, const int* member, T noise) {
  SetMemory<T>& m = ws.set;
  LoadedLimit<T> made{ws,    set,    member,  m.tableau, m.limit_x,  m.price,
                      m.low, m.high, m.basis, m.place,   m.follower, m.line};
  made.noise = noise;
  for (int i = 0; i < set.n; ++i) {
    if (ws.loads.of[member[i]] >= 0) m.follower[made.n_loads++] = i;
  }
  return made;
}

/// Lines of the two bounds of a member: 0 those far below zero load, 1 those far above, 2 those at zero load. At no
/// load others are together the largest.
template <class T>
void choose_lines(const LoadedLimit<T>& limit, int f, int range, int* line) {
  for (int way = 0; way < 2; ++way) {
    const Bound<T> bound = bound_of(limit.ws, limit.member[limit.follower[f]], way == 0 ? backward : forward, T(0), 0);
    const int steeper = value(bound.slope[1]) > value(bound.slope[0]) ? 1 : 0;
    line[2 * f + way] = range == 2 ? bound.line_at(T(0)) : range == 1 ? steeper : 1 - steeper;
  }
}

/// In which of these a load lies, by the larger lines of both bounds.
template <class T>
int range_of(const LoadedLimit<T>& limit, int f) {
  const int c = limit.member[limit.follower[f]];
  const T load = limit.ws.loads.now[limit.load_of_member(f)];
  const Bound<T> ahead = bound_of(limit.ws, c, forward, T(0), 0), behind = bound_of(limit.ws, c, backward, T(0), 0);
  const bool same = (ahead.line_at(load) == 1) == (value(ahead.slope[1]) > value(ahead.slope[0])) &&
                    (behind.line_at(load) == 1) == (value(behind.slope[1]) > value(behind.slope[0]));
  const bool none = (ahead.line_at(load) == 1) != (value(ahead.slope[1]) > value(ahead.slope[0])) &&
                    (behind.line_at(load) == 1) != (value(behind.slope[1]) > value(behind.slope[0]));
  return same ? 1 : none ? 0 : 2;
}

/// Most members with loads whose ranges are all tried; of more of them one after the other is changed.
inline constexpr int most_tried = 5;

/// The largest factor over all choices of lines; the solution is that of the best one. docs/theory/load-dependent.md
/// (11)
template <class T>
T solve_loaded(LoadedLimit<T>& limit) {
  int *line = limit.ws.set.line, *best = limit.ws.set.best_line;
  const int n = limit.n_loads;
  T most = T(-1);
  auto attempt = [&] {
    const T factor = limit.solve();
    if (!(value(factor) > value(most))) return;
    most = factor;
    for (int k = 0; k < 2 * n; ++k) best[k] = line[k];
  };
  for (int f = 0; f < n; ++f) choose_lines(limit, f, range_of(limit, f), line);
  attempt();
  int all = 1;
  for (int f = 0; f < n && f < most_tried; ++f) all *= 3;
  for (int number = 0; n <= most_tried && number < all && value(most) < ample; ++number) {
    for (int f = 0, rest = number; f < n; ++f, rest /= 3) choose_lines(limit, f, rest % 3, line);
    attempt();
  }
  // from all in one range, and from the best so far
  for (int range = 0; n > most_tried && range < 3 && value(most) < ample; ++range) {
    for (int f = 0; f < n; ++f) choose_lines(limit, f, range, line);
    attempt();
  }
  for (int f = 0; n > most_tried && f < 3 * n && value(most) < ample; ++f) {
    for (int k = 0; k < 2 * n; ++k) line[k] = best[k];
    choose_lines(limit, f / 3, f % 3, line);
    attempt();
  }
  for (int k = 0; k < 2 * n; ++k) line[k] = best[k];
  return limit.solve();
}

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/component.hpp>

/// What elements with many smooth pieces share: guards of which the least counts, intervals, grids of both directions.
namespace clutchwork {

/// What counts as beyond a border where it must not be found again at once, over the scale of a guard.
inline constexpr double border_slack = 1e-10;

/// The least of several guards, and whose it is. Its time derivative is as large as those of all, for each may be next.
/// One that rests on its border does not end the piece, unless those that rest are asked for.
template <class S>
struct Least {
  S least = S(1e300);
  S change = S(0);
  int& who;
  const bool rests;

  explicit Least(int& whose) : who(whose), rests(whose == resting) {}
  void watch(const S& guard, int number) {
    if constexpr (has_tangents<S>) {
      if (rests) return watch_resting(guard, number);
    }
    bool moves = false;
    if constexpr (requires { guard.d; }) {
      for (auto i = 0u; i < sizeof(guard.d) / sizeof(guard.d[0]); ++i) {
        change.d[i] += abs(guard.d[i]);
        moves = moves || value(guard.d[i]) != 0;
      }
    }
    if (value(guard) == 0 && !moves) return;
    if (value(guard) < value(least)) least = plain_of(guard), who = number;
  }
  /// One that is zero and does not move, to round-off.
  void watch_resting(const S& guard, int number) {
    constexpr double still = 1e-12, slow = 1e-9;
    bool moves = abs(value(guard)) > still;
    if constexpr (requires { guard.d; }) {
      for (auto i = 0u; i < sizeof(guard.d) / sizeof(guard.d[0]); ++i) moves = moves || abs(value(guard.d[i])) > slow;
    }
    if (!moves) least = plain_of(guard), who = number;
  }
  S margin() const { return least + change; }
};

/// The interval of x among n borders, the present one as long as x is not clearly beyond its ends.
template <class X, class Border>
int settled_interval(X x, int n, int present, std::type_identity_t<X> slack, Border&& border) {
  int k = present < n ? present : n;
  while (k < n && x > border(k) + slack) ++k;
  while (k > 0 && x < border(k - 1) - slack) --k;
  return k;
}

/// NumberList of a list, `numbers(...)` of the declaration.
template <class G>
struct NumberList {
  const G* at;
  int count;

  template <class T>
  NumberList(const Curve<T>& c, const G* points) : at(points + 3 * int(common(c.first))), count(int(common(c.count))) {}
  G operator[](int i) const { return at[3 * i]; }
};

/// A grid that starts at zero and holds for both signs of a quantity: borders at plus and minus each of its other
/// points, and at zero; values are held beyond its ends.
struct Mirrored {
  int points;

  int borders() const { return 2 * points - 1; }
  int intervals() const { return 2 * points; }
  template <class Grid>
  auto border(const Grid& grid, int i) const {
    using G = std::remove_cvref_t<decltype(grid[0])>;
    const int middle = points - 1;
    return i == middle ? G(0.0) : i < middle ? G(-grid[middle - i]) : grid[i - middle];
  }
  int side(int interval) const { return interval < points ? -1 : 1; }
  /// Number of the cell from point to point; the last one lies beyond the grid.
  int cell(int interval) const { return interval < points ? points - 1 - interval : interval - points; }
};

/// Share of the way through a cell of a grid; zero beyond the last point.
template <class S>
CLUTCHWORK_HOT S share_of_cell(const auto& grid, int cell, const S& x) {
  if (cell + 1 >= grid.count) return S(0);
  return (x - S(grid[cell])) / S(grid[cell + 1] - grid[cell]);
}

/// Linear value of a cell whose point i has the value at(i).
template <class S, class At_>
CLUTCHWORK_HOT S value_in_cell(int count, int cell, const S& share, At_&& at) {
  if (cell + 1 >= count) return S(at(count - 1));
  return S(at(cell)) + (S(at(cell + 1)) - S(at(cell))) * share;
}

/// Value of a curve that is held outside, on one of its intervals: 0 before the first point, then between points.
template <class T, class S>
CLUTCHWORK_HOT S held_value(const Curve<T>& c, const auto* points, const S& x, int interval) {
  const int n = int(common(c.count)), first = int(common(c.first));
  if (interval == 0) return S(points[3 * first + 1]);
  if (interval >= n) return S(points[3 * (first + n - 1) + 1]);
  return curve_value(c, points, x, interval - 1);
}

}  // namespace clutchwork

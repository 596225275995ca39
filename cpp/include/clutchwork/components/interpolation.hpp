#pragma once
#include <clutchwork/components/component.hpp>
#include <clutchwork/components/regions.hpp>

/// Tables of friction coefficients: linear or smooth, beyond their ends continued, kept or refused.
/// docs/theory/clutches.md
namespace clutchwork {

/// Parameters that every law with tables has; the first ones of it.
template <class T>
struct Tabulated {
  Word<T, choice::Interpolation> interpolation;  ///< [1]
  Word<T, choice::Extrapolation> extrapolation;  ///< [1]
};

/// What a table does between its points and beyond them.
struct Manner {
  choice::Interpolation interpolation;
  choice::Extrapolation extrapolation;

  template <class T>
  explicit Manner(const Tabulated<T>& p) : interpolation(p.interpolation), extrapolation(p.extrapolation) {}
  constexpr Manner(choice::Interpolation between, choice::Extrapolation beyond)
      : interpolation(between), extrapolation(beyond) {}
  bool smooth() const { return interpolation == choice::Interpolation::smooth; }
  bool kept() const { return extrapolation == choice::Extrapolation::nearest; }
};

/// Points of one row of a table, inside the pool.
template <class G>
struct Axis {
  const G* x;
  int count;

  G operator[](int i) const { return x[3 * i]; }
  G width(int i) const { return x[3 * (i + 1)] - x[3 * i]; }
  G last() const { return x[3 * (count - 1)]; }
};

template <class T, class G>
CLUTCHWORK_INLINE Axis<G> axis_of(const Curve<T>& c, const G* points) {
  return {points + 3 * int(value(c.first)), int(value(c.count))};
}

/// Number of the interval that holds x, the outer ones for what lies beyond.
CLUTCHWORK_INLINE int interval_of(const auto& axis, auto x) {
  int low = 0, high = axis.count - 2;
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (axis[middle] <= x) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low < 0 ? 0 : low;
}

/// x, taken to the nearest end where a table keeps its end values.
template <class S>
CLUTCHWORK_INLINE S within(const auto& axis, const Manner& manner, S x) {
  if (!manner.kept()) return x;
  return larger(smaller(x, S(axis.last())), S(axis[0]));
}

/// Slope at a point inside: harmonic mean of the secants beside it, weighted by their widths; zero at a peak.
template <class S>
CLUTCHWORK_INLINE S inner_slope(S before, S after, auto width_before, auto width_after) {
  if (value(before * after) <= 0) return S(0);
  const auto a = 2 * width_after + width_before, b = width_after + 2 * width_before;
  return S(a + b) * before * after / (S(a) * after + S(b) * before);
}

/// Slope at an end: of the parabola through three points, kept monotone.
template <class S>
CLUTCHWORK_INLINE S end_slope(S near, S next, auto width, auto width_next) {
  const S slope = (S(2 * width + width_next) * near - S(width) * next) / S(width + width_next);
  if (value(slope * near) <= 0) return S(0);
  if (value(near * next) <= 0 && abs(slope) > abs(S(3) * near)) return S(3) * near;
  return slope;
}

/// Slope at point i of a smooth table of at least three points; `at(i)` gives their values.
template <class S, class At_>
CLUTCHWORK_INLINE S smooth_slope(const auto& axis, At_&& at, int i) {
  auto secant = [&](int k) { return (at(k + 1) - at(k)) / S(axis.width(k)); };
  const int last = axis.count - 1;
  if (i == 0) return end_slope<S>(secant(0), secant(1), axis.width(0), axis.width(1));
  if (i == last) return end_slope<S>(secant(last - 1), secant(last - 2), axis.width(last - 1), axis.width(last - 2));
  return inner_slope<S>(secant(i - 1), secant(i), axis.width(i - 1), axis.width(i));
}

/// Cubic through two values with the given slopes over s from 0 to 1, continued by its slopes.
template <class S>
CLUTCHWORK_INLINE S cubic(S low, S high, S slope_low, S slope_high, S s) {
  if (value(s) <= 0) return low + slope_low * s;
  if (value(s) >= 1) return high + slope_high * (s - S(1));
  const S r = S(1) - s;
  return low * r * r * (S(1) + S(2) * s) + high * s * s * (S(1) + S(2) * r) + s * r * (slope_low * r - slope_high * s);
}

/// Value at x of a table whose point i has the value at(i); `k` is the interval that counts.
template <class S, class At_>
CLUTCHWORK_INLINE S table_value(const auto& axis, const Manner& manner, At_&& at, S x, int k) {
  if (axis.count == 1) return at(0);
  const S low = at(k), high = at(k + 1), h = S(axis.width(k));
  const S s = (x - S(axis[k])) / h;
  if (!manner.smooth()) return low + (high - low) * s;
  return cubic(low, high, smooth_slope<S>(axis, at, k) * h, smooth_slope<S>(axis, at, k + 1) * h, s);
}

/// Value of a table over any quantity but the slip.
template <class S, class At_>
CLUTCHWORK_INLINE S value_over(const auto& axis, const Manner& manner, At_&& at, S x) {
  const S inside = within(axis, manner, x);
  return table_value<S>(axis, manner, at, inside, interval_of(axis, value(inside)));
}

/// Cells of a table over an input, which no step may run over: between its points, and beyond its ends where it bends
/// there. docs/theory/events.md, rule 12
template <class G>
struct Cells {
  enum Who : int { below, above };
  Axis<G> axis;
  Manner manner;

  int ends() const { return int(axis.count > 1 && (manner.kept() || manner.smooth())); }
  int borders() const { return axis.count < 2 ? 0 : axis.count - 2 + 2 * ends(); }
  G border(int i) const { return axis[i + 1 - ends()]; }
  /// Interval of the axis whose line or cubic holds in a cell.
  int interval(int cell) const {
    const int last = axis.count < 2 ? 0 : axis.count - 2, i = cell - ends();
    return i < 0 ? 0 : i > last ? last : i;
  }
  /// x, or the end whose value is kept in its cell.
  template <class S>
  S within(const S& x, int cell) const {
    if (!manner.kept()) return x;
    return cell <= 0 ? S(axis[0]) : cell >= borders() ? S(axis.last()) : x;
  }
  /// Watch both borders of a cell, over a scale.
  template <class S>
  void watch(const S& x, int cell, Real<G> scale, Least<S>& least) const {
    if (cell > 0 && cell <= borders()) least.watch((x - S(border(cell - 1))) / S(scale), below);
    if (cell >= 0 && cell < borders()) least.watch((S(border(cell)) - x) / S(scale), above);
  }
  /// The cell that holds x; of two the upper one.
  int cell_of(Real<G> x) const {
    int cell = 0;
    while (cell < borders() && x >= value(border(cell))) ++cell;
    return cell;
  }
  /// The cell behind a border, or the one beyond it that holds x where that has jumped.
  int next(int cell, int who, Real<G> x, Real<G> scale) const {
    const int to = cell + (who == above ? 1 : -1);
    return settled_interval(x, borders(), larger(to, 0), border_slack * scale, [&](int i) { return value(border(i)); });
  }
};

/// Law that sticks and whose coefficients are tables over the temperature, `cells` of its parameters over `warm`; its
/// pieces are numbered by the interval between kinks over the slip first.
template <class Law>
struct OverTemperature {
  // temperatures that are one [K]
  static constexpr double scale = 1e2;

  template <class P>
  static int cell(const P& p, int piece) {
    return piece / (Law::slips(p) + 1);
  }
  template <class P, class S>
  static S margin(const P& p, const At<S>& at, int& who) {
    Least<S> least(who);
    Law::cells(p, at.points).watch(Law::warm(at), cell(p, at.piece), scale, least);
    return least.margin();
  }
  template <class P, class T>
  static int cross(const P& p, const At<T>& at, int who, T*) {
    const int next = Law::cells(p, at.points).next(cell(p, at.piece), who, value(Law::warm(at)), scale);
    return number(p, at.piece, next);
  }
  template <class P, class T>
  static int settled(const P& p, const At<T>& at) {
    return number(p, at.piece, Law::cells(p, at.points).cell_of(value(Law::warm(at))));
  }
  template <class P>
  static bool turns(const P&, int) {
    return false;
  }

 private:
  template <class P>
  static int number(const P& p, int piece, int cell) {
    const int intervals = Law::slips(p) + 1;
    return piece % intervals + intervals * cell;
  }
};

/// How far x is inside the ends of an axis, round-off conceded; below zero outside.
template <class X>
CLUTCHWORK_INLINE X room_inside(const auto& axis, X x) {
  const X first = value(axis[0]), last = value(axis.last());
  return smaller(x - first, last - x) + roundoff<X>(1e-9, 1e-6) * (last - first);
}

/// The same for a slip, which passes zero: its table starts there.
template <class X>
CLUTCHWORK_INLINE X room_for_slip(const auto& axis, X slip) {
  return (1 + roundoff<X>(1e-9, 1e-6)) * value(axis.last()) - abs(slip);
}

/// No kink there.
inline constexpr double nowhere = 1e300;

/// Slip at which a table that is continued linearly beyond its end falls to zero.
template <class G, class At_>
CLUTCHWORK_INLINE G vanishing_slip(const Axis<G>& axis, const Manner& manner, At_&& at) {
  const int last = axis.count - 1;
  if (last < 1) return G(nowhere);
  const G secant = (at(last) - at(last - 1)) / axis.width(last - 1);
  const G slope = manner.smooth() ? smooth_slope<G>(axis, at, last) : secant;
  return value(slope) < 0 ? axis.last() - at(last) / slope : G(nowhere);
}

/// Kinks of a table over the slip: its inner points, where a smooth one changes its curvature and no step may run over
/// what lies between them, its ends where it keeps their values, and where its continuation falls to zero.
template <class G>
struct Kinks {
  Axis<G> axis;
  Manner manner;
  bool falls = false;  ///< whether the table ends at zero, once there
  G zero = G(nowhere);

  int inner() const { return axis.count < 3 ? 0 : axis.count - 2; }
  int ends() const { return int(manner.kept() && axis.count > 1); }
  int zeros() const { return int(falls && manner.extrapolation == choice::Extrapolation::linear); }
  int count() const { return inner() + 2 * ends() + zeros(); }
  G at(int i) const {
    // an end at zero is no kink, for slips are not below
    if (ends() > 0 && i == 0) return value(axis[0]) > 0 ? axis[0] : G(-nowhere);
    i -= ends();
    if (i < inner()) return axis[i + 1];
    return ends() > 0 ? axis.last() : zero;
  }
};

/// Value over a slip on one of the pieces between the kinks.
template <class S, class At_>
CLUTCHWORK_INLINE S slip_value(const auto& kinks, At_&& at, S slip, int piece) {
  const auto& axis = kinks.axis;
  if (kinks.ends() > 0 && piece == 0) return at(0);
  if (kinks.ends() > 0 && piece == kinks.count()) return at(axis.count - 1);
  if (kinks.zeros() > 0 && piece == kinks.count()) return S(0);
  return table_value<S>(axis, kinks.manner, at, slip, piece - kinks.ends());
}

/// Law with one table of the kinetic coefficient over the slip, `kinetic` of its parameters.
template <class Law>
struct SlipTable {
  template <class P, class G>
  static Kinks<G> kinks(const P& p, const G* points) {
    const auto axis = axis_of(p.kinetic, points);
    return {axis, Law::manner(p), true, vanishing_slip(axis, Law::manner(p), [&](int i) { return axis.x[3 * i + 1]; })};
  }
  template <class P, class S>
  static S slide(const P& p, const At<S>& at) {
    const auto axis = axis_of(p.kinetic, at.points);
    return slip_value<S>(
        Kinks{axis, Law::manner(p), true}, [&](int i) { return S(axis.x[3 * i + 1]); }, at.rate, at.piece);
  }
  template <class P, class T>
  static T hold(const P& p, const At<T>&) {
    return p.static_;
  }
  /// Below zero where the table is left, which `seen` did.
  template <class P, class T>
  static T outside(const P& p, const At<T>& at, T& seen) {
    seen = at.rate;
    if (Law::manner(p).extrapolation != choice::Extrapolation::error) return T(1);
    return T(room_for_slip(axis_of(p.kinetic, at.points), value(at.rate)));
  }
  template <class P>
  static int edges(const P& p) {
    return Kinks<double>{Axis<double>{nullptr, int(value(p.kinetic.count))}, Law::manner(p), true}.count();
  }
  template <class P>
  static auto edge(const P& p, const auto* points, int i) {
    return kinks(p, points).at(i);
  }
};

/// A friction coefficient never drives.
template <class S>
CLUTCHWORK_INLINE S not_negative(S coefficient) {
  return larger(coefficient, S(0));
}

}  // namespace clutchwork

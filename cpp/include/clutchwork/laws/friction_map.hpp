#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::laws {

/// Static coefficient over the temperature, kinetic coefficient over temperature and slip. docs/theory/clutches.md
struct FrictionMap : OverTemperature<FrictionMap>, declared::FrictionMap {
  template <class T>
  struct Params : Tabulated<T> {
    Curve<T> temperatures;  ///< K
    Curve<T> speeds;        ///< rad/s
    Curve<T> static_;       ///< 1, one for each temperature
    Curve<T> kinetic;       ///< 1, a row over the speeds for each temperature
  };

  /// Whether the sizes of the tables belong together.
  template <class T>
  static bool fits(const Params<T>& p) {
    const double rows = value(p.temperatures.count), columns = value(p.speeds.count);
    return rows >= 2 && columns >= 2 && value(p.static_.count) == rows && value(p.kinetic.count) == rows * columns;
  }
  template <class T>
  static Manner manner(const Params<T>& p) {
    return Manner(p);
  }
  /// Slope between two secants, differentiable by both, within what keeps the cubic monotone; zero at a peak.
  template <class S>
  static S gentle_slope(S before, S after) {
    if (value(before * after) <= 0) return S(0);
    const S square = before * after;
    return S(2) * square * square / (before * before * before + after * after * after);
  }
  template <class S>
  static const S& warm(const At<S>& at) {
    return at.input[Input::temperature];
  }
  /// Kinks over the slip.
  template <class T>
  static int slips(const Params<T>& p) {
    return edges(p);
  }
  template <class T, class G>
  static Cells<G> cells(const Params<T>& p, const G* points) {
    return {axis_of(p.temperatures, points), manner(p)};
  }
  /// Value over the temperature of what has the value row(i) at temperature i, as in a cell.
  template <class T, class S, class Row>
  static S over_temperature(const Params<T>& p, const At<S>& at, int cell, Row&& row) {
    const auto table = cells(p, at.points);
    const auto axis = table.axis;
    const S x = table.within(warm(at), cell);
    const int k = table.interval(cell);
    const S low = row(k), high = row(k + 1), s = (x - S(axis[k])) / S(axis.width(k));
    if (!manner(p).smooth()) return not_negative(low + (high - low) * s);
    // slopes per interval; those at the ends are the secants
    const S here = high - low, h = S(axis.width(k));
    const S from = k > 0 ? gentle_slope((low - row(k - 1)) / S(axis.width(k - 1)), here / h) * h : here;
    const S to = k + 2 < axis.count ? gentle_slope(here / h, (row(k + 2) - high) / S(axis.width(k + 1))) * h : here;
    return not_negative(cubic(low, high, from, to, s));
  }
  template <class T, class S>
  static S slide(const Params<T>& p, const At<S>& at) {
    const auto speeds = axis_of(p.speeds, at.points), all = axis_of(p.kinetic, at.points);
    const int slip = at.piece % (slips(p) + 1);
    return over_temperature(p, at, cell(p, at.piece), [&](int i) {
      auto kinetic = [&](int j) { return S(all[i * speeds.count + j]); };
      return slip_value<S>(Kinks{speeds, manner(p)}, kinetic, at.rate, slip);
    });
  }
  /// The kinetic coefficient is a floor: continued far enough, the lines of a table may cross.
  template <class T>
  static T hold(const Params<T>& p, const At<T>& at) {
    const auto speeds = axis_of(p.speeds, at.points), all = axis_of(p.kinetic, at.points);
    const auto own = axis_of(p.static_, at.points);
    const int here = cells(p, at.points).cell_of(value(warm(at)));
    const T still = over_temperature(p, at, here, [&](int i) { return T(own[i]); });
    const T sliding = over_temperature(p, at, here, [&](int i) {
      auto kinetic = [&](int j) { return T(all[i * speeds.count + j]); };
      return value_over<T>(speeds, manner(p), kinetic, T(0));
    });
    return larger(still, sliding);
  }
  /// Wherever it starts to slip.
  template <class T>
  static int settle(const Params<T>& p, const At<T>& at) {
    return settled(p, at);
  }
  /// Below zero where the map is left, which `seen` did: the slip [rad/s] or the temperature [K].
  template <class T>
  static T outside(const Params<T>& p, const At<T>& at, T& seen) {
    seen = at.rate;
    if (manner(p).extrapolation != choice::Extrapolation::error) return T(1);
    const auto slip = room_for_slip(axis_of(p.speeds, at.points), value(at.rate));
    const auto temperature = room_inside(axis_of(p.temperatures, at.points), value(warm(at)));
    if (temperature < slip) seen = warm(at);
    return T(smaller(slip, temperature));
  }

  template <class T>
  static int edges(const Params<T>& p) {
    return Kinks<double>{Axis<double>{nullptr, int(value(p.speeds.count))}, manner(p)}.count();
  }
  template <class T>
  static auto edge(const Params<T>& p, const auto* points, int i) {
    return Kinks{axis_of(p.speeds, points), manner(p)}.at(i);
  }
};

}  // namespace clutchwork::laws

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::laws {

/// Both coefficients over the temperature as tables. docs/theory/clutches.md
struct TemperatureTable : OverTemperature<TemperatureTable>, declared::TemperatureTable {
  template <class T>
  struct Params : Tabulated<T> {
    Curve<T> static_;  ///< K -> 1
    Curve<T> kinetic;  ///< K -> 1
  };

  template <class S>
  static const S& warm(const At<S>& at) {
    return at.input[Input::temperature];
  }
  /// Kinks over the slip.
  template <class T>
  static int slips(const Params<T>&) {
    return 0;
  }
  template <class T, class G>
  static Cells<G> cells(const Params<T>& p, const G* points) {
    return {axis_of(p.kinetic, points), Manner(p)};
  }
  template <class T, class S>
  static S slide(const Params<T>& p, const At<S>& at) {
    const auto table = cells(p, at.points);
    const int k = cell(p, at.piece);
    const S x = table.within(warm(at), k);
    auto kinetic = [&](int i) { return S(table.axis.x[3 * i + 1]); };
    return not_negative(table_value<S>(table.axis, table.manner, kinetic, x, table.interval(k)));
  }
  template <class T>
  static T over(const Params<T>& p, const Curve<T>& curve, const At<T>& at) {
    const auto axis = axis_of(curve, at.points);
    auto coefficient = [&](int i) { return T(axis.x[3 * i + 1]); };
    return not_negative(value_over<T>(axis, Manner(p), coefficient, warm(at)));
  }
  /// The kinetic coefficient is a floor: continued far enough, the lines of a table may cross.
  template <class T>
  static T hold(const Params<T>& p, const At<T>& at) {
    return larger(over(p, p.static_, at), over(p, p.kinetic, at));
  }
  /// Wherever it starts to slip.
  template <class T>
  static int settle(const Params<T>& p, const At<T>& at) {
    return settled(p, at);
  }
  /// Below zero where the table is left, which `seen` did.
  template <class T>
  static T outside(const Params<T>& p, const At<T>& at, T& seen) {
    seen = warm(at);
    if (Manner(p).extrapolation != choice::Extrapolation::error) return T(1);
    return T(room_inside(axis_of(p.static_, at.points), value(seen)));
  }
};

}  // namespace clutchwork::laws

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::laws {

/// Both coefficients over the temperature as tables. docs/theory/clutches.md
struct TemperatureTable : declared::TemperatureTable {
  template <class T>
  struct Params : Tabulated<T> {
    Curve<T> static_;  ///< K -> 1
    Curve<T> kinetic;  ///< K -> 1
  };

  template <class T, class S>
  static S over(const Params<T>& p, const Curve<T>& curve, const At<S>& at) {
    const auto axis = axis_of(curve, at.points);
    auto coefficient = [&](int i) { return S(axis.x[3 * i + 1]); };
    return not_negative(value_over<S>(axis, Manner(p), coefficient, at.input[Input::temperature]));
  }
  template <class T, class S>
  static S slide(const Params<T>& p, const At<S>& at) {
    return over(p, p.kinetic, at);
  }
  /// The kinetic coefficient is a floor: continued far enough, the lines of a table may cross.
  template <class T>
  static T hold(const Params<T>& p, const At<T>& at) {
    return larger(over(p, p.static_, at), over(p, p.kinetic, at));
  }
  /// Below zero where the table is left, which `seen` did.
  template <class T>
  static T outside(const Params<T>& p, const At<T>& at, T& seen) {
    seen = at.input[Input::temperature];
    if (Manner(p).extrapolation != choice::Extrapolation::error) return T(1);
    return T(room_inside(axis_of(p.static_, at.points), value(seen)));
  }
};

}  // namespace clutchwork::laws

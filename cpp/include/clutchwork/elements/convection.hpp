#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Heat convection whose conductance is a table over abs(speed), constant beyond its ends. docs/theory/thermal.md
struct Convection : declared::Convection {
  template <class T>
  struct Params {
    Curve<T> conductance;  ///< rad/s -> W/K
  };

  /// Heat flow from the first to the second node [W]; inputs: their temperatures [K], the speed [rad/s].
  template <class T, class S>
  static S flow(const Params<T>& p, const At<S>& at) {
    return (at.input[Input::hot] - at.input[Input::cold]) * over(p, at.points, abs(at.input[Input::speed]));
  }

 private:
  template <class T, class S>
  static S over(const Params<T>& p, const auto* points, S speed) {
    const int first = int(value(p.conductance.first)), last = first + int(value(p.conductance.count)) - 1;
    if (value(speed) <= points[3 * first]) return S(points[3 * first + 1]);
    if (value(speed) >= points[3 * last]) return S(points[3 * last + 1]);
    int piece = 0;
    while (points[3 * (first + piece + 1)] < value(speed)) ++piece;
    return curve_value(p.conductance, points, speed, piece);
  }
};

}  // namespace clutchwork::elements

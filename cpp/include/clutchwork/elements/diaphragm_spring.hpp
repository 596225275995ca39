#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Clamp force over the travel of the release bearing, which follows the pedal. docs/theory/clutches.md
struct DiaphragmSpring : declared::DiaphragmSpring {
  template <class T>
  struct Params {
    Curve<T> force;                                ///< m -> N
    T ratio;                                       ///< [1]
    T free_travel;                                 ///< [m]
    T wear_ratio;                                  ///< [1]
    T lag;                                         ///< [s]
    Word<T, choice::Interpolation> interpolation;  ///< [1]
  };

  /// Force at the present travel [N]; wear takes the fingers towards the bearing.
  template <class T, class S>
  static S wanted(const Params<T>& p, const At<S>& at) {
    const auto axis = axis_of(p.force, at.points);
    const Manner manner{p.interpolation, choice::Extrapolation::nearest};
    const S pressed =
        larger(p.ratio * at.input[Input::travel] - p.free_travel, S(0)) + p.wear_ratio * at.input[Input::wear];
    auto force = [&](int i) { return S(axis.x[3 * i + 1]); };
    return value_over<S>(axis, manner, force, pressed);
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    rates[0] = (wanted(p, at) - at.state[0]) / p.lag;
  }
};

}  // namespace clutchwork::elements

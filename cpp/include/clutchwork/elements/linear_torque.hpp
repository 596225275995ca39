#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Torque linear in speed: odd in the speed, or even when it acts in the same direction at all speeds.
struct LinearTorque : declared::LinearTorque {
  template <class T>
  struct Params {
    T nominal_torque;  ///< [N m]
    T nominal_speed;   ///< [rad/s]
    T same_direction;  ///< [1]
  };
  static constexpr bool lanes = true;

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    const S x = at.rate / p.nominal_speed;
    const auto positive = p.nominal_speed > T(0);
    const auto flip = p.same_direction != T(0) && (at.piece == 0 ? positive : !positive);
    return select(flip, -(p.nominal_torque * x), p.nominal_torque * x);
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}

  template <class T>
  static int edges(const Params<T>& p) {
    return common(p.same_direction) != 0 ? 1 : 0;
  }
  template <class T>
  static double edge(const Params<T>&, const double*, int) {
    return 0.0;
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/stribeck_curve.hpp>

namespace clutchwork::laws {

/// Bristles that bend and slip; the state is the elastic part of the coefficient, stiffness times deflection.
struct LuGre {
  template <class T>
  struct Params : StribeckCurve<T> {
    T stiffness;  ///< [1/rad]
    T damping;    ///< [s/rad]
  };
  static constexpr int states = 1;

  /// Rate of the deflection [rad/s].
  template <class T, class S>
  static S bending(const Params<T>& p, const At<S>& at) {
    return at.rate - abs(at.rate) * at.state[0] / sliding_level(p, at.rate);
  }
  template <class T, class S>
  static S coefficient(const Params<T>& p, const At<S>& at) {
    return at.state[0] + p.damping * bending(p, at) + p.viscous * at.rate;
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    rates[0] = p.stiffness * bending(p, at);
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }
};

}  // namespace clutchwork::laws

#pragma once
#include <clutchwork/components/stribeck_curve.hpp>

namespace clutchwork::laws {

/// Rate-independent elastic-plastic friction; its state is the coefficient itself.
struct Dahl : declared::Dahl {
  template <class T>
  struct Params {
    T kinetic;    ///< [1]
    T stiffness;  ///< [1/rad]
    T exponent;   ///< [1]
  };

  template <class T, class S>
  static S coefficient(const Params<T>&, const At<S>& at) {
    return at.state[0];
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const T along = T(value(at.rate) < 0 ? -1 : 1);
    const S left = S(1) - at.state[0] * along / p.kinetic;
    const T side = T(value(left) < 0 ? -1 : 1);
    rates[0] = p.stiffness * at.rate * power_of_size(left, p.exponent) * side;
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.kinetic;
  }
};

}  // namespace clutchwork::laws

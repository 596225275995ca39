#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Linear spring; its state is the spring torque [N m].
struct Spring : declared::Spring {
  template <class T>
  struct Params {
    T stiffness;      ///< [N m/rad]
    T initial_twist;  ///< [rad]
  };
  static constexpr bool lanes = true, linear = true;

  template <class T, class S>
  static S torque(const Params<T>&, const At<S>& at) {
    return -at.state[0];
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    rates[0] = p.stiffness * at.rate;
  }
};

}  // namespace clutchwork::elements

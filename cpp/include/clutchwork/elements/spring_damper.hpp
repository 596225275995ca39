#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Linear spring and damper in parallel; its state is the spring torque [N m]. docs/theory/reduction.md
struct SpringDamper : declared::SpringDamper {
  template <class T>
  struct Params {
    T stiffness;      ///< [N m/rad]
    T damping;        ///< [N m s/rad]
    T initial_twist;  ///< [rad]
  };
  static constexpr bool lanes = true, linear = true;

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    return -(at.state[0] + p.damping * at.rate);
  }
  template <class T, class S>
  static S heat(const Params<T>& p, const At<S>& at) {
    return p.damping * at.rate * at.rate;
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    rates[0] = p.stiffness * at.rate;
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Linear viscous damper.
struct Damper : declared::Damper {
  template <class T>
  struct Params {
    T damping;  ///< [N m s/rad]
  };
  static constexpr bool lanes = true, linear = true;

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    return -(p.damping * at.rate);
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}
};

}  // namespace clutchwork::elements

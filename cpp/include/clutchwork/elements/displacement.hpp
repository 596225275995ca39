#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Angle or distance as a state, without torque.
struct Displacement : declared::Displacement {
  template <class T>
  struct Params {};

  template <class T, class S>
  static S torque(const Params<T>&, const At<S>&) {
    return S(0);
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>& at, S* rates) {
    rates[position] = at.rate;
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Torque over time.
struct Torque : declared::Torque {
  template <class T>
  struct Params {};
  static constexpr bool lanes = true, linear = true;

  template <class T, class S>
  static S torque(const Params<T>&, const At<S>& at) {
    return at.input[Input::torque];
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}
};

}  // namespace clutchwork::elements

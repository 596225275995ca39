#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Torque over time.
struct Torque {
  template <class T>
  struct Params {};
  static constexpr int states = 0;
  static constexpr int inputs = 1;

  template <class T, class S>
  static S torque(const Params<T>&, const At<S>& at) {
    return at.input[0];
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}
};

}  // namespace clutchwork::elements

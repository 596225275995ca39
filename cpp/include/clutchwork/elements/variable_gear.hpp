#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Rigid gear whose ratio is an input.
struct VariableGear : declared::VariableGear {
  template <class T>
  struct Params {};

  template <class T, class S>
  static S ratio(const Params<T>&, const At<S>& at) {
    return at.input[Input::ratio];
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}
};

}  // namespace clutchwork::elements

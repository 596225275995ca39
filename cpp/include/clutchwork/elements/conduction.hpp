#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Heat conduction between two thermal nodes. docs/theory/thermal.md
struct Conduction : declared::Conduction {
  template <class T>
  struct Params {
    T conductance;  ///< [W/K]
  };

  /// Heat flow from the first to the second node [W]; inputs: their temperatures [K].
  template <class T, class S>
  static S flow(const Params<T>& p, const At<S>& at) {
    return (at.input[Input::hot] - at.input[Input::cold]) * p.conductance;
  }
};

}  // namespace clutchwork::elements

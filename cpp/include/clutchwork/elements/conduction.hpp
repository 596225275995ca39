#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Heat conduction between two thermal nodes. docs/theory/thermal.md
struct Conduction {
  template <class T>
  struct Params {
    T conductance;  ///< [W/K]
  };
  static constexpr int states = 0;
  static constexpr int inputs = 2;

  /// Heat flow from the first to the second node [W]; inputs: their temperatures [K].
  template <class T, class S>
  static S flow(const Params<T>& p, const At<S>& at) {
    return (at.input[0] - at.input[1]) * p.conductance;
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Depth of wear by the energy of sliding. docs/theory/clutches.md
struct Wear {
  template <class T>
  struct Params {
    T rate;           ///< [m3/J]
    T area;           ///< [m2]
    T initial_depth;  ///< [m]
  };
  static constexpr int states = 1;
  static constexpr int inputs = 1;

  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    rates[0] = p.rate / p.area * larger(at.input[0], S(0));
  }
};

}  // namespace clutchwork::elements

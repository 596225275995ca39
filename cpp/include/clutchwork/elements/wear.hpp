#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Wear by the energy of sliding, which is the state [J]; a joule is worth rate/area of depth. docs/theory/clutches.md
/// (8)
struct Wear : declared::Wear {
  template <class T>
  struct Params {
    T rate;           ///< [m3/J]
    T area;           ///< [m2]
    T initial_depth;  ///< [m]
  };

  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>& at, S* rates) {
    rates[0] = larger(at.input[Input::heat], S(0));
  }
};

}  // namespace clutchwork::elements

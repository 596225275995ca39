#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Crank, rod and slider without mass. docs/theory/varying-ratios.md (15)
struct CrankSlider : declared::CrankSlider {
  template <class T>
  struct Params {
    T radius;  ///< [m]
    T rod;     ///< [m]
  };

  template <class T, class S>
  static S ratio(const Params<T>& p, const At<S>& at) {
    const S side = S(p.radius) * sin(at.state[angle]), along = S(p.radius) * cos(at.state[angle]);
    return -side - side * along / sqrt(S(p.rod * p.rod) - side * side);
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>& at, S* rates) {
    rates[angle] = at.rates[Way::shaft];
  }
};

}  // namespace clutchwork::elements

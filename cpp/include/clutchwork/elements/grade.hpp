#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Weight on a slope, and the height that it climbs. docs/theory/vehicle.md (1)
struct Grade : declared::Grade {
  template <class T>
  struct Params {
    T weight;  ///< [N]
  };

  /// Sine of the angle whose tangent is the slope.
  template <class T, class S>
  static S sine(const At<S>& at) {
    const S slope = at.input[Input::slope];
    return slope / sqrt(S(T(1)) + slope * slope);
  }
  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    return -(p.weight * sine<T>(at));
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>& at, S* rates) {
    rates[0] = at.rate * sine<T>(at);
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Force of masses that a shaft throws outwards against springs, with a small lag; below zero they rest.
struct Flyweights : declared::Flyweights {
  template <class T>
  struct Params {
    T mass;    ///< [kg]
    T radius;  ///< [m]
    T onset;   ///< [rad/s]
    T lag;     ///< [s]
  };

  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const S speed = at.input[Input::speed];
    const S force = p.mass * p.radius * (speed * speed - S(p.onset * p.onset));
    rates[0] = (force - at.state[0]) / p.lag;
  }
};

}  // namespace clutchwork::elements

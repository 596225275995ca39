#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Eddy-current brake whose resistance rises with the temperature. docs/theory/sources.md (1)
struct EddyCurrentBrake : declared::EddyCurrentBrake {
  template <class T>
  struct Params {
    T nominal_torque;           ///< [N m]
    T nominal_speed;            ///< [rad/s]
    T temperature_coefficient;  ///< [1/K]
    T reference_temperature;    ///< [K]
  };
  static constexpr bool lanes = true;

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    const S warmer = at.input[Input::temperature] - S(p.reference_temperature);
    const S resistance = S(1) + p.temperature_coefficient * warmer;
    // without resistance its peak is at rest, and nothing is left beyond that
    return choose(
        value(resistance) > 0,
        [&] {
          const S x = at.rate / (p.nominal_speed * resistance);
          return p.nominal_torque * x * T(-2) / (S(1) + x * x);
        },
        [] { return S(0); });
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Load that opposes the motion, smoothed around standstill.
struct ResistingTorque : declared::ResistingTorque {
  template <class T>
  struct Params {
    T speed;  ///< [rad/s]
  };
  static constexpr bool lanes = true;

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    // beyond 20 the hyperbolic tangent is one to the last bit
    const S x = at.rate / p.speed;
    return choose(
        x > S(20), [&] { return -at.input[Input::torque]; },
        [&] {
          return choose(
              x < S(-20), [&] { return at.input[Input::torque]; },
              [&] { return -(at.input[Input::torque] * tanh(x)); });
        });
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Drag of an open wet pack: it rises with the speed to a peak and falls beyond it. docs/theory/clutches.md
struct WetDrag : declared::WetDrag {
  template <class T>
  struct Params {
    T peak;   ///< [N m]
    T speed;  ///< [rad/s]
  };
  static constexpr bool lanes = true;

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    const S x = at.rate / p.speed;
    return at.input[Input::scale] * p.peak * x * T(-2) / (S(1) + x * x);
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}
};

}  // namespace clutchwork::elements

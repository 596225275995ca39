#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::laws {

/// Coefficient that falls exponentially with slip.
struct Exponential : declared::Exponential {
  template <class T>
  struct Params {
    T static_;  ///< [1]
    T slow;     ///< [1]
    T fast;     ///< [1]
    T speed;    ///< [rad/s]
  };
  static constexpr bool lanes = true;

  template <class T, class S>
  static S slide(const Params<T>& p, const At<S>& at) {
    // the floor keeps a trial point far behind the crossing finite
    const S x = larger(at.rate / p.speed, S(-20));
    return p.fast + (p.slow - p.fast) * exp(-x);
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }
};

}  // namespace clutchwork::laws

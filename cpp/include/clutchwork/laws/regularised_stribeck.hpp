#pragma once
#include <clutchwork/components/stribeck_curve.hpp>

namespace clutchwork::laws {

/// Stribeck curve with its jump smoothed: it creeps under any load.
struct RegularisedStribeck : declared::RegularisedStribeck {
  template <class T>
  struct Params : StribeckCurve<T> {
    T width;  ///< [rad/s]
  };

  template <class T, class S>
  static S coefficient(const Params<T>& p, const At<S>& at) {
    return stribeck(p, at.rate) * tanh(at.rate / p.width) + p.viscous * at.rate;
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }
};

}  // namespace clutchwork::laws

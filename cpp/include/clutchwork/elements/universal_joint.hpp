#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Cardan joint. docs/theory/varying-ratios.md (14)
struct UniversalJoint : declared::UniversalJoint {
  template <class T>
  struct Params {
    T bend_angle;  ///< [rad]
  };

  template <class T, class S>
  static S ratio(const Params<T>& p, const At<S>& at) {
    const T s = sin(p.bend_angle);
    const S c = cos(at.state[angle]);
    return S(cos(p.bend_angle)) / (S(T(1)) - S(s * s) * c * c);
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>& at, S* rates) {
    rates[angle] = at.rates[Way::base];
  }
};

}  // namespace clutchwork::elements

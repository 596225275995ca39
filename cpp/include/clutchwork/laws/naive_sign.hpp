#pragma once
#include <clutchwork/components/stribeck_curve.hpp>

namespace clutchwork::laws {

/// Stribeck curve times the sign of the slip, without a state of rest: shows how solvers stall.
struct NaiveSign : declared::NaiveSign {
  template <class T>
  struct Params : StribeckCurve<T> {};
  static constexpr bool chatters = true;

  template <class T, class S>
  static S coefficient(const Params<T>& p, const At<S>& at) {
    const auto slip = value(at.rate);
    return stribeck(p, at.rate) * T(slip > 0 ? 1 : slip < 0 ? -1 : 0) + p.viscous * at.rate;
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }
};

}  // namespace clutchwork::laws

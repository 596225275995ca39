#pragma once
#include <clutchwork/components/stribeck_curve.hpp>

namespace clutchwork::laws {

/// Stribeck curve times the sign of the slip, without a state of rest: shows how solvers stall. Slip that is round-off
/// of what others hold at rest has no sign.
struct NaiveSign : declared::NaiveSign {
  template <class T>
  struct Params : StribeckCurve<T> {};
  static constexpr bool chatters = true;
  static constexpr double least_slip = 1e-15;  ///< [rad/s]

  template <class T, class S>
  static S coefficient(const Params<T>& p, const At<S>& at) {
    const auto slip = value(at.rate);
    return stribeck(p, at.rate) * T(slip > least_slip ? 1 : slip < -least_slip ? -1 : 0) + p.viscous * at.rate;
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }
};

}  // namespace clutchwork::laws

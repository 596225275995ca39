#pragma once
#include <clutchwork/stribeck_curve.hpp>

namespace clutchwork::laws {

/// Stribeck curve with exact sticking.
struct Stribeck {
  template <class T>
  struct Params : StribeckCurve<T> {};
  static constexpr int states = 0;

  template <class T, class S>
  static S slide(const Params<T>& p, const At<S>& at) {
    return stribeck_forward(p, at.rate) + p.viscous * at.rate;
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }
};

}  // namespace clutchwork::laws

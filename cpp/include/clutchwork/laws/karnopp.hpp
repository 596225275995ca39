#pragma once
#include <clutchwork/components/stribeck_curve.hpp>

namespace clutchwork::laws {

/// Dead band of slip in which the static coefficient acts; it locks as soon as the slip falls to the band.
struct Karnopp : declared::Karnopp {
  template <class T>
  struct Params : StribeckCurve<T> {
    T band;  ///< [rad/s]
  };

  template <class T, class S>
  static S slide(const Params<T>& p, const At<S>& at) {
    if (at.piece == 0) return S(p.static_);
    return stribeck_forward(p, at.rate) + p.viscous * at.rate;
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }
  template <class T>
  static int edges(const Params<T>& p) {
    return stribeck_reach(p) > value(p.band) ? 2 : 1;
  }
  template <class T>
  static T edge(const Params<T>& p, const double*, int i) {
    return i == 0 ? p.band : T(stribeck_reach(p));
  }
};

}  // namespace clutchwork::laws

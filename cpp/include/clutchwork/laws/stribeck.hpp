#pragma once
#include <clutchwork/components/stribeck_curve.hpp>

namespace clutchwork::laws {

/// Stribeck curve with exact sticking.
struct Stribeck : declared::Stribeck {
  template <class T>
  struct Params : StribeckCurve<T> {};
  static constexpr bool lanes = true;

  template <class T, class S>
  static S slide(const Params<T>& p, const At<S>& at) {
    return stribeck_forward(p, at.rate) + p.viscous * at.rate;
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }
  template <class T>
  static int edges(const Params<T>&) {
    return 1;
  }
  template <class T>
  static Real<T> edge(const Params<T>& p, const auto*, int) {
    return stribeck_reach(p);
  }
};

}  // namespace clutchwork::laws

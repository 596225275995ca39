#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::laws {

/// Coefficient over slip as a table, continued linearly beyond its end.
struct CoefficientTable {
  template <class T>
  struct Params {
    T static_;         ///< [1]
    Curve<T> kinetic;  ///< rad/s -> 1
  };
  static constexpr int states = 0;

  template <class T, class S>
  static S slide(const Params<T>& p, const At<S>& at) {
    return curve_value(p.kinetic, at.points, at.rate, at.piece);
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }

  template <class T>
  static int edges(const Params<T>& p) {
    return curve_edges(p.kinetic);
  }
  template <class T>
  static double edge(const Params<T>& p, const double* points, int i) {
    return curve_edge(p.kinetic, points, i);
  }
};

}  // namespace clutchwork::laws

#pragma once
#include <clutchwork/interpolation.hpp>

namespace clutchwork::laws {

/// Kinetic coefficient over slip as a table. docs/theory/clutches.md
struct FrictionTable {
  template <class T>
  struct Params : Tabulated<T> {
    T static_;         ///< [1]
    Curve<T> kinetic;  ///< rad/s -> 1
  };
  static constexpr int states = 0;

  template <class T>
  static Manner manner(const Params<T>& p) {
    return Manner(p);
  }
  template <class T, class S>
  static S slide(const Params<T>& p, const At<S>& at) {
    const Axis axis = axis_of(p.kinetic, at.points);
    auto kinetic = [&](int i) { return S(axis.x[3 * i + 1]); };
    return not_negative(slip_value<S>(axis, manner(p), kinetic, at.rate, at.piece));
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }
  /// Below zero where the table is left, which `seen` did.
  template <class T>
  static T outside(const Params<T>& p, const At<T>& at, T& seen) {
    seen = at.rate;
    if (manner(p).extrapolation != Extrapolation::error) return T(1);
    return T(room_for_slip(axis_of(p.kinetic, at.points), value(at.rate)));
  }

  template <class T>
  static int edges(const Params<T>& p) {
    return Kinks{Axis{nullptr, int(value(p.kinetic.count))}, manner(p)}.count();
  }
  template <class T>
  static double edge(const Params<T>& p, const double* points, int i) {
    return Kinks{axis_of(p.kinetic, points), manner(p)}.at(i);
  }
};

}  // namespace clutchwork::laws

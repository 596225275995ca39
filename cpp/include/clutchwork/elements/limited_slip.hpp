#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/bound.hpp>

namespace clutchwork::elements {

/// Differential with friction between its sides: preload and a share of the torque of the carrier.
struct LimitedSlip : declared::LimitedSlip {
  template <class T>
  struct Params {
    T preload;  ///< [N m]
    T drive;    ///< [1]
    T coast;    ///< [1]
  };
  static constexpr bool one_way = false;

  template <class T, class S>
  static S load(const Params<T>&, const At<S>&) {
    return S(1);
  }
  /// The gear row puts minus half the torque of the carrier on each side: docs/theory/load-dependent.md (5)
  template <class T, class S>
  static Bound<S> bound(const Params<T>& p, const At<S>&, int) {
    return {{S(p.drive * T(-2)), S(p.coast * T(2))}, {S(p.preload), S(p.preload)}};
  }
  template <class T>
  static bool steady(const Params<T>&) {
    return true;
  }
};

}  // namespace clutchwork::elements

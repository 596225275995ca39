#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Freewheel that rolls over above a torque; its drag is the load.
struct SpragClutch : declared::SpragClutch {
  template <class T>
  struct Params {
    T holding;  ///< [N m]
    T drag;     ///< [N m]
  };
  static constexpr bool one_way = true;

  template <class T, class S>
  static S load(const Params<T>& p, const At<S>&) {
    return S(p.drag);
  }
  template <class T>
  static T holding(const Params<T>& p) {
    return p.holding;
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Freewheel that blocks negative slip, with a friction clutch in parallel.
struct OneWayClutch {
  template <class T>
  struct Params {
    T gain;  ///< [m3]
  };
  static constexpr int states = 0;
  static constexpr int inputs = 1;
  static constexpr bool one_way = true;

  template <class T, class S>
  static S load(const Params<T>& p, const At<S>& at) {
    return p.gain * at.input[0];
  }
};

}  // namespace clutchwork::elements

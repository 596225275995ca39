#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Friction clutch: load = gain * pressure (or normal force).
struct Clutch : declared::Clutch {
  template <class T>
  struct Params {
    T gain;  ///< [m3]
  };
  static constexpr bool lanes = true;
  static constexpr bool one_way = false;

  template <class T, class S>
  static S load(const Params<T>& p, const At<S>& at) {
    return p.gain * at.input[Input::pressure];
  }
};

}  // namespace clutchwork::elements

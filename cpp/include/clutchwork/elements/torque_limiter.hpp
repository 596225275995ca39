#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Clutch of constant load.
struct TorqueLimiter {
  template <class T>
  struct Params {
    T torque;  ///< [N m]
  };
  static constexpr int states = 0;
  static constexpr int inputs = 0;
  static constexpr bool one_way = false;

  template <class T, class S>
  static S load(const Params<T>& p, const At<S>&) {
    return S(p.torque);
  }
};

}  // namespace clutchwork::elements

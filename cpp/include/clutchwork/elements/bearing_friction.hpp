#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Friction of a bearing: constant load.
struct BearingFriction : declared::BearingFriction {
  template <class T>
  struct Params {
    T torque;  ///< [N m]
  };
  static constexpr bool lanes = true;
  static constexpr bool one_way = false;

  template <class T, class S>
  static S load(const Params<T>& p, const At<S>&) {
    return S(p.torque);
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Rolling resistance: pressed onto the road by the weight. docs/theory/vehicle.md (3)
struct RollingResistance : declared::RollingResistance {
  template <class T>
  struct Params {
    T weight;  ///< [N]
  };
  static constexpr bool one_way = false;

  template <class T, class S>
  static S load(const Params<T>& p, const At<S>& at) {
    const S slope = at.input[Input::slope];
    return p.weight / sqrt(S(T(1)) + slope * slope);
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Heat carried away by a flow of oil. docs/theory/thermal.md
struct OilFlow {
  template <class T>
  struct Params {
    T heat_capacity;  ///< [J/(kg K)]
  };
  static constexpr int states = 0;
  static constexpr int inputs = 3;

  /// Heat flow from the node to the inlet [W]; inputs: their temperatures [K], the flow of oil [kg/s].
  template <class T, class S>
  static S flow(const Params<T>& p, const At<S>& at) {
    const S carried = value(at.input[2]) > 0 ? at.input[2] : S(0);
    return (at.input[0] - at.input[1]) * carried * p.heat_capacity;
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Heat carried away by a flow of oil. docs/theory/thermal.md
struct OilFlow : declared::OilFlow {
  template <class T>
  struct Params {
    T heat_capacity;  ///< [J/(kg K)]
  };

  /// Heat flow from the node to the inlet [W]; inputs: their temperatures [K], the flow of oil [kg/s].
  template <class T, class S>
  static S flow(const Params<T>& p, const At<S>& at) {
    const S carried = value(at.input[Input::flow]) > 0 ? at.input[Input::flow] : S(0);
    return (at.input[Input::hot] - at.input[Input::inlet]) * carried * p.heat_capacity;
  }
};

}  // namespace clutchwork::elements

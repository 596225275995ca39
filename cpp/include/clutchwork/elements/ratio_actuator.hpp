#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Ratio that follows its command with a lag.
struct RatioActuator : declared::RatioActuator {
  template <class T>
  struct Params {
    T lag;  ///< [s]
  };

  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    rates[0] = (at.input[Input::command] - at.state[0]) / p.lag;
  }
};

}  // namespace clutchwork::elements

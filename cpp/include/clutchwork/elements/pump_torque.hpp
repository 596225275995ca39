#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/oil.hpp>

namespace clutchwork::elements {

/// Torque that a pump takes from its shaft. docs/theory/hydraulics.md (11)
struct PumpTorque : declared::PumpTorque {
  template <class T>
  struct Params {
    T displacement;  ///< [m3]
    T efficiency;    ///< [1]
    T drag;          ///< [N m s/rad]
    T slow;          ///< [rad/s]
  };

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    const S drop = at.input[Input::outlet] - at.input[Input::inlet];
    const S ideal = pump_per_radian(p.displacement) * pump_filling(at.input[Input::inlet]) * drop;
    return -ideal - pump_friction(p.efficiency, p.slow, ideal, at.rate) - p.drag * at.rate;
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/oil.hpp>

namespace clutchwork::elements {

/// Torque that a pump takes from its shaft; its friction has a kink where the pressure difference passes zero.
/// docs/theory/hydraulics.md (11)
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
    const S ideal = pump_per_radian(p.displacement) * pump_filling(at.input[Input::inlet]) * difference(at);
    return -ideal - pump_friction(p.efficiency, p.slow, at.piece, ideal, at.rate) - p.drag * at.rate;
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}

  template <class T, class S>
  static S margin(const Params<T>&, const At<S>& at, int& who) {
    return pump_margin(at.piece, at.input[Input::outlet], at.input[Input::inlet], who);
  }
  template <class T>
  static int cross(const Params<T>&, const At<T>& at, int who, T*) {
    return who == turned ? at.piece : at.piece == falling ? rising : falling;
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }
  template <class T>
  static int settle(const Params<T>&, const At<T>& at) {
    const auto u = value(difference(at));
    const auto slack = value(pump_slack(at.input[Input::outlet], at.input[Input::inlet]));
    if (abs(u) <= slack) return at.piece;
    return u < 0 ? falling : rising;
  }

 private:
  template <class S>
  static S difference(const At<S>& at) {
    return at.input[Input::outlet] - at.input[Input::inlet];
  }
};

}  // namespace clutchwork::elements

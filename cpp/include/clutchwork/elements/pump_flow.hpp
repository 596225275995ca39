#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/oil.hpp>

namespace clutchwork::elements {

/// Oil that a pump delivers, and where the work of its shaft goes. docs/theory/hydraulics.md (10), (12)
struct PumpFlow : declared::PumpFlow {
  template <class T>
  struct Params {
    T displacement;  ///< [m3]
    T efficiency;    ///< [1]
    T drag;          ///< [N m s/rad]
    T slow;          ///< [rad/s]
    T leakage;       ///< [m3]
  };

  template <class T, class S>
  static S drop(const Params<T>&, const At<S>& at) {
    return at.input[Input::outlet] - at.input[Input::inlet];
  }
  template <class T, class S>
  static S lost_flow(const Params<T>& p, const At<S>& at) {
    return p.leakage * drop(p, at) / (at.input[Input::density] * at.input[Input::viscosity]);
  }
  template <class T, class S>
  static S per_radian(const Params<T>& p, const At<S>& at) {
    return pump_per_radian(p.displacement) * pump_filling(at.input[Input::inlet]);
  }
  template <class T, class S>
  static S flow(const Params<T>& p, const At<S>& at) {
    return per_radian(p, at) * at.input[Input::speed] - lost_flow(p, at);
  }
  template <class T, class S>
  static void drawn(const Params<T>& p, const At<S>& at, S* flows) {
    flows[int(Input::inlet)] = flow(p, at);
    flows[int(Input::outlet)] = -flows[int(Input::inlet)];
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const S u = drop(p, at), w = at.input[Input::speed];
    const S friction = pump_friction(p.efficiency, p.slow, at.piece, per_radian(p, at) * u, w) + p.drag * w;
    rates[energy] = flow(p, at) * u;
    rates[loss] = lost_flow(p, at) * u + friction * w;
  }

  template <class T, class S>
  static S margin(const Params<T>&, const At<S>& at, int& who) {
    return pump_margin(at.piece, at.input[Input::outlet], at.input[Input::inlet], who);
  }
  template <class T>
  static int cross(const Params<T>&, const At<T>& at, int, T*) {
    return at.piece == falling ? rising : falling;
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/oil.hpp>

namespace clutchwork::elements {

/// Valve that opens above a pressure, or above a command that it follows. docs/theory/hydraulics.md (7)
struct ReliefValve : declared::ReliefValve {
  template <class T>
  struct Params {
    T discharge;   ///< [1]
    T transition;  ///< [1]
    T span;        ///< [Pa]
    T area;        ///< [m2]
    T lag;         ///< [s]
    T clearance;   ///< [1]
  };

  template <class T, class S>
  static S flow(const Params<T>& p, const At<S>& at) {
    const OilNow<S> oil{at.input[Input::density], at.input[Input::viscosity]};
    const S inlet = at.input[Input::inlet], way = (inlet - T(bar) * at.state[setting]) / p.span;
    const S area = p.area * uncovered(smaller(way, S(1)), p.clearance);
    return opening_flow(area, p.discharge, p.transition, oil, inlet - at.input[Input::outlet]);
  }
  template <class T, class S>
  static void drawn(const Params<T>& p, const At<S>& at, S* flows) {
    flows[int(Input::inlet)] = flow(p, at);
    flows[int(Input::outlet)] = -flows[int(Input::inlet)];
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    rates[setting] = (at.input[Input::command] / T(bar) - at.state[setting]) / p.lag;
    rates[loss] = flow(p, at) * (at.input[Input::inlet] - at.input[Input::outlet]);
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/oil.hpp>

namespace clutchwork::elements {

/// Flow through an orifice. docs/theory/hydraulics.md (2), (3)
struct Orifice : declared::Orifice {
  template <class T>
  struct Params {
    T discharge;   ///< [1]
    T transition;  ///< [1]
    T area;        ///< [m2]
  };

  template <class T, class S>
  static S flow(const Params<T>& p, const At<S>& at) {
    const OilNow<S> oil{at.input[Input::density], at.input[Input::viscosity]};
    return opening_flow(S(p.area), p.discharge, p.transition, oil, at.input[Input::inlet] - at.input[Input::outlet]);
  }
  template <class T, class S>
  static void drawn(const Params<T>& p, const At<S>& at, S* flows) {
    flows[int(Input::inlet)] = flow(p, at);
    flows[int(Input::outlet)] = -flows[int(Input::inlet)];
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    rates[loss] = flow(p, at) * (at.input[Input::inlet] - at.input[Input::outlet]);
  }
};

}  // namespace clutchwork::elements

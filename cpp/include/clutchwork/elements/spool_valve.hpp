#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/oil.hpp>

namespace clutchwork::elements {

/// Spool between supply, clutch and exhaust, which a pilot pressure moves against the pressure of the clutch.
/// docs/theory/hydraulics.md (6), (8)
struct SpoolValve : declared::SpoolValve {
  template <class T>
  struct Params {
    T discharge;     ///< [1]
    T transition;    ///< [1]
    T supply_area;   ///< [m2]
    T exhaust_area;  ///< [m2]
    T span;          ///< [Pa]
    T spring;        ///< [Pa]
    T feedback;      ///< [1]
    T overlap;       ///< [1]
    T clearance;     ///< [1]
    T lag;           ///< [s]
  };

  /// Flows from the supply into the clutch, and out of it.
  template <class S>
  struct Flows {
    S in, out, in_drop, out_drop;

    template <class T>
    Flows(const Params<T>& p, const At<S>& at) {
      const OilNow<S> oil{at.input[Input::density], at.input[Input::viscosity]};
      const S held = at.input[Input::clutch];
      const S force = T(bar) * at.state[pilot] - p.spring - p.feedback * held;
      const S way = larger(smaller(force / p.span, S(1)), S(-1));
      const T left = T(1) / (T(1) - p.overlap);
      const S fills = p.supply_area * uncovered((way - p.overlap) * left, p.clearance);
      const S empties = p.exhaust_area * uncovered((-way - p.overlap) * left, p.clearance);
      in_drop = at.input[Input::supply] - held, out_drop = held - at.input[Input::exhaust];
      in = opening_flow(fills, p.discharge, p.transition, oil, in_drop);
      out = opening_flow(empties, p.discharge, p.transition, oil, out_drop);
    }
  };

  template <class T, class S>
  static void drawn(const Params<T>& p, const At<S>& at, S* flows) {
    const Flows<S> now(p, at);
    flows[int(Input::supply)] = now.in;
    flows[int(Input::clutch)] = now.out - now.in;
    flows[int(Input::exhaust)] = -now.out;
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const Flows<S> now(p, at);
    rates[pilot] = (at.input[Input::command] / T(bar) - at.state[pilot]) / p.lag;
    rates[loss] = now.in * now.in_drop + now.out * now.out_drop;
  }
};

}  // namespace clutchwork::elements

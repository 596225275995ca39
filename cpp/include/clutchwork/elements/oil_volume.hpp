#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/oil.hpp>

namespace clutchwork::elements {

/// Oil between valves, compressed by what flows in. docs/theory/hydraulics.md (4), (5)
struct OilVolume : declared::OilVolume {
  template <class T>
  struct Params {
    T volume;        ///< [m3]
    T bulk_modulus;  ///< [Pa]
    T air;           ///< [1]
  };

  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const S now = T(bar) * at.state[pressure], flow = at.input[Input::gathered] + at.input[Input::inflow];
    const S around = now + T(ambient);
    const S softness = S(T(1) / p.bulk_modulus) + S(p.air * T(ambient)) / (around * around);
    rates[pressure] = flow / (p.volume * softness * T(bar));
    rates[energy] = now * flow;
  }
};

}  // namespace clutchwork::elements

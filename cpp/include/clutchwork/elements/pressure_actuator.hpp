#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Piston that fills, then follows its command. The state is the pressure on the plates; below zero it stands for the
/// volume that is still to be filled. docs/theory/clutches.md
struct PressureActuator : declared::PressureActuator {
  template <class T>
  struct Params {
    T lag;            ///< [s]
    T fill_time;      ///< [s]
    T fill_pressure;  ///< [Pa]
    T spring;         ///< [Pa]
    T rise;           ///< [Pa/s]
    T fall;           ///< [Pa/s]
  };

  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const S pressure = larger(at.state[0], S(0)), empty = S(-p.fill_time * p.fill_pressure / p.lag);
    const S wanted = (at.input[Input::command] - p.spring - pressure) / p.lag;
    // limits of the rate hold for the pressure, not for the volume
    const bool fills = value(at.state[0]) < 0;
    const S within = fills ? wanted : larger(smaller(wanted, S(p.rise)), S(-p.fall));
    // the piston rests when it is back
    rates[0] = larger(within, (empty - at.state[0]) / p.lag);
  }
};

}  // namespace clutchwork::elements

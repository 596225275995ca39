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

  // where the pressure has limits of its rate, the rate jumps when the piston is full
  enum Piece : int { pressed, filling };

  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const bool fills = is_limited(p) ? at.piece == filling : value(at.state[0]) < 0;
    const S pressure = fills ? S(0) : larger(at.state[0], S(0)), empty = S(-p.fill_time * p.fill_pressure / p.lag);
    const S wanted = (at.input[Input::command] - p.spring - pressure) / p.lag;
    // limits of the rate hold for the pressure, not for the volume
    const S within = fills ? wanted : larger(smaller(wanted, S(p.rise)), S(-p.fall));
    // the piston rests when it is back
    rates[0] = larger(within, (empty - at.state[0]) / p.lag);
  }
  /// What is left of the pressure, or of the volume that is to be filled.
  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    who = at.piece == filling ? pressed : filling;
    if (!is_limited(p)) return S(1);
    return (at.piece == filling ? -at.state[0] : at.state[0]) / p.fill_pressure;
  }
  template <class T>
  static int cross(const Params<T>&, const At<T>&, int who, T*) {
    return who;
  }

 private:
  template <class T>
  static bool is_limited(const Params<T>& p) {
    constexpr double none = 1e15;
    return value(p.rise) < none || value(p.fall) < none;
  }
};

}  // namespace clutchwork::elements

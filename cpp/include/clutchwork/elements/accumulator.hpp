#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/oil.hpp>

namespace clutchwork::elements {

/// Oil against a gas or a spring. docs/theory/hydraulics.md (9)
struct Accumulator : declared::Accumulator {
  template <class T>
  struct Params {
    Word<T, choice::Against> against;  ///< [1]
    T precharge;                       ///< [Pa]
    T capacity;                        ///< [m3]
    T exponent;                        ///< [1]
    T rate;                            ///< [Pa/m3]
    T volume;                          ///< [m3]
    T bulk_modulus;                    ///< [Pa]
  };
  enum Piece : int { empty, charging, full };

  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const S now = T(bar) * at.state[pressure], flow = at.input[Input::gathered] + at.input[Input::inflow];
    S softness = S(p.volume / p.bulk_modulus);
    // with some air in an empty one, as in an `OilVolume`, no pressure falls below vacuum
    if (at.piece == empty) softness += p.volume * T(air * ambient) / ((now + T(ambient)) * (now + T(ambient)));
    if (at.piece == charging && p.against == choice::Against::spring) softness += S(T(1) / p.rate);
    if (at.piece == charging && p.against == choice::Against::gas) {
      const S absolute = now + T(ambient),
              gas = p.capacity * exp(log(S(p.precharge + T(ambient)) / absolute) / p.exponent);
      softness += gas / (p.exponent * absolute);
    }
    rates[pressure] = flow / (softness * T(bar));
    rates[energy] = now * flow;
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    const S above = at.state[pressure] - p.precharge / T(bar);
    const bool spring = p.against == choice::Against::spring;
    const S below = spring ? S((p.precharge + p.rate * p.capacity) / T(bar)) - at.state[pressure] : S(1e300);
    // what stands on an edge at the start is a little inside
    const S slack = S(1e-9);
    if (at.piece == empty) return who = charging, slack - above;
    if (at.piece == full) return who = charging, slack - below;
    who = value(above) < value(below) ? empty : full;
    return (value(above) < value(below) ? above : below) + slack;
  }
  template <class T>
  static int cross(const Params<T>&, const At<T>&, int who, T*) {
    return who;
  }

  static constexpr double air = 0.005;  ///< share of the oil
};

}  // namespace clutchwork::elements

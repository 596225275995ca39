#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Piston behind an orifice. The state is the force on the plates, below zero the way that is left to them.
/// docs/theory/actuators.md (2) to (5)
struct ClutchActuator : declared::ClutchActuator {
  template <class T>
  struct Params {
    T orifice_area;      ///< [m2]
    T piston_area;       ///< [m2]
    T preload;           ///< [N]
    T spring_rate;       ///< [N/m]
    T kiss_stroke;       ///< [m]
    T contact_rate;      ///< [N/m]
    T seal_friction;     ///< [N]
    T discharge;         ///< [1]
    T density;           ///< [kg/m3]
    T laminar_pressure;  ///< [Pa]
    T volume;            ///< [m3]
    T bulk_modulus;      ///< [Pa]
  };
  // a piece is what the piston does, beyond the kiss point four more; without friction it goes both ways alike
  enum Motion : int { stopped, stuck, out, back };
  static Motion motion(int piece) { return Motion(piece & 3); }
  static bool kissed(int piece) { return (piece & 4) != 0; }

  template <class T, class S>
  static S stroke(const Params<T>& p, const At<S>& at) {
    return S(p.kiss_stroke) + at.state[force] / p.contact_rate;
  }
  /// Force of the springs on the piston, and their stiffness.
  template <class T, class S>
  static S springs(const Params<T>& p, const At<S>& at) {
    const S both = S(p.preload) + p.spring_rate * stroke(p, at);
    return kissed(at.piece) ? both + at.state[force] : both;
  }
  template <class T>
  static T stiffness(const Params<T>& p, int piece) {
    return kissed(piece) ? p.spring_rate + p.contact_rate : p.spring_rate;
  }
  /// Pressure at which the piston moves outwards, and back.
  template <class T, class S>
  static S lifting(const Params<T>& p, const At<S>& at) {
    return (springs(p, at) + S(p.seal_friction)) / p.piston_area;
  }
  template <class T, class S>
  static S falling(const Params<T>& p, const At<S>& at) {
    return (springs(p, at) - S(p.seal_friction)) / p.piston_area;
  }
  template <class T, class S>
  static S flow(const Params<T>& p, S u) {
    // a square root without a laminar part has no slope where it ends: below 1 Pa it is a line
    const T laminar = larger(p.laminar_pressure, T(1));
    return p.discharge * p.orifice_area * sqrt(T(2) / p.density) * u / sqrt(sqrt(u * u + laminar * laminar));
  }
  /// Pressure on a piston that does not move: that of the supply, unless oil must be compressed first.
  template <class T, class S>
  static S resting_pressure(const Params<T>& p, const At<S>& at) {
    return value(p.volume) > 0 ? at.state[pressure] : at.input[Input::supply_pressure];
  }

  /// Flow into the piston: of one that rests what compresses its oil.
  template <class T, class S>
  static S inflow(const Params<T>& p, const At<S>& at) {
    const Motion now = motion(at.piece);
    const S supply = at.input[Input::supply_pressure];
    if (now == out || now == back) return flow(p, supply - moving_pressure(p, at));
    return value(p.volume) > 0 ? flow(p, supply - at.state[pressure]) : S(0);
  }
  template <class T, class S>
  static S moving_pressure(const Params<T>& p, const At<S>& at) {
    return motion(at.piece) == out ? lifting(p, at) : falling(p, at);
  }
  template <class T, class S>
  static void drawn(const Params<T>& p, const At<S>& at, S* flows) {
    flows[int(Input::supply_pressure)] = inflow(p, at);
  }

  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const Motion now = motion(at.piece);
    const S supply = at.input[Input::supply_pressure], filling = inflow(p, at);
    if (now == stopped || now == stuck) {
      rates[force] = S(0);
      const S missing = supply - at.state[pressure];
      // what is seen of a pressure that follows at once
      rates[pressure] = value(p.volume) > 0 ? filling * p.bulk_modulus / p.volume : missing / T(1e-4);
      rates[loss] = filling * missing;
      return;
    }
    const T rate = stiffness(p, at.piece);
    const S speed = filling / (p.piston_area + p.volume / p.bulk_modulus * rate / p.piston_area);
    rates[force] = p.contact_rate * speed;
    rates[pressure] = rate / p.piston_area * speed;
    const S rubs = S(p.seal_friction) * (now == out ? speed : -speed);
    rates[loss] = filling * (supply - moving_pressure(p, at)) + rubs;
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    S least = S(1e300);
    S change = S(0);
    auto watch = [&](const S& guard, int number) {
      change += guard - plain_of(guard);
      if (value(guard) < value(least)) least = plain_of(guard), who = number;
    };
    const Motion now = motion(at.piece);
    const S way = stroke(p, at) / p.kiss_stroke, supply = at.input[Input::supply_pressure];
    const bool rubs = value(p.seal_friction) > 0;
    const T unit = T(1e5);
    // at the start it may be anywhere
    if (now == stopped && value(way) > 1e-9) return watch(S(1e-9) - way, leaves), least + change;
    if (now == stopped || now == stuck)
      watch(held_by(p, at, lifting(p, at) - resting_pressure(p, at), 1) / unit, lifts);
    if (now == stuck) watch(held_by(p, at, resting_pressure(p, at) - falling(p, at), -1) / unit, falls);
    if (now == out && rubs) watch((supply - lifting(p, at)) / unit, sticks);
    if (now == back) watch((falling(p, at) - supply) / unit, sticks);
    if (now == back || (now == out && !rubs)) watch(way, stops);
    if (now != stopped)
      watch((kissed(at.piece) ? at.state[force] : -at.state[force]) / (p.contact_rate * p.kiss_stroke), kisses);
    return least + change;
  }
  /// How far a piston at rest is from moving one way, by what its own pressure lacks: that follows the supply, and
  /// moves nothing before the supply could. docs/theory/actuators.md
  template <class T, class S>
  static S held_by(const Params<T>& p, const At<S>& at, const S& lacking, int way) {
    // more than it may be beyond by the tolerance of a step was there from the start: that moves the piston at once
    constexpr double at_once = 1e3;
    if (!(value(p.volume) > 0) || value(lacking) < -at_once) return lacking;
    const S ahead = T(way) * (resting_pressure(p, at) - at.input[Input::supply_pressure]);
    return value(ahead) > 0 ? lacking + ahead : lacking;
  }
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T* state) {
    const int side = at.piece & 4;
    const bool rubs = value(p.seal_friction) > 0;
    switch (who) {
      case lifts:
        return state[pressure] = lifting(p, at), side | out;
      case falls:
        return state[pressure] = falling(p, at), side | back;
      case leaves:
        return side | (rubs ? stuck : out);
      case sticks:
        return side | stuck;
      case stops:
        return state[force] = -p.contact_rate * p.kiss_stroke, int(stopped);
      default:
        return at.piece ^ 4;
    }
  }

 private:
  enum Who : int { lifts, falls, leaves, sticks, stops, kisses };
};

}  // namespace clutchwork::elements

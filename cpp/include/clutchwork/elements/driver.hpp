#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Proportional and integral control of two pedals. docs/theory/vehicle.md (7)
struct Driver : declared::Driver {
  template <class T>
  struct Params {
    T gain;           ///< [s/m]
    T integral_gain;  ///< [1/m]
    T lag;            ///< [s]
  };
  // a piece is what the foot does, plus four where the integral is held at its upper end, eight at the lower one
  enum Foot : int { brakes_fully, brakes, drives, drives_fully };
  static constexpr int upper = 4, lower = 8;

  template <class T, class S>
  static S error(const At<S>& at) {
    return at.input[Input::cycle] - at.input[Input::speed];
  }
  template <class T, class S>
  static S wanted(const Params<T>& p, const At<S>& at) {
    return p.gain * error<T>(at) + at.state[integral];
  }

  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const int foot = at.piece & 3;
    const S u = wanted(p, at);
    const S forward = foot == drives ? u : S(foot == drives_fully ? 1 : 0);
    const S against = foot == brakes ? -u : S(foot == brakes_fully ? 1 : 0);
    rates[throttle] = (forward - at.state[throttle]) / p.lag;
    rates[brake] = (against - at.state[brake]) / p.lag;
    rates[integral] = at.piece < upper ? p.integral_gain * error<T>(at) : S(0);
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    S least = S(1e300);
    S change = S(0);
    auto watch = [&](const S& guard, int number) {
      change += guard - plain_of(guard);
      if (value(guard) < value(least)) least = plain_of(guard), who = number;
    };
    const int foot = at.piece & 3;
    const S u = wanted(p, at), sum = at.state[integral];
    // on the border between the pedals where it goes tells: the other one stays released, to the last bit
    if constexpr (requires { u.d; }) {
      const auto slope = value(u.d[0]);
      if (value(u) == 0 && foot == brakes && slope > 0) return who = rises, S(-1e-300) + u;
      if (value(u) == 0 && foot == drives && slope < 0) return who = sinks, S(-1e-300) + u;
    }
    if (foot < drives_fully) watch(S(foot - 1) - u, rises);
    if (foot > brakes_fully) watch(u - S(foot - 2), sinks);
    if (at.piece < upper) {
      watch(S(1) - sum, tops);
      watch(sum + S(1), bottoms);
    } else {
      watch(at.piece < lower ? error<T>(at) : -error<T>(at), leaves);
    }
    return least + change;
  }
  template <class T>
  static int cross(const Params<T>&, const At<T>& at, int who, T* state) {
    const int foot = at.piece & 3;
    if (who == rises) return at.piece + (foot < drives_fully ? 1 : 0);
    if (who == sinks) return at.piece - (foot > brakes_fully ? 1 : 0);
    if (who == leaves) return foot;
    state[integral] = T(who == tops ? 1 : -1);
    return foot | (who == tops ? upper : lower);
  }

 private:
  enum Who : int { rises, sinks, tops, bottoms, leaves };
};

}  // namespace clutchwork::elements

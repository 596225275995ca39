#pragma once
#include <clutchwork/components/maxwell_slip.hpp>

namespace clutchwork::laws {

/// Hysteresis with non-local memory from Maxwell-slip elements; the states are the coefficients of the elements.
struct Leuven : declared::Leuven {
  static constexpr bool fixed_steps = false;  ///< bristles change within any step

  template <class T>
  struct Params : StribeckCurve<T> {
    Curve<T> elements;  ///< rad -> 1
    T order;            ///< [1]
    T damping;          ///< [s/rad]
  };
  static_assert(states == most_elements);
  // an element has left its limit when it is so far inside; the Stribeck level may push it back and forth
  static constexpr double slack = 1e-7;

  /// Whether an element slides against the slip, where the level fell below the hysteresis.
  static bool slides_back(int piece, int i) { return element_slides(piece, most_elements + i); }

  template <class T>
  static int count(const Params<T>& p) {
    return element_count(p.elements);
  }
  /// Rate of the deflection over the slip: 1 unloaded, 0 where the hysteresis reaches the level.
  template <class T, class S>
  static S share(const Params<T>& p, const At<S>& at) {
    const S ratio = element_sum(at.state, count(p)) / sliding_level(p, at.rate);
    const T side = T((value(at.rate) < 0) != (value(ratio) < 0) ? -1 : 1);
    return S(1) - power_of_size(ratio, p.order) * side;
  }
  template <class T, class S>
  static S coefficient(const Params<T>& p, const At<S>& at) {
    return element_sum(at.state, count(p)) + p.damping * at.rate * share(p, at) + p.viscous * at.rate;
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const S left = share(p, at), bending = at.rate * left;
    for (int i = 0; i < count(p); ++i) {
      const T stiffness =
          p.static_ * T(element_share(p.elements, at.points, i) / element_deflection(p.elements, at.points, i));
      // one that slides stays at its limit until the slip turns, or leaves it where the deflection runs back
      const bool inward = (value(left) < 0) != slides_back(at.piece, i);
      rates[i] = element_slides(at.piece, i) && !inward ? S(0) : stiffness * bending;
    }
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }

  /// How far an element is from the coefficient at which it slides, over that coefficient.
  template <class T, class S>
  static S room(const Params<T>& p, const At<S>& at, int i) {
    return S(1) - abs(at.state[i]) / (p.static_ * T(element_share(p.elements, at.points, i)));
  }
  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    S least = S(1);
    for (int i = 0; i < count(p); ++i) {
      const S left = element_slides(at.piece, i) ? S(slack) - room(p, at, i) : room(p, at, i);
      if (left < least) least = left, who = i;
    }
    return least;
  }
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T* state) {
    if (who == turned) return 0;
    const int against = 1 << (most_elements + who);
    if (element_slides(at.piece, who)) return at.piece & ~(1 << who | against);
    const T side = T(value(state[who]) < 0 ? -1 : 1);
    state[who] = side * p.static_ * T(element_share(p.elements, at.points, who));
    return at.piece | 1 << who | ((value(at.rate) < 0) != (value(side) < 0) ? against : 0);
  }
  /// Whether an element slides with the slip.
  static bool runs_on(int piece, int i) { return element_slides(piece, i) && !slides_back(piece, i); }
  template <class T>
  static bool turns(const Params<T>&, int piece) {
    return piece != 0;
  }
};

}  // namespace clutchwork::laws

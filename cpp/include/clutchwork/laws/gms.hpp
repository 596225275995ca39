#pragma once
#include <clutchwork/components/maxwell_slip.hpp>

namespace clutchwork::laws {

/// Generalised Maxwell-slip: elements in parallel that stick and slip, each with its share of the Stribeck curve; the
/// states are their coefficients.
struct GMS : declared::GMS {
  static constexpr bool fixed_steps = false;  ///< bristles change within any step

  template <class T>
  struct Params : StribeckCurve<T> {
    Curve<T> elements;  ///< rad -> 1
    T attraction;       ///< [1/s]
    T damping;          ///< [s/rad]
  };
  static_assert(states == most_elements);
  // an element on its way back is below its limit when it is so far inside
  static constexpr double slack = 1e-7;

  /// Whether an element sticks beyond the limit, which fell below it, and is on its way back.
  static bool returns(int piece, int i) { return element_slides(piece, most_elements + i); }

  template <class T>
  static int count(const Params<T>& p) {
    return element_count(p.elements);
  }
  template <class T, class S>
  static S coefficient(const Params<T>& p, const At<S>& at) {
    return element_sum(at.state, count(p)) + (p.viscous + p.damping * sticking_share(p, at)) * at.rate;
  }
  /// Sum of the shares of the elements that stick, whose deflection follows the slip.
  template <class T, class S>
  static T sticking_share(const Params<T>& p, const At<S>& at) {
    T sum = T(0);
    for (int i = 0; i < count(p); ++i) {
      if (!element_slides(at.piece, i)) sum += T(element_share(p.elements, at.points, i));
    }
    return sum;
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const S level = sliding_level(p, at.rate);
    for (int i = 0; i < count(p); ++i) {
      const T share = T(element_share(p.elements, at.points, i));
      if (element_slides(at.piece, i)) {
        const T side = T(value(at.state[i]) < 0 ? -1 : 1);
        rates[i] = p.attraction * (side * share - at.state[i] / level);
      } else {
        rates[i] = p.static_ * share / T(element_deflection(p.elements, at.points, i)) * at.rate;
      }
    }
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }

  /// How far an element is from the coefficient at which it slides, over that coefficient.
  template <class T, class S>
  static S room(const Params<T>& p, const At<S>& at, int i) {
    return S(1) - abs(at.state[i]) / (T(element_share(p.elements, at.points, i)) * sliding_level(p, at.rate));
  }
  /// The same for one on its way back, on the side that it comes from: it may cross its whole range within a step.
  template <class T, class S>
  static S way_back(const Params<T>& p, const At<S>& at, int i) {
    const S side = S(value(at.rate) > 0 ? -1 : 1);
    return S(1) - side * at.state[i] / (T(element_share(p.elements, at.points, i)) * sliding_level(p, at.rate));
  }
  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    S least = S(1);
    for (int i = 0; i < count(p); ++i) {
      if (element_slides(at.piece, i)) continue;
      const S left = returns(at.piece, i) ? S(slack) - way_back(p, at, i) : room(p, at, i);
      if (left < least) least = left, who = i;
    }
    return least;
  }
  template <class T>
  static int cross(const Params<T>&, const At<T>& at, int who, T* state) {
    if (who == turned) return 0;
    const int back = 1 << (most_elements + who);
    if (returns(at.piece, who)) return at.piece & ~back;
    // only the slip toward its limit breaks an element loose
    return at.piece | ((value(at.rate) < 0) == (value(state[who]) < 0) ? 1 << who : back);
  }
  /// Whether an element slides and is not on its way back.
  static bool runs_on(int piece, int i) { return element_slides(piece, i) && !returns(piece, i); }
  template <class T>
  static bool turns(const Params<T>&, int piece) {
    return piece != 0;
  }
};

}  // namespace clutchwork::laws

#pragma once
#include <clutchwork/maxwell_slip.hpp>

namespace clutchwork::laws {

/// Generalised Maxwell-slip: elements in parallel that stick and slip, each with its share of the Stribeck curve; the
/// states are their coefficients.
struct GMS {
  template <class T>
  struct Params : StribeckCurve<T> {
    Curve<T> elements;  ///< rad -> 1
    T attraction;       ///< [1/s]
  };
  static constexpr int states = most_elements;

  template <class T>
  static int count(const Params<T>& p) {
    return element_count(p.elements);
  }
  template <class T, class S>
  static S coefficient(const Params<T>& p, const At<S>& at) {
    return element_sum(at.state, count(p)) + p.viscous * at.rate;
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

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    S least = S(1);
    const S level = sliding_level(p, at.rate);
    const T along = T(value(at.rate) < 0 ? -1 : 1);
    for (int i = 0; i < count(p); ++i) {
      if (element_slides(at.piece, i)) continue;
      const S room = S(1) - along * at.state[i] / (T(element_share(p.elements, at.points, i)) * level);
      if (room < least) least = room, who = i;
    }
    return least;
  }
  template <class T>
  static int cross(const Params<T>&, const At<T>& at, int who, T*) {
    return who == turned ? 0 : at.piece | 1 << who;
  }
  template <class T>
  static bool turns(const Params<T>&, int piece) {
    return piece != 0;
  }
};

}  // namespace clutchwork::laws

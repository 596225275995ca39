#pragma once
#include <clutchwork/components/stribeck_curve.hpp>

namespace clutchwork::laws {

/// Wind-up of the contact under a tanh, with the Stribeck fall on top; the state is the wind-up over the elastic angle.
struct Mykhalevych : declared::Mykhalevych {
  template <class T>
  struct Params {
    T static_;                     ///< [1]
    T kinetic;                     ///< [1]
    T elastic;                     ///< [rad]
    T speed;                       ///< [rad/s]
    T viscous;                     ///< [1]
    Word<T, choice::Reset> reset;  ///< [1]
    T range;                       ///< [1]
    T passive;                     ///< [1]
  };
  enum Piece : int { winding, full };

  template <class T, class S>
  static S coefficient(const Params<T>& p, const At<S>& at) {
    const S x = at.rate / p.speed, wound = tanh(at.state[0] + p.viscous * x), left = fading(x * x);
    if (value(p.passive) != 0) return (p.kinetic + (p.static_ - p.kinetic) * left) * wound;
    const T along = T(value(at.rate) < 0 ? -1 : 1);
    return p.static_ * wound - along * (p.static_ - p.kinetic) * (S(1) - left);
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    rates[0] = at.piece == full ? S(0) : at.rate / p.elastic;
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    who = 0;
    if (p.reset != choice::Reset::saturate || at.piece == full) return S(1);
    return S(1) - abs(at.state[0]) / p.range;
  }
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T* state) {
    const T side = T(value(state[0]) < 0 ? -1 : value(state[0]) > 0 ? 1 : 0);
    if (p.reset == choice::Reset::saturate) {
      if (who == turned) return winding;
      state[0] = side * p.range;
      return full;
    }
    if (p.reset == choice::Reset::literal || abs(value(state[0])) > 1) state[0] = side;
    return at.piece;
  }
  template <class T>
  static bool turns(const Params<T>& p, int piece) {
    return p.reset != choice::Reset::saturate || piece == full;
  }
};

}  // namespace clutchwork::laws

#pragma once
#include <clutchwork/components/stribeck_curve.hpp>

namespace clutchwork::laws {

/// Rate-independent elastic-plastic friction; its state is the coefficient itself.
struct Dahl : declared::Dahl {
  template <class T>
  struct Params {
    T kinetic;    ///< [1]
    T stiffness;  ///< [1/rad]
    T exponent;   ///< [1]
  };

  template <class T, class S>
  static S coefficient(const Params<T>&, const At<S>& at) {
    return at.state[0];
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    if (at.piece == full) {
      rates[0] = S(0);
      return;
    }
    const S left = room(p, at);
    const T side = T(value(left) < 0 ? -1 : 1);
    rates[0] = p.stiffness * at.rate * power_of_size(left, p.exponent) * side;
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.kinetic;
  }

  /// How far the bristles are from full, on the side that they come from; full ones, from what full is now.
  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    who = 0;
    if (!ends(p)) return S(1);
    if (at.piece == full) return S(slack) - abs(S(1) - abs(at.state[0]) / p.kinetic);
    return (at.piece == beyond ? -room(p, at) : room(p, at)) - S(nearest);
  }
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T* state) {
    if (who == turned) return bends;
    const auto left = value(room(p, At<T>{at.rate, state, at.input, at.piece, at.points}));
    if (at.piece == full || abs(left) > slack) return left > 0 ? bends : beyond;
    state[0] = value(state[0]) < 0 ? -p.kinetic : p.kinetic;
    return full;
  }
  template <class T>
  static bool turns(const Params<T>&, int piece) {
    return piece == full;
  }

 private:
  // with an exponent below 1 the bristles are full within a finite slip, and rest there until it turns
  enum Piece : int { bends, full, beyond };
  static constexpr double nearest = 1e-10, slack = 1e-7;

  template <class T>
  static bool ends(const Params<T>& p) {
    return value(p.exponent) < 1;
  }
  template <class T, class S>
  static S room(const Params<T>& p, const At<S>& at) {
    return S(1) - at.state[0] * T(value(at.rate) < 0 ? -1 : 1) / p.kinetic;
  }
};

}  // namespace clutchwork::laws

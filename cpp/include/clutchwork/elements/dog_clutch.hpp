#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Teeth that mesh when they are aligned and close to synchronous. docs/theory/clutches.md
struct DogClutch {
  template <class T>
  struct Params {
    T teeth;      ///< [1]
    T gap;        ///< [rad]
    T stiffness;  ///< [N m/rad]
    T damping;    ///< [s/rad]
    T speed;      ///< [rad/s]
    T reach;      ///< [1]
    T lag;        ///< [s]
    T pointed;    ///< [1]
    T reversed;   ///< [1]
  };
  enum State : int { angle, sleeve };
  // apart: the sleeve moves freely; blocked: tooth stands on tooth; then in mesh: no flank, one flank, the other
  enum Piece : int { apart, blocked, loose, ahead, behind };
  static constexpr int states = 2;
  static constexpr int inputs = 1;

  /// Where the sleeve is wanted: above `reach` the teeth are to mesh.
  template <class T, class S>
  static S command(const Params<T>& p, const At<S>& at) {
    return at.input[0] * T(value(p.reversed) != 0 ? -1 : 1);
  }
  /// Angle from the middle of the nearest gap [rad].
  template <class T, class S>
  static S off_centre(const Params<T>& p, const At<S>& at) {
    const double pitch = 6.283185307179586 / value(p.teeth);
    return at.state[angle] - S(pitch * std::nearbyint(value(at.state[angle]) / pitch));
  }
  /// How deep the flanks are pressed together [rad].
  template <class T, class S>
  static S depth(const Params<T>& p, const At<S>& at) {
    if (at.piece == ahead) return off_centre(p, at) - S(p.gap / T(2));
    if (at.piece == behind) return -off_centre(p, at) - S(p.gap / T(2));
    return S(0);
  }
  /// Torque that pushes the flanks apart, never negative.
  template <class T, class S>
  static S push(const Params<T>& p, const At<S>& at) {
    if (at.piece != ahead && at.piece != behind) return S(0);
    const S closing = at.piece == ahead ? at.rate : -at.rate;
    return larger(p.stiffness * depth(p, at) * (S(1) + p.damping * closing), S(0));
  }
  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    return at.piece == behind ? push(p, at) : -push(p, at);
  }
  /// Heat of the damped flanks [W].
  template <class T, class S>
  static S heat(const Params<T>& p, const At<S>& at) {
    if (at.piece != ahead && at.piece != behind) return S(0);
    const S closing = at.piece == ahead ? at.rate : -at.rate;
    return (push(p, at) - p.stiffness * larger(depth(p, at), S(0))) * closing;
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    rates[angle] = at.rate;
    const S wanted = larger(smaller(command(p, at), S(1)), S(0));
    rates[sleeve] = at.piece == blocked ? S(0) : (wanted - at.state[sleeve]) / p.lag;
  }

  /// Below zero: aligned and slow enough to mesh.
  template <class T, class S>
  static S misfit(const Params<T>& p, const At<S>& at) {
    const S fast = abs(at.rate) / p.speed - S(1);
    if (value(p.pointed) != 0) return fast;
    return larger(fast, abs(off_centre(p, at)) * T(2) / p.gap - S(1));
  }
  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    who = 0;
    if (at.piece == apart) return S(p.reach) - at.state[sleeve];
    if (at.piece == blocked) {
      const S leaves = command(p, at) - S(p.reach), fits = misfit(p, at);
      if (leaves < fits) return who = 1, leaves;
      return fits;
    }
    const S out = at.state[sleeve] - S(p.reach);
    const S flank = at.piece == loose ? S(1) - abs(off_centre(p, at)) * T(2) / p.gap : depth(p, at) * T(2) / p.gap;
    if (out < flank) return who = 1, out;
    return flank;
  }
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T* state) {
    if (at.piece == apart) {
      if (who == turned || value(misfit(p, at)) > 0) return who == turned ? apart : blocked;
      return mesh(p, state);
    }
    if (at.piece == blocked) {
      if (who == turned) return blocked;
      return who == 1 ? apart : mesh(p, state);
    }
    if (who == turned) return at.piece;
    if (who == 1) return apart;
    if (at.piece != loose) return loose;
    return value(off_centre(p, at)) > 0 ? ahead : behind;
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }

 private:
  /// Into mesh: pointed teeth find the middle of the gap by themselves.
  template <class T>
  static int mesh(const Params<T>& p, T* state) {
    if (value(p.pointed) != 0) state[angle] = T(0);
    return loose;
  }
};

}  // namespace clutchwork::elements

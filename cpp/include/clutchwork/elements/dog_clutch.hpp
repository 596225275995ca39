#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Teeth that mesh when they are aligned and close to synchronous. docs/theory/clutches.md
struct DogClutch : declared::DogClutch {
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
  // apart: the sleeve moves freely; fast: it is held back, the slip is too high; blocked: tooth stands on tooth; then
  // in mesh: no flank, one flank, the other, and these where they part faster than they spring back
  enum Piece : int { apart, fast, blocked, loose, ahead, behind, slack_ahead, slack_behind };

  template <class T>
  static Real<T> pitch(const Params<T>& p) {
    return 6.283185307179586 / value(p.teeth);
  }
  /// Where the sleeve is wanted: above `reach` the teeth are to mesh.
  template <class T, class S>
  static S command(const Params<T>& p, const At<S>& at) {
    return at.input[Input::command] * T(value(p.reversed) != 0 ? -1 : 1);
  }
  /// The flank that is met: 1, -1, or 0 for none.
  static int flank(int piece) {
    return piece == ahead || piece == slack_ahead ? 1 : piece == behind || piece == slack_behind ? -1 : 0;
  }
  /// How deep the flanks are pressed together [rad]; in mesh the angle is that from the middle of the gap.
  template <class T, class S>
  static S depth(const Params<T>& p, const At<S>& at) {
    return S(flank(at.piece)) * at.state[angle] - S(p.gap / T(2));
  }
  /// Rate at which they close [rad/s].
  template <class T, class S>
  static S closing(const Params<T>&, const At<S>& at) {
    return S(flank(at.piece)) * at.rate;
  }
  /// Push of the flanks over that of their spring: they never pull.
  template <class T, class S>
  static S damped(const Params<T>& p, const At<S>& at) {
    return S(1) + p.damping * closing(p, at);
  }
  /// Torque that pushes the flanks apart.
  template <class T, class S>
  static S push(const Params<T>& p, const At<S>& at) {
    if (at.piece != ahead && at.piece != behind) return S(0);
    return p.stiffness * depth(p, at) * damped(p, at);
  }
  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    return S(-flank(at.piece)) * push(p, at);
  }
  /// Heat of the damped flanks [W].
  template <class T, class S>
  static S heat(const Params<T>& p, const At<S>& at) {
    if (flank(at.piece) == 0) return S(0);
    return (push(p, at) - p.stiffness * depth(p, at)) * closing(p, at);
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    rates[angle] = at.rate;
    const S wanted = larger(smaller(command(p, at), S(1)), S(0));
    rates[sleeve] = at.piece == blocked || at.piece == fast ? S(0) : (wanted - at.state[sleeve]) / p.lag;
  }

  /// Slip over the one above which teeth do not mesh, less one.
  template <class T, class S>
  static S excess(const Params<T>& p, const At<S>& at) {
    return abs(at.rate) / p.speed - S(1);
  }
  /// Way on the tip of the tooth to its nearer end, over half a gap; the tooth that it stands on ends at one pitch.
  template <class T, class S>
  static S way_on_tip(const Params<T>& p, const At<S>& at) {
    const S from = at.state[angle] - S(p.gap / T(2)), to = S(pitch(p)) - S(p.gap / T(2)) - at.state[angle];
    return smaller(from, to) * T(2) / p.gap;
  }
  /// The least of what keeps the piece. Its time derivative is that of all of them, for each may be the next to end it.
  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    S least = S(1e300);
    S change = S(0);
    auto watch = [&](const S& guard, int number) {
      change += guard - plain_of(guard);
      if (value(guard) < value(least)) least = plain_of(guard), who = number;
    };
    const S reach = S(p.reach);
    if (at.piece == apart) {
      watch(reach - at.state[sleeve], meets);
    } else if (at.piece == fast) {
      watch(excess(p, at), meets);
      watch(command(p, at) - reach, leaves);
    } else if (at.piece == blocked) {
      watch(way_on_tip(p, at), meets);
      watch(command(p, at) - reach, leaves);
      // a margin above the speed keeps the two from taking turns
      watch(S(0.01) - excess(p, at), slips);
    } else {
      watch(at.piece == loose ? S(1) - abs(at.state[angle]) * T(2) / p.gap : depth(p, at) * T(2) / p.gap, meets);
      watch(at.state[sleeve] - reach, leaves);
      if (flank(at.piece) != 0) watch(at.piece <= behind ? damped(p, at) : -damped(p, at), parts);
    }
    return least + change;
  }
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T* state) {
    if (who == turned) return at.piece;
    if (who == leaves) return at.piece <= blocked ? draw_back(p, state) : int(apart);
    if (who == slips) return fast;
    if (at.piece == blocked) return mesh(p, state);
    if (at.piece == apart || at.piece == fast) return meet(p, at, state);
    if (at.piece == loose) return next_flank(at);
    if (who == parts) return at.piece <= behind ? at.piece + (slack_ahead - ahead) : at.piece - (slack_ahead - ahead);
    return loose;
  }
  /// What presses the flanks is gone where the sleeve leaves them.
  template <class T>
  static T freed(const Params<T>& p, const At<T>& at, int who) {
    const T pressed = depth(p, at);
    return who == leaves && flank(at.piece) != 0 && value(pressed) > 0 ? T(0.5) * p.stiffness * pressed * pressed
                                                                       : T(0);
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }
  /// A sleeve that is in at the start is in mesh, whatever the slip.
  template <class T>
  static int settle(const Params<T>& p, const At<T>& at) {
    if (at.piece != apart || value(at.state[sleeve]) <= value(p.reach) + 1e-9) return at.piece;
    return abs(value(at.state[angle])) * 2 <= value(p.gap) ? loose : next_flank(at);
  }

 private:
  enum Who : int { meets, leaves, slips, parts };

  /// Angle from the middle of the nearest gap [rad].
  template <class T>
  static T off_centre(const Params<T>& p, const T* state) {
    return state[angle] - T(pitch(p) * nearbyint(value(state[angle]) / pitch(p)));
  }
  /// In mesh the angle is counted from the middle of the gap, which the teeth do not leave.
  template <class T>
  static int mesh(const Params<T>& p, T* state) {
    return state[angle] = off_centre(p, state), loose;
  }

  /// From the tips of the teeth, to round-off, where it would be held back at once again.
  template <class T>
  static int draw_back(const Params<T>& p, T* state) {
    return state[sleeve] = p.reach, apart;
  }

  /// The flank that the teeth are on, or next to.
  template <class T>
  static int next_flank(const At<T>& at) {
    return value(at.state[angle]) > 0 ? ahead : behind;
  }
  /// The sleeve at the tips of the teeth: held back, in mesh, or on a tooth. Pointed teeth find the middle of a gap.
  template <class T>
  static int meet(const Params<T>& p, const At<T>& at, T* state) {
    if (at.piece == apart && value(excess(p, at)) > 0) return fast;
    if (value(p.pointed) != 0) return state[angle] = T(0), loose;
    if (abs(value(off_centre(p, state))) * 2 < value(p.gap)) return mesh(p, state);
    state[angle] -= T(pitch(p) * floor(value(state[angle]) / pitch(p)));
    return blocked;
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/elastic_contact.hpp>
#include <clutchwork/components/stretch.hpp>

namespace clutchwork::elements {

/// Spring in series with dry friction whose limit is a table over the twist, and grows with the square of a speed.
/// docs/theory/compliance.md (10)
struct JenkinsElement : declared::JenkinsElement {
  template <class T>
  struct Params {
    T stiffness;       ///< [N m/rad]
    Curve<T> limit;    ///< rad -> N m
    T speed_friction;  ///< [N m s2/rad2]
  };
  // on each piece of the limit it sticks, or slides one way or the other
  enum Mode : int { sticks, ahead, behind };

  static int mode(int piece) { return piece % 3; }
  static int segment(int piece) { return piece / 3; }
  static int side(int piece) { return mode(piece) == behind ? -1 : 1; }
  static int piece_of(int segment, int mode) { return 3 * segment + mode; }
  template <class T>
  static bool follows_speed(const Params<T>& p) {
    return value(p.speed_friction) > 0;
  }

  /// A limit that is one number needs no twist.
  template <class T>
  static int count(const Params<T>& p) {
    return int(value(p.limit.count)) > 1 ? 2 : 1;
  }
  template <class T, class S>
  static S limit(const Params<T>& p, const At<S>& at) {
    const S v = at.input[Input::speed], more = p.speed_friction * v * v;
    if (count(p) == 1) return S(at.points[3 * int(value(p.limit.first)) + 1]) + more;
    return curve_value(p.limit, at.points, at.state[twist], segment(at.piece)) + more;
  }
  /// Torque of the spring: its state where it sticks.
  template <class T, class S>
  static S spring(const Params<T>& p, const At<S>& at) {
    return mode(at.piece) == sticks ? at.state[friction_torque] : T(side(at.piece)) * limit(p, at);
  }
  /// Rate of the spring over the rate of the twist, at a constant speed.
  template <class T, class S>
  static T growth(const Params<T>& p, const At<S>& at) {
    if (mode(at.piece) == sticks) return p.stiffness;
    return T(side(at.piece) * piece_slope(p.limit, at.points, segment(at.piece)));
  }
  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    return -spring(p, at);
  }
  template <class T, class S>
  static S heat(const Params<T>& p, const At<S>& at) {
    if (mode(at.piece) == sticks) return S(T(0));
    // less what the spring keeps, which is that of its state
    return spring(p, at) * at.rate - at.state[friction_torque] * winding(p, at) / p.stiffness;
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    rates[friction_torque] = winding(p, at);
    if (count(p) > 1) rates[twist] = at.rate;
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    LeastGuard<S> guards;
    const int k = segment(at.piece), m = mode(at.piece);
    if (count(p) > 1) {
      each_end(p.limit, at.points, at.state[twist], k,
               [&](const S& room, int next) { guards.watch(room, piece_of(next, m)); });
    }
    if (m == sticks) {
      const S size = S(largest(p, at.points));
      guards.watch((limit(p, at) - at.state[friction_torque]) / size, piece_of(k, ahead));
      guards.watch((limit(p, at) + at.state[friction_torque]) / size, piece_of(k, behind));
    } else if (follows_speed(p)) {
      guards.watch(lead(p, at), piece_of(k, sticks));
    }
    who = guards.who;
    return guards.least + guards.change;
  }
  /// Sliding ends where the limit grows faster than the spring: where the slip turns, behind a knot, with the speed.
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T* state) {
    state[friction_torque] = torque_left(p, at, who);
    return kept(p, at, next_piece(at.piece, who));
  }
  /// Energy that the spring loses where its piece is left: where a speed has jumped, with the torque above the limit;
  /// else what the lag of its state was worth, which may be below zero.
  template <class T>
  static T freed(const Params<T>& p, const At<T>& at, int who) {
    const T before = at.state[friction_torque], after = torque_left(p, at, who);
    return (before - after) * (before + after) / (T(2) * p.stiffness);
  }
  template <class T>
  static bool turns(const Params<T>& p, int piece) {
    return mode(piece) != sticks && !follows_speed(p);
  }
  template <class T>
  static int settle(const Params<T>& p, const At<T>& at) {
    const int k = segment(at.piece), m = mode(at.piece);
    const int to = piece_of(count(p) > 1 ? stretch_of(p.limit, at.points, value(at.state[twist]), k) : k, m);
    if (m != sticks && follows_speed(p) && is_above(p, at, to)) return piece_of(segment(to), sticks);
    return kept(p, at, to);
  }

 private:
  static int next_piece(int piece, int who) { return who == turned ? piece_of(segment(piece), sticks) : who; }
  /// Torque of the spring where its piece is left.
  template <class T>
  static T torque_left(const Params<T>& p, const At<T>& at, int who) {
    const int piece = mode(at.piece) == sticks ? next_piece(at.piece, who) : at.piece;
    return spring(p, At<T>{at.rate, at.state, at.input, piece, at.points});
  }

  static constexpr double delay = 1e-5;  // [s]
  // of the limit, by which the state may lag behind it while it slides
  static constexpr double lag = 1e-3;

  /// Rate of the state, which lags behind a limit that a speed changes: while it slides no torque depends on it.
  template <class T, class S>
  static S winding(const Params<T>& p, const At<S>& at) {
    const S along = growth(p, at) * at.rate;
    return mode(at.piece) != sticks && follows_speed(p) ? along + follows(p, at) : along;
  }
  /// Rate at which the state comes after a limit that a speed changes.
  template <class T, class S>
  static S follows(const Params<T>& p, const At<S>& at) {
    return (spring(p, at) - at.state[friction_torque]) / T(delay);
  }

  /// Whether the limit of a piece that slides has jumped above the spring, which must be wound up first.
  template <class T>
  static bool is_above(const Params<T>& p, const At<T>& at, int piece) {
    const At<T> there{at.rate, at.state, at.input, piece, at.points};
    const auto most = value(limit(p, there));
    return most - side(piece) * value(at.state[friction_torque]) > lag * most;
  }
  /// A piece, and where it slides whether it goes on: the spring would grow faster than the limit, however slowly.
  /// Where the limit follows a speed, its guard tells.
  template <class T>
  static int kept(const Params<T>& p, const At<T>& at, int piece) {
    if (mode(piece) == sticks || follows_speed(p)) return piece;
    const auto slope = value(piece_slope(p.limit, at.points, segment(piece)));
    const auto faster = side(piece) * value(p.stiffness) - slope;
    return faster * value(at.rate) > 0 ? piece : piece_of(segment(piece), sticks);
  }
  /// How much faster the spring would grow than the limit, over its stiffness; the drift of the input is that of the
  /// speed.
  template <class T, class S>
  static S lead(const Params<T>& p, const At<S>& at) {
    const S v = at.input[Input::speed];
    const T faster = T(side(at.piece)) * p.stiffness - T(piece_slope(p.limit, at.points, segment(at.piece)));
    S found = faster * at.rate / p.stiffness;
    if constexpr (requires { v.d[0]; }) found -= T(2) * p.speed_friction * v.v * v.d[0] / p.stiffness;
    return found;
  }
  /// The largest limit of the table: what counts as far from it.
  template <class T>
  static Real<T> largest(const Params<T>& p, const auto* points) {
    Real<T> most = 0;
    for (int i = 0; i < int(value(p.limit.count)); ++i)
      most = larger(most, value(points[3 * (int(value(p.limit.first)) + i) + 1]));
    return most > 0 ? most : Real<T>(1);
  }
};

}  // namespace clutchwork::elements

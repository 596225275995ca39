#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Tyre by the Magic Formula with relaxation. Pieces: off the road; else which speed carries the tread along, its sign,
/// and how fast the mass is. docs/theory/vehicle.md
struct Tyre : declared::Tyre {
  template <class T>
  struct Params {
    T B;                  ///< [1]
    T C;                  ///< [1]
    T D;                  ///< [1]
    T E;                  ///< [1]
    T relaxation_length;  ///< [m]
    T slip_limit;         ///< [1]
    T low_speed;          ///< [m/s]
    T low_speed_damping;  ///< [N s/m]
  };
  // rolling: the speed of the mass carries the tread along; spinning: that of the slip
  enum Carried : int { rolling_ahead, rolling_back, spinning_ahead, spinning_back };
  static constexpr int slow = 0, ahead = 4, behind = 8, lifted = 12;

  template <class T, class S>
  static void torques(const Params<T>& p, const At<S>& at, OwnTorques<S> torque) {
    torque[Way::speed] = S(0);
    torque[Way::slip] = at.piece == lifted ? S(0) : force(p, at);
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    if (at.piece == lifted) {
      rates[deflection] = S(0);
      return;
    }
    const S slip = -at.rates[Way::slip];
    rates[deflection] = slip - carried(p, at) * at.state[deflection] / p.relaxation_length;
  }

  /// Who: the piece that follows.
  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    const S &load = at.input[Input::load], &v = at.rates[Way::speed];
    if (at.piece == lifted) {
      who = slow + rolling_ahead;
      return -load;
    }
    S least = load;
    who = lifted;
    auto watch = [&](const S& guard, int next) {
      if (guard < least) least = guard, who = next;
    };
    const S limit = -at.rates[Way::slip] / p.slip_limit;
    const int now = at.piece % 4, zone = at.piece - now;
    // near rest, where the tread is hardly carried, round-off of the speeds does not change the piece
    const S rest = S(1e-9);
    if (now < spinning_ahead) {
      const S along = (now == rolling_ahead ? v : -v) + rest;
      watch(along - limit, zone + spinning_ahead), watch(along + limit, zone + spinning_back);
    } else {
      const S along = (now == spinning_ahead ? limit : -limit) + rest;
      watch(along - v, zone + rolling_ahead), watch(along + v, zone + rolling_back);
    }
    if (zone == slow) {
      watch(p.low_speed - v, ahead + now), watch(p.low_speed + v, behind + now);
    } else {
      watch((zone == ahead ? v : -v) - p.low_speed, slow + now);
    }
    return least;
  }
  template <class T, class S>
  static int cross(const Params<T>& p, const At<S>& at, int who, S* state) {
    // what is off the road is straight
    if (who == lifted) state[deflection] = S(0);
    return at.piece == lifted ? placed(p, at) : who;
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }
  template <class T, class S>
  static int settle(const Params<T>& p, const At<S>& at) {
    int who = 0;
    if (value(margin(p, at, who)) >= 0) return at.piece;
    return value(at.input[Input::load]) > 0 ? placed(p, at) : lifted;
  }

 private:
  template <class T, class S>
  static int placed(const Params<T>& p, const At<S>& at) {
    const auto v = value(at.rates[Way::speed]), limit = -value(at.rates[Way::slip]) / value(p.slip_limit);
    const int zone = v > value(p.low_speed) ? ahead : v < -value(p.low_speed) ? behind : slow;
    if (abs(limit) > abs(v)) return zone + (limit > 0 ? spinning_ahead : spinning_back);
    return zone + (v < 0 ? rolling_back : rolling_ahead);
  }
  /// Speed at which the tread is carried through the contact.
  template <class T, class S>
  static S carried(const Params<T>& p, const At<S>& at) {
    const S &v = at.rates[Way::speed], limit = -at.rates[Way::slip] / p.slip_limit;
    switch (at.piece % 4) {
      case rolling_ahead:
        return v;
      case rolling_back:
        return -v;
      case spinning_ahead:
        return limit;
      default:
        return -limit;
    }
  }
  template <class T, class S>
  static S force(const Params<T>& p, const At<S>& at) {
    const S& load = at.input[Input::load];
    if (value(load) <= 0) return S(0);
    S x = at.state[deflection] / p.relaxation_length;
    if (at.piece < ahead) {
      constexpr double pi = 3.14159265358979323846;
      const S fade = (S(1) + cos(at.rates[Way::speed] * S(pi) / p.low_speed)) * S(0.5);
      x -= fade * at.rates[Way::slip] * p.low_speed_damping / (load * (p.B * p.C * p.D));
    }
    const S b = x * p.B;
    return load * p.D * sin(atan(b - (b - atan(b)) * p.E) * p.C);
  }
};

}  // namespace clutchwork::elements

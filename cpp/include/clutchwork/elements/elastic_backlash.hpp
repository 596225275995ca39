#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/elastic_contact.hpp>

namespace clutchwork::elements {

/// Play between two elastic flanks. docs/theory/play.md
struct ElasticBacklash : declared::ElasticBacklash {
  template <class T>
  struct Params {
    T stiffness;  ///< [N m/rad]
    T damping;    ///< [N m s/rad]
    T gap;        ///< [rad]
    T limited;    ///< [1]
  };
  // no flank; then one flank as each Touch, and the other
  enum Piece : int { apart, ahead = 1, behind = 4 };

  /// The way in which the flank that is pressed opposes the twist; 0: none is.
  static int side(int piece) { return piece == apart ? 0 : piece < behind ? 1 : -1; }
  static Touch touch(int piece) { return Touch(piece - (piece < behind ? ahead : behind)); }
  static int piece_of(int side, Touch how) { return (side > 0 ? ahead : behind) + int(how); }

  template <class T, class S>
  static S depth(const Params<T>& p, const At<S>& at, int side) {
    return T(side) * at.state[twist] - S(p.gap / T(2));
  }
  template <class T, class S>
  static ElasticContact<S> contact(const Params<T>& p, const At<S>& at, int side) {
    const S closing = T(side) * at.rate;
    return {p.stiffness * depth(p, at, side), p.damping * closing, closing, value(p.damping), value(p.limited) != 0};
  }

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    const int s = side(at.piece);
    return s == 0 ? S(0) : T(-s) * contact(p, at, s).push(touch(at.piece));
  }
  template <class T, class S>
  static S heat(const Params<T>& p, const At<S>& at) {
    const int s = side(at.piece);
    if (s == 0) return S(0);
    const ElasticContact<S> c = contact(p, at, s);
    return (c.push(touch(at.piece)) - c.spring) * c.closing;
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>& at, S* rates) {
    rates[twist] = at.rate;
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    LeastGuard<S> guards;
    const int s = side(at.piece);
    if (s == 0) {
      guards.watch(-depth(p, at, 1), ahead), guards.watch(-depth(p, at, -1), behind);
    } else {
      guards.watch(depth(p, at, s), apart);
      contact(p, at, s).each_limit(touch(at.piece),
                                   [&](const S& guard, Touch next) { guards.watch(guard, piece_of(s, next)); });
    }
    who = guards.who;
    return guards.least + guards.change;
  }
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T*) {
    if (who == turned) return at.piece;
    // a flank that is met, or pressed at the start, touches as its forces tell
    if (at.piece == apart && who != apart) return piece_of(side(who), contact(p, at, side(who)).touch());
    return who;
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }
  /// A flank that is pressed stays so until its guard says otherwise.
  template <class T>
  static int settle(const Params<T>& p, const At<T>& at) {
    const int s = value(depth(p, at, 1)) > 0 ? 1 : value(depth(p, at, -1)) > 0 ? -1 : side(at.piece);
    return s == 0 ? int(apart) : piece_of(s, contact(p, at, s).touch());
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/elastic_contact.hpp>

namespace clutchwork::elements {

/// Sprocket on which a chain lies as a polygon; the angle is counted from the middle of a link and starts again with
/// each one. docs/theory/belts.md (6)
struct PolygonSprocket : declared::PolygonSprocket {
  template <class T>
  struct Params {
    T teeth;  ///< [1]
    T pitch;  ///< [m]
  };

  /// Angle from the middle of a link to its ends.
  template <class T>
  static T half(const Params<T>& p) {
    return T(3.141592653589793) / p.teeth;
  }
  template <class T, class S>
  static S ratio(const Params<T>& p, const At<S>& at) {
    return S(p.pitch / (T(2) * sin(half(p)))) * cos(at.state[angle]);
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>& at, S* rates) {
    rates[angle] = at.rates[Way::shaft];
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    LeastGuard<S> guards;
    const S share = at.state[angle] / S(half(p));
    guards.watch(S(T(1)) - share, next), guards.watch(S(T(1)) + share, last);
    who = guards.who;
    return guards.least + guards.change;
  }
  /// The next link takes over where this one ends.
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T* state) {
    if (who == next) state[angle] -= T(2) * half(p);
    if (who == last) state[angle] += T(2) * half(p);
    return at.piece;
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }

 private:
  enum Who : int { next, last };
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Two long hinged shoes inside a drum. docs/theory/clutches.md
struct DoubleShoeBrake : declared::DoubleShoeBrake {
  template <class T>
  struct Params {
    T radius;                          ///< [m]
    T hinge;                           ///< [m]
    T arm;                             ///< [m]
    T start;                           ///< [rad]
    T end;                             ///< [rad]
    Word<T, choice::Leading> leading;  ///< [1]
  };
  static constexpr bool one_way = false;

  template <class T, class S>
  static S load(const Params<T>&, const At<S>& at) {
    return at.input[Input::force];
  }
  /// Torque of one shoe over its force; a leading one presses itself on. Where a coefficient rises to self-locking it
  /// grabs, and never drives: a thousandth of its moment stays.
  template <class T, class S>
  static S shoe(const Params<T>& p, const S& mu, bool leads) {
    const T spread = cos(p.start) - cos(p.end);
    const T normal = (p.end - p.start) / T(2) - (sin(T(2) * p.end) - sin(T(2) * p.start)) / T(4);
    const T along = p.radius * spread - p.hinge / T(2) * (sin(p.end) * sin(p.end) - sin(p.start) * sin(p.start));
    const T free = p.hinge * normal;
    const S moment = larger(S(free) + S(leads ? -along : along) * mu, S(T(1e-3) * free));
    return mu * p.radius * p.arm * spread / moment;
  }
  template <class T, class S>
  static S gain(const Params<T>& p, const S& mu, int direction) {
    if (p.leading == choice::Leading::simplex) return shoe(p, mu, true) + shoe(p, mu, false);
    return S(2) * shoe(p, mu, direction > 0);
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/stop.hpp>

namespace clutchwork::elements {

/// Play between rigid flanks. docs/theory/play.md
struct Backlash : declared::Backlash, RigidStop {
  template <class T>
  struct Params {
    T gap;          ///< [rad]
    T restitution;  ///< [1]
    T rest_speed;   ///< [rad/s]
  };

  template <class T>
  static T end(const Params<T>& p, int side) {
    return p.gap * T(0.5 * side);
  }
  template <class T>
  static T restitution(const Params<T>& p, int) {
    return p.restitution;
  }
  template <class T>
  static T rest_speed(const Params<T>& p) {
    return p.rest_speed;
  }
};

}  // namespace clutchwork::elements

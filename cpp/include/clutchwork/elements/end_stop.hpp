#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/stop.hpp>

namespace clutchwork::elements {

/// Rigid stops at the ends of a way; one that is not there is no number. docs/theory/play.md
struct EndStop : declared::EndStop, RigidStop {
  template <class T>
  struct Params {
    T lower;              ///< [rad]
    T upper;              ///< [rad]
    T lower_restitution;  ///< [1]
    T upper_restitution;  ///< [1]
    T rest_speed;         ///< [rad/s]
  };

  template <class T>
  static T end(const Params<T>& p, int side) {
    return side < 0 ? p.lower : p.upper;
  }
  template <class T>
  static T restitution(const Params<T>& p, int side) {
    return side < 0 ? p.lower_restitution : p.upper_restitution;
  }
  template <class T>
  static T rest_speed(const Params<T>& p) {
    return p.rest_speed;
  }
};

}  // namespace clutchwork::elements

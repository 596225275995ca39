#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Torque over speed as a table, continued linearly beyond its ends.
struct SpeedTorque : declared::SpeedTorque {
  template <class T>
  struct Params {
    Curve<T> torque;  ///< rad/s -> N m
    T gain;           ///< [1]
  };
  static constexpr bool lanes = true;

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    return p.gain * curve_value(p.torque, at.points, at.rate, at.piece);
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}

  template <class T>
  static int edges(const Params<T>& p) {
    return curve_edges(p.torque);
  }
  template <class T>
  static auto edge(const Params<T>& p, const auto* points, int i) {
    return curve_edge(p.torque, points, i);
  }
};

}  // namespace clutchwork::elements

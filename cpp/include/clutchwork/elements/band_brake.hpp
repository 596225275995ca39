#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Band around a drum, pulled at one end and fixed at the other. docs/theory/clutches.md
struct BandBrake : declared::BandBrake {
  template <class T>
  struct Params {
    T radius;    ///< [m]
    T wrap;      ///< [rad]
    T reversed;  ///< [1]
  };
  static constexpr bool one_way = false;

  template <class T, class S>
  static S load(const Params<T>& p, const At<S>& at) {
    return p.radius * at.input[Input::force];
  }
  /// Torque over radius and force: the drum pulls the band on in one direction, and off in the other.
  template <class T, class S>
  static S gain(const Params<T>& p, const S& mu, int direction) {
    const bool pulls_on = (direction > 0) != (value(p.reversed) != 0);
    return pulls_on ? exp(mu * p.wrap) - S(1) : S(1) - exp(-(mu * p.wrap));
  }
};

}  // namespace clutchwork::elements

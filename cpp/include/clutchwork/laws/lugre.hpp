#pragma once
#include <clutchwork/components/bristles.hpp>

namespace clutchwork::laws {

/// Bristles that bend and slip; the state is the elastic part of the coefficient, stiffness times deflection.
struct LuGre : Bristles<LuGre>, declared::LuGre {
  template <class T>
  struct Params : StribeckCurve<T> {
    T stiffness;  ///< [1/rad]
    T damping;    ///< [s/rad]
  };

  /// Rate of the deflection [rad/s].
  template <class T, class S>
  static S bending(const Params<T>& p, const At<S>& at) {
    return at.rate - abs(at.rate) * at.state[0] / sliding_level(p, at.rate);
  }
};

}  // namespace clutchwork::laws

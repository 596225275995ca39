#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Drag in moving air. docs/theory/vehicle.md (2)
struct AirDrag : declared::AirDrag {
  template <class T>
  struct Params {
    T area;     ///< [m2]
    T density;  ///< [kg/m3]
  };
  enum Piece : int { ahead, behind };

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    const S u = at.rate - at.input[Input::wind];
    const S size = p.density * p.area * T(0.5) * u * u;
    return at.piece == behind ? size : -size;
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}

  /// Speed through the air, the way it goes now.
  template <class T, class S>
  static S margin(const Params<T>&, const At<S>& at, int& who) {
    who = 0;
    const S u = at.rate - at.input[Input::wind];
    return at.piece == behind ? -u : u;
  }
  template <class T>
  static int cross(const Params<T>&, const At<T>& at, int who, T*) {
    return who == turned ? at.piece : at.piece == behind ? ahead : behind;
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }
  template <class T>
  static int settle(const Params<T>&, const At<T>& at) {
    const auto u = value(at.rate - at.input[Input::wind]);
    return u == 0 ? at.piece : u < 0 ? behind : ahead;
  }
};

}  // namespace clutchwork::elements

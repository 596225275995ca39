#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::laws {

/// Coulomb friction with its jump smoothed: it creeps under any load.
struct Tanh : declared::Tanh {
  template <class T>
  struct Params {
    T kinetic;  ///< [1]
    T speed;    ///< [rad/s]
  };

  template <class T, class S>
  static S coefficient(const Params<T>& p, const At<S>& at) {
    return p.kinetic * tanh(at.rate * T(2) / p.speed);
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.kinetic;
  }
};

}  // namespace clutchwork::laws

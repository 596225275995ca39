#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::laws {

/// Coulomb friction with a static level.
struct Coulomb : declared::Coulomb {
  template <class T>
  struct Params {
    T static_;  ///< [1]
    T kinetic;  ///< [1]
  };
  static constexpr bool lanes = true;

  template <class T, class S>
  static S slide(const Params<T>& p, const At<S>&) {
    return S(p.kinetic);
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }
};

}  // namespace clutchwork::laws

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::laws {

/// Coefficient over slip as a table, linear between its points. docs/theory/clutches.md
struct CoefficientTable : SlipTable<CoefficientTable>, declared::CoefficientTable {
  template <class T>
  struct Params {
    T static_;                                     ///< [1]
    Curve<T> kinetic;                              ///< rad/s -> 1
    Word<T, choice::Extrapolation> extrapolation;  ///< [1]
  };

  template <class T>
  static Manner manner(const Params<T>& p) {
    return {choice::Interpolation::linear, p.extrapolation};
  }
};

}  // namespace clutchwork::laws

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::laws {

/// Coefficient over slip as a table, linear between its points. docs/theory/clutches.md
struct CoefficientTable : SlipTable<CoefficientTable> {
  template <class T>
  struct Params {
    T static_;         ///< [1]
    Curve<T> kinetic;  ///< rad/s -> 1
    T extrapolation;   ///< [1]
  };
  static constexpr int states = 0;

  template <class T>
  static Manner manner(const Params<T>& p) {
    return {Interpolation::linear, Extrapolation(int(value(p.extrapolation)))};
  }
};

}  // namespace clutchwork::laws

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::laws {

/// Kinetic coefficient over slip as a table. docs/theory/clutches.md
struct FrictionTable : SlipTable<FrictionTable>, declared::FrictionTable {
  template <class T>
  struct Params : Tabulated<T> {
    T static_;         ///< [1]
    Curve<T> kinetic;  ///< rad/s -> 1
  };

  template <class T>
  static Manner manner(const Params<T>& p) {
    return Manner(p);
  }
};

}  // namespace clutchwork::laws

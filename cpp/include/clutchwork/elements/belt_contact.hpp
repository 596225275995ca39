#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/layout.gen.hpp>

namespace clutchwork::elements {

/// Belt on its pulley: what is left of the tension at a speed, times a factor for either way of slip.
/// docs/theory/belts.md (3)
struct BeltContact : declared::BeltContact {
  template <class T>
  struct Params {
    T forward;          ///< [1]
    T backward;         ///< [1]
    T mass_per_length;  ///< [kg/m]
  };
  static constexpr bool one_way = false;

  template <class T, class S>
  static S load(const Params<T>& p, const At<S>& at) {
    const S v = at.input[Input::speed];
    return at.input[Input::tension] - p.mass_per_length * v * v;
  }
  template <class T, class S>
  static S gain(const Params<T>& p, const S& coefficient, int direction) {
    return coefficient * (direction == forward ? p.forward : p.backward);
  }
};

}  // namespace clutchwork::elements

#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Clutch whose kinetic torque and static limits are inputs. docs/theory/clutches.md
struct FundamentalClutch : declared::FundamentalClutch {
  template <class T>
  struct Params {};
  static constexpr bool one_way = false;

  /// The kinetic torque; a trace of the static ones keeps it closed where it can only hold.
  template <class T, class S>
  static S load(const Params<T>&, const At<S>& at) {
    const S holding = larger(at.input[Input::upper], S(0)) - smaller(at.input[Input::lower], S(0));
    return larger(at.input[Input::kinetic], S(0)) + T(1e-15) * holding;
  }
  /// What slips with a torque holds at least as much.
  template <class T>
  static T limit(const Params<T>& p, const At<T>& at, T, int direction) {
    return larger(direction > 0 ? -at.input[Input::lower] : at.input[Input::upper], load(p, at));
  }
};

}  // namespace clutchwork::elements

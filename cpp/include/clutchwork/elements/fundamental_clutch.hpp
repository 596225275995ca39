#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Clutch whose kinetic torque and static limits are inputs. docs/theory/clutches.md
struct FundamentalClutch : declared::FundamentalClutch {
  template <class T>
  struct Params {};
  static constexpr bool one_way = false;

  /// The kinetic torque; a trace of the static ones keeps it closed where it can only hold. Where none acts it is below
  /// zero by a trace, so that it passes zero where one begins to.
  template <class T, class S>
  static S load(const Params<T>&, const At<S>& at) {
    const S kinetic = at.input[Input::kinetic], upper = at.input[Input::upper], lower = -at.input[Input::lower];
    const S acts = larger(kinetic, S(0)) + T(1e-15) * (larger(upper, S(0)) + larger(lower, S(0)));
    if (value(acts) > 0) return acts;
    return T(1e-15) * (smaller(kinetic, S(0)) + smaller(upper, S(0)) + smaller(lower, S(0)));
  }
  /// What slips with a torque holds at least as much.
  template <class T>
  static T limit(const Params<T>& p, const At<T>& at, T, int direction) {
    return larger(direction > 0 ? -at.input[Input::lower] : at.input[Input::upper], load(p, at));
  }
};

}  // namespace clutchwork::elements

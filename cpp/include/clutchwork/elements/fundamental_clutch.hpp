#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Clutch whose kinetic torque and static limits are inputs. docs/theory/clutches.md
struct FundamentalClutch {
  template <class T>
  struct Params {};
  enum Input : int { kinetic, upper, lower };
  static constexpr int states = 0;
  static constexpr int inputs = 3;
  static constexpr bool one_way = false;

  /// The kinetic torque; a trace of the static ones keeps it closed where it can only hold.
  template <class T, class S>
  static S load(const Params<T>&, const At<S>& at) {
    const S holding = larger(at.input[upper], S(0)) - smaller(at.input[lower], S(0));
    return larger(at.input[kinetic], S(0)) + T(1e-15) * holding;
  }
  /// What slips with a torque holds at least as much.
  template <class T>
  static T limit(const Params<T>& p, const At<T>& at, T, int direction) {
    return larger(direction > 0 ? -at.input[lower] : at.input[upper], load(p, at));
  }
};

}  // namespace clutchwork::elements

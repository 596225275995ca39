#pragma once
#include <clutchwork/components/scalar.hpp>

/// Elastic contact of two bodies, which push and never pull: docs/theory/play.md.
namespace clutchwork {

/// How two bodies touch: damped in full; the damping at its limit, as large as the force of the spring; that which
/// would pull, and so is none.
enum class Touch : int { firm, hard, slack };

/// One contact: how deep, how fast it closes, and how its damping goes.
template <class S>
struct ElasticContact {
  S spring;          ///< force of the spring, zero or above
  S damping;         ///< force of the damper, above zero where it closes
  S closing;         ///< rate at which it closes
  Real<S> strength;  ///< damping over closing
  bool limited;      ///< the damping is never above the spring

  /// Force that pushes the bodies apart.
  CLUTCHWORK_HOT S push(Touch touch) const {
    if (touch == Touch::hard) return spring + spring;
    return touch == Touch::slack ? S(0) : spring + damping;
  }
  /// How it touches, by its forces alone.
  Touch touch() const {
    if (value(spring + damping) <= 0) return strength > 0 ? Touch::slack : Touch::firm;
    return limited && value(damping) > value(spring) ? Touch::hard : Touch::firm;
  }
  /// Rates by which it is off the limits of the damping, to f(guard, next touch).
  template <class F>
  void each_limit(Touch touch, F&& f) const {
    if (strength == 0) return;
    const S reach = spring / S(strength);
    if (touch == Touch::firm) {
      if (limited) f(reach - closing, Touch::hard);
      f(reach + closing, Touch::slack);
    } else {
      f(touch == Touch::hard ? closing - reach : -closing - reach, Touch::firm);
    }
  }
};

/// The least of several guards. Its time derivative is the sum of the sizes of theirs, for each may be the next to end
/// the piece.
template <class S>
struct LeastGuard {
  S least = S(1e300);
  S change = S(0);  ///< zero, with that derivative
  int who = -1;

  void watch(const S& guard, int number) {
    if constexpr (requires { guard.d[0]; }) change.d[0] += abs(guard.d[0]);
    if (value(guard) < value(least)) least = plain_of(guard), who = number;
  }
};

}  // namespace clutchwork

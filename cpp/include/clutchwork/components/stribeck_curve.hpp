#pragma once
#include <clutchwork/components/component.hpp>
#include <clutchwork/components/scalar.hpp>

/// The Stribeck curve that many laws share: docs/theory/friction-laws.md.
namespace clutchwork {

/// Parameters of a Stribeck curve; the first ones of every law that has one.
template <class T>
struct StribeckCurve {
  T static_;                     ///< [1]
  T kinetic;                     ///< [1]
  T speed;                       ///< [rad/s]
  Word<T, choice::Shape> shape;  ///< [1]
  T exponent;                    ///< [1]
  T viscous;                     ///< [s/rad]
};

/// |x|^n, finite with its derivative at zero. An exponent of 1 that moves has a derivative, too.
template <class T, class S>
CLUTCHWORK_INLINE S power_of_size(S x, T n) {
  constexpr double least = 1e-12;
  if constexpr (has_tangents<T>) {
    if (value(n) == 1 && !is_constant(n)) return abs(x) * (S(1) + S(n - T(1)) * log(larger(abs(x), S(least))));
  }
  return choose(value(n) == 1, [&] { return abs(x); }, [&] { return pow(larger(abs(x), S(least)), S(n)); });
}

/// exp(-x), zero where nothing of it is left: underflow is slow.
template <class S>
CLUTCHWORK_INLINE S fading(S x) {
  return choose(value(x) > 200, [] { return S(0); }, [&] { return exp(-x); });
}

/// Share of the static excess that is left at x = slip / speed: 1 at rest, falling to 0.
template <class T, class S>
CLUTCHWORK_INLINE S stribeck_share(const StribeckCurve<T>& c, S x) {
  switch (c.shape) {
    case choice::Shape::tustin:
      return fading(x);
    case choice::Shape::lorentz:
      return S(1) / (S(1) + x * x);
    case choice::Shape::power:
      return fading(power_of_size(x, c.exponent));
    default:
      return fading(x * x);
  }
}

/// Slip beyond which nothing of the static excess is left that counts: a step that starts there must not run over it.
template <class T>
CLUTCHWORK_INLINE Real<T> stribeck_reach(const StribeckCurve<T>& c) {
  const Real<T> speed = value(c.speed);
  switch (c.shape) {
    case choice::Shape::tustin:
      return 12 * speed;
    case choice::Shape::lorentz:
      return 10 * speed;
    case choice::Shape::power:
      return pow(Real<T>(12), 1 / value(c.exponent)) * speed;
    default:
      return 3.5 * speed;
  }
}

/// Coefficient over a slip in the direction of sliding, without the viscous part; smooth across zero.
template <class T, class S>
CLUTCHWORK_INLINE S stribeck_forward(const StribeckCurve<T>& c, S slip) {
  // the floor keeps a trial point far behind the crossing finite
  return c.kinetic + (c.static_ - c.kinetic) * stribeck_share(c, larger(slip / c.speed, S(-20)));
}

/// Coefficient over the size of the slip, without the viscous part.
template <class T, class S>
CLUTCHWORK_INLINE S stribeck(const StribeckCurve<T>& c, S slip) {
  return stribeck_forward(c, abs(slip));
}

/// Size of a coefficient at which a law slides: the curve, kept above zero.
template <class T, class S>
CLUTCHWORK_INLINE S sliding_level(const StribeckCurve<T>& c, S slip) {
  return larger(stribeck(c, slip), S(1e-9) * S(c.static_));
}

}  // namespace clutchwork

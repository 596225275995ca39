#pragma once
#include <cmath>
#include <type_traits>

#ifndef CLUTCHWORK_INLINE
#define CLUTCHWORK_INLINE inline __attribute__((always_inline))
#endif

/// What the core asks of a number. Scalars: double, float, Dual<double, N>, Dual<float, N>.
namespace clutchwork {

using std::abs, std::cos, std::exp, std::log, std::pow, std::sin, std::sqrt, std::tanh;

/// The plain number behind a scalar: comparisons and decisions use it, in double whatever the scalar.
template <class T>
  requires std::is_floating_point_v<T>
CLUTCHWORK_INLINE double value(T x) {
  return x;
}

template <class T>
CLUTCHWORK_INLINE T larger(T a, T b) {
  return b > a ? b : a;
}

template <class T>
CLUTCHWORK_INLINE T smaller(T a, T b) {
  return b < a ? b : a;
}

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/elementary.hpp>

#include <type_traits>

/// What the core asks of a number. Scalars: double, float, Single, and Dual over these.
namespace clutchwork {

/// The plain number behind a scalar: comparisons and decisions use it, in double whatever the scalar.
template <class T>
  requires std::is_floating_point_v<T>
CLUTCHWORK_HOT double value(T x) {
  return x;
}

/// The plain number behind a scalar, and what a comparison of two gives: double and bool, unless a scalar has lanes.
template <class T>
struct NumberOf {
  using Real = double;
  using Truth = bool;
  static constexpr bool lanes = false;
  static constexpr bool tangents = false;  ///< it carries derivatives of the whole run
  static constexpr bool single = false;    ///< it has single precision alone
  using Given = double;                    ///< a number of the model
  using Point = double;                    ///< a number of its curves
};
template <class T>
using Real = typename NumberOf<T>::Real;
template <class T>
using Truth = typename NumberOf<T>::Truth;
template <class T>
inline constexpr bool has_lanes = NumberOf<T>::lanes;
template <class T>
inline constexpr bool has_tangents = NumberOf<T>::tangents;
template <class T>
using Given = typename NumberOf<T>::Given;
template <class T>
using Point = typename NumberOf<T>::Point;

/// A tolerance that stands for round-off, by the precision of a scalar.
template <class T>
inline constexpr Real<T> roundoff(double in_double, double in_single) {
  return Real<T>(NumberOf<T>::single ? in_single : in_double);
}

/// A number that is the same in all lanes, such as a place or a choice.
template <class T>
CLUTCHWORK_HOT auto common(const T& x) {
  return value(x);
}

/// Answers to one question: for scalars with lanes there are as many as lanes, components/lanes.hpp.
CLUTCHWORK_HOT bool any(bool x) { return x; }
CLUTCHWORK_HOT bool all(bool x) { return x; }
CLUTCHWORK_HOT bool none(bool x) { return !x; }

/// Whether a number is zero, and its derivatives too.
CLUTCHWORK_HOT bool is_zero(double x) { return x == 0; }
CLUTCHWORK_HOT bool is_zero(float x) { return x == 0; }

/// Whether two numbers differ, or move apart with what they are made of.
template <class T>
CLUTCHWORK_HOT bool differ(const T& a, const T& b) {
  if constexpr (has_tangents<T>) {
    if (largest_difference(a, b) > 0) return true;
  }
  return value(a - b) != 0;
}

/// Whether a number counts: it is not zero, or what it is made of moves it.
template <class T>
CLUTCHWORK_HOT bool counts(const T& x) {
  if constexpr (has_tangents<T>)
    return !is_zero(x);
  else
    return any(value(x) != 0);
}

/// A number without the derivatives of a dual one.
template <class T>
CLUTCHWORK_HOT const T& plain_of(const T& x) {
  return x;
}

/// n where it is true, else zero.
CLUTCHWORK_HOT int count_where(bool which, int n) { return which ? n : 0; }

/// a where it is true, else b.
template <class T>
CLUTCHWORK_HOT T select(bool which, T a, T b) {
  return which ? a : b;
}
/// a() where it is true, else b(); what no lane asks for is not computed.
template <class A, class B>
CLUTCHWORK_HOT auto choose(bool which, A&& a, B&& b) {
  return which ? a() : b();
}

template <class T>
CLUTCHWORK_HOT T larger(T a, T b) {
  return select(b > a, b, a);
}

template <class T>
CLUTCHWORK_HOT T smaller(T a, T b) {
  return select(b < a, b, a);
}

}  // namespace clutchwork

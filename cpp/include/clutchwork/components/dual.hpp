#pragma once
#include <clutchwork/components/scalar.hpp>

namespace clutchwork {

/// Dual number: a value and its derivatives in N directions.
template <class T, int N>
struct Dual {
  T v{};
  T d[N]{};

  constexpr Dual() = default;
  constexpr Dual(T x) : v(x) {}
  template <class S>
    requires(std::is_arithmetic_v<S> && !std::is_same_v<S, T>)
  constexpr Dual(S x) : v(T(x)) {}

  /// The independent variable number i.
  static constexpr Dual variable(T x, int i) {
    Dual r(x);
    r.d[i] = T(1);
    return r;
  }

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }

  friend CLUTCHWORK_INLINE Dual operator-(const Dual& a) { return chain(a, -a.v, T(-1)); }
  friend CLUTCHWORK_INLINE Dual operator+(const Dual& a, const Dual& b) { return chain(a, T(1), b, T(1), a.v + b.v); }
  friend CLUTCHWORK_INLINE Dual operator-(const Dual& a, const Dual& b) { return chain(a, T(1), b, T(-1), a.v - b.v); }
  friend CLUTCHWORK_INLINE Dual operator*(const Dual& a, const Dual& b) { return chain(a, b.v, b, a.v, a.v * b.v); }
  // the value is a.v / b.v as the plain scalar computes it, so that the bits agree
  friend CLUTCHWORK_INLINE Dual operator/(const Dual& a, const Dual& b) {
    const T q = a.v / b.v;
    return chain(a, T(1) / b.v, b, -q / b.v, q);
  }

  friend auto operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend auto operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
  friend auto operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
  friend auto operator>=(const Dual& a, const Dual& b) { return a.v >= b.v; }
  friend auto operator==(const Dual& a, const Dual& b) { return a.v == b.v; }
  friend auto operator!=(const Dual& a, const Dual& b) { return a.v != b.v; }

  /// f(a) with derivative slope.
  static CLUTCHWORK_INLINE Dual chain(const Dual& a, T f, T slope) {
    Dual r(f);
    for (int i = 0; i < N; ++i) r.d[i] = slope * a.d[i];
    return r;
  }
  /// f(a, b) with partial derivatives fa and fb.
  static CLUTCHWORK_INLINE Dual chain(const Dual& a, T fa, const Dual& b, T fb, T f) {
    Dual r(f);
    for (int i = 0; i < N; ++i) r.d[i] = fa * a.d[i] + fb * b.d[i];
    return r;
  }
};

template <class T, int N>
CLUTCHWORK_INLINE auto value(const Dual<T, N>& x) {
  return value(x.v);
}

template <class T, int N>
CLUTCHWORK_INLINE Dual<T, N> plain_of(const Dual<T, N>& x) {
  return Dual<T, N>(x.v);
}

template <class T, int N>
struct NumberOf<Dual<T, N>> : NumberOf<T> {};

/// Lane by lane, for scalars with lanes.
template <class Mask, class T, int N>
  requires has_lanes<T>
CLUTCHWORK_INLINE Dual<T, N> select(const Mask& which, const Dual<T, N>& a, const Dual<T, N>& b) {
  Dual<T, N> r(select(which, a.v, b.v));
  for (int i = 0; i < N; ++i) r.d[i] = select(which, a.d[i], b.d[i]);
  return r;
}

template <class T, int N>
CLUTCHWORK_INLINE Dual<T, N> exp(const Dual<T, N>& x) {
  const T e = exp(x.v);
  return Dual<T, N>::chain(x, e, e);
}
template <class T, int N>
CLUTCHWORK_INLINE Dual<T, N> log(const Dual<T, N>& x) {
  return Dual<T, N>::chain(x, log(x.v), T(1) / x.v);
}
template <class T, int N>
CLUTCHWORK_INLINE Dual<T, N> sqrt(const Dual<T, N>& x) {
  const T r = sqrt(x.v);
  return Dual<T, N>::chain(x, r, T(0.5) / r);
}
template <class T, int N>
CLUTCHWORK_INLINE Dual<T, N> sin(const Dual<T, N>& x) {
  return Dual<T, N>::chain(x, sin(x.v), cos(x.v));
}
template <class T, int N>
CLUTCHWORK_INLINE Dual<T, N> cos(const Dual<T, N>& x) {
  return Dual<T, N>::chain(x, cos(x.v), -sin(x.v));
}
template <class T, int N>
CLUTCHWORK_INLINE Dual<T, N> atan(const Dual<T, N>& x) {
  return Dual<T, N>::chain(x, atan(x.v), T(1) / (T(1) + x.v * x.v));
}
template <class T, int N>
CLUTCHWORK_INLINE Dual<T, N> tanh(const Dual<T, N>& x) {
  const T t = tanh(x.v);
  return Dual<T, N>::chain(x, t, T(1) - t * t);
}
template <class T, int N>
CLUTCHWORK_INLINE Dual<T, N> abs(const Dual<T, N>& x) {
  return select(value(x.v) < 0, -x, x);
}
/// Power of a positive base.
template <class T, int N>
CLUTCHWORK_INLINE Dual<T, N> pow(const Dual<T, N>& a, const Dual<T, N>& b) {
  const T p = pow(a.v, b.v);
  return Dual<T, N>::chain(a, b.v * pow(a.v, b.v - T(1)), b, p * log(a.v), p);
}

/// y += a x, for a plain factor.
template <class T>
CLUTCHWORK_INLINE void add_times(T a, const T& x, T& y) {
  y += a * x;
}
template <class T, int N>
CLUTCHWORK_INLINE void add_times(T a, const Dual<T, N>& x, Dual<T, N>& y) {
  y.v += a * x.v;
  for (int i = 0; i < N; ++i) y.d[i] += a * x.d[i];
}

}  // namespace clutchwork

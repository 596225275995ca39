#pragma once
#include <clutchwork/components/scalar.hpp>

namespace clutchwork {

/// What stands for a T without derivatives of its own.
template <class S, class T>
concept Plain = std::is_convertible_v<const S&, T>;

/// It as a T where that costs nothing.
template <class T, class S>
CLUTCHWORK_INLINE decltype(auto) as_plain(const S& x) {
  if constexpr (std::is_floating_point_v<T>)
    return T(x);
  else
    return (x);
}

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

  CLUTCHWORK_INLINE Dual& operator+=(const Dual& b) { return *this = *this + b; }
  CLUTCHWORK_INLINE Dual& operator-=(const Dual& b) { return *this = *this - b; }
  CLUTCHWORK_INLINE Dual& operator*=(const Dual& b) { return *this = *this * b; }
  CLUTCHWORK_INLINE Dual& operator/=(const Dual& b) { return *this = *this / b; }

  friend CLUTCHWORK_INLINE Dual operator-(const Dual& a) { return of<negative>(a); }
  friend CLUTCHWORK_INLINE Dual operator+(const Dual& a, const Dual& b) { return of<sum>(a, b); }
  friend CLUTCHWORK_INLINE Dual operator-(const Dual& a, const Dual& b) { return of<difference>(a, b); }
  friend CLUTCHWORK_INLINE Dual operator*(const Dual& a, const Dual& b) { return of<product>(a, b); }
  friend CLUTCHWORK_INLINE Dual operator/(const Dual& a, const Dual& b) { return of<quotient>(a, b); }

  // a number without derivatives
  template <Plain<T> S>
  friend CLUTCHWORK_INLINE Dual operator+(Dual a, const S& b) {
    a.v += as_plain<T>(b);
    return a;
  }
  template <Plain<T> S>
  friend CLUTCHWORK_INLINE Dual operator-(Dual a, const S& b) {
    a.v -= as_plain<T>(b);
    return a;
  }
  template <Plain<T> S>
  friend CLUTCHWORK_INLINE Dual operator+(const S& a, const Dual& b) {
    return b + a;
  }
  template <Plain<T> S>
  friend CLUTCHWORK_INLINE Dual operator-(const S& a, const Dual& b) {
    return -b + a;
  }
  template <Plain<T> S>
  friend CLUTCHWORK_INLINE Dual operator*(const Dual& a, const S& b) {
    return of<multiple<std::remove_cvref_t<decltype(as_plain<T>(b))>>>(a, as_plain<T>(b));
  }
  template <Plain<T> S>
  friend CLUTCHWORK_INLINE Dual operator*(const S& a, const Dual& b) {
    return b * a;
  }
  template <Plain<T> S>
  friend CLUTCHWORK_INLINE Dual operator/(const Dual& a, const S& b) {
    return of<fraction>(a, T(b));
  }
  template <Plain<T> S>
  friend CLUTCHWORK_INLINE Dual operator/(const S& a, const Dual& b) {
    return Dual(T(a)) / b;
  }

  friend auto operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend auto operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
  friend auto operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
  friend auto operator>=(const Dual& a, const Dual& b) { return a.v >= b.v; }
  friend auto operator==(const Dual& a, const Dual& b) { return a.v == b.v; }
  friend auto operator!=(const Dual& a, const Dual& b) { return a.v != b.v; }

  /// f(a) with derivative slope.
  static CLUTCHWORK_INLINE Dual chain(const Dual& a, const T& f, const T& slope) { return of<by_one>(a, f, slope); }
  /// f(a, b) with partial derivatives fa and fb.
  static CLUTCHWORK_INLINE Dual chain(const Dual& a, const T& fa, const Dual& b, const T& fb, const T& f) {
    return of<by_two>(a, fa, b, fb, f);
  }

 private:
  /// An operation: by a call where each of its numbers is a loop over derivatives, beside which a call costs nothing.
  template <auto operation, class... A>
  static CLUTCHWORK_INLINE Dual of(const A&... a) {
    if constexpr (has_tangents<T>)
      return by_call<operation>(a...);
    else
      return operation(a...);
  }
  template <auto operation, class... A>
  [[gnu::noinline]] static Dual by_call(const A&... a) {
    return operation(a...);
  }

  static CLUTCHWORK_INLINE Dual negative(const Dual& a) {
    Dual r(-a.v);
    for (int i = 0; i < N; ++i) r.d[i] = -a.d[i];
    return r;
  }
  static CLUTCHWORK_INLINE Dual sum(const Dual& a, const Dual& b) {
    Dual r(a.v + b.v);
    for (int i = 0; i < N; ++i) r.d[i] = a.d[i] + b.d[i];
    return r;
  }
  static CLUTCHWORK_INLINE Dual difference(const Dual& a, const Dual& b) {
    Dual r(a.v - b.v);
    for (int i = 0; i < N; ++i) r.d[i] = a.d[i] - b.d[i];
    return r;
  }
  template <class S>
  static CLUTCHWORK_INLINE Dual multiple(const Dual& a, const S& b) {
    Dual r(a.v * b);
    for (int i = 0; i < N; ++i) r.d[i] = a.d[i] * b;
    return r;
  }
  static CLUTCHWORK_INLINE Dual product(const Dual& a, const Dual& b) { return by_two(a, b.v, b, a.v, a.v * b.v); }
  // the value is a.v / b.v as the plain scalar computes it, so that the bits agree
  static CLUTCHWORK_INLINE Dual quotient(const Dual& a, const Dual& b) {
    const T q = a.v / b.v;
    return by_two(a, T(1) / b.v, b, -q / b.v, q);
  }
  static CLUTCHWORK_INLINE Dual fraction(const Dual& a, const T& b) { return by_one(a, a.v / b, T(1) / b); }
  static CLUTCHWORK_INLINE Dual by_one(const Dual& a, const T& f, const T& slope) {
    Dual r(f);
    for (int i = 0; i < N; ++i) r.d[i] = slope * a.d[i];
    return r;
  }
  static CLUTCHWORK_INLINE Dual by_two(const Dual& a, const T& fa, const Dual& b, const T& fb, const T& f) {
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
CLUTCHWORK_INLINE Dual<T, N> cbrt(const Dual<T, N>& x) {
  const T r = cbrt(x.v);
  return Dual<T, N>::chain(x, r, T(1) / (T(3) * r * r));
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

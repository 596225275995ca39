#pragma once
#include <clutchwork/components/dual.hpp>
#include <clutchwork/components/slopes.hpp>

/// A number with derivatives of the whole run by some numbers of its model. docs/theory/gradients.md
namespace clutchwork {

/// A value and its derivatives in N directions, R of which are in one register of the processor.
template <int N, int R = 2>
struct Tangent {
  typedef double Part __attribute__((vector_size(8 * R)));
  static constexpr int kept = N, seen = N, parts = N / R, lanes = R;
  using Widest = Slopes<N, R>;  ///< its derivatives alone
  alignas(8 * R) Part part[parts]{};
  double v = 0;

  Tangent() = default;
  CLUTCHWORK_HOT Tangent(double x) : v(x) {}

  /// The number v whose derivatives are those that f makes of the parts.
  template <class F>
  static CLUTCHWORK_HOT Tangent each(double v, F&& f) {
    Tangent r;
    r.v = v;
    for (int i = 0; i < parts; ++i) r.part[i] = f(i);
    return r;
  }
  /// f(x) with derivative slope.
  static CLUTCHWORK_HOT Tangent chain(const Tangent& x, double f, double slope) {
    return each(f, [&](int i) { return x.part[i] * slope; });
  }

  CLUTCHWORK_HOT Tangent& operator+=(const Tangent& b) {
    v += b.v;
    for (int i = 0; i < parts; ++i) part[i] += b.part[i];
    return *this;
  }
  CLUTCHWORK_HOT Tangent& operator-=(const Tangent& b) {
    v -= b.v;
    for (int i = 0; i < parts; ++i) part[i] -= b.part[i];
    return *this;
  }
  CLUTCHWORK_HOT Tangent& operator*=(const Tangent& b) { return *this = *this * b; }
  CLUTCHWORK_HOT Tangent& operator/=(const Tangent& b) { return *this = *this / b; }

  friend CLUTCHWORK_HOT Tangent operator-(const Tangent& a) {
    return each(-a.v, [&](int i) { return -a.part[i]; });
  }
  friend CLUTCHWORK_HOT Tangent operator+(const Tangent& a, const Tangent& b) {
    return each(a.v + b.v, [&](int i) { return a.part[i] + b.part[i]; });
  }
  friend CLUTCHWORK_HOT Tangent operator-(const Tangent& a, const Tangent& b) {
    return each(a.v - b.v, [&](int i) { return a.part[i] - b.part[i]; });
  }
  friend CLUTCHWORK_HOT Tangent operator*(const Tangent& a, const Tangent& b) {
    return each(a.v * b.v, [&](int i) { return a.part[i] * b.v + b.part[i] * a.v; });
  }
  friend CLUTCHWORK_HOT Tangent operator/(const Tangent& a, const Tangent& b) {
    const double q = a.v / b.v, inverse = 1 / b.v;
    return each(q, [&](int i) { return (a.part[i] - b.part[i] * q) * inverse; });
  }
  // a plain factor has no derivatives
  friend CLUTCHWORK_HOT Tangent operator*(double a, const Tangent& b) { return chain(b, a * b.v, a); }
  friend CLUTCHWORK_HOT Tangent operator*(const Tangent& a, double b) { return chain(a, a.v * b, b); }
  friend CLUTCHWORK_HOT Tangent operator/(const Tangent& a, double b) { return chain(a, a.v / b, 1 / b); }

  friend CLUTCHWORK_HOT bool operator<(const Tangent& a, const Tangent& b) { return a.v < b.v; }
  friend CLUTCHWORK_HOT bool operator>(const Tangent& a, const Tangent& b) { return a.v > b.v; }
  friend CLUTCHWORK_HOT bool operator<=(const Tangent& a, const Tangent& b) { return a.v <= b.v; }
  friend CLUTCHWORK_HOT bool operator>=(const Tangent& a, const Tangent& b) { return a.v >= b.v; }
  friend CLUTCHWORK_HOT bool operator==(const Tangent& a, const Tangent& b) { return a.v == b.v; }
  friend CLUTCHWORK_HOT bool operator!=(const Tangent& a, const Tangent& b) { return a.v != b.v; }

  friend CLUTCHWORK_HOT double value(const Tangent& x) { return x.v; }
  /// What is left of it where its value is zero.
  friend CLUTCHWORK_HOT Tangent without_value(const Tangent& x) { return chain(x, 0.0, 1.0); }
  /// One derivative.
  double& slope(int i) { return reinterpret_cast<double*>(part)[i]; }
  double slope(int i) const { return reinterpret_cast<const double*>(part)[i]; }
  double seen_slope(int i) const { return slope(i); }
  /// f(std::type_identity<X>{}) with an X for the derivatives alone: in one direction, or in all.
  template <class F>
  static auto over(int directions, F&& f) {
    if (directions <= 1) return f(std::type_identity<double>{});
    return f(std::type_identity<Widest>{});
  }
  /// What a row keeps of the derivatives.
  friend CLUTCHWORK_HOT void keep(const Tangent& x, double* to) {
    for (int i = 0; i < N; ++i) to[i] = x.slope(i);
  }
  /// Largest size of what differs between two derivatives.
  friend double largest_difference(const Tangent& a, const Tangent& b) {
    double most = 0;
    for (int i = 0; i < N; ++i) most = larger(most, abs(a.slope(i) - b.slope(i)));
    return most;
  }
  friend CLUTCHWORK_HOT bool is_constant(const Tangent& x) {
    for (int i = 0; i < N; ++i) {
      if (x.slope(i) != 0) return false;
    }
    return true;
  }
  friend CLUTCHWORK_HOT bool is_zero(const Tangent& x) { return x.v == 0 && is_constant(x); }
};

template <int N, int R>
struct NumberOf<Tangent<N, R>> : NumberOf<double> {
  static constexpr bool tangents = true;
  using Given = Tangent<N, R>;
  using Point = Tangent<N, R>;
};

template <int N, int R>
struct SlopesAs<Tangent<N, R>, Slopes<N, R>> {
  using T = Tangent<N, R>;
  using X = Slopes<N, R>;
  using Seen = X;
  static constexpr int count = N;
  static CLUTCHWORK_HOT X of(const T& x) {
    X slopes;
    for (int i = 0; i < X::parts; ++i) slopes.part[i] = x.part[i];
    return slopes;
  }
  static CLUTCHWORK_HOT T number(double v, const X& slopes) {
    T x(v);
    for (int i = 0; i < X::parts; ++i) x.part[i] = slopes.part[i];
    return x;
  }
  static CLUTCHWORK_HOT const Seen& seen(const X& slopes) { return slopes; }
  static CLUTCHWORK_HOT Seen seen_of(const T& x) { return of(x); }
  static CLUTCHWORK_HOT double at(const Seen& slopes, int j) { return slopes.part[j / R][j % R]; }
};
template <int N, int R>
struct SlopesAs<Tangent<N, R>, double> {
  using T = Tangent<N, R>;
  using Seen = double;
  static constexpr int count = 1;
  static CLUTCHWORK_HOT double of(const T& x) { return x.part[0][0]; }
  static CLUTCHWORK_HOT T number(double v, double slope) {
    T x(v);
    // as a whole register: one that is written in pieces has to wait where it is read
    x.part[0] = typename T::Part{slope};
    return x;
  }
  static CLUTCHWORK_HOT double seen(double slope) { return slope; }
  static CLUTCHWORK_HOT double seen_of(const T& x) { return of(x); }
  static CLUTCHWORK_HOT double at(double slope, int) { return slope; }
};

#define CLUTCHWORK_CHAIN(NAME, F, SLOPE)                      \
  template <int N, int R>                                     \
  CLUTCHWORK_HOT Tangent<N, R> NAME(const Tangent<N, R>& x) { \
    const double f = F;                                       \
    return Tangent<N, R>::chain(x, f, SLOPE);                 \
  }
CLUTCHWORK_CHAIN(exp, exp(x.v), f)
CLUTCHWORK_CHAIN(log, log(x.v), 1 / x.v)
CLUTCHWORK_CHAIN(sqrt, sqrt(x.v), f > 0 ? 0.5 / f : 0.0)
CLUTCHWORK_CHAIN(cbrt, cbrt(x.v), f > 0 ? 1 / (3 * f * f) : 0.0)
CLUTCHWORK_CHAIN(sin, sin(x.v), cos(x.v))
CLUTCHWORK_CHAIN(cos, cos(x.v), -sin(x.v))
CLUTCHWORK_CHAIN(atan, atan(x.v), 1 / (1 + x.v * x.v))
CLUTCHWORK_CHAIN(tanh, tanh(x.v), 1 - f * f)
#undef CLUTCHWORK_CHAIN

template <int N, int R>
CLUTCHWORK_HOT Tangent<N, R> abs(const Tangent<N, R>& x) {
  return x.v < 0 ? -x : x;
}
/// Power of a positive base.
template <int N, int R>
CLUTCHWORK_HOT Tangent<N, R> pow(const Tangent<N, R>& a, const Tangent<N, R>& b) {
  const double p = pow(a.v, b.v);
  const double by_base = b.v * pow(a.v, b.v - 1), by_power = a.v > 0 ? p * log(a.v) : 0.0;
  return Tangent<N, R>::each(p, [&](int i) { return a.part[i] * by_base + b.part[i] * by_power; });
}
template <int N, int R>
CLUTCHWORK_HOT void add_times(double a, const Tangent<N, R>& x, Tangent<N, R>& y) {
  y.v += a * x.v;
  for (int i = 0; i < Tangent<N, R>::parts; ++i) y.part[i] += x.part[i] * a;
}
template <int N, int R>
CLUTCHWORK_HOT void add_times(Tangent<N, R> a, const Tangent<N, R>& x, Tangent<N, R>& y) {
  y += a * x;
}

}  // namespace clutchwork

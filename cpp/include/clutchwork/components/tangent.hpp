#pragma once
#include <clutchwork/components/dual.hpp>

/// A number with derivatives of the whole run by some numbers of its model. docs/theory/gradients.md
namespace clutchwork {

/// A value and its derivatives in N directions, which are a vector of the processor.
template <int N>
struct Tangent {
  typedef double Vector __attribute__((vector_size(8 * N)));
  double v = 0;
  Vector d{};

  Tangent() = default;
  CLUTCHWORK_INLINE Tangent(double x) : v(x) {}
  CLUTCHWORK_INLINE Tangent(double x, const Vector& slope) : v(x), d(slope) {}

  CLUTCHWORK_INLINE Tangent& operator+=(const Tangent& b) { return v += b.v, d += b.d, *this; }
  CLUTCHWORK_INLINE Tangent& operator-=(const Tangent& b) { return v -= b.v, d -= b.d, *this; }
  CLUTCHWORK_INLINE Tangent& operator*=(const Tangent& b) { return *this = *this * b; }
  CLUTCHWORK_INLINE Tangent& operator/=(const Tangent& b) { return *this = *this / b; }

  friend CLUTCHWORK_INLINE Tangent operator-(const Tangent& a) { return {-a.v, -a.d}; }
  friend CLUTCHWORK_INLINE Tangent operator+(const Tangent& a, const Tangent& b) { return {a.v + b.v, a.d + b.d}; }
  friend CLUTCHWORK_INLINE Tangent operator-(const Tangent& a, const Tangent& b) { return {a.v - b.v, a.d - b.d}; }
  friend CLUTCHWORK_INLINE Tangent operator*(const Tangent& a, const Tangent& b) {
    return {a.v * b.v, a.d * b.v + b.d * a.v};
  }
  friend CLUTCHWORK_INLINE Tangent operator/(const Tangent& a, const Tangent& b) {
    const double q = a.v / b.v;
    return {q, (a.d - b.d * q) * (1 / b.v)};
  }
  // a plain factor has no derivatives
  friend CLUTCHWORK_INLINE Tangent operator*(double a, const Tangent& b) { return {a * b.v, b.d * a}; }
  friend CLUTCHWORK_INLINE Tangent operator*(const Tangent& a, double b) { return {a.v * b, a.d * b}; }
  friend CLUTCHWORK_INLINE Tangent operator/(const Tangent& a, double b) { return {a.v / b, a.d * (1 / b)}; }
  friend CLUTCHWORK_INLINE Tangent operator+(double a, const Tangent& b) { return {a + b.v, b.d}; }
  friend CLUTCHWORK_INLINE Tangent operator+(const Tangent& a, double b) { return {a.v + b, a.d}; }
  friend CLUTCHWORK_INLINE Tangent operator-(double a, const Tangent& b) { return {a - b.v, -b.d}; }
  friend CLUTCHWORK_INLINE Tangent operator-(const Tangent& a, double b) { return {a.v - b, a.d}; }

  friend CLUTCHWORK_INLINE bool operator<(const Tangent& a, const Tangent& b) { return a.v < b.v; }
  friend CLUTCHWORK_INLINE bool operator>(const Tangent& a, const Tangent& b) { return a.v > b.v; }
  friend CLUTCHWORK_INLINE bool operator<=(const Tangent& a, const Tangent& b) { return a.v <= b.v; }
  friend CLUTCHWORK_INLINE bool operator>=(const Tangent& a, const Tangent& b) { return a.v >= b.v; }
  friend CLUTCHWORK_INLINE bool operator==(const Tangent& a, const Tangent& b) { return a.v == b.v; }
  friend CLUTCHWORK_INLINE bool operator!=(const Tangent& a, const Tangent& b) { return a.v != b.v; }

  friend CLUTCHWORK_INLINE double value(const Tangent& x) { return x.v; }
  /// f(x) with derivative slope.
  static CLUTCHWORK_INLINE Tangent chain(const Tangent& x, double f, double slope) { return {f, x.d * slope}; }
  /// What is left of it where its value is zero.
  friend CLUTCHWORK_INLINE Tangent without_value(const Tangent& x) { return {0.0, x.d}; }
  /// What a row keeps of the derivatives.
  static constexpr int kept = N;
  friend CLUTCHWORK_INLINE void keep(const Tangent& x, double* to) {
    const auto* d = reinterpret_cast<const double*>(&x.d);
    for (int i = 0; i < N; ++i) to[i] = d[i];
  }
  /// Largest size of what differs between two derivatives.
  friend double largest_difference(const Tangent& a, const Tangent& b) {
    const Vector apart = a.d - b.d;
    const auto* d = reinterpret_cast<const double*>(&apart);
    double most = 0;
    for (int i = 0; i < N; ++i) most = larger(most, abs(d[i]));
    return most;
  }
  friend CLUTCHWORK_INLINE bool is_zero(const Tangent& x) {
    bool none = x.v == 0;
    const auto* d = reinterpret_cast<const double*>(&x.d);
    for (int i = 0; i < N; ++i) none = none && d[i] == 0;
    return none;
  }
};

template <int N>
struct NumberOf<Tangent<N>> : NumberOf<double> {
  static constexpr bool tangents = true;
  using Given = Tangent<N>;
  using Point = double;
};

#define CLUTCHWORK_CHAIN(NAME, F, SLOPE)                   \
  template <int N>                                         \
  CLUTCHWORK_INLINE Tangent<N> NAME(const Tangent<N>& x) { \
    const double f = F;                                    \
    return Tangent<N>::chain(x, f, SLOPE);                 \
  }
CLUTCHWORK_CHAIN(exp, exp(x.v), f)
CLUTCHWORK_CHAIN(log, log(x.v), 1 / x.v)
CLUTCHWORK_CHAIN(sqrt, sqrt(x.v), f > 0 ? 0.5 / f : 0.0)
CLUTCHWORK_CHAIN(sin, sin(x.v), cos(x.v))
CLUTCHWORK_CHAIN(cos, cos(x.v), -sin(x.v))
CLUTCHWORK_CHAIN(atan, atan(x.v), 1 / (1 + x.v * x.v))
CLUTCHWORK_CHAIN(tanh, tanh(x.v), 1 - f * f)
#undef CLUTCHWORK_CHAIN

template <int N>
CLUTCHWORK_INLINE Tangent<N> abs(const Tangent<N>& x) {
  return x.v < 0 ? -x : x;
}
/// Power of a positive base.
template <int N>
CLUTCHWORK_INLINE Tangent<N> pow(const Tangent<N>& a, const Tangent<N>& b) {
  const double p = pow(a.v, b.v);
  const double by_base = b.v * pow(a.v, b.v - 1), by_power = a.v > 0 ? p * log(a.v) : 0.0;
  return {p, a.d * by_base + b.d * by_power};
}
template <int N>
CLUTCHWORK_INLINE void add_times(Tangent<N> a, const Tangent<N>& x, Tangent<N>& y) {
  y += a * x;
}

}  // namespace clutchwork

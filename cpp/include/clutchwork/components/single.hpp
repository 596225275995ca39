#pragma once
#include <clutchwork/components/scalar.hpp>
#include <clutchwork/layout.gen.hpp>

/// Numbers of single precision, for processors whose floating-point unit has no other: docs/theory/fixed-steps.md
namespace clutchwork {

/// A float that mixes with constants: these become floats where they are compiled, and nothing becomes a double unless
/// it is asked for.
struct Single {
  float v = 0;

  constexpr Single() = default;
  constexpr Single(float x) : v(x) {}
  constexpr Single(double x) : v(float(x)) {}
  template <class I>
    requires std::is_integral_v<I>
  constexpr Single(I x) : v(float(x)) {}

  template <class X>
    requires std::is_arithmetic_v<X>
  constexpr explicit operator X() const {
    return X(v);
  }

  CLUTCHWORK_HOT Single& operator+=(Single b) { return v += b.v, *this; }
  CLUTCHWORK_HOT Single& operator-=(Single b) { return v -= b.v, *this; }
  CLUTCHWORK_HOT Single& operator*=(Single b) { return v *= b.v, *this; }
  CLUTCHWORK_HOT Single& operator/=(Single b) { return v /= b.v, *this; }

  friend CLUTCHWORK_HOT Single operator-(Single a) { return -a.v; }
  friend CLUTCHWORK_HOT Single operator+(Single a, Single b) { return a.v + b.v; }
  friend CLUTCHWORK_HOT Single operator-(Single a, Single b) { return a.v - b.v; }
  friend CLUTCHWORK_HOT Single operator*(Single a, Single b) { return a.v * b.v; }
  friend CLUTCHWORK_HOT Single operator/(Single a, Single b) { return a.v / b.v; }
  friend CLUTCHWORK_HOT bool operator==(Single a, Single b) { return a.v == b.v; }
  friend CLUTCHWORK_HOT bool operator!=(Single a, Single b) { return a.v != b.v; }
  friend CLUTCHWORK_HOT bool operator<(Single a, Single b) { return a.v < b.v; }
  friend CLUTCHWORK_HOT bool operator>(Single a, Single b) { return a.v > b.v; }
  friend CLUTCHWORK_HOT bool operator<=(Single a, Single b) { return a.v <= b.v; }
  friend CLUTCHWORK_HOT bool operator>=(Single a, Single b) { return a.v >= b.v; }

  friend CLUTCHWORK_HOT Single value(Single x) { return x; }
  friend CLUTCHWORK_HOT bool is_zero(Single x) { return x.v == 0; }
  friend CLUTCHWORK_HOT Single larger(Single a, Single b) { return b.v > a.v ? b : a; }
  friend CLUTCHWORK_HOT Single smaller(Single a, Single b) { return b.v < a.v ? b : a; }
  friend CLUTCHWORK_HOT Single abs(Single x) { return __builtin_fabsf(x.v); }
  friend CLUTCHWORK_HOT Single sqrt(Single x) { return __builtin_sqrtf(x.v); }
  friend CLUTCHWORK_HOT Single nearbyint(Single x) { return __builtin_nearbyintf(x.v); }
  friend CLUTCHWORK_HOT Single floor(Single x) { return __builtin_floorf(x.v); }
  friend CLUTCHWORK_HOT Single fmod(Single x, Single y) { return __builtin_fmodf(x.v, y.v); }
};

template <>
struct NumberOf<Single> {
  using Real = Single;
  using Truth = bool;
  static constexpr bool lanes = false;
  static constexpr bool tangents = false;
  static constexpr bool single = true;
  using Given = Single;
  using Point = Single;
};

/// Instants stay double: a float of a day has hundredths of a second.
template <>
struct InstantOf<Single> {
  using type = double;
};

/// What is left of a sum a + b that was rounded to `sum`: exact, docs/theory/fixed-steps.md (14).
CLUTCHWORK_HOT Single lost_of(Single a, Single b, Single sum) {
  const Single part = sum - a;
  return (a - (sum - part)) + (b - part);
}
/// x += change, where `low` is what x has not taken yet.
CLUTCHWORK_HOT void add_to(Single& x, Single& low, Single change) {
  const Single all = low + change, sum = x + all;
  low = lost_of(x, all, sum), x = sum;
}

/// A number in two singles, the second one too small for the first: for matrices that many steps use.
struct Twofold {
  float high = 0, low = 0;

  constexpr Twofold() = default;
  constexpr Twofold(Single x) : high(x.v) {}
  constexpr Twofold(int x) : high(float(x)) {}
  constexpr Twofold(float a, float b) : high(a), low(b) {}
  explicit operator Single() const { return high; }

  /// a + b, exactly.
  static Twofold sum(float a, float b) {
    const float s = a + b, part = s - a;
    return {s, (a - (s - part)) + (b - part)};
  }
  /// a b, exactly: 12 bits of each.
  static Twofold product(float a, float b) {
    const float p = a * b, c = 4097.0f * a, d = 4097.0f * b;
    const float a1 = c - (c - a), a2 = a - a1, b1 = d - (d - b), b2 = b - b1;
    return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
  }
  friend Twofold operator-(Twofold a) { return {-a.high, -a.low}; }
  friend Twofold operator+(Twofold a, Twofold b) {
    const Twofold s = sum(a.high, b.high);
    return sum(s.high, s.low + (a.low + b.low));
  }
  friend Twofold operator-(Twofold a, Twofold b) { return a + -b; }
  friend Twofold operator*(Twofold a, Twofold b) {
    const Twofold p = product(a.high, b.high);
    return sum(p.high, p.low + (a.high * b.low + a.low * b.high));
  }
  friend Twofold operator/(Twofold a, Twofold b) {
    const float q = a.high / b.high;
    return sum(q, (a - b * Twofold(q, 0)).high / b.high);
  }
  Twofold& operator+=(Twofold b) { return *this = *this + b; }
  Twofold& operator-=(Twofold b) { return *this = *this - b; }

  friend Single value(Twofold x) { return x.high; }
  friend Twofold sqrt(Twofold x) {
    const float root = __builtin_sqrtf(x.high);
    return sum(root, (x - product(root, root)).high / (2.0f * root));
  }
};

/// Elementary functions within two units of the last place.
inline Single exp(Single a) {
  const float x = a.v;
  if (!(x < 88.8f)) return x != x ? a : Single(std::numeric_limits<float>::infinity());
  if (x < -104.0f) return 0.0f;
  constexpr float shift = 12582912.0f;
  const float shifted = 1.44269504f * x + shift, k = shifted - shift;
  const float r = (x - k * 0.693145752f) - k * 1.42860677e-6f;
  const float above =
      r +
      r * r * (1.0f / 2 + r * (1.0f / 6 + r * (1.0f / 24 + r * (1.0f / 120 + r * (1.0f / 720 + r * (1.0f / 5040))))));
  // two factors, for results that are no normal numbers
  const int n = int(k), half = n / 2;
  const auto power = [](int e) { return std::bit_cast<float>(std::uint32_t(e + 127) << 23); };
  return (1.0f + above) * power(half) * power(n - half);
}

/// The logarithm of a positive number in two parts.
inline void log_parts(float x, float& high, float& low) {
  int k = 0;
  if (x < 0x1p-126f) x *= 0x1p24f, k = -24;
  const std::int32_t above = std::bit_cast<std::int32_t>(x) - 0x3f3504f3;
  k += above >> 23;
  const float m = std::bit_cast<float>(std::bit_cast<std::int32_t>(x) - ((above >> 23) << 23));
  const float f = m - 1.0f, s = f / (2.0f + f), z = s * s;
  // 2 atanh(s) = f - s (f - 2 (s^2 / 3 + s^4 / 5 ...) s^-1 ...), which is exact in its first part
  const float rest = s * (2.0f * z * (1.0f / 3 + z * (1.0f / 5 + z * (1.0f / 7 + z * (1.0f / 9)))) - f);
  const float first = float(k) * 0.693145752f, sum = first + f, part = sum - first;
  const float lost = ((first - (sum - part)) + (f - part)) + (float(k) * 1.42860677e-6f + rest);
  high = sum + lost, low = (sum - high) + lost;
}
inline Single log(Single a) {
  constexpr float endless = std::numeric_limits<float>::infinity();
  if (!(a.v > 0)) return a.v == 0 ? -endless : std::numeric_limits<float>::quiet_NaN();
  if (a.v == endless) return a;
  float high, low;
  log_parts(a.v, high, low);
  return high + low;
}

/// A power of a number that is not negative, as components ask for.
inline Single pow(Single x, Single y) {
  constexpr float endless = std::numeric_limits<float>::infinity();
  if (y.v == 0 || x.v == 1) return 1.0f;
  if (x.v != x.v || y.v != y.v) return x + y;
  if (x.v == 0) return y.v > 0 ? 0.0f : endless;
  if (x.v < 0) {
    const float whole = __builtin_floorf(y.v);
    if (whole != y.v) return std::numeric_limits<float>::quiet_NaN();
    const Single size = pow(-x, y);
    return __builtin_floorf(0.5f * whole) != 0.5f * whole ? -size : size;
  }
  if (x.v == endless) return y.v > 0 ? endless : 0.0f;
  float high, low;
  log_parts(x.v, high, low);
  const float p = y.v * high;
  if (!(p < 100.0f && p > -120.0f)) return p > 0 ? endless : 0.0f;
  // 12 bits of each, so that the product is exact
  const float a = 4097.0f * y.v, b = 4097.0f * high, y1 = a - (a - y.v), h1 = b - (b - high);
  const float y2 = y.v - y1, h2 = high - h1, left = ((y1 * h1 - p) + y1 * h2 + y2 * h1) + y2 * h2;
  const Single e = exp(Single(p));
  return e.v < endless ? e + e * Single(left + y.v * low) : e;
}

/// sin where `ahead` is 0, cos where it is 1, of angles of some thousand turns at most.
inline Single sine_ahead(float x, int ahead) {
  constexpr float shift = 12582912.0f;
  if (!(__builtin_fabsf(x) < 1e30f)) return std::numeric_limits<float>::quiet_NaN();
  if (__builtin_fabsf(x) > 1e4f) x = __builtin_fmodf(x, 6.28318531f);
  const float k = (x * 0.636619772f + shift) - shift;
  // half a pi in parts of 11 bits, so that the products are exact
  const float r = ((x - k * 1.5703125f) - k * 4.83751297e-4f) - k * 7.54978942e-8f, z = r * r;
  const int number = (int(k) + ahead) & 3;
  const float size = number & 1 ? 1.0f - z * (0.5f - z * (1.0f / 24 - z * (1.0f / 720 - z * (1.0f / 40320))))
                                : r - r * z * (1.0f / 6 - z * (1.0f / 120 - z * (1.0f / 5040 - z * (1.0f / 362880))));
  return number & 2 ? -size : size;
}
inline Single sin(Single x) { return sine_ahead(x.v, 0); }
inline Single cos(Single x) { return sine_ahead(x.v, 1); }

inline Single tanh(Single a) {
  const float x = a.v, size = __builtin_fabsf(x);
  if (size < 0.625f) {
    // continued fraction of Lambert to its ninth
    const float z = x * x;
    return x - x * z * (315.0f + z * 14.0f) / (945.0f + z * (420.0f + z * 15.0f));
  }
  const float y = size > 9.0f ? 1.0f : 1.0f - 2.0f / (exp(Single(2.0f * size)).v + 1.0f);
  return x < 0 ? -y : x != x ? x : y;
}

inline Single atan(Single a) {
  const float x = a.v, size = __builtin_fabsf(x);
  if (x != x) return a;
  // about 0, 1/2 and 1
  constexpr float known[] = {0.0f, 0.463647609f, 0.785398163f};
  const float u = size > 1.0f ? 1.0f / size : size;
  const int i = u < 0.25f ? 0 : u < 0.75f ? 1 : 2;
  const float near = 0.5f * float(i), t = (u - near) / (1.0f + u * near), z = t * t;
  const float series = t - t * z * (1.0f / 3 - z * (1.0f / 5 - z * (1.0f / 7 - z * (1.0f / 9 - z * (1.0f / 11)))));
  const float y = size > 1.0f ? 1.57079633f - (known[i] + series) : known[i] + series;
  return x < 0 ? -y : y;
}

/// Of a number that is not negative.
inline Single cbrt(Single x) {
  if (!(x.v > 0) || x.v - x.v != 0) return x;
  const Single y = pow(x, Single(1.0f / 3));
  return y - (y * y * y - x) / (Single(3.0f) * y * y);
}

}  // namespace clutchwork

/// What a fixed step computes with, and what makes its matrices: an exported model says it, docs/guide/export.md.
namespace clutchwork::fixed {
#ifdef CLUTCHWORK_SINGLE
using real = Single;
using wide = Twofold;
#else
using real = double;
using wide = double;
#endif
}  // namespace clutchwork::fixed

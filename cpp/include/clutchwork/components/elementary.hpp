#pragma once
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

// what every step spends its time in is inlined in every build, the rest where a build asks for speed:
// decisions/0041-light.md
#ifndef CLUTCHWORK_HOT
#define CLUTCHWORK_HOT inline __attribute__((always_inline))
#define CLUTCHWORK_HOT_LAMBDA __attribute__((always_inline))
#else
#define CLUTCHWORK_HOT_LAMBDA
#endif
#ifndef CLUTCHWORK_INLINE
#define CLUTCHWORK_INLINE CLUTCHWORK_HOT
#endif

// what compilers may do with sums has to stop here
#if defined(__FAST_MATH__)
#error "clutchwork computes the same bits everywhere: compile it without -ffast-math"
#endif

/// Elementary functions from additions, products and divisions alone, so that every machine has the same bits of them:
/// mathematical libraries differ in the last one. Within one unit of it. docs/theory/elementary.md
namespace clutchwork {

static_assert(FLT_EVAL_METHOD == 0,
              "clutchwork needs doubles without further digits: compile it with -msse2 -mfpmath=sse");

// these are exact in every library
using std::abs, std::floor, std::fmod, std::nearbyint, std::sqrt;

/// A number in two parts, the second one too small for the first.
struct Pair {
  double high, low;
};

constexpr Pair exact_sum(double a, double b) {
  const double s = a + b, part = s - a;
  return {s, (a - (s - part)) + (b - part)};
}
constexpr Pair exact_product(double a, double b) {
  // 27 bits of each
  constexpr double split = 134217729.0;
  const double p = a * b, c = split * a, d = split * b;
  const double a1 = c - (c - a), a2 = a - a1, b1 = d - (d - b), b2 = b - b1;
  return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
}
constexpr Pair operator+(Pair a, Pair b) {
  const Pair s = exact_sum(a.high, b.high);
  return exact_sum(s.high, s.low + (a.low + b.low));
}
constexpr Pair operator*(Pair a, Pair b) {
  const Pair p = exact_product(a.high, b.high);
  return exact_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

/// c[0] + z (c[1] + z (c[2] + ...)). X: a number, or several in one register of the processor.
template <int N, class X>
CLUTCHWORK_HOT constexpr X polynomial(const double (&c)[N], X z) {
  X s = c[N - 2] + z * c[N - 1];
  for (int i = N - 3; i >= 0; --i) s = c[i] + z * s;
  return s;
}

/// Whole numbers of the width of X.
template <class X>
struct WordsOf {
  typedef std::uint64_t Type __attribute__((vector_size(sizeof(X))));
};
template <>
struct WordsOf<double> {
  using Type = std::uint64_t;
};
template <class X>
using BitsOf = typename WordsOf<X>::Type;

/// What a table has at these places.
template <class X>
CLUTCHWORK_HOT X looked_up(const double* table, const BitsOf<X>& place) {
  if constexpr (std::is_same_v<X, double>) {
    return table[place];
  } else {
    X found;
    for (std::size_t i = 0; i < sizeof(X) / sizeof(double); ++i) found[i] = table[place[i]];
    return found;
  }
}

/// The nearest whole number, for sizes below 2^51.
CLUTCHWORK_HOT double nearest(double x) {
  constexpr double shift = 6755399441055744.0;
  return (x + shift) - shift;
}

namespace powers {

/// 2^(i / 64), and its own last part over it.
struct Table {
  static constexpr int size = 64;
  double of[size], rest[size];

  constexpr Table() : of{}, rest{} {
    constexpr Pair step = {0x1.62e42fefa39efp-7, 0x1.abc9e3b39803fp-62};
    for (int i = 0; i < size; ++i) {
      const Pair x = step * Pair{double(i), 0};
      Pair sum = {1, 0}, term = {1, 0};
      for (int n = 1; n < 40; ++n) {
        // one over n in two parts
        const double inverse = 1.0 / n;
        const Pair back = exact_product(inverse, n);
        term = term * x * Pair{inverse, ((1 - back.high) - back.low) / n};
        sum = sum + term;
      }
      of[i] = sum.high, rest[i] = sum.low / sum.high;
    }
  }
};
inline constexpr Table table;

}  // namespace powers

/// exp for sizes below 708, where results are normal numbers; elsewhere anything.
template <class X>
CLUTCHWORK_HOT X exp_inside(X x) {
  // whole numbers end at the last bit of a number of this size
  constexpr double shift = 6755399441055744.0, per_step = 0x1.71547652b82fep+6;
  constexpr double step[] = {0x1.62e42fee00000p-7, 0x1.a39ef35793c76p-39};
  const X shifted = per_step * x + shift, k = shifted - shift;
  const auto n = std::bit_cast<BitsOf<X>>(shifted), i = n & std::uint64_t(powers::Table::size - 1);
  const X r = (x - k * step[0]) - k * step[1], square = r * r;
  const X of = looked_up<X>(powers::table.of, i), rest = looked_up<X>(powers::table.rest, i);
  const X scale = std::bit_cast<X>(std::bit_cast<BitsOf<X>>(of) + ((n - i) << 46));
  const X above = (rest + r) + square * (1.0 / 2 + r * (1.0 / 6)) + square * square * (1.0 / 24 + r * (1.0 / 120));
  return scale + scale * above;
}

/// exp of what is large, or not a number.
[[gnu::noinline]] inline double exp_outside(double x) {
  if (x != x) return x;
  if (abs(x) > 1400) return x > 0 ? std::numeric_limits<double>::infinity() : 0;
  const double half = exp_inside(0.5 * x);
  return half * half;
}

inline double exp(double x) { return x < 708 && x > -708 ? exp_inside(x) : exp_outside(x); }

/// The logarithm of a positive number in two parts.
inline Pair log_parts(double x) {
  constexpr double ln2[] = {0x1.62e42fee00000p-1, 0x1.a39ef35793c76p-33};
  // 2 atanh(s) = 2 s (1 + s^2 / 3 + s^4 / 5 ...)
  constexpr double series[] = {1.0 / 3,  1.0 / 5,  1.0 / 7,  1.0 / 9,  1.0 / 11,
                               1.0 / 13, 1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21};
  constexpr std::int64_t root_half = 0x3fe6a09e667f3bcd;
  std::int64_t k = 0;
  if (x < 0x1p-1022) x *= 0x1p54, k = -54;
  const std::int64_t above = std::bit_cast<std::int64_t>(x) - root_half;
  k += above >> 52;
  const double m = std::bit_cast<double>(std::bit_cast<std::int64_t>(x) - ((above >> 52) << 52));
  const double f = m - 1, g = 2 + f, g_low = f - (g - 2), s = f / g;
  const Pair back = exact_product(s, g);
  const double s_low = (((f - back.high) - back.low) - s * g_low) / g, z = s * s;
  const Pair sum = exact_sum(double(k) * ln2[0], 2 * s);
  return exact_sum(sum.high, sum.low + (double(k) * ln2[1] + (2 * s_low + 2 * s * z * polynomial(series, z))));
}

inline double log(double x) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!(x > 0)) return x == 0 ? -infinity : std::numeric_limits<double>::quiet_NaN();
  if (x == infinity) return x;
  return log_parts(x).high;
}

inline double pow(double x, double y) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (y == 0 || x == 1) return 1;
  if (x != x || y != y) return x + y;
  const bool whole = floor(y) == y, odd = whole && floor(0.5 * y) != 0.5 * y;
  if (x == 0) return y > 0 ? (odd ? x : 0) : (odd ? 1 / x : infinity);
  if (x < 0) {
    if (!whole) return std::numeric_limits<double>::quiet_NaN();
    const double size = pow(-x, y);
    return odd ? -size : size;
  }
  if (x == infinity) return y > 0 ? infinity : 0;
  const Pair l = log_parts(x);
  const double rough = y * l.high;
  if (!(rough < 800 && rough > -800)) return rough > 0 ? infinity : 0;
  const Pair p = exact_product(y, l.high);
  const double e = exp(p.high);
  // the end of numbers lies before that of the product
  return e < infinity ? e + e * (p.low + y * l.low) : e;
}

/// An angle less so many right angles: the rest, within an eighth of a turn, in two parts.
struct Quarter {
  Pair rest;
  int number;
};

inline Quarter quarter_of(double x) {
  // half a pi in parts of 24 bits, so that the products are exact
  constexpr double part[] = {0x1.921fb4p+0, 0x1.4442dp-24, 0x1.846988p-48, 0x1.8cc516p-72};
  constexpr double turn = 0x1.921fb54442d18p+2, far = 5e8;
  if (abs(x) <= 0x1.921fb54442d18p-1) return {{x, 0}, 0};
  if (!(abs(x) < std::numeric_limits<double>::infinity())) return {{std::numeric_limits<double>::quiet_NaN(), 0}, 0};
  if (abs(x) > far) x = fmod(x, turn);
  const double k = nearest(x * 0x1.45f306dc9c883p-1);
  Pair r = {x - k * part[0], 0};
  r = r + Pair{-k * part[1], 0};
  r = r + Pair{-k * part[2], 0};
  r = r + Pair{-k * part[3], 0};
  return {r, int(std::int64_t(k) & 3)};
}

CLUTCHWORK_HOT double sine_near(Pair r) {
  constexpr double series[] = {-1.0 / 6,
                               1.0 / 120,
                               -1.0 / 5040,
                               1.0 / 362880,
                               -1.0 / 39916800,
                               1.0 / 6227020800.0,
                               -1.0 / 1307674368000.0,
                               1.0 / 355687428096000.0};
  const double z = r.high * r.high;
  return r.high + (r.high * z * polynomial(series, z) + r.low * (1 - 0.5 * z));
}

CLUTCHWORK_HOT double cosine_near(Pair r) {
  constexpr double series[] = {1.0 / 24,
                               -1.0 / 720,
                               1.0 / 40320,
                               -1.0 / 3628800,
                               1.0 / 479001600,
                               -1.0 / 87178291200.0,
                               1.0 / 20922789888000.0,
                               -1.0 / 6402373705728000.0};
  const double z = r.high * r.high, half = 0.5 * z, w = 1 - half;
  return w + (((1 - w) - half) + (z * z * polynomial(series, z) - r.high * r.low));
}

inline double sin(double x) {
  const Quarter q = quarter_of(x);
  const double size = q.number & 1 ? cosine_near(q.rest) : sine_near(q.rest);
  return q.number & 2 ? -size : size;
}

inline double cos(double x) {
  const Quarter q = quarter_of(x);
  const double size = q.number & 1 ? sine_near(q.rest) : cosine_near(q.rest);
  return q.number == 1 || q.number == 2 ? -size : size;
}

/// tanh for sizes below 0.625: continued fraction of Lambert to its seventeenth.
template <class X>
CLUTCHWORK_HOT X tanh_near(X x) {
  constexpr double above[] = {11486475, 810810, 12870, 44}, below[] = {34459425, 16216200, 945945, 13860, 45};
  const X z = x * x;
  return x - x * (z * polynomial(above, z) / polynomial(below, z));
}

/// The same for sizes above, up to 20, from which on it is one to the last bit.
template <class X>
CLUTCHWORK_HOT X tanh_far(X size) {
  return 1 - 2 / (exp_inside(2 * size) + 1);
}

inline double tanh(double x) {
  const double size = abs(x);
  if (size < 0.625) return tanh_near(x);
  const double y = size > 20 ? 1 : tanh_far(size);
  return x < 0 ? -y : x != x ? x : y;
}

inline double atan(double x) {
  // of i / 8, in two parts
  constexpr Pair known[] = {{0, 0},
                            {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                            {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                            {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                            {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                            {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                            {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                            {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                            {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
  constexpr Pair right = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
  constexpr double series[] = {-1.0 / 3,  1.0 / 5,  -1.0 / 7,  1.0 / 9,  -1.0 / 11, 1.0 / 13,
                               -1.0 / 15, 1.0 / 17, -1.0 / 19, 1.0 / 21, -1.0 / 23};
  if (x != x) return x;
  const double size = abs(x), u = size > 1 ? 1 / size : size;
  const int i = u < 0.1875 ? 0 : int(8 * u + 0.5);
  const double t = i == 0 ? u : (u - 0.125 * i) / (1 + u * (0.125 * i)), z = t * t;
  const double rest = known[i].low + (t + t * z * polynomial(series, z));
  const double y = size > 1 ? right.high - known[i].high + (right.low - rest) : known[i].high + rest;
  return x < 0 ? -y : y;
}

/// Of a number that is not negative.
inline double cbrt(double x) {
  if (!(x > 0) || x - x != 0) return x;
  const double y = pow(x, 1.0 / 3);
  return y - (y * y * y - x) / (3 * y * y);
}

/// x^(-1/5) of a normal positive number, to 4 units of its last place: an eighth of the instructions of the power.
inline double fifth_root_of_inverse(double x) {
  // the exponent is divided with the digits behind it, less what a straight line misses of a logarithm: right to 4 %
  double y = std::bit_cast<double>(0x4cb8'a7ef'9db2'2d0e - std::bit_cast<std::int64_t>(x) / 5);
  for (int round = 0; round < 2; ++round) {
    // the series of (1 + off)^(-1/5), off being how far x y^5 is from one
    const double square = y * y, off = x * y * (square * square) - 1;
    y -= y * (off * (0.2 - off * (0.12 - off * 0.088)));
  }
  return y;
}

inline float exp(float x) { return float(exp(double(x))); }
inline float log(float x) { return float(log(double(x))); }
inline float pow(float x, float y) { return float(pow(double(x), double(y))); }
inline float sin(float x) { return float(sin(double(x))); }
inline float cos(float x) { return float(cos(double(x))); }
inline float tanh(float x) { return float(tanh(double(x))); }
inline float atan(float x) { return float(atan(double(x))); }

}  // namespace clutchwork

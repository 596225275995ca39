#pragma once
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

/// Checks that print what failed and count; a test ends with `return check::result();`.
namespace check {

inline int failures = 0, checks = 0;

inline bool that(bool good, const char* text, const char* file, int line) {
  ++checks;
  if (good) return true;
  if (++failures <= 20) std::printf("%s:%d: not so: %s\n", file, line, text);
  return false;
}

inline bool near(double a, double b, double tolerance, const char* text, const char* file, int line) {
  ++checks;
  if (std::fabs(a - b) <= tolerance) return true;
  if (++failures <= 20) {
    std::printf("%s:%d: %s: %.17g against %.17g, off by %.3g > %.3g\n", file, line, text, a, b, a - b, tolerance);
  }
  return false;
}

inline bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// How many random cases are tried of so many: a part of them in the first tier, as tests/support/tiers.py says.
inline int part(int count) {
  const char* tier = std::getenv("CLUTCHWORK_TIER");
  return tier != nullptr && std::strcmp(tier, "first") == 0 ? (count + 3) / 4 : count;
}

/// Exit status of the test.
inline int result() {
  std::printf("%d checks, %d failed\n", checks, failures);
  return failures == 0 ? 0 : 1;
}

/// Random numbers that are the same everywhere (splitmix64).
struct Random {
  std::uint64_t state;
  std::uint64_t next() {
    std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double unit() { return double(next() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  int below(int n) { return int(next() % std::uint64_t(n)); }
};

}  // namespace check

#define CHECK(condition) check::that(condition, #condition, __FILE__, __LINE__)
#define CHECK_NEAR(a, b, tolerance) check::near(a, b, tolerance, #a, __FILE__, __LINE__)

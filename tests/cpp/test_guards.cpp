// The search for the first zero of a guard: polynomials with known roots.

#include <clutchwork/run/guards/list.hpp>

#include "check.hpp"

using namespace clutchwork;

namespace {

struct Quartic {
  double a[5];
  double operator()(double s) const { return a[0] + s * (a[1] + s * (a[2] + s * (a[3] + s * a[4]))); }
  void bernstein(double* b) const {
    constexpr double choose[5][5] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}};
    for (int i = 0; i < 5; ++i) {
      b[i] = 0;
      for (int j = 0; j <= i; ++j) b[i] += choose[i][j] / choose[4][j] * a[j];
    }
  }
};

/// scale (s - r1)(s - r2) (1 + u s + w s^2), the last factor positive on [0, 1].
Quartic dip(double scale, double r1, double r2, double u, double w) {
  const double p = r1 * r2, q = -(r1 + r2);
  return {{scale * p, scale * (q + p * u), scale * (1 + q * u + p * w), scale * (u + q * w), scale * w}};
}

/// Where the core finds the first crossing; -1: none.
double find(const Quartic& f, double tolerance) {
  double b[5], low = 0, high = 1;
  f.bernstein(b);
  if (!first_bracket(b, tolerance, 40, f(1.0) < 0, low, high)) return -1;
  const double f_high = f(high);
  return f_high >= 0 ? high : locate(f, low, larger(f(low), 0.0), high, f_high);
}

/// In and out again within one step: none below the tolerance is missed, none found that is not there.
void double_crossings() {
  check::Random g{7};
  int deep = 0, shallow = 0;
  for (int round = 0; round < 10000; ++round) {
    const double scale = std::pow(10.0, g.between(-3, 3)), gap = std::pow(10.0, g.between(-6, -0.1));
    const double r1 = g.between(0, 1 - gap), r2 = r1 + gap;
    const Quartic f = dip(scale, r1, r2, g.between(-0.9, 2), g.between(0, 1));
    double b[5], size = 0, lowest = 0;
    f.bernstein(b);
    for (double x : b) size = larger(size, abs(x));
    for (int i = 1; i < 20; ++i) lowest = smaller(lowest, f(r1 + gap * i / 20));
    const double tolerance = 1e-9 * size, s = find(f, tolerance);
    // twice the tolerance: halves of one dip that fall on both sides of a split are judged apart
    if (lowest < -2 * tolerance) {
      ++deep;
      if (!CHECK(s >= 0)) continue;
      CHECK(s <= r1 + 0.5 * gap);
      CHECK_NEAR(f(s), 0.0, tolerance);
      if (lowest < -1e3 * tolerance) CHECK_NEAR(s, r1, 1e-9);
    } else if (lowest > -tolerance) {
      shallow += s < 0;
    }
  }
  CHECK(deep > 5000 && shallow > 500);
}

/// Positive quartics have no crossing; a single crossing is found to round-off.
void single_crossings() {
  check::Random g{8};
  for (int round = 0; round < 10000; ++round) {
    const double r = g.between(1e-3, 1);
    const Quartic f = dip(-1, r, -g.between(0.5, 3), g.between(-0.9, 2), g.between(0, 1));
    CHECK_NEAR(find(f, 1e-12), r, 1e-12);
    const Quartic clear = dip(1, 1.1 + g.unit(), 1.2 + g.unit(), g.between(-0.9, 2), g.between(0, 1));
    CHECK(find(clear, 1e-12) == -1);
  }
}

/// Three crossings: the first one counts.
void first_of_three() {
  check::Random g{9};
  for (int round = 0; round < 10000; ++round) {
    const double r1 = g.between(0.01, 0.3), r2 = r1 + g.between(0.01, 0.3), r3 = r2 + g.between(0.01, 0.3);
    const Quartic f{{r1 * r2 * r3, -(r1 * r2 + r1 * r3 + r2 * r3), r1 + r2 + r3, -1, 0}};
    CHECK_NEAR(find(f, 1e-12), r1, 1e-11);
  }
}

/// Samples and the vertex of a parabola see a dip of any function that bends slowly.
void sampled_crossings() {
  check::Random g{10};
  for (int round = 0; round < 2000; ++round) {
    const double middle = g.between(0.15, 0.85), depth = g.between(1e-4, 0.2), width = g.between(3, 6);
    auto f = [&](double s) { return std::cosh(width * (s - middle)) - 1 - depth; };
    const double root = middle - std::acosh(1 + depth) / width;
    if (root <= 0) continue;
    CHECK_NEAR(first_crossing(f, f(0), f(1), 1.0), root, 1e-10);
    auto clear = [&](double s) { return f(s) + 1.01 * depth; };
    CHECK(first_crossing(clear, clear(0), clear(1), 1.0) == -1);
  }
}

}  // namespace

int test_guards() {
  double_crossings();
  single_crossings();
  first_of_three();
  sampled_crossings();
  return check::result();
}

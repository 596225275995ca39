#pragma once
#include "check.hpp"
#include "fixture.hpp"

/// Friction laws by themselves: numbers of the Stribeck curve, and motions whose outcome is known.
namespace fixture {

/// Numbers of a Stribeck curve; an exponent only where the shape has one.
inline Numbers stribeck_curve(double static_, double kinetic, double speed, int shape = 0, double viscous = 0) {
  return {static_, kinetic, speed, double(shape), shape == 3 ? 1.3 : 2.0, viscous};
}

/// docs/theory/friction-laws.md (4) and (5), from the numbers above.
inline double curve_at(const Numbers& c, double slip) {
  const double x = std::fabs(slip) / c[2];
  const double share[] = {std::exp(-x * x), std::exp(-x), 1 / (1 + x * x), std::exp(-std::pow(x, c[4]))};
  return c[1] + (c[0] - c[1]) * share[int(c[3])];
}

inline double sign(double x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0; }

/// A disc on the housing under a constant load.
template <class L>
int disc(Model& m, double inertia, double speed, double load, const Numbers& law) {
  const int shaft = m.shaft(inertia, speed);
  m.contact<elements::BearingFriction, L>(housing, shaft, {load}, {}, law);
  return shaft;
}

/// A disc whose speed is prescribed, which nothing can hold; another one beside it is free.
template <class L>
int driven(Model& m, const std::vector<Segment>& speed, double load, const Numbers& law) {
  m.shaft(1);
  const int shaft = m.prescribed(1, m.signal(speed));
  m.contact<elements::BearingFriction, L>(housing, shaft, {load}, {}, law);
  return shaft;
}

/// A run on tight tolerances, so that closed forms are met.
struct TightRun : Run {
  explicit TightRun(const Model& model, double rtol = 1e-10) : Run(model) {
    CHECK(cw_set_option(run, "rtol", rtol) == 1 && cw_set_option(run, "atol", 1e-2 * rtol) == 1);
  }
  /// Rows at n equal steps up to `end`: `visit(t, row)`.
  template <class F>
  void grid(double end, int n, F&& visit) {
    const double start = cw_time(run);
    Numbers times(n), rows(std::size_t(n * at.size));
    for (int i = 0; i < n; ++i) times[i] = start + (end - start) * (i + 1) / n;
    std::int64_t filled = 0;
    CHECK(cw_advance(run, end, times.data(), rows.data(), n, 0, &filled) == 0);
    CHECK(filled == n);
    for (std::int64_t i = 0; i < filled; ++i) visit(times[i], &rows[i * at.size]);
  }
};

}  // namespace fixture

#pragma once
#include <clutchwork/components/component.hpp>

/// Curves over an own state, piece by piece: docs/theory/compliance.md.
namespace clutchwork {

/// Slope of a curve on one of its pieces.
template <class T, class G>
G piece_slope(const Curve<T>& c, const G* points, int piece) {
  return points[3 * (int(value(c.first)) + piece) + 2];
}

/// Width of a curve, 1 where it has a single point: what counts as far along it.
template <class T, class G>
Real<T> curve_width(const Curve<T>& c, const G* points) {
  const G* p = points + 3 * int(value(c.first));
  const int n = int(value(c.count));
  return n > 1 ? value(p[3 * (n - 1)]) - value(p[0]) : Real<T>(1);
}

/// The piece that x is on; the present one where x is at its end.
template <class T>
int stretch_of(const Curve<T>& c, const auto* points, Real<T> x, int piece) {
  const Real<T> slack = roundoff<T>(1e-12, 1e-6) * curve_width(c, points);
  while (piece > 0 && x < value(curve_edge(c, points, piece - 1)) - slack) --piece;
  while (piece < curve_edges(c) && x > value(curve_edge(c, points, piece)) + slack) ++piece;
  return piece;
}

/// Watch both ends of the piece that x is on, f(room over the width, next piece); the outer ones have one end or none.
template <class T, class S, class F>
void each_end(const Curve<T>& c, const auto* points, const S& x, int piece, F&& f) {
  const int edges = curve_edges(c);
  const S width = S(curve_width(c, points));
  if (piece < edges) f((S(curve_edge(c, points, piece)) - x) / width, piece + 1);
  if (piece > 0) f((x - S(curve_edge(c, points, piece - 1))) / width, piece - 1);
}

}  // namespace clutchwork

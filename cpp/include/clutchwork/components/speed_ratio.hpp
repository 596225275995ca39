#pragma once
#include <clutchwork/components/component.hpp>

/// Tables over a ratio of two speeds that ends at 1, as pieces: docs/theory/coupled.md.
namespace clutchwork {

/// Whether a speed is so small that its square, and with it every torque, is zero; a ratio over it may not be finite.
template <class S>
CLUTCHWORK_HOT bool vanishes(const S& speed) {
  return abs(value(speed)) < 1e-150;
}

/// A list of numbers in the pool.
template <class G>
struct List {
  const G* x;
  int count;

  G operator[](int i) const { return x[3 * i]; }
};
template <class T, class G>
CLUTCHWORK_HOT List<G> list_of(const Curve<T>& c, const G* points) {
  return {points + 3 * int(common(c.first)), int(common(c.count))};
}

/// Number of the piece that holds a ratio: 0 below the first point, then the interval that ends at that point.
CLUTCHWORK_HOT int ratio_piece(const auto& ratios, auto x) {
  int piece = 0;
  while (piece + 1 < ratios.count && x >= ratios[piece]) ++piece;
  return piece;
}

/// A quantity over the ratio on one piece; `at(i)` is its value at a point, `above` the ratio less 1, which is exact
/// where both speeds are the same.
template <class S, class At_>
CLUTCHWORK_HOT S over_ratio(const auto& ratios, int piece, const S& above, At_&& at) {
  if (piece == 0) return S(at(0));
  const auto slope = (at(piece) - at(piece - 1)) / (ratios[piece] - ratios[piece - 1]);
  return above * slope + (at(piece) + slope * (1.0 - ratios[piece]));
}

}  // namespace clutchwork

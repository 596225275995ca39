#pragma once
#include <clutchwork/components/component.hpp>
#include <clutchwork/components/stribeck_curve.hpp>

/// Elements in parallel that bend and then slide: what Leuven and GMS share. Element i is one point of a curve
/// (deflection at which it breaks away, share of the coefficient); bit i of the piece: it slides.
namespace clutchwork {

inline constexpr int most_elements = 10;

template <class T>
CLUTCHWORK_HOT int element_count(const Curve<T>& c) {
  const int n = int(value(c.count));
  return n < most_elements ? n : most_elements;
}

template <class T, class G>
CLUTCHWORK_HOT G element_deflection(const Curve<T>& c, const G* points, int i) {
  return points[3 * (int(value(c.first)) + i)];
}

template <class T, class G>
CLUTCHWORK_HOT G element_share(const Curve<T>& c, const G* points, int i) {
  return points[3 * (int(value(c.first)) + i) + 1];
}

CLUTCHWORK_HOT bool element_slides(int piece, int i) { return (piece >> i & 1) != 0; }

template <class S>
CLUTCHWORK_HOT S element_sum(const S* state, int n) {
  S sum = state[0];
  for (int i = 1; i < n; ++i) sum += state[i];
  return sum;
}

}  // namespace clutchwork

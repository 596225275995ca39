#pragma once
#include <clutchwork/components/scalar.hpp>

/// The first zero of a function inside a step: docs/theory/events.md.
namespace clutchwork {

/// First interval in which a quartic in Bernstein form turns from not negative to negative. b[0] counts as not
/// negative; inner dips above -tolerance do not count, the end value does.
inline bool first_bracket(const double* b, double tolerance, int depth, bool last, double& low, double& high) {
  int changes = 0;
  bool dips = last && b[4] < 0, below = false;
  for (int i = 1; i < 5; ++i) {
    dips = dips || b[i] < -tolerance;
    changes += (b[i] < 0) != below;
    below = b[i] < 0;
  }
  if (!dips) return false;
  if (below && (changes == 1 || depth == 0)) return true;
  if (depth == 0) return false;
  // split in the middle
  double left[5], right[5], work[5];
  for (int i = 0; i < 5; ++i) work[i] = b[i];
  work[0] = larger(work[0], 0.0);
  for (int k = 0; k < 5; ++k) {
    left[k] = work[0];
    right[4 - k] = work[4 - k];
    for (int i = 0; i < 4 - k; ++i) work[i] = 0.5 * (work[i] + work[i + 1]);
  }
  const double middle = 0.5 * (low + high);
  double end = middle;
  if (first_bracket(left, tolerance, depth - 1, false, low, end)) return high = end, true;
  low = middle;
  return first_bracket(right, tolerance, depth - 1, last, low, high);
}

/// Value of a function that is compiled once for all places that ask for it.
template <class F>
[[gnu::noinline]] double sample(F& f, double x) {
  return f(x);
}

/// Root of a decreasing-through-zero function on [low, high] with f(low) >= 0 > f(high), to round-off (ITP). One that
/// starts at zero is followed back to where it is above, in so many halvings.
template <class F>
double locate(F&& f, double low, double f_low, double high, double f_high, int halvings = 12) {
  // a guard that starts on its surface: step off it, or it is hit at once
  for (int k = 1; k < halvings && f_low <= 0; ++k) {
    const double x = low + (high - low) / double(1ll << k), y = f(x);
    if (y > 0) low = x, f_low = y;
  }
  if (f_low <= 0) return low;
  for (int i = 0; i < 100 && high - low > 4e-16 * (1 + high); ++i) {
    // false position, bisection every third time
    double x = (low * f_high - high * f_low) / (f_high - f_low);
    if (i % 3 == 2 || !(x > low && x < high)) x = 0.5 * (low + high);
    if (x <= low || x >= high) break;
    const double y = f(x);
    if (y > 0) {
      low = x, f_low = y;
    } else if (y < 0) {
      high = x, f_high = y;
    } else {
      return x;
    }
  }
  return high;
}

/// First zero of a function with kinks, which may dip sharply between two samples: a fine grid, and at each of its
/// lowest places a search for the bottom; then its root. -1: none before `limit`.
template <class F>
[[gnu::noinline]] double first_dip(F&& sampled, double start, double end, double limit, int rounds = 16) {
  constexpr int intervals = 16;
  auto f = [&](double s) { return sample(sampled, s); };
  auto place = [&](int i) { return limit * i / intervals; };
  double y[intervals + 1];
  y[0] = larger(start, 0.0);
  for (int i = 1; i <= intervals; ++i) {
    y[i] = i == intervals && limit == 1 ? end : f(place(i));
    if (y[i] < 0) return locate(f, place(i - 1), y[i - 1], place(i), y[i]);
    const bool low = i >= 2 && y[i - 1] <= y[i - 2] && y[i - 1] <= y[i];
    if (!low || y[i - 1] > 2 * (y[i - 2] + y[i] - 2 * y[i - 1])) continue;
    // thirds towards the bottom
    double left = place(i - 2), right = place(i), before = y[i - 2];
    for (int k = 0; k < rounds; ++k) {
      const double a = left + (right - left) / 3, b = right - (right - left) / 3, at_a = f(a);
      if (at_a < 0) return locate(f, left, before, a, at_a);
      const double at_b = f(b);
      if (at_b < 0) return locate(f, a, at_a, b, at_b);
      at_a > at_b ? (left = a, before = at_a) : (right = b);
    }
  }
  return -1;
}

/// A zero by the first sample below zero, among four inner points and the vertex of a parabola at the lowest of them;
/// -1: none.
template <class F>
[[gnu::noinline]] double any_crossing(F&& f, double start, double end, double limit) {
  double x[8], y[8];
  int n = 0;
  x[n] = 0, y[n++] = larger(start, 0.0);
  for (int i = 1; i < 5; ++i) x[n] = 0.2 * i * limit, y[n] = f(x[n]), ++n;
  x[n] = limit, y[n++] = end;
  int low = 0;
  for (int i = 1; i < n; ++i) {
    if (y[i] < 0) return locate(f, x[i - 1], y[i - 1], x[i], y[i]);
    if (y[i] < y[low]) low = i;
  }
  // one that is low at an end may dip elsewhere
  for (int i = 1; (low == 0 || low == n - 1) && i < n - 1; ++i) {
    if (y[i] < y[i - 1] && y[i] < y[i + 1]) low = i;
  }
  // vertex through the lowest sample and its neighbours; once more, closer, where it almost touches
  const int middle = low == 0 ? 1 : low == n - 1 ? n - 2 : low;
  double centre = x[middle], step = x[middle] - x[middle - 1];
  double left = y[middle - 1], here = y[middle], right = y[middle + 1];
  for (int round = 0; round < 2; ++round) {
    const double d = left - 2 * here + right;
    if (d <= 0) return -1;
    const double vertex = centre + 0.5 * step * (left - right) / d;
    if (vertex <= 0 || vertex >= limit || abs(vertex - centre) > step) return -1;
    const double bottom = f(vertex);
    if (bottom < 0) {
      int before = 0;
      while (before + 1 < n && x[before + 1] < vertex) ++before;
      return locate(f, x[before], y[before], vertex, bottom);
    }
    if (bottom > 0.01 * larger(left, right)) return -1;
    step *= 0.1;
    centre = vertex, here = bottom;
    left = f(larger(0.0, vertex - step)), right = f(smaller(limit, vertex + step));
  }
  return -1;
}

/// First zero of a guard that may dip between samples; a later one may have been seen first. One that starts below zero
/// comes back at first.
template <class F>
double first_crossing(F&& sampled, double start, double end, double limit) {
  constexpr int earlier = 3;
  auto f = [&](double s) { return sample(sampled, s); };
  double s = any_crossing(f, start, limit == 1 ? end : f(limit), limit);
  for (int k = 0; k < earlier && start >= 0 && s > 0; ++k) {
    const double before = any_crossing(f, start, 0.0, s);
    if (!(before >= 0 && before < s)) break;
    s = before;
  }
  return s;
}

}  // namespace clutchwork

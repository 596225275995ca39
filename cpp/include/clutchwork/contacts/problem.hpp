#pragma once
#include <clutchwork/components/envelope.hpp>
#include <clutchwork/workspace/settings.hpp>

/// The bounded convex problem behind sticking: docs/theory/contacts.md.
namespace clutchwork {

/// Mobility of the n contacts of a problem, of which each has some in common with few others, its neighbours.
template <class T>
struct Neighbours {
  int n;
  Envelope near;      ///< of all contacts, in their order
  const T* mobility;  ///< in it
  T* diagonal;        ///< n
  const int* list;    ///< contacts, n
  const int *place, *last, *slot;
  int* row;

  int place_of(int i) const { return place[list[i]]; }
  /// Calls f(j, G_ij) for the neighbours j of i, i among them, in their order.
  template <class F>
  CLUTCHWORK_HOT void each(int i, F&& f) const {
    const int p = place_of(i);
    const T* own = mobility + near.sky[p];
    for (int q = near.low[p]; q < p; ++q) {
      if (slot[q] >= 0) f(slot[q], own[q]);
    }
    f(i, diagonal[i]);
    for (int q = p + 1; q <= last[p]; ++q) {
      if (slot[q] >= 0 && near.low[q] <= p) f(slot[q], mobility[near.sky[q] + p]);
    }
  }
};

/// One problem: minimise 1/2 x'(G + E)x + g'x over lower <= x <= upper; E is a small weight by capacity.
/// Views into memory of the caller; n contacts.
template <class T>
struct BoundedProblem {
  int n;
  Neighbours<T> matrix;  ///< G
  T* gradient;           ///< n, g: slip accelerations without the contact torques
  T* lower;              ///< n, may be -infinity
  T* upper;              ///< n, may be +infinity
  T* weight;             ///< n, the diagonal of E
  T* x;                  ///< n, start and solution
  T* slope;              ///< n, G x + g at the end: the slip accelerations
  T* trial;              ///< n
  Envelope near;         ///< of the factor
  T* factor;             ///< of the free contacts
  int* bound;            ///< n: 0 free, -1 at lower, +1 at upper
  int* free;             ///< n, in the order of the factor
};

/// Weights of the regularisation: equal share of capacity among redundant contacts. capacity[i] may be infinite.
template <class T>
void capacity_weights(BoundedProblem<T>& p, const T* capacity, double small = 1e-10) {
  double largest = 0;
  for (int i = 0; i < p.n; ++i) {
    const double c = value(capacity[i]);
    if (c < infinity && c > largest) largest = c;
  }
  for (int i = 0; i < p.n; ++i) {
    const double c = value(capacity[i]);
    const double ratio = c > 0 && c < infinity ? largest / c : 1;
    p.weight[i] = p.matrix.diagonal[i] * T(small * (ratio < 1e6 ? ratio : 1e6));
  }
}

/// G x + g for one contact.
template <class T>
T slope_of(const BoundedProblem<T>& p, int i) {
  T s = T(0);
  p.matrix.each(i, [&](int j, T g) { s += g * p.x[j]; });
  return s + p.gradient[i];
}

/// List the free contacts in the order of their places, and lay the rows of their factor; how many.
template <class T>
int list_free(BoundedProblem<T>& p) {
  const Neighbours<T>& g = p.matrix;
  int m = 0, most = -1, least = p.n > 0 ? g.place_of(0) : 0;
  for (int i = 0; i < p.n; ++i) least = smaller(least, g.place_of(i)), most = larger(most, g.place_of(i));
  for (int q = least; q <= most; ++q) {
    const int i = g.slot[q];
    g.row[q] = m;
    if (i < 0 || p.bound[i] != 0) continue;
    p.near.low[m] = p.near.whole ? 0 : g.row[larger(g.near.low[q], least)];
    p.free[m++] = i;
  }
  p.near.lay(m);
  return m;
}

/// Factor (G + E) of the free contacts; returns their number, or -1 when it is not positive definite.
template <class T>
int factor_free(BoundedProblem<T>& p) {
  const Neighbours<T>& g = p.matrix;
  p.near.whole = g.near.whole;
  const int m = list_free(p);
  for (int a = 0; a < m; ++a) {
    const int i = p.free[a], place = g.place_of(i);
    T* row = p.factor + p.near.sky[a];
    for (int b = p.near.low[a]; b < a; ++b) row[b] = g.mobility[g.near.sky[place] + g.place_of(p.free[b])];
    row[a] = g.diagonal[i] + p.weight[i];
  }
  return cholesky(m, p.near, p.factor) ? m : -1;
}

/// Newton step of the m free contacts, already factored, towards the minimum, bounds ignored; `regular` keeps the
/// weight in the residual.
template <class T>
void newton_step(BoundedProblem<T>& p, int m, bool regular) {
  for (int a = 0; a < m; ++a) {
    const int i = p.free[a];
    p.trial[a] = -(slope_of(p, i) + (regular ? p.weight[i] * p.x[i] : T(0)));
  }
  forward_solve(m, p.near, p.factor, p.trial);
  backward_solve(m, p.near, p.factor, p.trial);
  for (int a = 0; a < m; ++a) p.slope[p.free[a]] = p.trial[a];
}

/// The share of its step at which contact i meets a bound; infinity: it does not, or does not move.
template <class T>
T room_of(const BoundedProblem<T>& p, int i) {
  if (p.bound[i] != 0 || value(p.slope[i]) == 0) return T(infinity);
  const T limit = p.slope[i] > T(0) ? p.upper[i] : p.lower[i];
  return abs(value(limit)) == infinity ? T(infinity) : (limit - p.x[i]) / p.slope[i];
}

/// Of a step: what meets a bound within it meets it at once, but for round-off.
inline constexpr double at_once = 1e-12;

/// The longest step in [0, 1] that keeps the bounds. Whatever meets a bound there is held at it, all at once where
/// several do. Whether any does.
template <class T>
bool step_to_bounds(BoundedProblem<T>& p) {
  T alpha = T(1);
  bool blocked = false;
  for (int i = 0; i < p.n; ++i) {
    const T room = room_of(p, i);
    if (room < alpha) alpha = larger(room, T(0)), blocked = true;
  }
  for (int i = 0; i < p.n; ++i) {
    if (p.bound[i] != 0) continue;
    const bool meets = blocked && !(room_of(p, i) > alpha + T(at_once));
    p.x[i] += alpha * p.slope[i];
    if (!meets) continue;
    p.bound[i] = p.slope[i] > T(0) ? 1 : -1;
    p.x[i] = p.bound[i] > 0 ? p.upper[i] : p.lower[i];
  }
  return blocked;
}

/// Round-off of the slip acceleration of contact i: of what all torques make of it.
template <class T>
double slope_round_off(const BoundedProblem<T>& p, int i) {
  double scale = abs(value(p.gradient[i]));
  p.matrix.each(i, [&](int j, T g) { scale = larger(scale, abs(value(g * p.x[j]))); });
  return 1e-13 * scale;
}

/// The bound contact whose torque most wants to come back inside (-1: none).
template <class T>
int most_violated(const BoundedProblem<T>& p) {
  int worst = -1;
  double most = 0;
  for (int i = 0; i < p.n; ++i) {
    if (p.bound[i] == 0 || !(p.lower[i] < p.upper[i])) continue;
    const double s = value(slope_of(p, i) + p.weight[i] * p.x[i]) * p.bound[i];
    const double unit = value(sqrt(p.matrix.diagonal[i]));
    if (s / unit > most && s > slope_round_off(p, i)) {
      most = s / unit;
      worst = i;
    }
  }
  return worst;
}

/// Take the weight out again: Newton steps of the m free contacts with the exact matrix. One that meets a bound stays
/// there, and the others are refined without it.
template <class T>
void refine(BoundedProblem<T>& p, int m) {
  int steps = 0;
  for (int round = 0; round < p.n + 3 && steps < 3; ++round) {
    newton_step(p, m, false);
    bool met = false;
    for (int i = 0; i < p.n; ++i) {
      if (p.bound[i] != 0) continue;
      p.x[i] += p.slope[i];
      if (p.x[i] > p.upper[i]) p.x[i] = p.upper[i], p.bound[i] = 1, met = true;
      if (p.x[i] < p.lower[i]) p.x[i] = p.lower[i], p.bound[i] = -1, met = true;
    }
    steps = met ? 0 : steps + 1;
    if (met) m = factor_free(p);
    if (m < 0) return;
  }
}

/// Primal active set on the regularised problem, then refinement on the free contacts; `warm`: what starts at a bound
/// is held there first. False: iteration cap reached.
template <class T>
bool solve(BoundedProblem<T>& p, bool warm = false) {
  for (int i = 0; i < p.n; ++i) {
    p.x[i] = smaller(larger(p.x[i], p.lower[i]), p.upper[i]);
    p.bound[i] = p.lower[i] < p.upper[i] ? 0 : 1;
    if (warm && p.bound[i] == 0) p.bound[i] = int(p.x[i] == p.upper[i]) - int(p.x[i] == p.lower[i]);
  }
  bool solved = false;
  int m = 0;
  for (int round = 0; round < 20 * p.n + 50 && !solved; ++round) {
    m = factor_free(p);
    if (m < 0) return false;
    newton_step(p, m, true);
    if (step_to_bounds(p)) continue;
    const int release = most_violated(p);
    if (release < 0) {
      solved = true;
    } else {
      p.bound[release] = 0;
    }
  }
  refine(p, m);
  for (int i = 0; i < p.n; ++i) p.trial[i] = slope_of(p, i);
  for (int i = 0; i < p.n; ++i) p.slope[i] = p.trial[i];
  return solved;
}

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/single.hpp>

/// Impulses of all contacts over one step, within their bounds, by a primal-dual active set:
/// docs/theory/fixed-steps.md
namespace clutchwork::fixed {

/// Minimise 1/2 x'(W + E)x + g'x over lower <= x <= upper; E is the diagonal `weight`. Views into memory of the caller.
struct Boxes {
  int n;
  const wide* mobility;  ///< W, n x n
  const real *gradient, *lower, *upper, *weight;
  wide *x, *slope;  ///< solution, and W x + g: the slips at the end of the step
  int* side;        ///< 0 free, -1 at lower, 1 at upper: a guess, then the solution
  wide *solved, *factor;
  int* list;
};

/// At most so many sets are tried; the step fails behind it. docs/theory/fixed-steps.md, rule 2
inline constexpr int most_sets = 45;

/// W x + g of contact i.
inline wide slope_of(const Boxes& p, int i) {
  wide s = p.gradient[i];
  const wide* row = p.mobility + i * p.n;
  for (int j = 0; j < p.n; ++j) s += row[j] * p.x[j];
  return s;
}

/// Factor of W + E of the m free contacts of the list, by rows of the length m. False: it is not positive definite.
inline bool factor_free(const Boxes& p, int m) {
  for (int a = 0; a < m; ++a) {
    const wide* own = p.mobility + p.list[a] * p.n;
    wide* row = p.factor + a * m;
    for (int b = 0; b <= a; ++b) {
      const wide* other = p.factor + b * m;
      wide s = own[p.list[b]] + wide(a == b ? p.weight[p.list[a]] : real(0));
      for (int k = 0; k < b; ++k) s -= row[k] * other[k];
      if (a == b && !(value(s) > 0)) return false;
      row[b] = a == b ? sqrt(s) : s / other[b];
    }
  }
  return true;
}

/// solved := -(W + E)^-1 solved of the free contacts.
inline void solve_free(const Boxes& p, int m) {
  wide* y = p.solved;
  for (int a = 0; a < m; ++a) {
    wide s = -y[a];
    for (int k = 0; k < a; ++k) s -= p.factor[a * m + k] * y[k];
    y[a] = s / p.factor[a * m + a];
  }
  for (int a = m - 1; a >= 0; --a) {
    wide s = y[a];
    for (int k = a + 1; k < m; ++k) s -= p.factor[k * m + a] * y[k];
    y[a] = s / p.factor[a * m + a];
  }
}

/// Solve for the free contacts where the others are at their bounds; how many are free, -1: it failed.
inline int solve_set(const Boxes& p) {
  int m = 0;
  for (int i = 0; i < p.n; ++i) {
    if (p.side[i] == 0) p.list[m++] = i;
    p.x[i] = p.side[i] == 0 ? real(0) : p.side[i] > 0 ? p.upper[i] : p.lower[i];
  }
  if (!factor_free(p, m)) return -1;
  for (int a = 0; a < m; ++a) p.solved[a] = slope_of(p, p.list[a]);
  solve_free(p, m);
  for (int a = 0; a < m; ++a) p.x[p.list[a]] = p.solved[a];
  return m;
}

/// Where contact i should be, seen from the present set; its present side where that is right.
inline int wanted_side(const Boxes& p, int i) {
  if (p.side[i] == 0) return real(p.x[i]) < p.lower[i] ? -1 : real(p.x[i]) > p.upper[i] ? 1 : 0;
  if (!(p.lower[i] < p.upper[i])) return p.side[i];
  const wide* row = p.mobility + i * p.n;
  wide s = wide(p.gradient[i]) + p.weight[i] * p.x[i];
  real size = abs(p.gradient[i]);
  for (int j = 0; j < p.n; ++j) s += row[j] * p.x[j], size += abs(real(row[j] * p.x[j]));
  // what round-off makes of a slip decides nothing
  return real(s) * p.side[i] > roundoff<real>(1e-14, 1e-12) * size ? 0 : p.side[i];
}

/// Take the weight out again: one step with the exact matrix, within the bounds.
inline void refine_once(const Boxes& p, int m) {
  for (int a = 0; a < m; ++a) p.solved[a] = slope_of(p, p.list[a]);
  solve_free(p, m);
  for (int a = 0; a < m; ++a) {
    const int i = p.list[a];
    const wide x = p.x[i] + p.solved[a];
    p.x[i] = real(x) < p.lower[i] ? wide(p.lower[i]) : real(x) > p.upper[i] ? wide(p.upper[i]) : x;
  }
}

/// How many sets were tried, -1: none of them was right. All that is wrong changes at once while that makes less of it,
/// else the last one alone, which ends with any matrix of this kind.
inline int solve(const Boxes& p) {
  int fewest = p.n + 1, patience = 3;
  for (int tried = 1; tried <= most_sets; ++tried) {
    const int m = solve_set(p);
    if (m < 0) return -1;
    int wrong = 0, last = -1;
    for (int i = 0; i < p.n; ++i) {
      if (wanted_side(p, i) != p.side[i]) ++wrong, last = i;
    }
    if (wrong == 0) {
      refine_once(p, m);
      for (int i = 0; i < p.n; ++i) p.slope[i] = slope_of(p, i);
      return tried;
    }
    if (wrong < fewest) {
      fewest = wrong, patience = 3;
    } else {
      --patience;
    }
    if (patience < 0) {
      p.side[last] = wanted_side(p, last);
      continue;
    }
    // all are judged by the same solution
    for (int i = 0; i < p.n; ++i) p.list[i] = wanted_side(p, i);
    for (int i = 0; i < p.n; ++i) p.side[i] = p.list[i];
  }
  return -1;
}

}  // namespace clutchwork::fixed

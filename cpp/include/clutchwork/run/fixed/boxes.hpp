#pragma once
#include <clutchwork/components/single.hpp>
#include <clutchwork/run/fixed/products.hpp>

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
CLUTCHWORK_INLINE wide slope_of(const Boxes& p, int n, int i) {
  wide s = p.gradient[i];
  const wide* row = p.mobility + i * n;
  for (int j = 0; j < n; ++j) s += row[j] * p.x[j];
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

/// Slopes of the m free contacts solved for.
CLUTCHWORK_INLINE void solve_list(const Boxes& p, int n, int m) {
  for (int a = 0; a < m; ++a) p.solved[a] = slope_of(p, n, p.list[a]);
  solve_free(p, m);
}

/// Solve for the free contacts where the others are at their bounds; how many are free, -1: it failed.
CLUTCHWORK_INLINE int solve_set(const Boxes& p, int n) {
  int m = 0;
  for (int i = 0; i < n; ++i) {
    if (p.side[i] == 0) p.list[m++] = i;
    p.x[i] = p.side[i] == 0 ? real(0) : p.side[i] > 0 ? p.upper[i] : p.lower[i];
  }
  if (m == 0) return 0;
  if (!factor_free(p, m)) return -1;
  solve_list(p, n, m);
  for (int a = 0; a < m; ++a) p.x[p.list[a]] = p.solved[a];
  return m;
}

/// Where contact i should be, seen from the present set; its present side where that is right. Finds its slope.
CLUTCHWORK_INLINE int wanted_side(const Boxes& p, int n, int i) {
  if (p.side[i] == 0) return real(p.x[i]) < p.lower[i] ? -1 : real(p.x[i]) > p.upper[i] ? 1 : 0;
  const wide* row = p.mobility + i * n;
  wide s = p.gradient[i];
  real size = abs(p.gradient[i]);
  for (int j = 0; j < n; ++j) {
    const wide part = row[j] * p.x[j];
    s += part, size += abs(real(part));
  }
  p.slope[i] = s;
  if (!(p.lower[i] < p.upper[i])) return p.side[i];
  // what round-off makes of a slip decides nothing
  const wide slip = s + p.weight[i] * p.x[i];
  return real(p.side[i] > 0 ? slip : -slip) > roundoff<real>(1e-14, 1e-12) * size ? 0 : p.side[i];
}

/// The number nearest to x that bounds allow.
CLUTCHWORK_HOT double within(double x, double lower, double upper) { return smaller(larger(x, lower), upper); }
CLUTCHWORK_HOT Twofold within(Twofold x, Single lower, Single upper) {
  return value(x) < lower ? Twofold(lower) : value(x) > upper ? Twofold(upper) : x;
}

/// Take the weight out again: one step with the exact matrix, within the bounds.
CLUTCHWORK_INLINE void refine_once(const Boxes& p, int n, int m) {
  solve_list(p, n, m);
  for (int a = 0; a < m; ++a) {
    const int i = p.list[a];
    p.x[i] = within(p.x[i] + p.solved[a], p.lower[i], p.upper[i]);
  }
  for (int i = 0; i < n; ++i) p.slope[i] = slope_of(p, n, i);
}

/// How many sets were tried, of N contacts, or as many as there are.
template <int N>
int solve_sized(const Boxes& p) {
  const int n = N > 0 ? N : p.n;
  int fewest = n + 1, patience = 3;
  for (int tried = 1; tried <= most_sets; ++tried) {
    const int m = solve_set(p, n);
    if (m < 0) return -1;
    int wrong = 0, last = -1;
    for (int i = 0; i < n; ++i) {
      if (wanted_side(p, n, i) != p.side[i]) ++wrong, last = i;
    }
    if (wrong == 0) {
      if (m > 0) refine_once(p, n, m);
      return tried;
    }
    if (wrong < fewest) {
      fewest = wrong, patience = 3;
    } else {
      --patience;
    }
    if (patience < 0) {
      p.side[last] = wanted_side(p, n, last);
      continue;
    }
    // all are judged by the same solution
    for (int i = 0; i < n; ++i) p.list[i] = wanted_side(p, n, i);
    for (int i = 0; i < n; ++i) p.side[i] = p.list[i];
  }
  return -1;
}

/// How many sets were tried, -1: none of them was right. All that is wrong changes at once while that makes less of it,
/// else the last one alone, which ends with any matrix of this kind.
inline int solve(const Boxes& p) {
  if constexpr (has_few_sizes) {
    switch (p.n) {
      case 1:
        return solve_sized<1>(p);
      case 2:
        return solve_sized<2>(p);
      case 3:
        return solve_sized<3>(p);
    }
  }
  return solve_sized<0>(p);
}

}  // namespace clutchwork::fixed

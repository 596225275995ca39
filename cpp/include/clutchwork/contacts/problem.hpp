#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/workspace/settings.hpp>

/// The bounded convex problem behind sticking: docs/theory/contacts.md.
namespace clutchwork {

/// One problem: minimise 1/2 x'(G + E)x + g'x over lower <= x <= upper; E is a small weight by capacity.
/// Views into memory of the caller; n contacts.
template <class T>
struct BoundedProblem {
  int n;
  T* matrix;    ///< n x n, G
  T* gradient;  ///< n, g: slip accelerations without the contact torques
  T* lower;     ///< n, may be -infinity
  T* upper;     ///< n, may be +infinity
  T* weight;    ///< n, the diagonal of E
  T* x;         ///< n, start and solution
  T* slope;     ///< n, G x + g at the end: the slip accelerations
  T* trial;     ///< n
  T* factor;    ///< n x n
  int* bound;   ///< n: 0 free, -1 at lower, +1 at upper
  int* free;    ///< n
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
    p.weight[i] = p.matrix[i * p.n + i] * T(small * (ratio < 1e6 ? ratio : 1e6));
  }
}

/// G x + g for one contact.
template <class T>
T slope_of(const BoundedProblem<T>& p, int i) {
  return dot(p.n, p.matrix + i * p.n, p.x) + p.gradient[i];
}

/// Factor (G + E) of the free contacts; returns their number, or -1 when it is not positive definite.
template <class T>
int factor_free(BoundedProblem<T>& p) {
  int m = 0;
  for (int i = 0; i < p.n; ++i) {
    if (p.bound[i] == 0) p.free[m++] = i;
  }
  for (int a = 0; a < m; ++a) {
    for (int b = 0; b <= a; ++b) p.factor[a * p.n + b] = p.matrix[p.free[a] * p.n + p.free[b]];
    p.factor[a * p.n + a] += p.weight[p.free[a]];
  }
  return cholesky(m, p.factor, p.n) ? m : -1;
}

/// Newton step of the m free contacts, already factored, towards the minimum, bounds ignored; `regular` keeps the
/// weight in the residual.
template <class T>
void newton_step(BoundedProblem<T>& p, int m, bool regular) {
  for (int a = 0; a < m; ++a) {
    const int i = p.free[a];
    p.trial[a] = -(slope_of(p, i) + (regular ? p.weight[i] * p.x[i] : T(0)));
  }
  forward_solve(m, p.factor, p.n, p.trial);
  backward_solve(m, p.factor, p.n, p.trial);
  for (int a = 0; a < m; ++a) p.slope[p.free[a]] = p.trial[a];
}

/// Longest step in [0, 1] that keeps the bounds, and the contact that stops it (-1: none).
template <class T>
T longest_step(const BoundedProblem<T>& p, int& blocking) {
  T alpha = T(1);
  blocking = -1;
  for (int i = 0; i < p.n; ++i) {
    if (p.bound[i] != 0 || value(p.slope[i]) == 0) continue;
    const T limit = p.slope[i] > T(0) ? p.upper[i] : p.lower[i];
    if (abs(value(limit)) == infinity) continue;
    const T room = (limit - p.x[i]) / p.slope[i];
    if (room < alpha) {
      alpha = larger(room, T(0));
      blocking = i;
    }
  }
  return alpha;
}

/// The bound contact whose torque most wants to come back inside (-1: none).
template <class T>
int most_violated(const BoundedProblem<T>& p) {
  int worst = -1;
  double most = 0;
  for (int i = 0; i < p.n; ++i) {
    if (p.bound[i] == 0 || !(p.lower[i] < p.upper[i])) continue;
    const double s = value(slope_of(p, i) + p.weight[i] * p.x[i]) * p.bound[i];
    const double unit = value(sqrt(p.matrix[i * p.n + i]));
    const double scale = 1e-13 * (abs(value(p.gradient[i])) + value(p.matrix[i * p.n + i]) * abs(value(p.x[i])));
    if (s > scale && s / unit > most) {
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

/// Primal active set on the regularised problem, then refinement on the free contacts; false: iteration cap reached.
template <class T>
bool solve(BoundedProblem<T>& p) {
  for (int i = 0; i < p.n; ++i) {
    p.x[i] = smaller(larger(p.x[i], p.lower[i]), p.upper[i]);
    p.bound[i] = p.lower[i] < p.upper[i] ? 0 : 1;
  }
  bool solved = false;
  int m = 0;
  for (int round = 0; round < 20 * p.n + 50 && !solved; ++round) {
    m = factor_free(p);
    if (m < 0) return false;
    newton_step(p, m, true);
    int blocking;
    const T alpha = longest_step(p, blocking);
    for (int i = 0; i < p.n; ++i) {
      if (p.bound[i] == 0) p.x[i] += alpha * p.slope[i];
    }
    if (blocking >= 0) {
      p.bound[blocking] = p.slope[blocking] > T(0) ? 1 : -1;
      p.x[blocking] = p.bound[blocking] > 0 ? p.upper[blocking] : p.lower[blocking];
      continue;
    }
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

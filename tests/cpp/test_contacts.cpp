// The bounded convex problem: its conditions of optimality, and the least objective over all sets.

#include <clutchwork/workspace.hpp>
//
#include <clutchwork/components/dense.hpp>
#include <clutchwork/contacts/problem.hpp>
#include <vector>

#include "check.hpp"

using namespace clutchwork;
using Numbers = std::vector<double>;

namespace {

/// A problem and the memory it looks at.
struct Problem {
  int n;
  Numbers matrix, gradient, lower, upper, weight, x, slope, trial, factor, capacity;
  std::vector<int> bound, free, numbers, last, row, low, sky, near_low, near_sky;
  explicit Problem(int size)
      : n(size),
        matrix(std::size_t(n * n)),
        gradient(n),
        lower(n),
        upper(n),
        weight(n),
        x(n),
        slope(n),
        trial(n),
        factor(std::size_t(n * n)),
        capacity(n),
        bound(n),
        free(n),
        numbers(n),
        last(n, n - 1),
        row(n),
        low(n),
        sky(n),
        near_low(n),
        near_sky(n) {
    for (int i = 0; i < n; ++i) numbers[i] = i;
  }
  /// Solve it, the matrix whole or without the zeros before the first number of each row.
  bool run(bool whole = true) {
    Envelope all{low.data(), sky.data()};
    for (int i = 0; i < n; ++i) {
      low[i] = 0;
      while (matrix[i * n + low[i]] == 0 && low[i] < i) ++low[i];
    }
    Numbers lower_half(std::size_t(whole ? all.lay_whole(n) : all.lay(n))), diagonal(n);
    for (int i = 0; i < n; ++i) {
      for (int j = low[i]; j <= i; ++j) lower_half[sky[i] + j] = matrix[i * n + j];
      diagonal[i] = matrix[i * n + i];
    }
    const int* own = numbers.data();
    const Neighbours<double> g{n, all, lower_half.data(), diagonal.data(), own, own, last.data(), own, row.data()};
    BoundedProblem<double> p{n,
                             g,
                             gradient.data(),
                             lower.data(),
                             upper.data(),
                             weight.data(),
                             x.data(),
                             slope.data(),
                             trial.data(),
                             Envelope{near_low.data(), near_sky.data()},
                             factor.data(),
                             bound.data(),
                             free.data()};
    capacity_weights(p, capacity.data());
    return solve(p);
  }
  /// Size of the terms that cancel in the slope of contact i.
  double scale(int i) const {
    double s = abs(gradient[i]);
    for (int j = 0; j < n; ++j) s = larger(s, abs(matrix[i * n + j] * x[j]));
    return s;
  }
};

/// Directions of n contacts in the space of k mass-weighted speeds: repeated, dependent and plain ones.
Problem random_problem(check::Random& g) {
  const int n = 2 + g.below(7), k = 1 + g.below(8);
  Problem p(n);
  Numbers rows(std::size_t(n * k)), a(k);
  for (double& v : a) v = g.between(-1, 1) * std::pow(10.0, g.between(-2, 3));
  for (int i = 0; i < n; ++i) {
    double* row = &rows[i * k];
    if (i > 0 && g.below(5) == 0) {
      axpy(k, g.between(-1, 1), &rows[g.below(i) * k], row);
      axpy(k, double(g.below(3) - 1), &rows[g.below(i) * k], row);
    }
    if (dot(k, row, row) < 1e-4) {
      for (int j = 0; j < k; ++j) row[j] = g.between(-1, 1);
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) p.matrix[i * n + j] = dot(k, &rows[i * k], &rows[j * k]);
    p.gradient[i] = dot(k, &rows[i * k], a.data());
    const int kind = g.below(8);
    p.capacity[i] = kind == 0 ? 0.0 : std::pow(10.0, g.between(-3, 6));
    p.lower[i] = -p.capacity[i], p.upper[i] = p.capacity[i];
    if (kind == 1) p.upper[i] = p.capacity[i] = infinity;
  }
  return p;
}

/// Largest violation of the optimality conditions, each in units of the terms that cancel in it.
double violation(const Problem& p) {
  double worst = 0;
  for (int i = 0; i < p.n; ++i) {
    if (!(p.x[i] >= p.lower[i] && p.x[i] <= p.upper[i])) return infinity;
    if (p.lower[i] == p.upper[i]) continue;
    const double s = dot(p.n, &p.matrix[i * p.n], p.x.data()) + p.gradient[i];
    const double bad = p.x[i] == p.upper[i] ? larger(s, 0.0) : p.x[i] == p.lower[i] ? larger(-s, 0.0) : abs(s);
    worst = larger(worst, bad / larger(p.scale(i), 1e-300));
  }
  return worst;
}

/// Least objective over all sets of free and bound contacts, its round-off added; NaN where directions are nearly
/// dependent.
double enumerate(const Problem& p) {
  double best = infinity;
  int sets = 1;
  for (int i = 0; i < p.n; ++i) sets *= 3;
  for (int set = 0; set < sets; ++set) {
    Numbers x(p.n), a, b;
    std::vector<int> open;
    bool real = true;
    for (int i = 0, code = set; i < p.n; ++i, code /= 3) {
      if (code % 3 == 0)
        open.push_back(i);
      else
        x[i] = code % 3 == 1 ? p.lower[i] : p.upper[i];
      real = real && abs(x[i]) < infinity;
    }
    const int m = int(open.size());
    for (int i : open) {
      double r = -p.gradient[i];
      for (int j = 0; j < p.n; ++j) r -= p.matrix[i * p.n + j] * x[j];
      b.push_back(r);
      for (int j : open) a.push_back(p.matrix[i * p.n + j]);
    }
    // a singular set repeats another one with fewer free contacts
    bool singular = !cholesky(m, a.data(), m);
    for (int i = 0; i < m && !singular; ++i) {
      const double share = a[i * m + i] * a[i * m + i] / p.matrix[open[i] * p.n + open[i]];
      singular = share < 1e-12;
      if (!singular && share < 1e-4) return NAN;
    }
    if (!real || singular) continue;
    forward_solve(m, a.data(), m, b.data());
    backward_solve(m, a.data(), m, b.data());
    for (int i = 0; i < m; ++i) {
      x[open[i]] = b[i];
      const double room = 1e-9 * abs(b[i]);
      real = real && b[i] >= p.lower[open[i]] - room && b[i] <= p.upper[open[i]] + room;
    }
    double value = dot(p.n, p.gradient.data(), x.data()), noise = abs(value);
    for (int i = 0; i < p.n; ++i) {
      for (int j = 0; j < p.n; ++j) {
        const double term = 0.5 * x[i] * p.matrix[i * p.n + j] * x[j];
        value += term, noise += abs(term);
      }
    }
    if (real) best = smaller(best, value + 1e-14 * noise);
  }
  return best;
}

void random_problems() {
  check::Random g{1};
  int compared = 0;
  double worst = 0;
  for (int round = 0; round < 20000; ++round) {
    Problem p = random_problem(g);
    if (!CHECK(p.run())) continue;
    const double bad = violation(p);
    worst = larger(worst, bad);
    // round-off over directions that are nearly dependent, which gears never give
    if (!CHECK(bad <= 1e-9)) std::printf("  round %d, n %d: %.3g\n", round, p.n, bad);
    for (int i = 0; i < p.n; ++i) {
      CHECK_NEAR(p.slope[i], dot(p.n, &p.matrix[i * p.n], p.x.data()) + p.gradient[i], 1e-12 * p.scale(i));
    }
    const double least = p.n <= 3 ? enumerate(p) : NAN;
    if (least != least) continue;
    ++compared;
    double own = dot(p.n, p.gradient.data(), p.x.data()), size = 0;
    for (int i = 0; i < p.n; ++i) {
      own += 0.5 * p.x[i] * dot(p.n, &p.matrix[i * p.n], p.x.data());
      size += abs(p.x[i]) * p.scale(i);
    }
    CHECK(own <= least + 1e-9 * size);
  }
  CHECK(compared > 4000);
  std::printf("largest violation %.3g\n", worst);
}

/// The same problem gives the same bits, and equal contacts share by capacity.
void plain_cases() {
  check::Random g{2};
  for (int round = 0; round < 200; ++round) {
    Problem a = random_problem(g);
    Problem b = a;
    CHECK(a.run() && b.run());
    for (int i = 0; i < a.n; ++i) CHECK(check::same_bits(a.x[i], b.x[i]));
  }
  Problem p(2);
  p.matrix = {1, 1, 1, 1}, p.gradient = {-3, -3}, p.capacity = p.upper = {10, 20}, p.lower = {-10, -20};
  CHECK(p.run());
  CHECK_NEAR(p.x[0] + p.x[1], 3, 1e-12);
  CHECK_NEAR(p.x[1] / p.x[0], 2, 1e-6);
}

/// Contacts between neighbours in a row of speeds: without the zeros the torques are those of the whole matrix.
void rows_of_neighbours() {
  check::Random g{3};
  for (int round = 0; round < 300; ++round) {
    const int n = 2 + g.below(40), k = n + 1;
    Problem p(n);
    Numbers rows(std::size_t(n * k)), a(k);
    for (double& v : a) v = g.between(-1, 1);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j <= g.below(3); ++j) rows[i * k + smaller(i + j, k - 1)] = g.between(0.1, 1) * (j % 2 ? -1 : 1);
      if (g.below(10) == 0) rows[i * k + g.below(k)] = 1;
    }
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) p.matrix[i * n + j] = dot(k, &rows[i * k], &rows[j * k]);
      p.gradient[i] = dot(k, &rows[i * k], a.data());
      p.upper[i] = p.capacity[i] = g.between(0, 1), p.lower[i] = -p.upper[i];
    }
    Problem sparse = p;
    CHECK(p.run(true) && sparse.run(false));
    for (int i = 0; i < n; ++i) CHECK_NEAR(sparse.slope[i], p.slope[i], 1e-9);
  }
}

}  // namespace

int test_contacts() {
  random_problems();
  rows_of_neighbours();
  plain_cases();
  return check::result();
}

// Factorisations, dense and in envelopes: the factors multiply to the matrix, the solves invert it.

#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/envelope.hpp>
#include <vector>

#include "check.hpp"

using namespace clutchwork;
using Numbers = std::vector<double>;

namespace {

Numbers random(check::Random& g, int n) {
  Numbers x(static_cast<std::size_t>(n));
  for (double& v : x) v = g.between(-1, 1);
  return x;
}

/// L L' = A, and the solves undo A.
void factors(check::Random& g, int n) {
  const Numbers b = random(g, n * n);
  Numbers a(b.size());
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) a[i * n + j] = dot(n, &b[i * n], &b[j * n]) + (i == j ? 0.1 : 0.0);
  }
  Numbers l = a;
  CHECK(cholesky(n, l.data(), n));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) CHECK_NEAR(dot(j + 1, &l[i * n], &l[j * n]), a[i * n + j], 1e-13 * n);
  }
  const Numbers x = random(g, n);
  Numbers y(x.size());
  for (int i = 0; i < n; ++i) y[i] = dot(n, &a[i * n], x.data());
  forward_solve(n, l.data(), n, y.data());
  backward_solve(n, l.data(), n, y.data());
  for (int i = 0; i < n; ++i) CHECK_NEAR(y[i], x[i], 1e-11 * n);
  l = a;
  l[(n - 1) * n + n - 1] = -1;
  CHECK(!cholesky(n, l.data(), n));
}

/// In the envelope of a matrix stands the dense factor; whole, its bits.
void envelopes(check::Random& g, int n) {
  Numbers a(std::size_t(n * n));
  std::vector<int> low(a.size()), sky(a.size());
  for (int i = 0; i < n; ++i) {
    low[i] = g.below(i + 1);
    for (int j = low[i]; j < i; ++j) a[i * n + j] = g.between(-1, 1);
    a[i * n + i] = n + 1.0;
  }
  Numbers l = a;
  CHECK(cholesky(n, l.data(), n));
  const Numbers b = random(g, n);
  for (bool whole : {false, true}) {
    Envelope e{low.data(), sky.data()};
    Numbers factor(std::size_t(whole ? e.lay_whole(n) : e.lay(n)));
    for (int i = 0; i < n; ++i) {
      for (int j = low[i]; j <= i; ++j) factor[sky[i] + j] = a[i * n + j];
    }
    CHECK(cholesky(n, e, factor.data()));
    Numbers x = b, y = b, turned = b;
    forward_solve(n, l.data(), n, x.data()), backward_solve(n, l.data(), n, x.data());
    forward_solve(n, e, factor.data(), y.data()), backward_solve(n, e, factor.data(), y.data());
    transposed_times(n, e, factor.data(), b.data(), turned.data());
    for (int i = 0; i < n; ++i) {
      double s = 0;
      for (int j = i; j < n; ++j) s += l[j * n + i] * b[j];
      CHECK_NEAR(y[i], x[i], whole ? 0.0 : 1e-14);
      CHECK_NEAR(turned[i], s, 1e-12);
    }
  }
}

/// A inverse times A is one; a singular matrix is said to be so.
void inverses(check::Random& g, int n) {
  const Numbers a = random(g, n * n);
  Numbers w = a;
  std::vector<int> pivot(static_cast<std::size_t>(n));
  if (!CHECK(invert(n, w.data(), pivot.data()))) return;
  double size = 0;
  for (double x : w) size = larger(size, abs(x));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      double s = 0;
      for (int k = 0; k < n; ++k) s += w[i * n + k] * a[k * n + j];
      CHECK_NEAR(s, i == j ? 1.0 : 0.0, 1e-13 * n * size * size);
    }
  }
  w = a;
  for (int i = 0; i < n; ++i) w[i * n] = 0;
  CHECK(!invert(n, w.data(), pivot.data()));
}

/// Rank r of m rows; orthonormal columns, the first of which span the rows.
void split(check::Random& g, int m, int n, int r) {
  Numbers basis = random(g, r * n), rows(std::size_t(m * n)), q(std::size_t(n * n)), norms(std::size_t(m + 1));
  for (int i = 0; i < m; ++i) {
    const double scale = std::pow(10.0, g.between(-6, 6));
    for (int k = 0; k < r; ++k) axpy(n, scale * g.between(-1, 1), &basis[k * n], &rows[i * n]);
  }
  std::vector<int> order(std::size_t(m + 1));
  Numbers work = rows;
  const int rank = orthonormal_split(m, n, work.data(), q.data(), order.data(), norms.data());
  CHECK(rank == smaller(r, m));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double s = 0;
      for (int k = 0; k < n; ++k) s += q[k * n + i] * q[k * n + j];
      CHECK_NEAR(s, i == j ? 1.0 : 0.0, 1e-13);
    }
  }
  for (int i = 0; i < m; ++i) {
    const double length = sqrt(dot(n, &rows[i * n], &rows[i * n]));
    for (int j = rank; j < n; ++j) {
      double s = 0;
      for (int k = 0; k < n; ++k) s += q[k * n + j] * rows[i * n + k];
      CHECK_NEAR(s, 0.0, 1e-12 * length);
    }
  }
  std::vector<char> seen(std::size_t(m + 1));
  for (int i = 0; i < m; ++i) seen[order[i]] = 1;
  for (int i = 0; i < m; ++i) CHECK(seen[i] == 1);
}

}  // namespace

int test_dense() {
  check::Random g{11};
  for (int n = 1; n <= 12; ++n) factors(g, n), inverses(g, n), envelopes(g, n);
  for (int round = 0; round < 300; ++round) {
    const int n = 1 + g.below(8), m = g.below(9);
    split(g, m, n, m == 0 ? 0 : 1 + g.below(n));
  }
  return check::result();
}

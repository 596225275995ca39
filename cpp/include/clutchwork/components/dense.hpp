#pragma once
#include <clutchwork/components/scalar.hpp>

/// Small dense kernels on row-major views; sizes from 1 to a few hundred, no heap.
namespace clutchwork {

// rows may be plain where what they multiply has derivatives
template <class T, class S>
CLUTCHWORK_HOT S dot(int n, const T* a, const S* b) {
  S s = S(0);
  for (int i = 0; i < n; ++i) s += a[i] * b[i];
  return s;
}

template <class A, class X, class Y>
CLUTCHWORK_HOT void axpy(int n, A a, const X* x, Y* y) {
  for (int i = 0; i < n; ++i) y[i] += a * x[i];
}

/// Lower Cholesky factor in place; false when a pivot is not positive.
template <class T>
bool cholesky(int n, T* a, int stride) {
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      T s = a[i * stride + j];
      for (int k = 0; k < j; ++k) s -= a[i * stride + k] * a[j * stride + k];
      if (i != j) {
        a[i * stride + j] = s / a[j * stride + j];
      } else {
        if (!(value(s) > 0)) return false;
        a[i * stride + i] = sqrt(s);
      }
    }
  }
  return true;
}

/// x := L^-1 x.
template <class T>
void forward_solve(int n, const T* l, int stride, T* x) {
  for (int i = 0; i < n; ++i) {
    T s = x[i];
    for (int k = 0; k < i; ++k) s -= l[i * stride + k] * x[k];
    x[i] = s / l[i * stride + i];
  }
}

/// x := L^-T x.
template <class T>
void backward_solve(int n, const T* l, int stride, T* x) {
  for (int i = n - 1; i >= 0; --i) {
    T s = x[i];
    for (int k = i + 1; k < n; ++k) s -= l[k * stride + i] * x[k];
    x[i] = s / l[i * stride + i];
  }
}

/// Inverse of a small general matrix in place by Gauss-Jordan with row pivoting; false when singular.
template <class T>
bool invert(int n, T* a, int* pivot) {
  for (int c = 0; c < n; ++c) {
    int p = c;
    for (int r = c + 1; r < n; ++r) {
      if (abs(value(a[r * n + c])) > abs(value(a[p * n + c]))) p = r;
    }
    if (value(a[p * n + c]) == 0) return false;
    pivot[c] = p;
    for (int j = 0; j < n && p != c; ++j) {
      const T swap = a[c * n + j];
      a[c * n + j] = a[p * n + j];
      a[p * n + j] = swap;
    }
    const T inverse = T(1) / a[c * n + c];
    a[c * n + c] = T(1);
    for (int j = 0; j < n; ++j) a[c * n + j] *= inverse;
    for (int r = 0; r < n; ++r) {
      if (r == c) continue;
      const T factor = a[r * n + c];
      // most shared states flow to few others
      if (!counts(factor)) continue;
      a[r * n + c] = T(0);
      for (int j = 0; j < n; ++j) a[r * n + j] -= factor * a[c * n + j];
    }
  }
  for (int c = n - 1; c >= 0; --c) {
    if (pivot[c] == c) continue;
    for (int r = 0; r < n; ++r) {
      const T swap = a[r * n + c];
      a[r * n + c] = a[r * n + pivot[c]];
      a[r * n + pivot[c]] = swap;
    }
  }
  return true;
}

/// LU factor of a general matrix in place, by rows with row pivoting; the diagonal holds 1/u. False when singular.
template <class T>
bool factor_lu(int n, T* a, int* pivot) {
  for (int c = 0; c < n; ++c) {
    int p = c;
    for (int r = c + 1; r < n; ++r) {
      if (abs(value(a[r * n + c])) > abs(value(a[p * n + c]))) p = r;
    }
    pivot[c] = p;
    if (!(abs(value(a[p * n + c])) > 0)) return false;
    for (int j = 0; j < n && p != c; ++j) {
      const T swap = a[c * n + j];
      a[c * n + j] = a[p * n + j];
      a[p * n + j] = swap;
    }
    const T inverse = T(1) / a[c * n + c];
    a[c * n + c] = inverse;
    for (int r = c + 1; r < n; ++r) {
      if constexpr (std::is_floating_point_v<T>) {
        if (a[r * n + c] == 0) continue;
      }
      const T factor = a[r * n + c] * inverse;
      a[r * n + c] = factor;
      for (int j = c + 1; j < n; ++j) a[r * n + j] -= factor * a[c * n + j];
    }
  }
  return true;
}

/// b := A^-1 b with that factor.
template <class T>
void solve_lu(int n, const T* a, const int* pivot, T* b) {
  for (int c = 0; c < n; ++c) {
    const T swap = b[c];
    b[c] = b[pivot[c]];
    b[pivot[c]] = swap;
  }
  for (int i = 1; i < n; ++i) b[i] -= dot(i, a + i * n, b);
  for (int i = n - 1; i >= 0; --i) b[i] = (b[i] - dot(n - 1 - i, a + i * n + i + 1, b + i + 1)) * a[i * n + i];
}

/// Of the rows order[rank..m) the one with the largest part outside the span so far, relative to its length (-1: none
/// has any); the first of those of which more than `enough` is outside.
template <class T>
int most_independent(int m, int n, const T* rows, const int* order, const T* norms, int rank, T enough) {
  int best = -1;
  T best_share = T(1e-10);
  for (int r = rank; r < m; ++r) {
    const T* x = rows + order[r] * n + rank;
    const T length = sqrt(dot(n - rank, x, x));
    const T share = norms[order[r]] > T(0) ? smaller(length / norms[order[r]], enough) : T(0);
    const bool is_first = best >= 0 && share == enough && share == best_share && order[r] < order[best];
    if (share > best_share || is_first) best = r, best_share = share;
  }
  return best;
}

/// Reflect row u onto axis `rank`, and with it all other rows and q.
template <class T>
void reflect(int m, int n, T* rows, T* q, T* u, int rank) {
  const T length = sqrt(dot(n - rank, u + rank, u + rank));
  const T alpha = u[rank] > T(0) ? -length : length;
  u[rank] -= alpha;
  const T beta = T(2) / dot(n - rank, u + rank, u + rank);
  auto turn = [&](T* x) { axpy(n - rank, -(beta * dot(n - rank, u + rank, x + rank)), u + rank, x + rank); };
  for (int r = 0; r < m; ++r) {
    if (rows + r * n != u) turn(rows + r * n);
  }
  for (int i = 0; i < n; ++i) turn(q + i * n);
  u[rank] = alpha;
  for (int j = rank + 1; j < n; ++j) u[j] = T(0);
}

/// Orthonormal basis of R^n whose first `rank` columns span the given rows, by pivoted Householder reflections.
/// rows: m x n, overwritten. q: n x n, its column j is q[i * n + j]. order: m, pivot order; rows from `spanning` on are
/// turned with the others and never pivots (-1: none). Of rows of which more than `enough` is independent the first
/// ones pivot. Returns the rank.
template <class T>
int orthonormal_split(int m, int n, T* rows, T* q, int* order, T* norms, int spanning = -1, T enough = T(2)) {
  const int pivots = spanning < 0 ? m : spanning;
  for (int i = 0; i < n * n; ++i) q[i] = T(0);
  for (int i = 0; i < n; ++i) q[i * n + i] = T(1);
  for (int r = 0; r < m; ++r) {
    order[r] = r;
    norms[r] = sqrt(dot(n, rows + r * n, rows + r * n));
  }
  int rank = 0;
  for (; rank < pivots && rank < n; ++rank) {
    const int best = most_independent(pivots, n, rows, order, norms, rank, enough);
    if (best < 0) break;
    const int swap = order[rank];
    order[rank] = order[best];
    order[best] = swap;
    reflect(m, n, rows, q, rows + order[rank] * n, rank);
  }
  return rank;
}

}  // namespace clutchwork

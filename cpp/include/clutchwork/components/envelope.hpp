#pragma once
#include <clutchwork/components/scalar.hpp>
#include <cstdint>

/// Symmetric matrices in envelopes: the lower half, each row from its first number on. No heap.
namespace clutchwork {

/// Where the rows start; entry (i, j), low[i] <= j <= i, stands at sky[i] + j.
struct Envelope {
  int *low = nullptr, *sky = nullptr;
  bool whole = false;  ///< every row starts at the first column

  /// Lay n rows one behind the other, their first columns given; how many numbers they hold.
  std::int64_t lay(int n) const {
    std::int64_t end = 0;
    for (int i = 0; i < n; ++i) {
      sky[i] = int(end - low[i]);
      end += i - low[i] + 1;
    }
    return end;
  }
  /// All rows from the first column on.
  std::int64_t lay_whole(int n) {
    whole = true;
    for (int i = 0; i < n; ++i) low[i] = 0;
    return lay(n);
  }
};

/// Lower Cholesky factor in place; false when a pivot is not positive.
template <class T>
bool cholesky(int n, const Envelope& e, T* a) {
  for (int i = 0; i < n; ++i) {
    T* row = a + e.sky[i];
    for (int j = e.low[i]; j <= i; ++j) {
      const T* other = a + e.sky[j];
      T s = row[j];
      for (int k = larger(e.low[i], e.low[j]); k < j; ++k) s -= row[k] * other[k];
      if (i != j) {
        row[j] = s / other[j];
      } else {
        if (!(value(s) > 0)) return false;
        row[i] = sqrt(s);
      }
    }
  }
  return true;
}

/// x := L^-1 x.
template <class T>
void forward_solve(int n, const Envelope& e, const T* l, T* x) {
  for (int i = 0; i < n; ++i) {
    const T* row = l + e.sky[i];
    T s = x[i];
    for (int k = e.low[i]; k < i; ++k) s -= row[k] * x[k];
    x[i] = s / row[i];
  }
}

/// x := L^-T x.
template <class T>
void backward_solve(int n, const Envelope& e, const T* l, T* x) {
  for (int i = n - 1; i >= 0 && !e.whole; --i) {
    const T* row = l + e.sky[i];
    const T own = x[i] = x[i] / row[i];
    for (int j = e.low[i]; j < i; ++j) x[j] -= row[j] * own;
  }
  // in the order of sums of a dense matrix, so that few speeds keep their bits
  for (int i = n - 1; i >= 0 && e.whole; --i) {
    T s = x[i];
    for (int k = i + 1; k < n; ++k) s -= l[e.sky[k] + i] * x[k];
    x[i] = s / l[e.sky[i] + i];
  }
}

/// y := L' x.
template <class T>
void transposed_times(int n, const Envelope& e, const T* l, const T* x, T* y) {
  for (int i = 0; i < n; ++i) y[i] = T(0);
  for (int j = 0; j < n; ++j) {
    for (int i = e.low[j]; i <= j; ++i) y[i] += l[e.sky[j] + i] * x[j];
  }
}

}  // namespace clutchwork

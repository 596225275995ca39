#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/run/fixed/pairs.hpp>
#include <clutchwork/workspace.hpp>

/// Rates of all directions and speeds of all nodes from speeds: of few speeds by whole matrices, which need no indices.
namespace clutchwork::fixed {

using Run = Workspace<real>;

/// x += change. Where numbers are single, what that loses is kept: docs/theory/fixed-steps.md (14)
inline void add(double& x, const double*, int, double change) { x += change; }
inline void add(Single& x, Single* low, int i, Single change) { add_to(x, low[i], change); }
/// The same of number i of an array, and of the one behind it.
template <class V>
CLUTCHWORK_HOT void add_at(double* x, const double*, int i, const V& change) {
  put(x + i, take<V>(x + i) + change);
}
template <class V>
CLUTCHWORK_HOT void add_at(Single* x, Single* low, int i, const V& change) {
  add_to(x[i], low[i], change);
}

/// y := M x, for n rows of N numbers that stand by columns, each as long as `column`.
template <int N>
CLUTCHWORK_INLINE void multiply_few(int n, int column, const real* matrix, const real* x, real* y) {
  real at[N];
  for (int k = 0; k < N; ++k) at[k] = x[k];
  in_pairs(n, [&](int i, auto as) {
    using V = decltype(as);
    V s = take<V>(matrix + i) * at[0];
    for (int k = 1; k < N; ++k) s += take<V>(matrix + k * column + i) * at[k];
    put(y + i, s);
  });
}
/// The same for as many numbers as there are speeds; `sparse(i)` is a row where these are more than a few.
template <class Row>
CLUTCHWORK_INLINE void multiply(int nv, int n, int column, const real* matrix, Row&& sparse, const real* x, real* y) {
  static_assert(most_whole_speeds == 4);
  if constexpr (!has_few_sizes) {
    for (int i = 0; i < n; ++i) {
      if (nv > most_whole_speeds) {
        y[i] = sparse(i).times(x);
        continue;
      }
      y[i] = nv > 0 ? matrix[i] * x[0] : real(0);
      for (int k = 1; k < nv; ++k) y[i] += matrix[k * column + i] * x[k];
    }
    return;
  }
  switch (nv) {
    case 1:
      return multiply_few<1>(n, column, matrix, x, y);
    case 2:
      return multiply_few<2>(n, column, matrix, x, y);
    case 3:
      return multiply_few<3>(n, column, matrix, x, y);
    case 4:
      return multiply_few<4>(n, column, matrix, x, y);
    default:
      for (int i = 0; i < n; ++i) y[i] = sparse(i).times(x);
  }
}

/// x := (L L')^-1 x for a factor of N numbers a row.
template <int N, class T>
CLUTCHWORK_INLINE void solve_few(const T* l, T* x) {
  T at[N];
  for (int i = 0; i < N; ++i) {
    T s = x[i];
    for (int k = 0; k < i; ++k) s -= l[i * N + k] * at[k];
    at[i] = s / l[i * N + i];
  }
  for (int i = N - 1; i >= 0; --i) {
    T s = at[i];
    for (int k = i + 1; k < N; ++k) s -= l[k * N + i] * at[k];
    at[i] = s / l[i * N + i];
  }
  for (int i = 0; i < N; ++i) x[i] = at[i];
}
/// The same for as many numbers as there are speeds.
template <class T>
inline void solve_step(int nv, const T* factor, T* x) {
  if constexpr (has_few_sizes) {
    static_assert(most_whole_speeds == 4);
    switch (nv) {
      case 1:
        return solve_few<1>(factor, x);
      case 2:
        return solve_few<2>(factor, x);
      case 3:
        return solve_few<3>(factor, x);
      case 4:
        return solve_few<4>(factor, x);
    }
  }
  forward_solve(nv, factor, nv, x), backward_solve(nv, factor, nv, x);
}

/// Rates of directions by speeds, without the prescribed ones: at least those from `first` on.
CLUTCHWORK_INLINE void rates_by(const Run& ws, const real* speeds, real* rates, int first = 0) {
  const int nv = int(ws.sys.speeds);
  // pairs end where the arrays do
  first -= first % 2;
  multiply(
      nv, ws.n_directions - first, ws.n_directions, ws.fixed.rate_rows + first,
      [&](int d) { return rate_row(ws.sys, first + d); }, speeds, rates + first);
}

/// x += factor times the row of direction d.
CLUTCHWORK_INLINE void add_direction(const Run& ws, int d, real factor, real* x) {
  const int nv = int(ws.sys.speeds);
  if (nv <= most_whole_speeds) {
    const real* share = ws.fixed.rate_rows + d;
    for (int k = 0; k < nv; ++k, share += ws.n_directions) x[k] += factor * *share;
    return;
  }
  const auto row = rate_row(ws.sys, d);
  for (int k = 0; k < row.n; ++k) x[row.column[k]] += factor * row.value[k];
}

/// Slips are small differences of speeds: where these are single, they are summed in two parts, with what the sums of
/// the speeds have not taken yet.
inline void sum_slips(const Workspace<double>&, double*) {}
inline void sum_slips(const Workspace<Single>& ws, Single* rates) {
  for (int d = int(ws.sys.elements); d < ws.n_directions; ++d) {
    const auto row = rate_row(ws.sys, d);
    Twofold slip;
    for (int k = 0; k < row.n; ++k) {
      const int i = row.column[k];
      slip += Twofold::product(row.value[k].v, ws.v[i].v) + Twofold(row.value[k] * ws.fixed.speed_low[i]);
    }
    rates[d] = slip.high;
  }
}

/// Speeds of all nodes, or what they gain.
CLUTCHWORK_INLINE void nodes_by(const Run& ws, const real* speeds, const real* given, real* nodes) {
  const auto& sys = ws.sys;
  multiply(
      int(sys.speeds), int(sys.nodes), int(sys.nodes), ws.fixed.node_rows, [&](int n) { return basis_row(sys, n); },
      speeds, nodes);
  for (int n = 0; sys.prescribed > 0 && n < sys.nodes; ++n) {
    for (int p = 0; p < sys.prescribed; ++p) nodes[n] += sys.basis_prescribed[n * sys.prescribed + p] * given[p];
  }
}

/// Once per run: the whole rows of few speeds, by columns.
inline void fill_rows(Run& ws) {
  const int nv = int(ws.sys.speeds);
  if (nv > most_whole_speeds) return;
  auto fill = [&](real* whole, int column, const auto& row) {
    for (int k = 0; k < nv; ++k) whole[k * column] = 0;
    for (int k = 0; k < row.n; ++k) whole[row.column[k] * column] = row.value[k];
  };
  const int nd = ws.n_directions, nn = int(ws.sys.nodes);
  for (int d = 0; d < nd; ++d) fill(ws.fixed.rate_rows + d, nd, rate_row(ws.sys, d));
  for (int n = 0; n < nn; ++n) fill(ws.fixed.node_rows + n, nn, basis_row(ws.sys, n));
}

}  // namespace clutchwork::fixed

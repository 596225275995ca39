#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/workspace.hpp>

/// Rates of all directions and speeds of all nodes from speeds: of few speeds by whole rows, which need no indices.
namespace clutchwork::fixed {

using Run = Workspace<real>;

/// x += change. Where numbers are single, what that loses is kept: docs/theory/fixed-steps.md (14)
inline void add(double& x, const double*, int, double change) { x += change; }
inline void add(Single& x, Single* low, int i, Single change) { add_to(x, low[i], change); }

/// y := rows x, for n rows of N numbers.
template <int N>
CLUTCHWORK_INLINE void multiply_few(int n, const real* row, const real* x, real* y) {
  real at[N];
  for (int k = 0; k < N; ++k) at[k] = x[k];
  for (int i = 0; i < n; ++i, row += N) {
    real s = row[0] * at[0];
    for (int k = 1; k < N; ++k) s += row[k] * at[k];
    y[i] = s;
  }
}
/// The same for as many numbers as there are speeds; `sparse(i)` is a row where these are more than a few.
template <class Row>
CLUTCHWORK_INLINE void multiply(int nv, int n, const real* rows, Row&& sparse, const real* x, real* y) {
  static_assert(most_whole_speeds == 4);
  switch (nv) {
    case 1:
      return multiply_few<1>(n, rows, x, y);
    case 2:
      return multiply_few<2>(n, rows, x, y);
    case 3:
      return multiply_few<3>(n, rows, x, y);
    case 4:
      return multiply_few<4>(n, rows, x, y);
    default:
      for (int i = 0; i < n; ++i) y[i] = sparse(i).times(x);
  }
}

/// Rates of all directions by speeds, without the prescribed ones.
inline void rates_by(const Run& ws, const real* speeds, real* rates) {
  multiply(
      int(ws.sys.speeds), ws.n_directions, ws.fixed.rate_rows, [&](int d) { return rate_row(ws.sys, d); }, speeds,
      rates);
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
inline void nodes_by(const Run& ws, const real* speeds, const real* given, real* nodes) {
  const auto& sys = ws.sys;
  multiply(
      int(sys.speeds), int(sys.nodes), ws.fixed.node_rows, [&](int n) { return basis_row(sys, n); }, speeds, nodes);
  for (int n = 0; sys.prescribed > 0 && n < sys.nodes; ++n) {
    for (int p = 0; p < sys.prescribed; ++p) nodes[n] += sys.basis_prescribed[n * sys.prescribed + p] * given[p];
  }
}

/// Once per run: the whole rows of few speeds.
inline void fill_rows(Run& ws) {
  const int nv = int(ws.sys.speeds);
  if (nv > most_whole_speeds) return;
  auto fill = [&](real* whole, const auto& row) {
    for (int k = 0; k < nv; ++k) whole[k] = 0;
    for (int k = 0; k < row.n; ++k) whole[row.column[k]] = row.value[k];
  };
  for (int d = 0; d < ws.n_directions; ++d) fill(ws.fixed.rate_rows + d * nv, rate_row(ws.sys, d));
  for (int n = 0; n < ws.sys.nodes; ++n) fill(ws.fixed.node_rows + n * nv, basis_row(ws.sys, n));
}

}  // namespace clutchwork::fixed

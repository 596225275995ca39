#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/contacts/eliminate.hpp>
#include <clutchwork/workspace.hpp>

/// Reduced coordinates for many speeds: a subset of v, each locked contact eliminating one; everything stays sparse.
namespace clutchwork {

/// Rows over the reduced speeds: rates, then locked contacts whose directions vary.
template <class T>
int row_count(const Workspace<T>& ws) {
  return ws.n_rates + ws.ratios.more_rows;
}

/// Rates of the branches: rows.rate. False: there is no room.
template <class T>
bool compress_rates(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  const std::int64_t room = is_few(sys) ? ws.n_directions * sys.speeds : sys.rate_room;
  const Compressed<T>& expansion = ws.rows.expansion;
  Compressed<T>& rate = ws.rows.rate;
  int at = 0;
  bool fits = true;
  for (int k = 0; k < row_count(ws); ++k) {
    rate.first[k] = at;
    const auto given = rate_row(sys, ws.branch[k].direction);
    WorkRow<T> row(ws.reduced.row, ws.reduced.nz);
    for (int g = 0; g < given.n; ++g) {
      const int i = given.column[g];
      for (int e = expansion.first[i]; e < expansion.first[i + 1]; ++e)
        row.add(expansion.col[e], T(given.value[g]) * expansion.val[e]);
    }
    row.take([&](int j, T x) {
      fits = fits && at < room;
      if (fits) rate.col[at] = j, rate.val[at++] = x;
    });
  }
  rate.first[row_count(ws)] = at;
  return fits;
}

/// Calls f(row, column, number) for the products whose sums are the lower half of the reduced mass N' M N.
template <class T, class F>
void each_mass(const Workspace<T>& ws, F&& f) {
  const auto& sys = ws.sys;
  const Compressed<T>& n = ws.rows.expansion;
  for (int i = 0; i < sys.speeds; ++i) {
    const auto row = mass_row(sys, i);
    for (int m = 0; m < row.n; ++m) {
      const int j = row.column[m];
      for (int a = n.first[i]; a < n.first[i + 1]; ++a) {
        for (int b = n.first[j]; b < n.first[j + 1]; ++b) {
          if (n.col[b] <= n.col[a]) f(n.col[a], n.col[b], T(row.value[m]) * n.val[a] * n.val[b]);
        }
      }
    }
  }
}

/// Envelope of M + sum of branch couplings: first column of each row, and where it lies. sky[i] + j is the place of
/// entry (i, j), low[i] <= j <= i. How many numbers it holds.
template <class T>
std::int64_t lay_envelope(Workspace<T>& ws) {
  const Compressed<T>& rate = ws.rows.rate;
  const int nz = ws.reduced.nz;
  int* low = ws.rows.low;
  for (int i = 0; i < nz; ++i) low[i] = i;
  each_mass(ws, [&](int i, int j, T) { low[i] = smaller(low[i], j); });
  for (int k = 0; k < ws.n_branches; ++k) {
    if (rate.first[k] == rate.first[k + 1]) continue;
    const int least = rate.col[rate.first[k]];
    for (int e = rate.first[k]; e < rate.first[k + 1]; ++e) low[rate.col[e]] = smaller(low[rate.col[e]], least);
  }
  return Envelope{low, ws.rows.sky}.lay(nz);
}

/// Reduced mass, lower half: rows.mass. The envelope serves to add it up. False: there is no room.
template <class T>
bool compress_mass(Workspace<T>& ws, std::int64_t size) {
  const auto& sys = ws.sys;
  const int nz = ws.reduced.nz;
  const std::int64_t room = is_few(sys) ? sys.speeds * (sys.speeds + 1) / 2 : sys.mass_room;
  const int *low = ws.rows.low, *sky = ws.rows.sky;
  T* sum = ws.rows.envelope;
  Compressed<T>& mass = ws.rows.mass;
  for (std::int64_t k = 0; k < size; ++k) sum[k] = T(0);
  each_mass(ws, [&](int i, int j, T m) { sum[sky[i] + j] += m; });
  int at = 0;
  for (int i = 0; i < nz; ++i) {
    mass.first[i] = at;
    for (int j = low[i]; j <= i; ++j) {
      if (value(sum[sky[i] + j]) == 0) continue;
      if (at >= room) return false;
      mass.col[at] = j, mass.val[at++] = sum[sky[i] + j];
    }
  }
  mass.first[nz] = at;
  return true;
}

/// Right-hand side of M z = N' M (v - Y u), in reduced.y; the form solves it.
template <class T>
void reduce_momentum(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed);
  const Compressed<T>& expansion = ws.rows.expansion;
  T *speed = ws.reduced.momentum, *z = ws.reduced.y;
  for (int j = 0; j < nv; ++j) {
    speed[j] = ws.v[j];
    for (int p = 0; p < np; ++p) speed[j] -= ws.reduced.y_basis[j * np + p] * ws.in.prescribed[p];
  }
  for (int j = 0; j < ws.reduced.nz; ++j) z[j] = T(0);
  for (int i = 0; i < nv; ++i) {
    const T own = sys.massless[i] ? speed[i] : T(0);
    expansion.add(i, mass_row(sys, i).times(speed) + own, z);
  }
}

/// Rates, mass and envelope of the present mode, whose speeds are expanded. False: there is no room.
template <class T>
bool reduce_sparse(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  if (!compress_rates(ws)) return false;
  const std::int64_t size = lay_envelope(ws),
                     room = is_few(sys) ? sys.speeds * (sys.speeds + 1) / 2 : sys.envelope_room;
  if (size > room || !compress_mass(ws, size)) return false;
  reduce_momentum(ws);
  return true;
}

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/workspace.hpp>

/// Reduced coordinates for many speeds: a subset of v, each locked contact eliminating one; everything stays sparse.
namespace clutchwork {

/// Speed by which a row, whose largest entry was `full`, is solved (-1: it depends on those before).
template <class T>
int pivot_in(int nv, const T* row, double full) {
  int pivot = -1;
  for (int j = 0; j < nv; ++j) {
    const double size = abs(value(row[j]));
    if (size > 1e-10 * full && (pivot < 0 || size > 1.01 * abs(value(row[pivot])))) pivot = j;
  }
  return pivot;
}

/// Expansion v = N z with one speed eliminated per independent locked contact (columns still numbered by v), in
/// reduced.z_basis. Returns how many were eliminated.
template <class T>
int eliminate_locked(Workspace<T>& ws) {
  int eliminated = 0;
  const int nv = int(ws.sys.speeds);
  T *n = ws.reduced.z_basis, *row = ws.reduced.row;
  for (int i = 0; i < nv * nv; ++i) n[i] = T(0);
  for (int i = 0; i < nv; ++i) n[i * nv + i] = T(1), ws.rows.eliminated_by[i] = -1;
  for (int a = 0; a < ws.held.n; ++a) {
    const double* given = ws.sys.contact_rate + std::int64_t(ws.held.contact[a]) * nv;
    double full = 0;
    for (int j = 0; j < nv; ++j) row[j] = T(0);
    for (int i = 0; i < nv; ++i) {
      if (given[i] == 0) continue;
      full = larger(full, abs(given[i]));
      for (int j = 0; j < nv; ++j) row[j] += T(given[i]) * n[i * nv + j];
    }
    const int pivot = pivot_in(nv, row, full);
    if (pivot < 0) continue;
    ws.rows.eliminated_by[pivot] = a;
    ++eliminated;
    for (int i = 0; i < nv; ++i) {
      const T share = n[i * nv + pivot];
      if (value(share) == 0) continue;
      const T factor = share / row[pivot];
      for (int j = 0; j < nv; ++j) {
        if (value(row[j]) != 0) n[i * nv + j] -= factor * row[j];
      }
      n[i * nv + pivot] = T(0);
    }
  }
  return eliminated;
}

/// Compressed rows of a dense matrix, keeping only the columns with a number, under that.
template <class T>
void compress(int rows, int cols, const T* dense, const int* number, Compressed<T>& to) {
  int at = 0;
  for (int i = 0; i < rows; ++i) {
    to.first[i] = at;
    for (int j = 0; j < cols; ++j) {
      if (number[j] < 0 || value(dense[i * cols + j]) == 0) continue;
      to.col[at] = number[j];
      to.val[at++] = dense[i * cols + j];
    }
  }
  to.first[rows] = at;
}

/// Rates of the branches: rows.rate.
template <class T>
void compress_rates(Workspace<T>& ws) {
  const System& sys = ws.sys;
  const int nv = int(sys.speeds), nz = ws.reduced.nz;
  const Compressed<T>& expansion = ws.rows.expansion;
  Compressed<T>& rate = ws.rows.rate;
  T* row = ws.reduced.row;
  int at = 0;
  for (int k = 0; k < ws.n_rates; ++k) {
    rate.first[k] = at;
    const double* given = rate_row(sys, ws.branch[k].direction);
    for (int j = 0; j < nz; ++j) row[j] = T(0);
    for (int i = 0; i < nv; ++i) {
      if (given[i] != 0) expansion.add(i, T(given[i]), row);
    }
    for (int j = 0; j < nz; ++j) {
      if (value(row[j]) == 0) continue;
      rate.col[at] = j;
      rate.val[at++] = row[j];
    }
  }
  rate.first[ws.n_rates] = at;
}

/// Reduced mass N' M N, lower and upper: rows.mass. `dense`: memory for nz x nz.
template <class T>
void compress_mass(Workspace<T>& ws, T* dense) {
  const System& sys = ws.sys;
  const int nv = int(sys.speeds), nz = ws.reduced.nz;
  const Compressed<T>& expansion = ws.rows.expansion;
  for (int i = 0; i < nz * nz; ++i) dense[i] = T(0);
  for (int i = 0; i < nv; ++i) {
    for (int j = 0; j < nv; ++j) {
      const double m = sys.mass[i * nv + j];
      if (m == 0) continue;
      for (int e = expansion.first[i]; e < expansion.first[i + 1]; ++e) {
        for (int f = expansion.first[j]; f < expansion.first[j + 1]; ++f) {
          dense[expansion.col[e] * nz + expansion.col[f]] += T(m) * expansion.val[e] * expansion.val[f];
        }
      }
    }
  }
  for (int j = 0; j < nz; ++j) ws.rows.number[j] = j;
  compress(nz, nz, dense, ws.rows.number, ws.rows.mass);
}

/// Envelope of M + sum of branch couplings: first column of each row, and where it lies. sky[i] + j is the place of
/// entry (i, j), low[i] <= j <= i.
template <class T>
void lay_envelope(Workspace<T>& ws) {
  const Compressed<T>&mass = ws.rows.mass, &rate = ws.rows.rate;
  const int nz = ws.reduced.nz;
  int* low = ws.rows.low;
  for (int i = 0; i < nz; ++i) {
    low[i] = i;
    for (int e = mass.first[i]; e < mass.first[i + 1]; ++e) low[i] = smaller(low[i], mass.col[e]);
  }
  for (int k = 0; k < ws.n_branches; ++k) {
    if (rate.first[k] == rate.first[k + 1]) continue;
    const int least = rate.col[rate.first[k]];
    for (int e = rate.first[k]; e < rate.first[k + 1]; ++e) low[rate.col[e]] = smaller(low[rate.col[e]], least);
  }
  int end = 0;
  for (int i = 0; i < nz; ++i) {
    ws.rows.sky[i] = end - low[i];
    end += i - low[i] + 1;
  }
}

/// Right-hand side of M z = N' M (v - Y u), in reduced.y; the form solves it.
template <class T>
void reduce_momentum(Workspace<T>& ws) {
  const System& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed);
  const Compressed<T>& expansion = ws.rows.expansion;
  T *momentum = ws.reduced.momentum, *z = ws.reduced.y;
  for (int i = 0; i < nv; ++i) {
    T s = T(0);
    for (int j = 0; j < nv; ++j) {
      const double m = sys.mass[i * nv + j] + (i == j && sys.massless[i] ? 1.0 : 0.0);
      if (m == 0) continue;
      T speed = ws.v[j];
      for (int p = 0; p < np; ++p) speed -= ws.reduced.y_basis[j * np + p] * ws.in.prescribed[p];
      s += T(m) * speed;
    }
    momentum[i] = s;
  }
  for (int j = 0; j < ws.reduced.nz; ++j) z[j] = T(0);
  for (int i = 0; i < nv; ++i) expansion.add(i, momentum[i], z);
}

/// Expansion, rates, mass and envelope of the present mode; reduced.z_basis holds the eliminated expansion and is used
/// up.
template <class T>
void reduce_sparse(Workspace<T>& ws) {
  const int nv = int(ws.sys.speeds);
  int nz = 0;
  for (int j = 0; j < nv; ++j) ws.rows.number[j] = ws.rows.eliminated_by[j] < 0 ? nz++ : -1;
  ws.reduced.nz = nz;
  compress(nv, nv, ws.reduced.z_basis, ws.rows.number, ws.rows.expansion);
  compress_rates(ws);
  compress_mass(ws, ws.reduced.z_basis);
  lay_envelope(ws);
  reduce_momentum(ws);
}

}  // namespace clutchwork

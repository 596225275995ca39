#pragma once
#include <clutchwork/workspace.hpp>

/// Reduced coordinates for many speeds: a subset of v, each locked contact eliminating one; everything stays sparse.
namespace clutchwork {

/// Expansion v = N z with one speed eliminated per independent locked contact (columns still numbered by v).
/// Returns how many were eliminated.
template <class T>
int eliminate_locked(Workspace<T>& ws, T* n) {
  int eliminated = 0;
  const int nv = int(ws.sys.speeds);
  for (int i = 0; i < nv * nv; ++i) n[i] = T(0);
  for (int i = 0; i < nv; ++i) n[i * nv + i] = T(1), ws.pivot_of[i] = -1;
  T* row = ws.scratch;
  for (int a = 0; a < ws.n_locked; ++a) {
    const double* given = ws.sys.contact_rate + std::int64_t(ws.locked[a]) * nv;
    double full = 0;
    for (int j = 0; j < nv; ++j) row[j] = T(0);
    for (int i = 0; i < nv; ++i) {
      if (given[i] == 0) continue;
      full = larger(full, abs(given[i]));
      for (int j = 0; j < nv; ++j) row[j] += T(given[i]) * n[i * nv + j];
    }
    int pivot = -1;
    for (int j = 0; j < nv; ++j) {
      if (abs(value(row[j])) > 1e-10 * full && (pivot < 0 || abs(value(row[j])) > 1.01 * abs(value(row[pivot]))))
        pivot = j;
    }
    if (pivot < 0) continue;
    ws.pivot_of[pivot] = a;
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

/// Compressed rows of a dense matrix, keeping only the columns in `keep` (renumbered); returns the entries.
template <class T>
int compress(int rows, int cols, const T* dense, const int* number, int* first, int* col, T* val) {
  int at = 0;
  for (int i = 0; i < rows; ++i) {
    first[i] = at;
    for (int j = 0; j < cols; ++j) {
      if (number[j] < 0 || value(dense[i * cols + j]) == 0) continue;
      col[at] = number[j];
      val[at++] = dense[i * cols + j];
    }
  }
  first[rows] = at;
  return at;
}

/// Expansion, rates, mass and envelope of the present mode; ws.z_basis holds the eliminated expansion and is used up.
template <class T>
void reduce_sparse(Workspace<T>& ws) {
  const System& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed);
  T* n = ws.z_basis;
  int* number = ws.iscratch;
  int nz = 0;
  for (int j = 0; j < nv; ++j) number[j] = ws.pivot_of[j] < 0 ? nz++ : -1;
  ws.nz = nz;
  compress(nv, nv, n, number, ws.exp_first, ws.exp_col, ws.exp_val);

  // rates of the branches
  T* row = ws.scratch;
  int at = 0;
  for (int k = 0; k < ws.n_rates; ++k) {
    ws.sp_first[k] = at;
    const int d = ws.branch[k].direction;
    const double* given = d < sys.elements ? sys.element_rate + d * nv : sys.contact_rate + (d - sys.elements) * nv;
    for (int j = 0; j < nz; ++j) row[j] = T(0);
    for (int i = 0; i < nv; ++i) {
      if (given[i] == 0) continue;
      for (int e = ws.exp_first[i]; e < ws.exp_first[i + 1]; ++e) row[ws.exp_col[e]] += T(given[i]) * ws.exp_val[e];
    }
    for (int j = 0; j < nz; ++j) {
      if (value(row[j]) == 0) continue;
      ws.sp_col[at] = j;
      ws.sp_val[at++] = row[j];
    }
  }
  ws.sp_first[ws.n_rates] = at;

  // reduced mass N' M N, lower and upper, compressed
  T* mass = n;
  for (int i = 0; i < nz * nz; ++i) mass[i] = T(0);
  for (int i = 0; i < nv; ++i) {
    for (int j = 0; j < nv; ++j) {
      const double m = sys.mass[i * nv + j];
      if (m == 0) continue;
      for (int e = ws.exp_first[i]; e < ws.exp_first[i + 1]; ++e) {
        for (int f = ws.exp_first[j]; f < ws.exp_first[j + 1]; ++f) {
          mass[ws.exp_col[e] * nz + ws.exp_col[f]] += T(m) * ws.exp_val[e] * ws.exp_val[f];
        }
      }
    }
  }
  for (int j = 0; j < nz; ++j) number[j] = j;
  compress(nz, nz, mass, number, ws.m_first, ws.m_col, ws.m_val);

  // envelope: first column of each row of M + sum of branch couplings
  int* low = ws.iscratch + nv;
  for (int i = 0; i < nz; ++i) {
    low[i] = i;
    for (int e = ws.m_first[i]; e < ws.m_first[i + 1]; ++e) low[i] = smaller(low[i], ws.m_col[e]);
  }
  for (int k = 0; k < ws.n_branches; ++k) {
    if (ws.sp_first[k] == ws.sp_first[k + 1]) continue;
    const int least = ws.sp_col[ws.sp_first[k]];
    for (int e = ws.sp_first[k]; e < ws.sp_first[k + 1]; ++e) low[ws.sp_col[e]] = smaller(low[ws.sp_col[e]], least);
  }
  // sky[i] + j is the place of entry (i, j), low[i] <= j <= i
  int end = 0;
  for (int i = 0; i < nz; ++i) {
    ws.sky[i] = end - low[i];
    ws.pivot_of[i] = low[i];
    end += i - low[i] + 1;
  }

  // right-hand side of M z = N' M (v - Y u); the form solves it
  T* momentum = ws.dense_v;
  for (int i = 0; i < nv; ++i) {
    T s = T(0);
    for (int j = 0; j < nv; ++j) {
      const double m = sys.mass[i * nv + j] + (i == j && sys.massless[i] ? 1.0 : 0.0);
      if (m == 0) continue;
      T speed = ws.v[j];
      for (int p = 0; p < np; ++p) speed -= ws.y_basis[j * np + p] * ws.prescribed[p];
      s += T(m) * speed;
    }
    momentum[i] = s;
  }
  for (int j = 0; j < nz; ++j) ws.y[j] = T(0);
  for (int i = 0; i < nv; ++i) {
    for (int e = ws.exp_first[i]; e < ws.exp_first[i + 1]; ++e) ws.y[ws.exp_col[e]] += ws.exp_val[e] * momentum[i];
  }
}

}  // namespace clutchwork

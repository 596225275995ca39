#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/geometry.hpp>
#include <clutchwork/motion/sparse.hpp>
#include <clutchwork/workspace.hpp>

/// The reduced motion of one mode: v = Z z + Y u with the locked slips gone. docs/theory/multipliers.md.
namespace clutchwork {

/// Orthonormal directions in held.basis whose first ones, as many as returned, span the independent contacts; the
/// others the motion that is left.
template <class T>
int split_locked(Workspace<T>& ws) {
  for (int a = 0; a < ws.held.n_fixed; ++a) ws.held.all[a] = ws.held.contact[a];
  return split_held(ws, ws.held.n_fixed);
}

/// Multipliers as a linear map of branch torques and prescribed accelerations; few speeds only.
template <class T>
void map_multipliers(Workspace<T>& ws) {
  const int m = ws.held.n_fixed, ne = int(ws.sys.elements), np = int(ws.sys.prescribed), nv = int(ws.sys.speeds);
  const Compressed<T>& mass_weighted = ws.geometry.mass_weighted;
  T *b = ws.held.rhs, *x = ws.held.solved;
  for (int k = 0; k < ws.n_branches; ++k) {
    for (int a = 0; a < m; ++a) {
      b[a] = -product(mass_weighted, ne + ws.held.contact[a], ws.branch[k].direction);
    }
    solve_locked(ws, b, x);
    for (int a = 0; a < m; ++a) ws.held.reach[a * ws.n_branches + k] = x[a];
  }
  for (int p = 0; p < np; ++p) {
    for (int a = 0; a < m; ++a) {
      const int d = ne + ws.held.contact[a];
      // between prescribed speeds no torque holds
      b[a] = is_rigid(ws, ws.held.contact[a])
                 ? T(0)
                 : mass_weighted.times(d, ws.geometry.prescribed_momentum + p * nv) - prescribed_share(ws, d, p);
    }
    solve_locked(ws, b, x);
    for (int a = 0; a < m; ++a) ws.held.reach_prescribed[a * np + p] = x[a];
  }
}

/// The part of a momentum that the independent contacts leave free, turned round: by the basis of a split.
template <class T>
void free_part(const Workspace<T>& ws, const T* momentum, T* x) {
  const T* basis = ws.held.basis;
  const int nv = int(ws.sys.speeds);
  for (int i = 0; i < nv; ++i) x[i] = T(0);
  for (int j = ws.reduced.rank; j < nv; ++j) {
    T s = T(0);
    for (int i = 0; i < nv; ++i) s += basis[i * nv + j] * momentum[i];
    for (int i = 0; i < nv; ++i) x[i] -= s * basis[i * nv + j];
  }
}

/// The same for many speeds, without a basis: less what the independent contacts take.
template <class T>
void far_free_part(Workspace<T>& ws, const T* momentum, T* x) {
  const int nv = int(ws.sys.speeds), ne = int(ws.sys.elements), m = ws.held.n_fixed;
  const Compressed<T>& mass_weighted = ws.geometry.mass_weighted;
  T *share = ws.held.rhs, *size = ws.held.solved;
  for (int i = 0; i < nv; ++i) x[i] = -momentum[i];
  // what round-off leaves is taken too
  for (int round = 0; round < 2; ++round) {
    for (int a = 0; a < m; ++a) share[a] = mass_weighted.times(ne + ws.held.contact[a], x);
    solve_locked(ws, share, size);
    for (int a = 0; a < m; ++a) mass_weighted.add(ne + ws.held.contact[a], -size[a], x);
  }
}

/// Y: what prescribed speeds do to v inside the mode, momentum along Z untouched.
template <class T>
void map_prescribed(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed), ne = int(sys.elements), m = ws.held.n_fixed;
  for (int p = 0; p < np; ++p) {
    T* x = ws.reduced.column;
    const T* momentum = ws.geometry.prescribed_momentum + p * nv;
    is_few(sys) ? free_part(ws, momentum, x) : far_free_part(ws, momentum, x);
    T *share = ws.held.rhs, *size = ws.held.solved;
    for (int a = 0; a < m; ++a) share[a] = prescribed_share(ws, ne + ws.held.contact[a], p);
    solve_locked(ws, share, size);
    for (int a = 0; a < m; ++a) ws.geometry.mass_weighted.add(ne + ws.held.contact[a], -size[a], x);
    backward_solve(nv, ws.geometry.inertia, ws.geometry.factor, x);
    for (int i = 0; i < nv; ++i) ws.reduced.y_basis[i * np + p] = x[i];
  }
}

/// Rates of the branches in reduced coordinates: rate = row_z z + offset u.
template <class T>
void reduce_rates(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  const int np = int(sys.prescribed), nz = ws.reduced.nz;
  for (int k = 0; k < row_count(ws); ++k) {
    const int d = ws.branch[k].direction;
    const auto row = rate_row(sys, d);
    for (int p = 0; p < np; ++p) {
      T s = prescribed_share(ws, d, p);
      for (int e = 0; e < row.n; ++e) s += T(row.value[e]) * ws.reduced.y_basis[row.column[e] * np + p];
      ws.reduced.offset[k * np + p] = s;
    }
    if (ws.reduced.is_sparse) continue;
    for (int j = 0; j < nz; ++j) {
      T s = T(0);
      for (int e = 0; e < row.n; ++e) s += T(row.value[e]) * ws.reduced.z_basis[row.column[e] * nz + j];
      ws.reduced.row_z[k * nz + j] = s;
    }
  }
}

/// Dense reduced coordinates: Z with Z' M Z = 1, and z = Z'(M v + M_p u).
template <class T>
void reduce_dense(Workspace<T>& ws) {
  const T* basis = ws.held.basis;
  const int nv = int(ws.sys.speeds), nz = ws.reduced.nz, np = int(ws.sys.prescribed);
  T* x = ws.reduced.momentum;
  transposed_times(nv, ws.geometry.inertia, ws.geometry.factor, ws.v, x);
  for (int i = 0; i < nv; ++i) {
    for (int p = 0; p < np; ++p) x[i] += ws.geometry.prescribed_momentum[p * nv + i] * ws.in.prescribed[p];
  }
  T* column = ws.reduced.column;
  for (int j = 0; j < nz; ++j) {
    for (int i = 0; i < nv; ++i) column[i] = basis[i * nv + ws.reduced.rank + j];
    ws.reduced.y[j] = dot(nv, column, x);
    backward_solve(nv, ws.geometry.inertia, ws.geometry.factor, column);
    for (int i = 0; i < nv; ++i) ws.reduced.z_basis[i * nz + j] = column[i];
  }
}

/// The same where few of many speeds are left: the kept ones, made orthonormal in the mass. False: they depend on each
/// other.
template <class T>
bool reduce_to_few(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  const int nv = int(sys.speeds), nz = ws.reduced.nz, np = int(sys.prescribed);
  const Compressed<T>& expansion = ws.rows.expansion;
  T mass[small_speeds * small_speeds] = {}, *momentum = ws.reduced.momentum;
  each_mass(ws, [&](int i, int j, T m) { mass[i * nz + j] += m; });
  if (!cholesky(nz, mass, nz)) return false;
  for (int i = 0; i < nv; ++i) {
    T* z = ws.reduced.z_basis + i * nz;
    for (int j = 0; j < nz; ++j) z[j] = T(0);
    expansion.add(i, T(1), z);
    forward_solve(nz, mass, nz, z);
    momentum[i] = mass_row(sys, i).times(ws.v);
    for (int p = 0; p < np; ++p) momentum[i] += T(sys.mass_prescribed[i * np + p]) * ws.in.prescribed[p];
  }
  for (int j = 0; j < nz; ++j) {
    ws.reduced.y[j] = T(0);
    for (int i = 0; i < nv; ++i) ws.reduced.y[j] += ws.reduced.z_basis[i * nz + j] * momentum[i];
  }
  return true;
}

}  // namespace clutchwork

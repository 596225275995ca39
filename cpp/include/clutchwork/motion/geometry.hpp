#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/workspace.hpp>

/// Directions and inertias of the whole run, mass-weighted: docs/theory/multipliers.md.
namespace clutchwork {

/// The mass-weighted directions without their zeros, and the mobility of the contacts: their products.
template <class T>
void compress_directions(Workspace<T>& ws) {
  const int nv = int(ws.sys.speeds), ne = int(ws.sys.elements), nc = int(ws.sys.contacts);
  Compressed<T>& white = ws.geometry.white;
  int at = 0;
  for (int d = 0; d < ws.n_directions; ++d) {
    white.first[d] = at;
    for (int i = 0; i < nv; ++i) {
      if (value(ws.geometry.direction[d * nv + i]) == 0) continue;
      white.col[at] = i;
      white.val[at++] = ws.geometry.direction[d * nv + i];
    }
  }
  white.first[ws.n_directions] = at;
  for (int a = 0; a < nc; ++a) {
    for (int b = 0; b <= a; ++b) {
      const T s = dot(nv, ws.geometry.direction + (ne + a) * nv, ws.geometry.direction + (ne + b) * nv);
      ws.geometry.mobility[a * nc + b] = ws.geometry.mobility[b * nc + a] = s;
    }
  }
}

/// Once per run: mass-weighted directions L^-1 D' and prescribed momentum L^-1 M_p. False when M is not positive
/// definite.
template <class T>
bool prepare_geometry(Workspace<T>& ws) {
  const System& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed);
  for (int i = 0; i < nv * nv; ++i) ws.geometry.factor[i] = T(sys.mass[i]);
  for (int i = 0; i < nv; ++i) ws.geometry.factor[i * nv + i] += T(sys.massless[i] ? 1.0 : 0.0);
  if (!cholesky(nv, ws.geometry.factor, nv)) return false;
  for (int d = 0; d < ws.n_directions; ++d) {
    const double* row = rate_row(sys, d);
    for (int i = 0; i < nv; ++i) ws.geometry.direction[d * nv + i] = T(row[i]);
    forward_solve(nv, ws.geometry.factor, nv, ws.geometry.direction + d * nv);
  }
  for (int p = 0; p < np; ++p) {
    for (int i = 0; i < nv; ++i) ws.geometry.prescribed_momentum[p * nv + i] = T(sys.mass_prescribed[i * np + p]);
    forward_solve(nv, ws.geometry.factor, nv, ws.geometry.prescribed_momentum + p * nv);
  }
  compress_directions(ws);
  // without redundant contacts nothing is ever held by others
  const int nc = int(sys.contacts);
  for (int c = 0; c < nc; ++c) ws.held.all[c] = c;
  ws.geometry.redundant = split_held(ws, nc) < nc;
  return true;
}

}  // namespace clutchwork

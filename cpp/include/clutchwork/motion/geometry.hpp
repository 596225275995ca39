#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/envelope.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/workspace.hpp>

/// Directions and inertias of the whole run, mass-weighted: docs/theory/multipliers.md.
namespace clutchwork {

/// Factor of the mass matrix; massless speeds count as one. False when it is not positive definite.
template <class T>
bool factor_mass(Workspace<T>& ws, const Sizes& room) {
  const auto& sys = ws.sys;
  const int nv = int(sys.speeds);
  Envelope& e = ws.geometry.inertia;
  T* factor = ws.geometry.factor;
  for (int i = 0; i < nv; ++i) {
    const auto row = mass_row(sys, i);
    e.low[i] = row.n > 0 ? smaller(row.column[0], i) : i;
  }
  const std::int64_t size = room.few ? e.lay_whole(nv) : e.lay(nv);
  if (size > room.factor) return false;
  for (std::int64_t k = 0; k < size; ++k) factor[k] = T(0);
  for (int i = 0; i < nv; ++i) {
    const auto row = mass_row(sys, i);
    for (int k = 0; k < row.n && row.column[k] <= i; ++k) factor[e.sky[i] + row.column[k]] = T(row.value[k]);
    factor[e.sky[i] + i] += T(sys.massless[i] ? 1.0 : 0.0);
  }
  return cholesky(nv, e, factor);
}

/// The mass-weighted directions L^-1 D' without their zeros, and the mobility of each. False: there is no room.
template <class T>
bool weigh_directions(Workspace<T>& ws, const Sizes& room) {
  const auto& sys = ws.sys;
  const int nv = int(sys.speeds);
  const Envelope& e = ws.geometry.inertia;
  const T* factor = ws.geometry.factor;
  Compressed<T>& mass_weighted = ws.geometry.mass_weighted;
  T* x = ws.geometry.column;
  // behind a speed nothing refers to those before `rest`
  int *rest = ws.geometry.rest, at = 0;
  for (int i = nv - 1; i >= 0; --i) rest[i] = i + 1 < nv ? smaller(e.low[i], rest[i + 1]) : e.low[i];
  for (int i = 0; i < nv; ++i) x[i] = T(0);
  for (int d = 0; d < ws.n_directions; ++d) {
    mass_weighted.first[d] = at;
    T square = T(0);
    const auto row = rate_row(sys, d);
    for (int k = 0; k < row.n; ++k) x[row.column[k]] = T(row.value[k]);
    const int first = row.n > 0 ? row.column[0] : nv, end = row.n > 0 ? row.column[row.n - 1] : -1;
    for (int i = first, last = -1; i < nv && (i <= end || rest[i] <= last); ++i) {
      T s = x[i];
      const T* own = factor + e.sky[i];
      for (int k = larger(e.low[i], first); k < i; ++k) s -= own[k] * x[k];
      x[i] = s / own[i];
      if (value(x[i]) == 0) {
        x[i] = T(0);
        continue;
      }
      if (at >= room.mass_weighted) return false;
      last = i, mass_weighted.col[at] = i, mass_weighted.val[at++] = x[i];
      square += x[i] * x[i];
    }
    for (int k = mass_weighted.first[d]; k < at; ++k) x[mass_weighted.col[k]] = T(0);
    ws.geometry.own[d] = square;
  }
  mass_weighted.first[ws.n_directions] = at;
  return true;
}

/// Product of two mass-weighted directions.
template <class T>
T product(const Compressed<T>& mass_weighted, int a, int b) {
  T s = T(0);
  int e = mass_weighted.first[a], f = mass_weighted.first[b];
  while (e < mass_weighted.first[a + 1] && f < mass_weighted.first[b + 1]) {
    if (mass_weighted.col[e] == mass_weighted.col[f]) s += mass_weighted.val[e] * mass_weighted.val[f];
    const int left = mass_weighted.col[e], right = mass_weighted.col[f];
    e += left <= right, f += right <= left;
  }
  return s;
}

/// An order of the contacts in which those with speeds in common are close: by their last speed. Few keep theirs.
template <class T>
void order_contacts(Workspace<T>& ws, bool few) {
  const int nv = int(ws.sys.speeds), ne = int(ws.sys.elements), nc = int(ws.sys.contacts);
  const Compressed<T>& mass_weighted = ws.geometry.mass_weighted;
  int *place = ws.geometry.place, *at = ws.geometry.at, *start = ws.geometry.rest;
  // those without inertia come first
  auto bucket = [&](int c) {
    const int end = mass_weighted.first[ne + c + 1];
    return mass_weighted.first[ne + c] < end ? mass_weighted.col[end - 1] + 1 : 0;
  };
  for (int i = 0; i <= nv + 1; ++i) start[i] = 0;
  for (int c = 0; c < nc; ++c) ++start[bucket(c) + 1];
  for (int i = 1; i <= nv + 1; ++i) start[i] += start[i - 1];
  for (int c = 0; c < nc; ++c) {
    place[c] = few ? c : start[bucket(c)]++;
    at[place[c]] = c;
  }
}

/// Mobility of the contacts: products of their directions. False: there is no room.
template <class T>
bool weigh_contacts(Workspace<T>& ws, const Sizes& room) {
  const int ne = int(ws.sys.elements), nc = int(ws.sys.contacts);
  Geometry<T>& g = ws.geometry;
  order_contacts(ws, room.few);
  auto first = [&](int p) { return g.mass_weighted.col[g.mass_weighted.first[ne + g.at[p]]]; };
  auto last = [&](int p) { return g.mass_weighted.col[g.mass_weighted.first[ne + g.at[p] + 1] - 1]; };
  auto empty = [&](int p) { return g.mass_weighted.first[ne + g.at[p]] == g.mass_weighted.first[ne + g.at[p] + 1]; };
  for (int p = 0, low = 0; p < nc; ++p) {
    // the last speeds ascend, so that what overlaps is a stretch of places
    g.near.low[p] = p;
    if (empty(p)) continue;
    for (low = p; low > 0 && !empty(low - 1) && last(low - 1) >= first(p);) --low;
    g.near.low[p] = low;
  }
  const std::int64_t size = room.few ? g.near.lay_whole(nc) : g.near.lay(nc);
  if (size > room.mobility) return false;
  for (int p = 0; p < nc; ++p) g.last[p] = p;
  for (int p = 0; p < nc; ++p) {
    for (int q = g.near.low[p]; q <= p; ++q) {
      g.mobility[g.near.sky[p] + q] = product(g.mass_weighted, ne + g.at[p], ne + g.at[q]);
      g.last[q] = p;
    }
  }
  return true;
}

/// Once per run: mass-weighted directions L^-1 D' and prescribed momentum L^-1 M_p. False when M is not positive
/// definite, or there is no room.
template <class T>
bool prepare_geometry(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  const Sizes room(sys);
  const int nv = int(sys.speeds), np = int(sys.prescribed), nc = int(sys.contacts);
  if (!factor_mass(ws, room) || !weigh_directions(ws, room) || !weigh_contacts(ws, room)) return false;
  for (int p = 0; p < np; ++p) {
    T* momentum = ws.geometry.prescribed_momentum + p * nv;
    for (int i = 0; i < nv; ++i) momentum[i] = T(sys.mass_prescribed[i * np + p]);
    forward_solve(nv, ws.geometry.inertia, ws.geometry.factor, momentum);
  }
  // without redundant contacts nothing is ever held by others
  ws.geometry.redundant = room.spares > 0;
  if (!room.few) return true;
  for (int c = 0; c < nc; ++c) ws.held.all[c] = c;
  ws.geometry.redundant = split_held(ws, nc) < nc;
  return true;
}

}  // namespace clutchwork

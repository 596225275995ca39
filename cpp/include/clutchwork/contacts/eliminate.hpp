#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/workspace.hpp>

/// Speeds eliminated by locked contacts, one each, without ever writing down a zero: docs/theory/reduction.md.
namespace clutchwork {

/// The row that is worked on, in reduced.row, and the stretch outside of which it is zero.
template <class T>
struct WorkRow {
  T* x;
  int low, high = -1;

  WorkRow(T* row, int n) : x(row), low(n) {}
  void add(int j, T size) {
    x[j] += size;
    low = smaller(low, j), high = larger(high, j);
  }
  /// Calls f(column, number) for what is not zero, in ascending order, and leaves zeros.
  template <class F>
  void take(F&& f) {
    for (int j = low; j <= high; ++j) {
      if (value(x[j]) != 0) f(j, x[j]);
      x[j] = T(0);
    }
  }
};

/// Speed by which a row, whose largest entry was `full`, is solved (-1: it depends on those before).
template <class T>
int pivot_in(const WorkRow<T>& row, double full) {
  int pivot = -1;
  for (int j = row.low; j <= row.high; ++j) {
    const double size = abs(value(row.x[j]));
    if (size > 1e-10 * full && (pivot < 0 || size > 1.01 * abs(value(row.x[pivot])))) pivot = j;
  }
  return pivot;
}

/// The slip of a contact over the speeds that are left, after `steps` eliminations; its largest entry before.
template <class T>
double reduce_row(const Workspace<T>& ws, int c, int steps, WorkRow<T>& row) {
  const Compressed<T>& solved = ws.rows.solved;
  const auto given = rate_row(ws.sys, int(ws.sys.elements) + c);
  double full = 0;
  int waiting = 0, first = steps;
  for (int e = 0; e < given.n; ++e) {
    const int j = given.column[e], step = ws.rows.step[j];
    row.add(j, T(given.value[e]));
    full = larger(full, abs(value(given.value[e])));
    if (step >= 0) ++waiting, first = smaller(first, step);
  }
  // what replaces a speed is eliminated later, if at all
  for (int r = first; waiting > 0 && r < steps; ++r) {
    const int p = ws.rows.pivot[r];
    if (value(row.x[p]) == 0) continue;
    const T factor = row.x[p];
    row.x[p] = T(0);
    --waiting;
    for (int e = solved.first[r]; e < solved.first[r + 1]; ++e) {
      const int j = solved.col[e];
      const bool before = value(row.x[j]) != 0;
      row.add(j, factor * solved.val[e]);
      if (ws.rows.step[j] >= 0) waiting += int(value(row.x[j]) != 0) - int(before);
    }
  }
  return full;
}

/// Eliminate one speed for each of n contacts whose slip does not depend on those before: held.number tells for which,
/// -1 for the others. Returns how many, -1: there is no room.
template <class T>
int eliminate(Workspace<T>& ws, const int* contact, int n) {
  const int nv = int(ws.sys.speeds);
  const std::int64_t room = is_few(ws.sys) ? std::int64_t(nv) * nv : ws.sys.expansion_room;
  Compressed<T>& solved = ws.rows.solved;
  int steps = 0, at = 0;
  for (int j = 0; j < nv; ++j) ws.reduced.row[j] = T(0), ws.rows.step[j] = -1;
  solved.first[0] = 0;
  for (int a = 0; a < n; ++a) {
    WorkRow<T> row(ws.reduced.row, nv);
    const double full = reduce_row(ws, contact[a], steps, row);
    const int pivot = pivot_in(row, full);
    ws.held.number[a] = pivot < 0 ? -1 : steps;
    bool fits = true;
    const T size = pivot < 0 ? T(1) : row.x[pivot];
    row.take([&](int j, T x) {
      if (pivot < 0 || j == pivot) return;
      fits = fits && at < room;
      if (fits) solved.col[at] = j, solved.val[at++] = T(0) - x / size;
    });
    if (!fits) return -1;
    if (pivot < 0) continue;
    ws.rows.pivot[steps] = pivot, ws.rows.step[pivot] = steps;
    solved.first[++steps] = at;
  }
  return steps;
}

/// The eliminated speeds over those that are kept: rows.spread. False: there is no room.
template <class T>
bool spread_eliminated(Workspace<T>& ws, int steps) {
  const int nv = int(ws.sys.speeds);
  const std::int64_t room = is_few(ws.sys) ? std::int64_t(nv) * nv : ws.sys.expansion_room;
  const Compressed<T>& solved = ws.rows.solved;
  Compressed<T>& spread = ws.rows.spread;
  int at = 0;
  spread.first[0] = 0;
  // from the last to the first, for a speed is solved over those that are eliminated later
  for (int r = steps - 1, k = 0; r >= 0; --r, ++k) {
    WorkRow<T> row(ws.reduced.row, nv);
    for (int e = solved.first[r]; e < solved.first[r + 1]; ++e) {
      const int j = solved.col[e];
      if (ws.rows.step[j] < 0) {
        row.add(j, solved.val[e]);
        continue;
      }
      const int own = ws.rows.spread_at[j];
      for (int f = spread.first[own]; f < spread.first[own + 1]; ++f)
        row.add(spread.col[f], solved.val[e] * spread.val[f]);
    }
    bool fits = true;
    row.take([&](int j, T x) {
      fits = fits && at < room;
      if (fits) spread.col[at] = j, spread.val[at++] = x;
    });
    if (!fits) return false;
    ws.rows.spread_at[ws.rows.pivot[r]] = k;
    spread.first[k + 1] = at;
  }
  return true;
}

/// Numbers of the kept speeds, in the order of the last speed that each one moves, in which those that are coupled
/// are close: rows.number; how many.
template <class T>
int number_kept(Workspace<T>& ws) {
  const int nv = int(ws.sys.speeds);
  const Compressed<T>& spread = ws.rows.spread;
  int *number = ws.rows.number, *last = ws.rows.low, nz = 0;
  auto each = [&](int i, auto&& f) {
    if (ws.rows.step[i] < 0) return f(i);
    const int k = ws.rows.spread_at[i];
    for (int e = spread.first[k]; e < spread.first[k + 1]; ++e) f(spread.col[e]);
  };
  for (int i = 0; i < nv; ++i) {
    number[i] = -1;
    each(i, [&](int j) { last[j] = i; });
  }
  for (int i = 0; i < nv; ++i) {
    each(i, [&](int j) {
      if (last[j] == i) number[j] = nz++;
    });
  }
  return nz;
}

/// Expansion v = N z: rows.expansion. False: there is no room.
template <class T>
bool expand_kept(Workspace<T>& ws) {
  const int nv = int(ws.sys.speeds);
  const std::int64_t room = is_few(ws.sys) ? std::int64_t(nv) * nv : ws.sys.expansion_room;
  const Compressed<T>& spread = ws.rows.spread;
  Compressed<T>& to = ws.rows.expansion;
  int at = 0;
  for (int i = 0; i < nv; ++i) {
    to.first[i] = at;
    const bool kept = ws.rows.step[i] < 0;
    const int k = kept ? 0 : ws.rows.spread_at[i], n = kept ? 1 : spread.first[k + 1] - spread.first[k];
    if (at + n > room) return false;
    if (kept) to.col[at] = ws.rows.number[i], to.val[at++] = T(1);
    for (int e = kept ? 0 : spread.first[k]; !kept && e < spread.first[k + 1]; ++e)
      to.col[at] = ws.rows.number[spread.col[e]], to.val[at++] = spread.val[e];
  }
  to.first[nv] = at;
  return true;
}

/// Expansion v = N z with one speed eliminated per independent locked contact: rows.expansion, its columns numbered,
/// and reduced.nz. False: there is no room.
template <class T>
bool eliminate_locked(Workspace<T>& ws) {
  const int steps = eliminate(ws, ws.held.contact, ws.held.n_fixed);
  if (steps < 0 || !spread_eliminated(ws, steps)) return false;
  ws.reduced.nz = number_kept(ws);
  ws.reduced.rank = steps;
  return expand_kept(ws);
}

}  // namespace clutchwork

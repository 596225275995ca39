#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/run/fixed/boxes.hpp>
#include <clutchwork/run/fixed/torques.hpp>

/// Contacts that follow loads, over one step: docs/theory/fixed-steps.md (12)
namespace clutchwork::fixed {

/// Which bound a contact has: its static torque, its kinetic one, that for good; none, where a gear jams.
enum Box : int { at_rest, sliding, slips_on, stops };

/// Below this a pivot of contacts that follow loads is not positive.
inline constexpr real least_pivot = 1e-6;

/// The impulses of loads without those of contacts, where the changes without them are known.
inline void see_free_loads(Run& ws, real h) {
  const auto& sys = ws.sys;
  Fixed<real>& f = ws.fixed;
  const int nv = int(sys.speeds), np = int(sys.prescribed);
  for (int l = 0; l < sys.loads; ++l) {
    real sum = dot(nv, f.load_by_speed + l * nv, f.change);
    if (np > 0) sum += dot(np, f.load_by_given + l * np, f.given_change);
    real size = abs(sum);
    for (int d = 0; d < ws.n_directions; ++d) {
      if (!is_smooth(ws, d)) continue;
      const real rate = load_rate(sys, l, d);
      if (rate == 0) continue;
      const real middle = f.start_rate[d] + 0.5 * (f.rate_change[d] + f.gained[d]);
      const real impulse = h * rate * (f.force[d] + f.kept[d] * middle);
      sum -= impulse, size += abs(impulse);
    }
    f.load_free[l] = sum, f.load_size[l] = size;
  }
}

/// Impulse of load l.
inline real load_impulse(const Run& ws, int l) {
  const int nc = int(ws.sys.contacts);
  return ws.fixed.load_free[l] + dot(nc, ws.fixed.load_reach + l * nc, ws.fixed.impulse);
}

/// How large the parts are that make it: what round-off is measured by.
inline real load_scale(const Run& ws, int l) {
  const int nc = int(ws.sys.contacts);
  real size = ws.fixed.load_size[l];
  for (int c = 0; c < nc; ++c) size += abs(ws.fixed.load_reach[l * nc + c] * ws.fixed.impulse[c]);
  return size;
}

/// What the contacts that follow loads can hold in this step, over their loads.
inline void see_bounds_of_loads(Run& ws) {
  for (int k = 0; k < ws.fixed.plan.n_unsteady; ++k) {
    const int l = ws.fixed.plan.unsteady[k], c = int(ws.sys.load_contact[l]), mode = ws.contact.mode[c];
    const real slip = ws.fixed.predicted[ws.sys.elements + c];
    see_bound(ws, l, mode == locked || mode == open ? 0.0 : larger(mode * slip, 0.0));
  }
}

/// The same of load l against slip in a direction.
inline const Bound<real>& bound_at(const Run& ws, int l, int direction) {
  return ws.fixed.load_bound[2 * l + (direction > 0)];
}

/// The impulse that the contact of load l can give against slip, where that has the impulse `load`.
inline real most_impulse(const Run& ws, int l, int direction, real load, real h) {
  return larger(h * bound_at(ws, l, direction).at(load / h), 0.0);
}

/// Whether a contact joins prescribed shafts alone.
CLUTCHWORK_INLINE bool joins_prescribed(const Run& ws, int c) { return ws.fixed.plan.n_rigid > 0 && is_rigid(ws, c); }

/// The bounds of a contact; one between prescribed shafts has its impulse whatever they are. What resists waits in
/// `kinetic` and `limit` as an impulse.
CLUTCHWORK_INLINE void set_bounds(Run& ws, int c, real ahead, real behind) {
  Fixed<real>& f = ws.fixed;
  if (!joins_prescribed(ws, c)) f.lower[c] = -ahead, f.upper[c] = behind;
  f.kinetic[2 * c + 1] = f.limit[2 * c + 1] = ahead, f.kinetic[2 * c] = f.limit[2 * c] = behind;
}
/// These as torques.
inline void share_over_step(Run& ws, real h) {
  for (int l = 0; l < ws.sys.loads; ++l) {
    const int c = int(ws.sys.load_contact[l]);
    for (int way = 0; way < 2; ++way) ws.fixed.kinetic[2 * c + way] = ws.fixed.limit[2 * c + way] /= h;
  }
}

/// What the contacts that slip can give with the loads of their last torques; those at rest have no bounds yet.
inline void begin_loads(Run& ws, real h) {
  Fixed<real>& f = ws.fixed;
  const int ne = int(ws.sys.elements), nc = int(ws.sys.contacts);
  for (int c = 0; ws.sys.loads > 0 && c < nc; ++c) f.impulse[c] = h * f.torque[ne + c];
  for (int l = 0; l < ws.sys.loads; ++l) {
    const int c = int(ws.sys.load_contact[l]), mode = ws.contact.mode[c];
    const real load = load_impulse(ws, l);
    for (int way = 0; way < 2; ++way) f.load_line[2 * l + way] = bound_at(ws, l, 2 * way - 1).line_at(load / h);
    if (mode == locked || mode == open) {
      set_bounds(ws, c, infinity, infinity);
    } else {
      set_bounds(ws, c, most_impulse(ws, l, forward, load, h), most_impulse(ws, l, backward, load, h));
    }
  }
}

/// Bounds of the only load where all contacts slip, each at one of its bounds as it did: with the line that its load
/// is on, in closed form. False: neither line has it, or not all of them do. docs/theory/fixed-steps.md (13)
inline bool slip_with_load(Run& ws, real h) {
  Fixed<real>& f = ws.fixed;
  const int nc = int(ws.sys.contacts), own = int(ws.sys.load_contact[0]), mode = ws.contact.mode[own];
  if (ws.sys.loads != 1 || f.plan.n_rigid > 0) return false;
  real base = f.load_free[0];
  for (int c = 0; c < nc; ++c) {
    const int other = ws.contact.mode[c];
    if (other == locked || other == open) return false;
    f.impulse[c] = other == forward ? f.lower[c] : f.upper[c];
    if (c == own) continue;
    if (!(abs(f.impulse[c]) < infinity)) return false;
    base += f.load_reach[c] * f.impulse[c];
  }
  const Bound<real>& bound = bound_at(ws, 0, mode);
  const real reach = f.load_reach[own], per_h = 1 / h;
  for (int line = 0; line < 2; ++line) {
    const real pivot = 1 + mode * bound.slope[line] * reach;
    const real size = bound.slope[line] * base + h * bound.offset[line];
    if (!(pivot > least_pivot) || !(size >= 0)) continue;
    const real load = base - mode * reach * size / pivot;
    if (bound.line_at(load * per_h) != line) continue;
    f.impulse[own] = -mode * size / pivot;
    set_bounds(ws, own, most_impulse(ws, 0, forward, load, h), most_impulse(ws, 0, backward, load, h));
    (mode == forward ? f.lower[own] : f.upper[own]) = f.impulse[own];
    f.load_line[0] = bound_at(ws, 0, backward).line_at(load * per_h);
    f.load_line[1] = bound_at(ws, 0, forward).line_at(load * per_h);
    return true;
  }
  return false;
}

/// The bound at which a contact is, -1 below, 1 above; 0: none. What prescribed speeds drive is at one that resists.
inline int bound_side(const Run& ws, int c, real tolerance) {
  if (!joins_prescribed(ws, c)) return ws.fixed.side[c];
  const real slip = ws.fixed.end_slip[c];
  return abs(slip) <= tolerance ? 0 : slip > 0 ? -1 : 1;
}

/// How the free contacts and with them load l answer to a unit impulse of contact `from`.
inline real answered(const Run& ws, const Boxes& p, int l, int from, int m) {
  const real* reach = ws.fixed.load_reach + l * p.n;
  real sum = reach[from];
  for (int a = 0; a < m; ++a) sum += reach[p.list[a]] * real(p.solved[a]);
  return sum;
}

/// All bounds at the loads of the solution; lists the contacts at one, in `follower`, and returns how many. Whether the
/// solution is another one with them: `moves`.
inline int see_bounds(Run& ws, real h, real tolerance, bool& moves) {
  Fixed<real>& f = ws.fixed;
  int n = 0;
  moves = false, f.load_miss = 0;
  for (int l = 0; l < ws.sys.loads; ++l) {
    const int c = int(ws.sys.load_contact[l]), side = bound_side(ws, c, tolerance);
    const real load = f.load_now[l] = load_impulse(ws, l), x = f.impulse[c], size = abs(x) + load_scale(ws, l);
    if (f.box[c] == stops) continue;
    const real ahead = most_impulse(ws, l, forward, load, h), behind = most_impulse(ws, l, backward, load, h);
    set_bounds(ws, c, ahead, behind);
    const real wanted = side == 0 ? larger(smaller(x, behind), -ahead) : side < 0 ? -ahead : behind;
    moves = moves || abs(wanted - x) > (side == 0 ? real(1e-12) : real(1e-13)) * size;
    if (size > 0) f.load_miss = larger(f.load_miss, abs(wanted - x) / size);
    if (side != 0) f.follower[n++] = l;
  }
  return n;
}

/// The system of the n contacts at a bound, each with its line at its load, or with that of the round before: what
/// their impulses change of what each is off.
inline void couple_bounds(Run& ws, const Boxes& p, real h, real tolerance, int n, bool last_lines) {
  Fixed<real>& f = ws.fixed;
  int m = 0;
  for (int c = 0; c < p.n; ++c) m += f.side[c] == 0;
  for (int b = 0; b < n; ++b) {
    const int from = int(ws.sys.load_contact[f.follower[b]]);
    for (int a = 0; a < m; ++a) p.solved[a] = p.mobility[p.list[a] * p.n + from];
    solve_free(p, m);
    for (int a = 0; a < n; ++a) {
      const int l = f.follower[a], c = int(ws.sys.load_contact[l]), side = bound_side(ws, c, tolerance);
      const Bound<real>& bound = bound_at(ws, l, -side);
      const real load = f.load_now[l] / h;
      const int line = last_lines ? f.load_line[2 * l + (side < 0)] : bound.line_at(load);
      f.load_matrix[a * n + b] = real(a == b ? 1 : 0) - side * bound.slope[line] * answered(ws, p, l, from, m);
      f.load_off[a] = side * h * bound.on(line, load) - f.impulse[c];
    }
  }
}

/// Solve it in place, in the order of the contacts. How many of them are left out, whose friction would grow with what
/// it drives: their pivots are not positive, and their places in `follower` are negative.
/// docs/theory/load-dependent.md, rule 4
inline int solve_bounds(Fixed<real>& f, int n) {
  real *m = f.load_matrix, *x = f.load_off;
  int out = 0;
  for (int k = 0; k < n; ++k) {
    if (!(m[k * n + k] > least_pivot)) {
      ++out, x[k] = 0, f.follower[k] = -1 - f.follower[k];
      for (int j = 0; j < n; ++j) m[k * n + j] = m[j * n + k] = 0;
      m[k * n + k] = 1;
    }
    for (int i = k + 1; i < n; ++i) {
      const real share = m[i * n + k] / m[k * n + k];
      for (int j = k; j < n; ++j) m[i * n + j] -= share * m[k * n + j];
      x[i] -= share * x[k];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) x[k] -= m[k * n + j] * x[j];
    x[k] /= m[k * n + k];
  }
  return out;
}

/// The bound of the contact of a load that solves its system; a gear that was left out stops for this step.
inline void take_bound(Run& ws, int a, real tolerance) {
  Fixed<real>& f = ws.fixed;
  const bool jams = f.follower[a] < 0;
  const int c = int(ws.sys.load_contact[jams ? -1 - f.follower[a] : f.follower[a]]);
  if (jams) {
    f.box[c] = stops, f.side[c] = 0;
    return set_bounds(ws, c, infinity, infinity);
  }
  const int side = bound_side(ws, c, tolerance);
  const real size = larger(side * (f.impulse[c] + f.load_off[a]), 0.0);
  if (joins_prescribed(ws, c)) f.lower[c] = f.upper[c] = side * size;
  if (side < 0)
    f.lower[c] = -size, f.kinetic[2 * c + 1] = f.limit[2 * c + 1] = size;
  else
    f.upper[c] = size, f.kinetic[2 * c] = f.limit[2 * c] = size;
}

/// The bounds of contacts that follow loads at the loads of the solution: exactly where these are at a bound, as long
/// as no contact goes to another one. Whether the solution is another one with them. docs/theory/fixed-steps.md, rule 6
inline bool follow_loads(Run& ws, const Boxes& p, real h, real tolerance) {
  Fixed<real>& f = ws.fixed;
  bool moves = false;
  const int n = see_bounds(ws, h, tolerance, moves);
  if (!moves) return false;
  couple_bounds(ws, p, h, tolerance, n, false);
  if (solve_bounds(f, n) > 0) {
    // a solution that has gone beyond a change of line goes back to the line before
    for (int a = 0; a < n; ++a) f.follower[a] = f.follower[a] < 0 ? -1 - f.follower[a] : f.follower[a];
    couple_bounds(ws, p, h, tolerance, n, true);
    solve_bounds(f, n);
  }
  for (int l = 0; l < ws.sys.loads; ++l) {
    const real load = f.load_now[l] / h;
    for (int way = 0; way < 2; ++way) f.load_line[2 * l + way] = bound_at(ws, l, 2 * way - 1).line_at(load);
  }
  for (int a = 0; a < n; ++a) take_bound(ws, a, tolerance);
  return true;
}

}  // namespace clutchwork::fixed

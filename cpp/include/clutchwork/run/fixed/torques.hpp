#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/run/fixed/prepare.hpp>
#include <clutchwork/run/settle.hpp>

/// Torques of elements and of laws that never stick, in the middle of a step: docs/theory/fixed-steps.md
namespace clutchwork::fixed {

/// Part of a step at which a state is taken whose own rate is z over the step: a half where it is slow, so that energy
/// is kept, and as much more as an exponential needs. docs/theory/fixed-steps.md (10)
inline real share_of(real z) {
  if constexpr (NumberOf<real>::single) {
    // the first terms, where what follows loses all that it has
    if (z > -0.3) return z < 0 ? 0.5 - z / 12 + z * z * z / 720 : real(0.5);
  }
  if (!(z < -1e-3)) return 0.5;
  return z < -40 ? 1 + 1 / z : 1 / z + 1 / (1 - exp(z));
}

/// The piece of a branch at the rates of its ways.
inline void settle_piece(Run& ws, Branch<real>& b, const real* rate) {
  const int d = b.direction, edges = edge_count(ws, d);
  if (edges > 0) ws.piece[d] += piece_of(ws, d, rate[0]) - ws.piece[d] % (edges + 1);
  b.piece = ws.piece[d];
  ws.piece[d] = b.piece = settled_piece(ws, b, rate);
}

/// An element of several ways: each torque with its slope by its own rate, the states by their rates in the middle.
inline void see_ways(Run& ws, Branch<real>& b, real h) {
  Fixed<real>& f = ws.fixed;
  using S = Dual<real, most_ways>;
  const real* rate = f.predicted + b.direction;
  if (f.bends[b.direction] == settling) settle_piece(ws, b, rate);
  S rates[most_ways], own[most_own_states], state_rates[most_own_states], input[most_inputs], torque[most_ways];
  for (int i = 0; i < b.ways; ++i) rates[i] = S::variable(rate[i], i);
  for (int i = 0; i < b.states; ++i) own[i] = S(f.state_ahead[b.state + i]);
  for (int i = 0; i < b.inputs; ++i) input[i] = S(b.input[i]);
  element_torques(ws, b, rates, own, input, state_rates, torque);
  for (int i = 0; i < b.ways; ++i)
    f.force[b.direction + i] = torque[i].v, f.slope[b.direction + i] = smaller(torque[i].d[i], 0.0);
  for (int i = 0; i < b.states; ++i) {
    const int s = b.state + i;
    f.state_force[s] = ws.state[s] + h * state_rates[i].v, f.state_slope[s] = 0, f.state_share[s] = 1;
  }
}

/// The n own states of a branch in the middle: fixed part and slope by the rate, in state_force and state_slope.
CLUTCHWORK_INLINE void eliminate_states(Run& ws, const Branch<real>& b, real h, const int n) {
  Fixed<real>& f = ws.fixed;
  const Jacobian<real>& j = ws.jacobian;
  const real* block = j.g_state + j.block[b.direction];
  real fastest = 0, matrix[most_own_states * most_own_states];
  for (int i = 0; i < n; ++i) fastest = smaller(fastest, block[i * n + i]);
  const real share = share_of(h * fastest);
  // what grows by itself is taken explicitly
  for (int i = 0; i < n * n; ++i) matrix[i] = i % (n + 1) == 0 && block[i] > 0 ? 0 : -share * h * block[i];
  for (int i = 0; i < n; ++i) matrix[i * n + i] += 1;
  int pivot[most_own_states];
  // a singular block is taken explicitly
  if (!invert(n, matrix, pivot)) {
    for (int i = 0; i < n * n; ++i) matrix[i] = i % (n + 1) == 0;
  }
  real fixed[most_own_states], slope[most_own_states];
  for (int i = 0; i < n; ++i) {
    const int s = b.state + i;
    fixed[i] = ws.state[s] - f.state_ahead[s] + share * h * ws.observed.state_rates[s];
    slope[i] = share * h * j.g_rate[s];
  }
  for (int i = 0; i < n; ++i) {
    const int s = b.state + i;
    f.state_force[s] = f.state_ahead[s] + dot(n, matrix + i * n, fixed),
    f.state_slope[s] = dot(n, matrix + i * n, slope);
    f.state_share[s] = share;
  }
}

/// Torque over the rate in the middle: force + slope rate. docs/theory/fixed-steps.md (4)
inline void see_branch(Run& ws, Branch<real>& b, real h) {
  Fixed<real>& f = ws.fixed;
  const int d = b.direction;
  if (b.ways > 1) return see_ways(ws, b, h);
  const real rate = f.predicted[d];
  if (f.bends[d] == settling) settle_piece(ws, b, &rate);
  const Partial<real> p =
      branch_partial(ws, b, rate, real(0), f.state_ahead, ws.observed.state_rates, state_partials(ws, d));
  real torque = p.torque, slope = p.by_rate;
  if (b.states > 0) {
    // mostly it is one, for which no loop is left
    b.states == 1 ? eliminate_states(ws, b, h, 1) : eliminate_states(ws, b, h, b.states);
    for (int i = 0; i < b.states; ++i) {
      const int s = b.state + i;
      // the middle of the state from where it is taken
      const real half = 0.5 / f.state_share[s];
      const real middle = ws.state[s] + half * (f.state_force[s] - ws.state[s]);
      torque += ws.jacobian.f_state[s] * (middle - f.state_ahead[s]);
      slope += ws.jacobian.f_state[s] * half * f.state_slope[s];
    }
  }
  f.force[d] = torque, f.slope[d] = smaller(slope, 0.0);
}

/// Whether the matrix has the slopes of the torques well enough: states exactly, so that their energy is kept.
inline bool is_kept(const Run& ws, const Branch<real>& b, real h) {
  const Fixed<real>& f = ws.fixed;
  const int d = b.direction;
  const real off = abs(f.slope[d] - f.kept[d]);
  if (b.states > 0 && b.ways == 1) return off <= roundoff<real>(1e-14, 5e-6) * abs(f.slope[d]);
  // a speed without inertia goes where its slopes are
  if (f.massless[d] != 0) return off <= 1e-3 * abs(f.slope[d]);
  return 0.5 * h * off * ws.geometry.own[d] <= 0.02;
}

/// Whether a direction has a torque that is a function of its rate and states.
inline bool is_smooth(const Run& ws, int d) { return ws.fixed.plan.smooth[d] != 0; }

/// Torques that are linear: their part without the rate, and the slope over it for steps of another length. Whether the
/// matrix has these.
inline bool see_lines(Run& ws, real h) {
  Fixed<real>& f = ws.fixed;
  const bool other_length = f.length != h;
  bool kept = true;
  for (int k = 0; k < f.plan.n_linear; ++k) {
    const int d = f.plan.linear[k];
    const Line<real>& line = f.plan.line[d];
    const Branch<real>& b = ws.branch[d];
    real torque = line.offset;
    if (b.inputs > 0) torque = branch_torque_once(ws, b, real(0), ws.state, ws.observed.state_rates);
    if (b.inputs == 0 && b.states > 0) torque += line.by_state * ws.state[b.state];
    f.force[d] = torque;
    if (!other_length) continue;
    f.slope[d] = line.by_rate + 0.5 * h * line.by_state * line.state_by_rate;
    // nothing else accounts for the rate
    kept = kept && f.slope[d] == f.kept[d];
  }
  return kept;
}

/// The matrix gets the slopes that torques have now where it has not kept them. False: it is not positive definite.
inline bool make_matrix(Run& ws, real h, bool kept) {
  Fixed<real>& f = ws.fixed;
  for (int d = 0; !kept && d < ws.n_directions; ++d) f.kept[d] = is_smooth(ws, d) ? f.slope[d] : 0;
  return factor_step(ws, h);
}

/// All of them; the matrix follows where they have changed. False: it is not positive definite.
inline bool see_torques(Run& ws, real h) {
  Fixed<real>& f = ws.fixed;
  const FixedPlan<real>& plan = f.plan;
  bool kept = see_lines(ws, h);
  for (int k = 0; k < plan.n_bent; ++k) {
    const int d = plan.bent[k];
    // the first way has seen the others
    if (ws.branch[d].ways > 0) see_branch(ws, ws.branch[d], h);
    kept = kept && is_kept(ws, ws.branch[d], h);
  }
  if (!(kept && f.length == h) && !make_matrix(ws, h, kept)) return false;
  for (int k = 0; k < plan.n_bent; ++k) {
    const int d = plan.bent[k];
    f.force[d] -= f.kept[d] * f.predicted[d];
  }
  return true;
}

/// The states at the end, for the rates that were found.
inline void end_states(Run& ws, real h) {
  Fixed<real>& f = ws.fixed;
  auto middle = [&](int d) { return f.start_rate[d] + 0.5 * f.rate_change[d]; };
  for (int k = 0; k < f.plan.n_linear; ++k) {
    const int d = f.plan.linear[k];
    const Branch<real>& b = ws.branch[d];
    if (b.states > 0) f.state_change[b.state] = h * f.plan.line[d].state_by_rate * middle(d);
  }
  for (int k = 0; k < f.plan.n_bent; ++k) {
    const int d = f.plan.bent[k];
    const Branch<real>& b = ws.branch[d];
    const real off = middle(d) - f.predicted[d];
    for (int s = b.state; s < b.state + b.states; ++s)
      f.state_change[s] = (f.state_force[s] + f.state_slope[s] * off - ws.state[s]) / f.state_share[s];
  }
}

}  // namespace clutchwork::fixed

#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/full.hpp>
#include <clutchwork/motion/mesh_loads.hpp>
#include <clutchwork/motion/reduce.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/workspace.hpp>

/// The smooth motion inside a mode: torques, derivatives, multipliers. y = (z, states).
namespace clutchwork {

/// d := (sum of row' torque, state rates) at (t, y). The first part is M dz/dt.
template <class Form, class T = typename Form::Scalar>
CLUTCHWORK_HOT void evaluate_inline(Form& form, Real<T> t, const T* y, T* d) {
  Workspace<T>& ws = form.ws;
  if constexpr (Form::full) return evaluate_whole(form, t, y, d, ws.full.plain.rate, ws.full.plain.torque);
  const int nz = form.nz(), n = form.n();
  inputs_with(ws, t, y + nz);
  for (int i = 0; i < n; ++i) d[i] = T(0);
  if constexpr (!Form::small) {
    if (ws.sys.shared > 0) {
      for (int k = 0; k < ws.n_branches; ++k) {
        ws.shared.stage_rate[k] = form.rate(k, y) + offset_rate(ws, k);
        ws.shared.stage_torque[k] = branch_torque(ws, ws.branch[k], ws.shared.stage_rate[k], y + nz, d + nz);
        form.push(k, ws.shared.stage_torque[k], d);
      }
      return shared_rates(ws, ws.shared.stage_rate, ws.shared.stage_torque, y + nz, d + nz);
    }
  }
  for (int k = 0; k < ws.n_branches; ++k) {
    const T rate = form.rate(k, y) + offset_rate(ws, k);
    form.push(k, branch_torque(ws, ws.branch[k], rate, y + nz, d + nz), d);
  }
}

template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] void evaluate(Form& form, Real<T> t, const T* y, T* d) {
  evaluate_inline(form, t, y, d);
}

/// As evaluate, keeping rates and torques of the branches in ws.observed, for output and guards.
template <class Form, class T = typename Form::Scalar>
void observe(Form& form, double t, const T* y, T* d) {
  Workspace<T>& ws = form.ws;
  T *rate = ws.observed.rate, *torque = ws.observed.torque;
  if constexpr (Form::full) return evaluate_whole(form, t, y, d, rate, torque);
  const int nz = form.nz(), n = form.n();
  inputs_with(ws, t, y + nz);
  for (int i = 0; i < n; ++i) d[i] = T(0);
  for (int k = 0; k < ws.n_branches; ++k) {
    rate[k] = form.rate(k, y) + offset_rate(ws, k);
    torque[k] = branch_torque_once(ws, ws.branch[k], rate[k], y + nz, d + nz);
    form.push(k, torque[k], d);
  }
}

/// evaluate plus all partial derivatives; dt := derivative of d by time.
template <class Form, class T = typename Form::Scalar>
CLUTCHWORK_HOT void linearize(Form& form, Real<T> t, const T* y, T* d, T* dt, StepEnd<T>& edge) {
  Workspace<T>& ws = form.ws;
  if constexpr (Form::full) return linearize_whole(form, t, y, d, dt, edge);
  const int nz = form.nz(), n = form.n();
  inputs_with(ws, t, y + nz);
  input_slopes_at(ws, t);
  for (int i = 0; i < n; ++i) d[i] = T(0);
  for (int i = 0; i < n; ++i) dt[i] = T(0);
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<T>& b = ws.branch[k];
    edge.rate[k] = form.rate(k, y) + offset_rate(ws, k);
    const StatePartials<T> out = state_partials(ws, k);
    const Partial<T> p = branch_partial(ws, b, edge.rate[k], offset_slope(ws, k), y + nz, d + nz, out);
    ws.jacobian.partial[k] = p;
    form.push(k, p.torque, d);
    // a lane without it adds zeros
    if (counts(p.by_time)) form.push(k, p.by_time, dt);
    for (int s = 0; s < b.states; ++s) dt[nz + b.state + s] = out.g_time[s];
  }
  for (int k = ws.n_branches; k < ws.n_rates; ++k) edge.rate[k] = form.rate(k, y) + offset_rate(ws, k);
  if constexpr (!Form::small) {
    if (ws.sys.shared > 0) linearize_shared(ws, edge.rate, y + nz, d + nz, dt + nz);
  }
  ++ws.statistics.jacobians;
}

/// Slopes of the rates along the motion: edge.slope, from dz/dt.
template <class Form, class T = typename Form::Scalar>
CLUTCHWORK_HOT void slopes(Form& form, const T* velocity, StepEnd<T>& edge) {
  Workspace<T>& ws = form.ws;
  for (int k = 0; k < ws.n_rates; ++k) edge.slope[k] = form.rate(k, velocity) + offset_slope(ws, k);
}

/// All inputs at (t, y), the rates among them.
template <class Form, class T = typename Form::Scalar>
CLUTCHWORK_HOT void inputs_of(Form& form, Real<T> t, const T* y) {
  if constexpr (Form::full) return full_inputs(form, t, y);
  inputs_with(form.ws, t, y + form.nz());
}

/// Torques of many locked contacts for given branch torques: free acceleration, then one solve with the factor of their
/// mobility.
template <class T>
void sparse_multipliers(const Workspace<T>& ws, const T* torque, int np, T* out) {
  const auto& sys = ws.sys;
  const int m = ws.held.n_fixed, nv = int(sys.speeds), ne = int(sys.elements);
  T *q = ws.held.motion, *b = ws.held.rhs;
  for (int i = 0; i < nv; ++i) q[i] = T(0);
  for (int k = 0; k < ws.n_branches; ++k) {
    ws.geometry.mass_weighted.add(ws.branch[k].direction, torque[k], q);
  }
  // those of varying directions are known
  for (int a = m; a < ws.held.n; ++a) ws.geometry.mass_weighted.add(ne + ws.held.contact[a], out[a], q);
  for (int p = 0; p < np; ++p) axpy(nv, -ws.in.prescribed_slope[p], ws.geometry.prescribed_momentum + p * nv, q);
  for (int a = 0; a < m; ++a) {
    const int d = ne + ws.held.contact[a];
    b[a] = T(0) - ws.geometry.mass_weighted.times(d, q);
    // between prescribed speeds no torque holds
    for (int p = 0; p < np && !is_rigid(ws, ws.held.contact[a]); ++p)
      b[a] -= prescribed_share(ws, d, p) * ws.in.prescribed_slope[p];
  }
  solve_locked(ws, b, out);
}

/// Torques of the locked contacts for given branch torques; `moving`: with the prescribed accelerations.
template <class T>
CLUTCHWORK_HOT void multipliers(const Workspace<T>& ws, const T* torque, bool moving, T* out) {
  const auto& sys = ws.sys;
  const int m = ws.held.n, nb = ws.n_branches, np = moving ? int(sys.prescribed) : 0;
  if (ws.held.mapped) {
    for (int a = 0; a < m; ++a) {
      out[a] = dot(nb, ws.held.reach + a * nb, torque);
      for (int p = 0; p < np; ++p)
        out[a] += ws.held.reach_prescribed[a * sys.prescribed + p] * ws.in.prescribed_slope[p];
    }
    return;
  }
  if constexpr (!has_lanes<T>) sparse_multipliers(ws, torque, np, out);
}

/// Size of the time derivative of a capacity, which follows the load.
template <class T>
T capacity_swing(const Workspace<T>& ws, int c, T capacity) {
  const T load = load_of(ws, c);
  return choose(
      value(load) > 0 && value(capacity) < infinity, [&] { return abs(capacity * load_slope(ws, c) / load); },
      [] { return T(0); });
}

/// Torques of the branches and their drift at the point that was linearized last, at y, where the speeds change with
/// `velocity`.
template <class Form, class T = typename Form::Scalar>
CLUTCHWORK_HOT void drift_torques(Form& form, const T* y, const T* velocity, const T* d, const StepEnd<T>& edge) {
  Workspace<T>& ws = form.ws;
  T *drift = ws.observed.drift, *torque = ws.observed.torque;
  const T* states = d + form.nz();
  if constexpr (Form::full) return drift_whole(form, y, velocity, states, torque, drift);
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<T>& b = ws.branch[k];
    const Partial<T>& p = ws.jacobian.partial[k];
    torque[k] = p.torque;
    drift[k] = p.by_rate * (edge.slope[k] - offset_slope(ws, k)) + p.by_time;
    for (int s = 0; s < b.states; ++s) drift[k] += ws.jacobian.f_state[b.state + s] * states[b.state + s];
    if constexpr (!Form::small) {
      const int nx = int(ws.sys.shared);
      for (int j = 0; j < nx; ++j) drift[k] += ws.jacobian.torque_by[k * nx + j] * states[ws.sys.states - nx + j];
    }
  }
}

/// Loads, how fast they change, and how far from their ends the lines are with which contacts slip that follow them.
template <class T>
[[gnu::noinline]] void sense_loads(Workspace<T>& ws, StepEnd<T>& edge) {
  const Dual<T, 1>* held = ws.ratios.drift.held;
  loads_of(ws, ws.observed.torque, true, ws.loads.now, [&](int c) { return held[c].v; });
  loads_of(ws, ws.observed.drift, false, ws.loads.drift, [&](int c) { return held[c].d[0]; });
  for (int l = 0; l < ws.sys.loads; ++l) edge.load[l] = ws.loads.now[l], edge.load_drift[l] = ws.loads.drift[l];
  for (int i = 0; i < ws.loads.n_sliding; ++i) {
    const int l = ws.loads.sliding[i];
    T by_load = T(0);
    edge.clearance[l] = line_clearance(ws, l, edge.rate[ws.loads.branch[i]], by_load);
    edge.closing[l] = by_load * ws.loads.drift[l];
  }
}

/// Size of the time derivative of the capacity of a contact that follows a load.
template <class T>
T load_swing(const Workspace<T>& ws, int c, T torque) {
  const int l = ws.loads.of[c];
  const Bound<T> bound = bound_of(ws, c, value(torque) > 0 ? backward : forward, T(0), 0);
  return abs(bound.slope[bound.line_at(ws.loads.now[l])] * ws.loads.drift[l]);
}

/// The most that a change of its load does to the capacity of such a contact.
template <class T>
T load_share(const Workspace<T>& ws, int c) {
  T most = T(0);
  for (int way = backward; way <= forward; way += forward - backward) {
    const Bound<T> bound = bound_of(ws, c, way, T(0), 0);
    most = larger(most, larger(abs(bound.slope[0]), abs(bound.slope[1])));
  }
  return most;
}

/// Multipliers of the locked contacts, their drift and their capacities there.
template <class Form, class T = typename Form::Scalar>
CLUTCHWORK_HOT void sense(Form& form, const T* y, const T* velocity, const T* d, StepEnd<T>& edge) {
  Workspace<T>& ws = form.ws;
  const int m = ws.held.n;
  if constexpr (Form::full) {
    full_drifts(form, d, edge);
    if (m == 0 && ws.loads.n_sliding == 0) return;
  } else {
    if (m == 0) return;
  }
  drift_torques(form, y, velocity, d, edge);
  if constexpr (Form::full) sense_loads(ws, edge);
  T size = T(0);
  for (int k = 0; k < ws.n_branches; ++k) size += abs(ws.observed.torque[k]);
  if constexpr (Form::full) {
    varying_multipliers(ws, ws.ratios.drift, edge.multiplier, [](const auto& x) { return x.v; });
    varying_multipliers(ws, ws.ratios.drift, edge.drift, [](const auto& x) { return x.d[0]; });
  }
  multipliers(ws, ws.observed.torque, true, edge.multiplier);
  multipliers(ws, ws.observed.drift, false, edge.drift);
  for (int a = 0; a < m; ++a) {
    edge.noise[a] = T(1e-12) * size;
    const int c = ws.held.contact[a];
    edge.capacity[a] = capacity_left(ws, c, edge.multiplier[a]);
    edge.swing[a] =
        choose(load_bends(ws, c), [&] { return capacity_swing(ws, c, most_capacity(ws, c)); }, [] { return T(0); });
    if constexpr (Form::full) {
      if (ws.loads.of[c] >= 0) {
        edge.swing[a] = larger(load_swing(ws, c, T(1)), load_swing(ws, c, T(-1)));
        // round-off of its load, twice what a decision concedes, for one that holds less than that
        const T more = edge.noise[a] * T(4) * (T(1) + load_share(ws, c));
        if (ws.held.in_set[a] == 0 && value(edge.capacity[a]) < value(more)) edge.noise[a] = more;
      }
    }
  }
  if constexpr (!has_lanes<T>) {
    for (int k = 0; k < ws.held.n_sets; ++k) [[unlikely]]
      edge.room[k] = set_room(ws, k, edge.multiplier, edge.noise[0], edge.load);
  }
}

/// Room of the dependent sets were the torques of their independent contacts to drift on for a time.
template <class T>
double room_ahead(Workspace<T>& ws, int k, const StepEnd<T>& edge, double time) {
  T* carried = ws.held.carried;
  for (int a = 0; a < ws.held.n; ++a) carried[a] = edge.multiplier[a] + T(time) * edge.drift[a];
  for (int l = 0; l < ws.sys.loads; ++l) ws.loads.drift[l] = edge.load[l] + T(time) * edge.load_drift[l];
  return value(set_room(ws, k, carried, edge.noise[0], ws.loads.drift));
}

/// v = Z z + Y u.
template <class Form, class T = typename Form::Scalar>
void expand(Form& form, const T* z, T* v, bool offset = true) {
  Workspace<T>& ws = form.ws;
  const int nv = int(ws.sys.speeds), np = int(ws.sys.prescribed), nz = form.nz();
  for (int i = 0; i < nv; ++i) {
    T s = T(0);
    if constexpr (Form::small) {
      for (int j = 0; j < nz; ++j) s += ws.reduced.z_basis[i * nz + j] * z[j];
    } else {
      s = ws.rows.expansion.times(i, z);
    }
    for (int p = 0; p < np && offset; ++p) s += ws.reduced.y_basis[i * np + p] * ws.in.prescribed[p];
    v[i] = s;
  }
}

/// Size of what makes the rate of branch k, from the sizes of the speeds.
template <class T>
CLUTCHWORK_HOT Real<T> rate_size(const Workspace<T>& ws, int k, const Real<T>* size) {
  const auto row = rate_row(ws.sys, ws.branch[k].direction);
  Real<T> sum = 0;
  for (int e = 0; e < row.n; ++e) sum += abs(value(row.value[e])) * size[row.column[e]];
  return sum;
}

/// Absolute tolerance of each own state: what counts as an error of the rate that bends it, over its span. The sizes of
/// the speeds are known. docs/theory/integrators.md
template <class Form, class T = typename Form::Scalar>
CLUTCHWORK_HOT void floor_states(Form& form, const T* y) {
  Workspace<T>& ws = form.ws;
  if constexpr (Form::full) return floor_whole(form, y);
  const Real<T> rtol = ws.options.rtol, atol = ws.options.atol;
  for (int i = 0; i < form.ns(); ++i) ws.reduced.floor[i] = atol;
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<T>& b = ws.branch[k];
    if (b.states == 0) continue;
    const Real<T> rate = atol + rtol * rate_size(ws, k, ws.reduced.size);
    for (int i = b.state; i < b.state + b.states; ++i)
      ws.reduced.floor[i] += ws.reduced.span[i] * abs(value(ws.jacobian.g_rate[i])) * rate;
  }
}

/// f(share, j) for each reduced speed j that speed i is made of.
template <class Form, class F, class T = typename Form::Scalar>
CLUTCHWORK_HOT void each_share(const Form& form, int i, F&& f) {
  if constexpr (Form::small) {
    for (int j = 0; j < form.nz(); ++j) f(value(form.ws.reduced.z_basis[i * form.nz() + j]), j);
  } else {
    const Compressed<T>& expansion = form.ws.rows.expansion;
    for (int e = expansion.first[i]; e < expansion.first[i + 1]; ++e) f(value(expansion.val[e]), expansion.col[e]);
  }
}

/// Weighted RMS norm of an error in (v, states), relative to the larger of two points; a speed counts as no slower than
/// a share of the fastest. The same in every form. docs/theory/integrators.md
template <class Form, class T = typename Form::Scalar>
CLUTCHWORK_HOT Real<T> error_norm(Form& form, const T* error, const T* a, const T* b) {
  // of the fastest speed
  constexpr double slow = 1e-3;
  const Workspace<T>& ws = form.ws;
  const Real<T> rtol = ws.options.rtol, atol = ws.options.atol;
  const int nv = int(ws.sys.speeds), nz = form.nz(), ns = form.ns();
  Real<T>*size = ws.reduced.size, *missed = ws.reduced.missed, fastest = 0, sum = 0;
  for (int i = 0; i < nv; ++i) {
    Real<T> e = 0, va = 0, vb = 0;
    each_share(form, i,
               [&](Real<T> z, int j) { e += z * value(error[j]), va += z * value(a[j]), vb += z * value(b[j]); });
    missed[i] = e;
    size[i] = larger(abs(va), abs(vb));
    fastest = larger(fastest, size[i]);
  }
  for (int i = 0; i < nv; ++i) {
    const Real<T> x = missed[i] / (atol + rtol * larger(size[i], Real<T>(slow) * fastest));
    sum += x * x;
  }
  if (ns > 0) floor_states(form, a);
  for (int i = 0; i < ns; ++i) {
    const Real<T> s = larger(abs(value(a[nz + i])), abs(value(b[nz + i])));
    const Real<T> x = value(error[nz + i]) / (ws.reduced.floor[i] + rtol * s);
    sum += x * x;
  }
  return nv + ns > 0 ? sqrt(sum / Real<T>(nv + ns)) : Real<T>(0);
}

}  // namespace clutchwork

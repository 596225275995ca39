#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/motion/form.hpp>
#include <clutchwork/motion/ratios.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/workspace.hpp>

/// The full form: the whole right-hand side as one function of any scalar, its Jacobian by dual numbers, dense LU. For
/// systems that are more than directions with a torque each. docs/theory/coupled.md
namespace clutchwork {

/// Rows as in the sparse form; a step is solved with the whole matrix.
template <class T>
struct FullForm : SparseForm<T> {
  static constexpr bool full = true;
  using SparseForm<T>::SparseForm, SparseForm<T>::ws, SparseForm<T>::nz, SparseForm<T>::n;

  /// LU factor of scale M - J.
  bool factor_whole(T scale) {
    const int count = n();
    T* a = ws.full.factor;
    for (int i = 0; i < count * count; ++i) a[i] = -ws.full.jacobian[i];
    const Compressed<T>& mass = ws.rows.mass;
    for (int i = 0; i < nz(); ++i) {
      for (int e = mass.first[i]; e < mass.first[i + 1]; ++e) {
        const T m = scale * mass.val[e];
        a[i * count + mass.col[e]] += m;
        if (mass.col[e] != i) a[mass.col[e] * count + i] += m;
      }
    }
    for (int i = nz(); i < count; ++i) a[i * count + i] += scale;
    return is_factored(count);
  }
  /// LU factor of -J in the rows of speeds without inertia; those of all others are of the unit matrix. A huge inertia
  /// in their place would be a pivot of the columns of speeds that have none.
  bool factor_held() {
    const int count = nz(), size = n();
    T* a = ws.full.factor;
    for (int i = 0; i < count; ++i) {
      const bool light = ws.rows.mass.first[i] == ws.rows.mass.first[i + 1];
      for (int j = 0; j < count; ++j) a[i * count + j] = light ? -ws.full.jacobian[i * size + j] : T(i == j ? 1 : 0);
    }
    return is_factored(count);
  }
  template <class X>
  void solve_whole(X* b, int count) const {
    const Full<T>& f = ws.full;
    for (int c = 0; c < count; ++c) {
      const X swap = b[c];
      b[c] = b[f.pivot[c]];
      b[f.pivot[c]] = swap;
    }
    auto less = [&](int k, X x) {
      for (int e = f.first[k]; e < f.first[k + 1]; ++e) add_times(-f.part[e], b[f.column[e]], x);
      return x;
    };
    for (int i = 0; i < count; ++i) b[i] = less(2 * i, b[i]);
    for (int i = count - 1; i >= 0; --i) b[i] = less(2 * i + 1, b[i]) * f.factor[i * count + i];
  }

 private:
  bool is_factored(int count) {
    if (!factor_lu(count, ws.full.factor, ws.full.pivot)) return false;
    pack(count);
    return true;
  }
  /// Most of a factor are zeros, and it is solved with several times.
  void pack(int count) {
    Full<T>& f = ws.full;
    int n = 0;
    auto take = [&](int k, const T* row, int from, int to) {
      f.first[k] = n;
      for (int j = from; j < to; ++j) {
        if (counts(row[j])) f.part[n] = row[j], f.column[n++] = j;
      }
    };
    for (int i = 0; i < count; ++i) {
      take(2 * i, f.factor + i * count, 0, i), take(2 * i + 1, f.factor + i * count, i + 1, count);
    }
    f.first[2 * count] = n;
  }
};

/// The inputs that are shared states.
template <class T, class S>
void whole_inputs(const FullForm<T>& form, const Whole<S>& e) {
  const Workspace<T>& ws = form.ws;
  const auto& sys = ws.sys;
  const S* shared = e.y + form.n() - sys.shared;
  for (int k = 0; k < ws.in.n_shared_refs; ++k) {
    const int ref = ws.in.shared_ref[k], j = sys.input_refs[ref] - int(sys.inputs);
    e.input[ref] = S(T(sys.shared_offset[j]));
    add_times(T(sys.shared_scale[j]), shared[j], e.input[ref]);
  }
}

/// The rates of the branches.
template <class T, class S>
void whole_rates(const FullForm<T>& form, const Whole<S>& e) {
  const Workspace<T>& ws = form.ws;
  const Compressed<T>& rows = ws.rows.rate;
  const int np = int(ws.sys.prescribed);
  const S* prescribed = e.input + ws.sys.n_input_refs;
  for (int k = 0; k < ws.n_branches; ++k) {
    S rate = S(T(0));
    for (int i = rows.first[k]; i < rows.first[k + 1]; ++i) add_times(rows.val[i], e.y[rows.col[i]], rate);
    for (int p = 0; p < np; ++p) add_times(ws.reduced.offset[k * np + p], prescribed[p], rate);
    e.rate[k] = rate;
  }
}

/// The inputs that are rates of elements.
template <class T, class S>
void whole_rate_inputs(const FullForm<T>& form, const Whole<S>& e) {
  const Workspace<T>& ws = form.ws;
  for (int i = 0; i < ws.in.n_rate_refs; ++i) {
    const int ref = ws.in.rate_ref[i];
    e.input[ref] = e.rate[ws.branch_of[element_behind(ws, ref)]];
  }
}

/// All inputs at (t, y), those included that are rates.
template <class T>
void full_inputs(FullForm<T>& form, Real<T> t, const T* y) {
  Workspace<T>& ws = form.ws;
  inputs_with(ws, t, y + form.nz());
  for (int i = 0; i < ws.in.n_rate_refs; ++i) {
    const int ref = ws.in.rate_ref[i], k = ws.branch_of[element_behind(ws, ref)];
    ws.in.u[ref] = form.rate(k, y) + offset_rate(ws, k);
  }
}

/// Time derivatives of the inputs that are rates, from slope(k) of branch k.
template <class T, class F>
void rate_slopes(Workspace<T>& ws, F&& slope) {
  for (int i = 0; i < ws.in.n_rate_refs; ++i) {
    const int ref = ws.in.rate_ref[i];
    ws.in.du[ref] = slope(ws.branch_of[element_behind(ws, ref)]);
  }
}

/// Time derivatives of the inputs that are no signals: of rates from their slopes, of shared states from their rates.
template <class T>
void full_drifts(FullForm<T>& form, const T* d, const StepEnd<T>& edge) {
  Workspace<T>& ws = form.ws;
  rate_slopes(ws, [&](int k) { return edge.slope[k]; });
  for (int i = 0; i < ws.in.n_shared_refs; ++i) {
    const int ref = ws.in.shared_ref[i], j = ws.sys.input_refs[ref] - int(ws.sys.inputs);
    ws.in.shared_slope[ref] = T(ws.sys.shared_scale[j]) * d[form.n() - ws.sys.shared + j];
  }
}

/// Torque of branch k with all its ways, and the rates of its states.
template <class T, class S>
void whole_torque(const FullForm<T>& form, const Whole<S>& e, int k) {
  const Workspace<T>& ws = form.ws;
  const Branch<T>& b = ws.branch[k];
  const S *own = e.y + form.nz() + b.state, *input = e.input + (b.input - ws.in.u);
  S* rates = e.d + form.nz() + b.state;
  if (b.law < 0) return element_torques(ws, b, e.rate + k, own, input, rates, e.torque + k);
  const S* law_input = e.input + (b.law_input - ws.in.u);
  // what follows a load is solved for with all torques
  if (b.follows) {
    e.torque[k] = S(T(0));
    return;
  }
  e.torque[k] = b.compliant ? bending_torque<most_own_states, T, S>(ws, b, e.rate[k], own, input, law_input, rates)
                            : sliding_torque<T, S>(ws, b, e.rate[k], input, law_input);
}

/// The system of the torques of contacts in slip that follow loads: each is a line over its load, and the loads are
/// sums of all torques, of which those of transmissions come later. docs/theory/load-dependent.md (8)
template <class T, class S>
void pose_loads(const FullForm<T>& form, const Whole<S>& e) {
  const Workspace<T>& ws = form.ws;
  const int m = ws.loads.n_sliding, nd = ws.n_directions, np = int(ws.sys.prescribed);
  for (int i = 0; i < m; ++i) {
    const int l = ws.loads.sliding[i], k = ws.loads.branch[i], line = ws.loads.line[l];
    const Branch<T>& b = ws.branch[k];
    const T *by_branch = ws.loads.by_branch + l * nd, sign = T(b.sign);
    const Bound<S> bound = contact_bound<T, S>(b.kind, b.params, S(sign) * e.rate[k], e.input + (b.input - ws.in.u),
                                               b.piece, points_of(ws), b.sign);
    S given = S(T(0));
    for (int j = 0; j < ws.n_branches; ++j) add_times(by_branch[j], e.torque[j], given);
    for (int p = 0; p < np; ++p)
      add_times(ws.loads.by_prescribed[l * np + p], slope_of_reference(ws, e, form.n(), int(ws.sys.n_input_refs) + p),
                given);
    const S slope = bound.slope[line] * S(sign);
    for (int j = 0; j < m; ++j) e.coupling[i * m + j] = slope * S(by_branch[ws.loads.branch[j]]) + S(T(i == j ? 1 : 0));
    e.followed[i] = -(slope * given + bound.offset[line] * S(sign));
    e.steepness[i] = slope;
  }
}

/// Torques of these contacts; those of all others are pushed.
template <class T, class S>
[[gnu::noinline]] void whole_loads(const FullForm<T>& form, const Whole<S>& e) {
  const Workspace<T>& ws = form.ws;
  const Compressed<T>& rows = ws.rows.rate;
  const int m = ws.loads.n_sliding;
  pose_loads(form, e);
  if (ws.ratios.n > 0) couple_loads(ws, e, form.nz());
  // a singular one gives no finite torque, which ends the run
  if (m > 1) {
    factor_lu(m, e.coupling, e.pivot);
    solve_lu(m, e.coupling, e.pivot, e.followed);
  } else {
    e.pivot[0] = 0;
    if (abs(value(e.coupling[0])) > 0) e.coupling[0] = S(T(1)) / e.coupling[0];
    e.followed[0] *= e.coupling[0];
  }
  for (int j = 0; j < m; ++j) {
    const int k = ws.loads.branch[j];
    e.torque[k] = e.followed[j];
    for (int i = rows.first[k]; i < rows.first[k + 1]; ++i) add_times(rows.val[i], e.torque[k], e.d[rows.col[i]]);
  }
}

/// Heats of the branches; the first way of an element has that of all.
template <class T, class S>
void whole_heats(const FullForm<T>& form, const Whole<S>& e) {
  const Workspace<T>& ws = form.ws;
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<T>& b = ws.branch[k];
    const S *own = e.y + form.nz() + b.state, *input = e.input + (b.input - ws.in.u);
    e.heat[k] = b.law >= 0    ? -e.torque[k] * e.rate[k]
                : b.ways == 0 ? S(T(0))
                              : element_heat(ws, b, e.rate + k, own, input, e.torque + k);
  }
}

/// A flow and a process at their inputs.
template <class T, class S>
S whole_flow(const FullForm<T>& form, const Whole<S>& e, int f) {
  const auto& sys = form.ws.sys;
  return visit_flow(sys.flow_kind[f], [&](auto tag) {
    using E = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(form.ws.params + sys.flow_param[f]);
    return E::flow(p, flow_at<T, S>(form.ws, f, e.input + sys.flow_input[f]));
  });
}
template <class T, class S>
void whole_process(const FullForm<T>& form, const Whole<S>& e, int i) {
  const auto& sys = form.ws.sys;
  const S* state = e.y + form.nz() + sys.process_state[i];
  visit_process(sys.process_kind[i], [&](auto tag) {
    using E = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(form.ws.params + sys.process_param[i]);
    const At<S> at = process_at<T, S>(form.ws, i, state, e.input + sys.process_input[i]);
    E::state_rates(p, at, e.d + form.nz() + sys.process_state[i]);
  });
}

/// Rates of the shared states.
template <class T, class S>
void whole_shared(const FullForm<T>& form, const Whole<S>& e) {
  const Workspace<T>& ws = form.ws;
  const auto& sys = ws.sys;
  whole_heats(form, e);
  for (int i = 0; i < ws.in.n_direction_refs; ++i) {
    const int ref = ws.in.direction_ref[i];
    Read what;
    const int k = branch_behind(ws, ref, what);
    e.input[ref] = k < 0                ? S(T(0))
                   : what == Read::rate ? e.rate[k]
                   : what == Read::heat ? e.heat[k]
                                        : e.torque[k] * e.rate[k] + e.heat[k];
  }
  S* x = e.d + form.n() - sys.shared;
  for (int h = 0; h < sys.heats; ++h) {
    const int k = ws.branch_of[sys.heat_direction[h]];
    if (k >= 0 && k < ws.n_branches) add_times(T(sys.heat_share[h]), e.heat[k], x[sys.heat_to[h]]);
  }
  for (int f = 0; f < sys.flows; ++f) {
    const S q = whole_flow(form, e, f);
    if (sys.flow_from[f] >= 0) x[sys.flow_from[f]] -= q;
    if (sys.flow_to[f] >= 0) x[sys.flow_to[f]] += q;
  }
  if (with_draws && sys.draws > 0) gather<T, S>(ws, e.y + form.nz(), e.input);
  for (int i = 0; i < sys.processes; ++i) whole_process(form, e, i);
}

/// d := (sum of row' torque, rates of all states) at e.y; `input` holds the signals. Every torque is known once all
/// branches were asked, before any of them pushes: what couples them further is solved for there.
template <class T, class S>
[[gnu::noinline]] void whole_motion(const FullForm<T>& form, const Whole<S>& e) {
  const Workspace<T>& ws = form.ws;
  const Compressed<T>& rows = ws.rows.rate;
  for (int i = 0; i < form.n(); ++i) e.d[i] = S(T(0));
  if (ws.in.n_shared_refs > 0) whole_inputs(form, e);
  whole_rates(form, e);
  if (ws.in.n_rate_refs > 0) whole_rate_inputs(form, e);
  for (int k = 0; k < ws.n_branches; ++k) {
    if (ws.branch[k].ways > 0) whole_torque(form, e, k);
  }
  for (int k = 0; k < ws.n_branches; ++k) {
    for (int i = rows.first[k]; i < rows.first[k + 1]; ++i) add_times(rows.val[i], e.torque[k], e.d[rows.col[i]]);
  }
  if (ws.loads.n_sliding > 0) {
    // processes that give ratios do not look at heats
    if (ws.ratios.n > 0 && ws.sys.shared > 0) whole_shared(form, e);
    whole_loads(form, e);
    for (int i = form.n() - int(ws.sys.shared); i < form.n(); ++i) e.d[i] = S(T(0));
  }
  if (ws.sys.shared > 0) whole_shared(form, e);
  // those of transmissions were zero up to here; the rates of states that give ratios are known now
  if (ws.ratios.n > 0) whole_ratios(ws, e, form.nz());
}

/// d at (t, y), with rates and torques of the branches where they are wanted.
template <class T>
void evaluate_whole(FullForm<T>& form, Real<T> t, const T* y, T* d, T* rate, T* torque) {
  Workspace<T>& ws = form.ws;
  inputs_at(ws, t);
  if (ws.ratios.n > 0 || (ws.loads.n_sliding > 0 && ws.sys.prescribed > 0)) input_slopes_at(ws, t);
  Whole<T> e = ws.full.plain;
  e.d = d, e.input = ws.in.u, e.rate = rate, e.torque = torque;
  for (int i = 0; i < form.n(); ++i) e.y[i] = y[i];
  whole_motion(form, e);
  varying_multipliers(ws, ws.ratios.plain, ws.observed.carried, [](const T& x) { return x; });
}

/// Signals as dual numbers, column `time` of which is time; beyond the last one: none is.
template <class T, int N>
void lift_inputs(const Workspace<T>& ws, int time, const Whole<Dual<T, N>>& e) {
  for (int i = 0; i < ws.in.n_refs; ++i) e.input[i] = Dual<T, N>(ws.in.u[i]);
  for (int k = 0; k < ws.in.n_varying && time < N; ++k) {
    const int ref = ws.in.varying[k];
    e.input[ref].d[time] = ws.in.du[ref];
  }
}

/// d and its Jacobian at (t, y); dt := derivative by time.
template <class T>
void linearize_whole(FullForm<T>& form, Real<T> t, const T* y, T* d, T* dt, StepEnd<T>& edge) {
  constexpr int N = Full<T>::chunk;
  Workspace<T>& ws = form.ws;
  const int n = form.n();
  full_inputs(form, t, y);
  input_slopes_at(ws, t);
  Whole<Dual<T, N>>& e = ws.full.some;
  for (int first = 0; first <= n; first += N) {
    // the column behind the last unknown is time
    const int last = smaller(first + N, n);
    for (int i = 0; i < n; ++i) e.y[i] = Dual<T, N>(y[i]);
    for (int i = first; i < last; ++i) e.y[i].d[i - first] = T(1);
    e.time = n - first;
    lift_inputs(ws, n - first, e);
    whole_motion(form, e);
    for (int i = 0; i < n; ++i) {
      for (int j = first; j < last; ++j) ws.full.jacobian[i * n + j] = e.d[i].d[j - first];
      if (n - first < N) dt[i] = e.d[i].d[n - first];
    }
  }
  for (int i = 0; i < n; ++i) d[i] = e.d[i].v;
  for (int k = 0; k < ws.n_branches; ++k) edge.rate[k] = e.rate[k].v;
  for (int k = ws.n_branches; k < ws.n_rates; ++k) edge.rate[k] = form.rate(k, y) + offset_rate(ws, k);
  ++ws.statistics.jacobians;
}

/// Torques of the branches and their drift along the motion, of which the velocity and the rates of the states are
/// given; the inputs are those of the same instant.
template <class T>
void drift_whole(FullForm<T>& form, const T* y, const T* velocity, const T* state_rates, T* torque, T* drift) {
  Workspace<T>& ws = form.ws;
  const int nz = form.nz(), n = form.n();
  if (n < Full<T>::chunk && ws.ratios.n == 0) {
    // all derivatives are there since the motion was linearized
    for (int k = 0; k < ws.n_branches; ++k) {
      const auto& by = ws.full.some.torque[k];
      torque[k] = by.v;
      drift[k] = by.d[n] + dot(nz, by.d, velocity) + dot(n - nz, by.d + nz, state_rates);
    }
    return;
  }
  Whole<Dual<T, 1>>& e = ws.full.along;
  e.time = 0;
  for (int i = 0; i < form.n(); ++i) {
    e.y[i] = Dual<T, 1>(y[i]);
    e.y[i].d[0] = i < nz ? velocity[i] : state_rates[i - nz];
  }
  lift_inputs(ws, 0, e);
  whole_motion(form, e);
  for (int k = 0; k < ws.n_branches; ++k) torque[k] = e.torque[k].v, drift[k] = e.torque[k].d[0];
}

/// Size of what makes the rates that bend an own state per unit of their errors: as large as the derivative by the rate
/// where there is one.
template <class T>
Real<T> bend_of(const FullForm<T>& form, const Branch<T>& b, int k, int state) {
  const Compressed<T>& rows = form.ws.rows.rate;
  const T* row = form.ws.full.jacobian + (form.nz() + state) * form.n();
  Real<T> by_speeds = 0, widest = 0;
  for (int j = 0; j < form.nz(); ++j) by_speeds += abs(value(row[j]));
  for (int w = k; w < k + b.ways; ++w) {
    Real<T> size = 0;
    for (int i = rows.first[w]; i < rows.first[w + 1]; ++i) size += abs(value(rows.val[i]));
    widest = larger(widest, size);
  }
  return widest > 0 ? by_speeds / widest : 0;
}

/// As floor_states, from the Jacobian.
template <class T>
void floor_whole(FullForm<T>& form, const T* y) {
  Workspace<T>& ws = form.ws;
  const Real<T> rtol = ws.options.rtol, atol = ws.options.atol;
  for (int i = 0; i < form.ns(); ++i) ws.reduced.floor[i] = atol;
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<T>& b = ws.branch[k];
    for (int i = b.state; i < b.state + b.states; ++i) {
      if (ws.reduced.span[i] == 0) continue;
      const T* row = ws.full.jacobian + (form.nz() + i) * form.n();
      Real<T> moved = 0;
      for (int j = 0; j < form.nz(); ++j) moved += abs(value(row[j] * y[j]));
      ws.reduced.floor[i] += ws.reduced.span[i] * (bend_of(form, b, k, i) * atol + rtol * moved);
    }
  }
}

/// Square of the fastest swing of branch k on its own states [1/s2].
template <class T>
double swing_whole(FullForm<T>& form, int k) {
  Workspace<T>& ws = form.ws;
  const Branch<T>& b = ws.branch[k];
  const int n = form.n(), nz = form.nz();
  T* x = ws.full.plain.d;
  double square = 0;
  for (int s = nz + b.state; s < nz + b.state + b.states; ++s) {
    for (int i = 0; i < nz; ++i) x[i] = ws.full.jacobian[i * n + s];
    form.solve_mass(x);
    square += abs(value(dot(nz, ws.full.jacobian + s * n, x)));
  }
  return square;
}

}  // namespace clutchwork

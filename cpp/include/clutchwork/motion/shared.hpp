#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/workspace.hpp>

/// States that any component may read (temperatures, pressures, wear): flows between them, heat into them, processes of
/// their own. docs/theory/thermal.md.
namespace clutchwork {

/// Part of the rate of a branch that the prescribed speeds give, and its time derivative.
template <class T>
CLUTCHWORK_HOT T offset_rate(const Workspace<T>& ws, int k) {
  const int np = int(ws.sys.prescribed);
  return np == 0 ? T(0) : dot(np, ws.reduced.offset + k * np, ws.in.prescribed);
}
template <class T>
CLUTCHWORK_HOT T offset_slope(const Workspace<T>& ws, int k) {
  const int np = int(ws.sys.prescribed);
  return np == 0 ? T(0) : dot(np, ws.reduced.offset + k * np, ws.in.prescribed_slope);
}

/// Values of the references to shared states; `state` are all states.
template <class T>
CLUTCHWORK_HOT void shared_inputs(Workspace<T>& ws, const T* state) {
  const auto& sys = ws.sys;
  for (int k = 0; k < ws.in.n_shared_refs; ++k) {
    const int ref = ws.in.shared_ref[k], j = sys.input_refs[ref] - int(sys.inputs);
    ws.in.u[ref] = T(sys.shared_offset[j]) + T(sys.shared_scale[j]) * state[sys.states - sys.shared + j];
  }
}

/// All inputs of torques and contacts at time t for the given states.
template <class T>
CLUTCHWORK_HOT void inputs_with(Workspace<T>& ws, Real<T> t, const T* state) {
  inputs_at(ws, t);
  if constexpr (!has_lanes<T>) {
    if (ws.in.n_shared_refs > 0) shared_inputs(ws, state);
  }
}

/// What a reference to a direction reads, in the order of their numbers: its rate, its heat, or the power that it draws
/// from its supply, work and heat.
enum class Read : int { rate, heat, supply };

/// Whether processes draw from each other; a core without such kinds does without.
#ifdef CLUTCHWORK_NO_DRAWS
inline constexpr bool with_draws = false;
#else
inline constexpr bool with_draws = true;
#endif

/// Whether a reference reads the sum of the flows into a process.
template <class T>
bool is_sum(const Workspace<T>& ws, int code) {
  return with_draws && code >= ws.sys.inputs + ws.sys.shared + 3 * ws.n_directions;
}

/// Where such a reference points: its branch, -1 while that is locked.
template <class T>
int branch_behind(const Workspace<T>& ws, int ref, Read& what) {
  const auto& sys = ws.sys;
  const int d = sys.input_refs[ref] - int(sys.inputs + sys.shared);
  what = Read(d / ws.n_directions);
  const int k = ws.branch_of[d % ws.n_directions];
  return k < ws.n_branches ? k : -1;
}

/// Rates, heats and supplied powers of directions as inputs of flows and processes.
template <class T>
void direction_inputs(Workspace<T>& ws, const T* rate) {
  for (int i = 0; i < ws.in.n_direction_refs; ++i) {
    const int ref = ws.in.direction_ref[i];
    Read what;
    const int k = branch_behind(ws, ref, what);
    ws.in.u[ref] = k < 0                ? T(0)
                   : what == Read::rate ? rate[k]
                   : what == Read::heat ? ws.shared.heat[k]
                                        : ws.shared.supply[k];
  }
}

/// The element behind a reference to a rate.
template <class T>
CLUTCHWORK_HOT int element_behind(const Workspace<T>& ws, int ref) {
  return ws.sys.input_refs[ref] - int(ws.sys.inputs + ws.sys.shared);
}

/// References to rates at the present speeds.
template <class T>
void present_rates(Workspace<T>& ws) {
  for (int i = 0; i < ws.in.n_rate_refs; ++i) {
    const int ref = ws.in.rate_ref[i];
    ws.in.u[ref] = rate_of(ws, element_behind(ws, ref));
  }
}

/// Process i at its states and inputs, on the piece that it is on.
template <class T, class S>
CLUTCHWORK_HOT At<S> process_at(const Workspace<T>& ws, int i, const S* own, const S* input) {
  return At<S>{S(0), own, input, ws.shared.piece[i], points_of(ws)};
}

/// The same of flow f.
template <class T, class S>
CLUTCHWORK_HOT At<S> flow_at(const Workspace<T>& ws, int f, const S* input) {
  return At<S>{S(T(0)), nullptr, input, ws.shared.piece[ws.sys.processes + f], points_of(ws)};
}

template <class T>
T flow_value(const Workspace<T>& ws, int f) {
  const auto& sys = ws.sys;
  return visit_flow(sys.flow_kind[f], [&](auto tag) {
    using E = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + sys.flow_param[f]);
    return E::flow(p, flow_at<T, T>(ws, f, ws.in.u + sys.flow_input[f]));
  });
}

/// Sums of the flows into processes that gather, from states and inputs: docs/theory/hydraulics.md (5).
template <class T, class S>
void gather(const Workspace<T>& ws, const S* state, S* input) {
  const auto& sys = ws.sys;
  for (int j = 0; j < sys.draws; ++j) input[sys.process_input[sys.draw_from[j]]] = S(T(0));
  for (int j = 0; j < sys.draws;) {
    const int c = sys.draw_process[j];
    visit_process(sys.process_kind[c], [&](auto tag) {
      using E = typename decltype(tag)::type;
      if constexpr (DrawingProcess<E>) {
        const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + sys.process_param[c]);
        S flow[E::inputs]{};
        E::drawn(p, process_at<T, S>(ws, c, state + sys.process_state[c], input + sys.process_input[c]), flow);
        for (; j < sys.draws && sys.draw_process[j] == c; ++j)
          input[sys.process_input[sys.draw_from[j]]] -= flow[sys.draw_input[j]];
      }
    });
  }
}

/// Calls f(flow, process, its states, its inputs) for each flow that leaves a process, with its derivatives by the
/// states and then by the inputs of the one that draws.
template <class T, class F>
void each_drawn(const Workspace<T>& ws, int from, const T* state, F&& f) {
  const auto& sys = ws.sys;
  for (int j = 0; j < sys.draws; ++j) {
    if (sys.draw_from[j] != from) continue;
    const int c = sys.draw_process[j];
    visit_process(sys.process_kind[c], [&](auto tag) {
      using E = typename decltype(tag)::type;
      if constexpr (DrawingProcess<E>) {
        using S = Dual<T, E::states + most_inputs>;
        S input[most_inputs], own[E::states], flow[E::inputs];
        for (int i = 0; i < E::inputs; ++i) input[i] = S::variable(ws.in.u[sys.process_input[c] + i], E::states + i);
        for (int i = 0; i < E::states; ++i) own[i] = S::variable(state[sys.process_state[c] + i], i);
        const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + sys.process_param[c]);
        E::drawn(p, process_at<T, S>(ws, c, own, input), flow);
        f(flow[sys.draw_input[j]], c, int(E::states), int(E::inputs));
      }
    });
  }
}

/// Rates of the shared states at given rates and torques of the branches; `state` and `d` are all states.
template <class T>
[[gnu::noinline]] void shared_rates(Workspace<T>& ws, const T* rate, const T* torque, const T* state, T* d) {
  const auto& sys = ws.sys;
  T* x = d + sys.states - sys.shared;
  for (int j = 0; j < sys.shared; ++j) x[j] = T(0);
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<T>& b = ws.branch[k];
    if (b.ways == 1) {
      ws.shared.heat[k] = branch_heat(ws, b, rate[k], state, Dual<T, 1>(torque[k])).v;
    } else {
      ws.shared.heat[k] = b.ways == 0 ? T(0) : element_heat(ws, b, rate + k, state + b.state, b.input, torque + k);
    }
    ws.shared.supply[k] = torque[k] * rate[k] + ws.shared.heat[k];
  }
  direction_inputs(ws, rate);
  for (int h = 0; h < sys.heats; ++h) {
    const int k = ws.branch_of[sys.heat_direction[h]];
    if (k >= 0 && k < ws.n_branches) x[sys.heat_to[h]] += T(sys.heat_share[h]) * ws.shared.heat[k];
  }
  for (int f = 0; f < sys.flows; ++f) {
    const T q = flow_value(ws, f);
    if (sys.flow_from[f] >= 0) x[sys.flow_from[f]] -= q;
    if (sys.flow_to[f] >= 0) x[sys.flow_to[f]] += q;
  }
  if (with_draws && sys.draws > 0) gather(ws, state, ws.in.u);
  for (int i = 0; i < sys.processes; ++i) {
    visit_process(sys.process_kind[i], [&](auto tag) {
      using E = typename decltype(tag)::type;
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + sys.process_param[i]);
      const T *own = state + sys.process_state[i], *input = ws.in.u + sys.process_input[i];
      E::state_rates(p, process_at(ws, i, own, input), d + sys.process_state[i]);
    });
  }
}

/// Torques of the branches by the shared states, through their inputs and those of their laws.
template <class T>
void torques_by_shared(Workspace<T>& ws, const T* rate, const T* state) {
  const auto& sys = ws.sys;
  const int nx = int(sys.shared);
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<T>& b = ws.branch[k];
    T* row = ws.jacobian.torque_by + k * nx;
    for (int j = 0; j < nx; ++j) row[j] = T(0);
    const int n = b.inputs + b.law_inputs;
    auto source = [&](int i) {
      const T* at = i < b.inputs ? b.input + i : b.law_input + (i - b.inputs);
      return sys.input_refs[at - ws.in.u] - int(sys.inputs);
    };
    bool any = false;
    for (int i = 0; i < n; ++i) any = any || source(i) >= 0;
    if (!any) continue;
    T by_input[2 * most_inputs];
    branch_by_input(ws, b, rate[k], state, by_input);
    for (int i = 0; i < n; ++i) {
      const int j = source(i);
      if (j >= 0) row[j] += by_input[i] * T(sys.shared_scale[j]);
    }
  }
}

/// Derivatives of the rate of shared state i, collected term by term.
template <class T>
struct SharedRow {
  Workspace<T>& ws;
  T* dt;           ///< time derivatives of all state rates
  const T* rate;   ///< of each branch
  const T* state;  ///< all of them
  int nx, ns, nd, first;

  SharedRow(Workspace<T>& workspace, T* time, const T* rates, const T* states)
      : ws(workspace),
        dt(time),
        rate(rates),
        state(states),
        nx(int(ws.sys.shared)),
        ns(int(ws.sys.states)),
        nd(ws.n_directions),
        first(int(ws.sys.states - ws.sys.shared)) {}

  /// factor times the heat of branch k.
  void add_heat(int i, T factor, int k) {
    const Branch<T>& b = ws.branch[k];
    ws.jacobian.by_rate[i * nd + k] += factor * ws.shared.heat_rate[k];
    for (int s = 0; s < b.states; ++s)
      ws.jacobian.by_state[i * ns + b.state + s] += factor * ws.shared.heat_share[k] * ws.jacobian.f_state[b.state + s];
    for (int j = 0; j < nx; ++j)
      ws.jacobian.by_shared[i * nx + j] += factor * ws.shared.heat_share[k] * ws.jacobian.torque_by[k * nx + j];
    dt[first + i] += factor * ws.shared.heat_time[k];
  }
  /// factor times the power that branch k draws from its supply: its work, and its heat.
  void add_supply(int i, T factor, int k) {
    const Branch<T>& b = ws.branch[k];
    const Partial<T>& p = ws.jacobian.partial[k];
    add_heat(i, factor, k);
    const T by_torque = factor * rate[k];
    ws.jacobian.by_rate[i * nd + k] += factor * p.torque + by_torque * p.by_rate;
    for (int s = 0; s < b.states; ++s)
      ws.jacobian.by_state[i * ns + b.state + s] += by_torque * ws.jacobian.f_state[b.state + s];
    for (int j = 0; j < nx; ++j) ws.jacobian.by_shared[i * nx + j] += by_torque * ws.jacobian.torque_by[k * nx + j];
    dt[first + i] += factor * p.torque * offset_slope(ws, k) + by_torque * p.by_time;
  }
  /// factor times the sum of the flows into process c.
  void add_sum(int i, T factor, int c) {
    const auto& sys = ws.sys;
    each_drawn(ws, c, state, [&](const auto& flow, int by, int states, int inputs) {
      const int at = int(sys.process_state[by]) - first;
      for (int s = 0; s < states; ++s) ws.jacobian.by_shared[i * nx + at + s] -= factor * flow.d[s];
      for (int k = 0; k < inputs; ++k) add_input(i, -factor * flow.d[states + k], int(sys.process_input[by]) + k);
    });
  }
  /// factor times the input that stands at a reference.
  void add_input(int i, T factor, int ref) {
    const auto& sys = ws.sys;
    const int code = sys.input_refs[ref];
    if (!counts(factor)) return;
    if (code < sys.inputs) {
      dt[first + i] += factor * ws.in.du[ref];
    } else if (code < sys.inputs + sys.shared) {
      const int j = code - int(sys.inputs);
      ws.jacobian.by_shared[i * nx + j] += factor * T(sys.shared_scale[j]);
    } else if (is_sum(ws, code)) {
      add_sum(i, factor, code - int(sys.inputs + sys.shared) - 3 * nd);
    } else {
      Read what;
      const int k = branch_behind(ws, ref, what);
      if (k < 0) return;
      if (what == Read::heat) return add_heat(i, factor, k);
      if (what == Read::supply) return add_supply(i, factor, k);
      ws.jacobian.by_rate[i * nd + k] += factor;
      dt[first + i] += factor * offset_slope(ws, k);
    }
  }
};

/// Heats of the branches with their derivatives by rate and time; `heat_share`: by the torque.
template <class T>
void linearize_heats(Workspace<T>& ws, const T* rate, const T* state) {
  for (int k = 0; k < ws.n_branches; ++k) {
    const Partial<T>& p = ws.jacobian.partial[k];
    Dual<T, 1> torque(p.torque), still(p.torque);
    torque.d[0] = p.by_rate;
    const Dual<T, 1> heat = branch_heat(ws, ws.branch[k], rate[k], state, torque);
    // by the torque itself: -rate where heat is the whole work, else nothing
    Dual<T, 1> unit(T(1));
    const T base = branch_heat(ws, ws.branch[k], rate[k], state, Dual<T, 1>(T(0))).v;
    ws.shared.heat_share[k] = branch_heat(ws, ws.branch[k], rate[k], state, unit).v - base;
    ws.shared.heat[k] = heat.v;
    ws.shared.heat_rate[k] = heat.d[0];
    // the prescribed part of the rate changes the heat like any other, except through the torque, whose by_time has it
    const T by_rate_alone = heat.d[0] - ws.shared.heat_share[k] * p.by_rate;
    ws.shared.heat_time[k] = by_rate_alone * offset_slope(ws, k) + ws.shared.heat_share[k] * p.by_time;
  }
}

/// Derivatives of the flows between shared states.
template <class T>
void linearize_flow(Workspace<T>& ws, SharedRow<T>& row, int f) {
  const auto& sys = ws.sys;
  visit_flow(sys.flow_kind[f], [&](auto tag) {
    using E = typename decltype(tag)::type;
    using S = Dual<T, most_inputs>;
    S input[most_inputs];
    for (int i = 0; i < E::inputs; ++i) input[i] = S::variable(ws.in.u[sys.flow_input[f] + i], i);
    const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + sys.flow_param[f]);
    const S q = E::flow(p, flow_at<T, S>(ws, f, input));
    for (int i = 0; i < E::inputs; ++i) {
      if (sys.flow_from[f] >= 0) row.add_input(sys.flow_from[f], -q.d[i], sys.flow_input[f] + i);
      if (sys.flow_to[f] >= 0) row.add_input(sys.flow_to[f], q.d[i], sys.flow_input[f] + i);
    }
  });
}

/// Derivatives of a process by its own states and its inputs; `state` are all states.
template <class T>
void linearize_process(Workspace<T>& ws, SharedRow<T>& row, int c, const T* state) {
  const auto& sys = ws.sys;
  const int nx = int(sys.shared);
  visit_process(sys.process_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    using S = Dual<T, E::states + most_inputs>;
    S input[most_inputs], own[E::states], rates[E::states];
    for (int i = 0; i < E::inputs; ++i) input[i] = S::variable(ws.in.u[sys.process_input[c] + i], E::states + i);
    for (int i = 0; i < E::states; ++i) own[i] = S::variable(state[sys.process_state[c] + i], i);
    const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + sys.process_param[c]);
    E::state_rates(p, process_at<T, S>(ws, c, own, input), rates);
    const int at = sys.process_state[c] - row.first;
    for (int s = 0; s < E::states; ++s) {
      for (int j = 0; j < E::states; ++j) ws.jacobian.by_shared[(at + s) * nx + at + j] += rates[s].d[j];
      for (int i = 0; i < E::inputs; ++i) row.add_input(at + s, rates[s].d[E::states + i], sys.process_input[c] + i);
    }
  });
}

/// Rates of the shared states and all their derivatives, after the branches have been linearized.
template <class T>
[[gnu::noinline]] void linearize_shared(Workspace<T>& ws, const T* rate, const T* state, T* d, T* dt) {
  const auto& sys = ws.sys;
  const int nx = int(sys.shared), ns = int(sys.states), nd = ws.n_directions;
  torques_by_shared(ws, rate, state);
  T* torque = ws.observed.torque;
  for (int k = 0; k < ws.n_branches; ++k) torque[k] = ws.jacobian.partial[k].torque;
  shared_rates(ws, rate, torque, state, d);
  linearize_heats(ws, rate, state);
  for (int i = 0; i < nx * nd; ++i) ws.jacobian.by_rate[i] = T(0);
  for (int i = 0; i < nx * ns; ++i) ws.jacobian.by_state[i] = T(0);
  for (int i = 0; i < nx * nx; ++i) ws.jacobian.by_shared[i] = T(0);
  SharedRow<T> row(ws, dt, rate, state);
  for (int h = 0; h < sys.heats; ++h) {
    const int k = ws.branch_of[sys.heat_direction[h]];
    if (k >= 0 && k < ws.n_branches) row.add_heat(sys.heat_to[h], T(sys.heat_share[h]), k);
  }
  for (int f = 0; f < sys.flows; ++f) linearize_flow(ws, row, f);
  for (int c = 0; c < sys.processes; ++c) linearize_process(ws, row, c, state);
  for (int k = 0; k < ws.in.n_shared_refs; ++k) {
    const int ref = ws.in.shared_ref[k], j = sys.input_refs[ref] - int(sys.inputs);
    ws.in.shared_slope[ref] = T(sys.shared_scale[j]) * d[row.first + j];
  }
}

}  // namespace clutchwork

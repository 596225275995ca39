#pragma once
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/lanes/workspace.hpp>

/// Numbers of runs into lanes and back: docs/theory/lanes.md.
namespace clutchwork {

/// n numbers of a run into lane i, and back.
template <int R>
CLUTCHWORK_INLINE void put(Lanes<R>* to, const double* from, int n, int i) {
  for (int j = 0; j < n; ++j) to[j][i] = from[j];
}
template <int R>
CLUTCHWORK_INLINE void get(double* to, const Lanes<R>* from, int n, int i) {
  for (int j = 0; j < n; ++j) to[j] = from[j][i];
}

/// What stays as it is during a call: parameters, curves, tolerances.
template <int R>
void put_model(Workspace<Lanes<R>>& ws, const Workspace<double>& run, int i) {
  put(ws.params, run.params, int(run.sys.n_params), i);
  put(ws.points, run.sys.points, 3 * int(run.sys.n_points), i);
  ws.options.rtol[i] = run.options.rtol, ws.options.atol[i] = run.options.atol;
}

/// The mode that all lanes are in, from one of them.
template <int R>
void take_mode(Workspace<Lanes<R>>& ws, const Workspace<double>& run) {
  ws.n_branches = run.n_branches, ws.n_rates = run.n_rates;
  for (int c = 0; c < run.sys.contacts; ++c) {
    ws.contact.fault[c] = run.contact.fault[c], ws.contact.compliant[c] = run.contact.compliant[c];
  }
  ws.held.n = run.held.n;
  for (int a = 0; a < run.held.n; ++a) ws.held.contact[a] = run.held.contact[a];
  ws.reduced.nz = run.reduced.nz;
  ws.guard.n_lines = run.guard.n_lines, ws.guard.n_undirected = run.guard.n_undirected;
  for (int l = 0; l < run.guard.n_lines; ++l) ws.guard.line[l].branch = run.guard.line[l].branch;
  auto input = [&](const double* at) { return ws.in.u + (at - run.in.u); };
  auto slope = [&](const double* at) { return ws.in.du + (at - run.in.du); };
  for (int k = 0; k < run.n_rates; ++k) {
    const Branch<double>& b = run.branch[k];
    ws.branch[k] = {.params = ws.params + (b.params - run.params),
                    .law_params = b.law < 0 ? nullptr : ws.params + (b.law_params - run.params),
                    .input = input(b.input),
                    .input_slope = slope(b.input_slope),
                    .law_input = b.law < 0 ? nullptr : input(b.law_input),
                    .law_input_slope = b.law < 0 ? nullptr : slope(b.law_input_slope),
                    .inputs = b.inputs,
                    .law_inputs = b.law_inputs,
                    .kind = b.kind,
                    .law = b.law,
                    .direction = b.direction,
                    .state = b.state,
                    .states = b.states,
                    .ways = b.ways,
                    .piece = b.piece,
                    .sign = b.sign,
                    .pressed = b.pressed,
                    .compliant = b.compliant,
                    .follows = b.follows,
                    .shaped = b.shaped};
    ws.jacobian.block[k] = run.jacobian.block[k];
  }
}

/// What the speeds bring into the rates of the branches with states.
template <int R>
void put_gross(Workspace<Lanes<R>>& ws, const Workspace<double>& run, int i) {
  const int nv = int(run.sys.speeds);
  for (int k = 0; k < run.n_branches; ++k) {
    if (run.branch[k].states == 0) continue;
    Lanes<R>* to = ws.reduced.gross + k * nv;
    for (int j = 0; j < nv; ++j) to[j][i] = 0;
    const auto row = rate_row(run.sys, run.branch[k].direction);
    for (int e = 0; e < row.n; ++e) to[row.column[e]][i] = abs(row.value[e]);
  }
}

/// The reduced motion of the mode of one lane.
template <int R>
void put_motion(Workspace<Lanes<R>>& ws, const Workspace<double>& run, int i) {
  const int nz = run.reduced.nz, nv = int(run.sys.speeds), np = int(run.sys.prescribed), m = run.held.n;
  put(ws.reduced.z_basis, run.reduced.z_basis, nv * nz, i);
  put(ws.reduced.span, run.reduced.span, int(run.sys.states), i);
  put(ws.reduced.row_z, run.reduced.row_z, run.n_rates * nz, i), put_gross(ws, run, i);
  put(ws.reduced.offset, run.reduced.offset, run.n_rates * np, i);
  put(ws.held.reach, run.held.reach, m * run.n_branches, i);
  put(ws.held.reach_prescribed, run.held.reach_prescribed, m * np, i);
}

/// One end of a step.
template <int R>
void put_end(StepEnd<Lanes<R>>& to, const StepEnd<double>& from, int n_rates, int held, int i) {
  put(to.rate, from.rate, n_rates, i), put(to.slope, from.slope, n_rates, i);
  put(to.multiplier, from.multiplier, held, i), put(to.drift, from.drift, held, i);
  put(to.capacity, from.capacity, held, i), put(to.swing, from.swing, held, i), put(to.noise, from.noise, held, i);
}
template <int R>
void get_end(StepEnd<double>& to, const StepEnd<Lanes<R>>& from, int n_rates, int held, int i) {
  get(to.rate, from.rate, n_rates, i), get(to.slope, from.slope, n_rates, i);
  get(to.multiplier, from.multiplier, held, i), get(to.drift, from.drift, held, i);
  get(to.capacity, from.capacity, held, i), get(to.swing, from.swing, held, i), get(to.noise, from.noise, held, i);
}

/// Derivatives of the torques.
template <int R>
void put_jacobian(Workspace<Lanes<R>>& ws, const Workspace<double>& run, int i) {
  Jacobian<Lanes<R>>& to = ws.jacobian;
  const Jacobian<double>& from = run.jacobian;
  const int n = int(run.sys.states);
  for (int k = 0; k < run.n_branches; ++k) put(&to.partial[k].torque, &from.partial[k].torque, 3, i);
  put(to.f_state, from.f_state, n, i), put(to.g_rate, from.g_rate, n, i), put(to.g_time, from.g_time, n, i);
  put(to.g_state, from.g_state, n, i);
}
template <int R>
void get_jacobian(Workspace<double>& run, const Workspace<Lanes<R>>& ws, int i) {
  Jacobian<double>& to = run.jacobian;
  const Jacobian<Lanes<R>>& from = ws.jacobian;
  const int n = int(run.sys.states);
  for (int k = 0; k < run.n_branches; ++k) get(&to.partial[k].torque, &from.partial[k].torque, 3, i);
  get(to.f_state, from.f_state, n, i), get(to.g_rate, from.g_rate, n, i), get(to.g_time, from.g_time, n, i);
  get(to.g_state, from.g_state, n, i);
}

/// Values of the inputs, and the segments that they are on.
template <int R>
void put_inputs(Workspace<Lanes<R>>& ws, const Workspace<double>& run, int i) {
  Signals<Lanes<R>>& in = ws.in;
  put(in.u, run.in.u, in.n_refs, i), put(in.du, run.in.du, in.n_refs, i);
  for (int ref = 0; ref < in.n_refs; ++ref) {
    const Signal& signal = run.in.signal[run.in.ref_signal[ref]];
    in.varies[ref].set(i, signal.varying);
    in.linear[ref].set(i, signal.linear && (signal.coef == nullptr || signal.coef[4] == 0));
    if (!signal.varying) continue;
    in.start[ref][i] = signal.start;
    put(in.cubic + 4 * ref, signal.coef, 4, i);
  }
  for (int a = 0; a < ws.held.n; ++a) ws.contact.bends[ws.held.contact[a]].set(i, load_bends(run, ws.held.contact[a]));
}

/// Lists of what varies in some lane that is there.
template <int R>
void list_varying(Workspace<Lanes<R>>& ws) {
  Signals<Lanes<R>>& in = ws.in;
  in.n_varying = 0;
  for (int ref = 0; ref < in.n_refs; ++ref) {
    in.waves[ref] = 0;
    bool varies = false;
    for (int i = 0; i < n_lanes; ++i) {
      if (ws.run[i] == nullptr || !in.varies[ref][i]) {
        in.varies[ref].set(i, false);
        continue;
      }
      varies = true;
      const double* c = ws.run[i]->in.signal[ws.run[i]->in.ref_signal[ref]].coef;
      if (c[4] != 0 || c[8] != 0) in.waves[ref] = 1;
    }
    if (varies) in.varying[in.n_varying++] = ref;
  }
}

/// The line guards of one lane.
template <int R>
void put_lines(Workspace<Lanes<R>>& ws, const Workspace<double>& run, int i) {
  for (int l = 0; l < ws.guard.n_lines; ++l) {
    ws.guard.line[l].sign[i] = run.guard.line[l].sign, ws.guard.line[l].level[i] = run.guard.line[l].level;
  }
  ws.noise[i] = 1e-3 * run.guard.zero;
}

}  // namespace clutchwork

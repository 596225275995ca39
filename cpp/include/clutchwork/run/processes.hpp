#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/workspace.hpp>

/// Processes that switch between smooth pieces: docs/theory/events.md, rule 12.
namespace clutchwork {

/// Inputs of process c at time t with their time derivatives, for given states; rate(d, slope) is that of direction d.
template <class T, class Rate>
void place_process_inputs(const Workspace<T>& ws, int c, double t, const T* state, const T* rates, Rate&& rate, int n,
                          Dual<T, 1>* out) {
  const auto& sys = ws.sys;
  for (int i = 0; i < n; ++i) {
    const int ref = int(sys.process_input[c]) + i, code = sys.input_refs[ref], j = code - int(sys.inputs);
    T x = T(0), slope = T(0);
    if (j < 0) {
      x = T(signal_value(ws, code, t)), slope = T(signal_slope(ws, code, t));
    } else if (j < sys.shared) {
      const std::int64_t place = sys.states - sys.shared + j;
      x = T(sys.shared_offset[j]) + T(sys.shared_scale[j]) * state[place];
      slope = T(sys.shared_scale[j]) * rates[place];
    } else {
      const int d = j - int(sys.shared), k = d < ws.n_directions ? -1 : ws.branch_of[d - ws.n_directions];
      if (d < ws.n_directions) x = rate(d, slope);
      if (k >= 0 && k < ws.n_branches) x = ws.shared.heat[k];
    }
    out[i] = Dual<T, 1>(x), out[i].d[0] = slope;
  }
}

/// How far process c is from leaving its piece, and its time derivative; `who` would leave.
template <class T, class Rate>
Dual<T, 1> process_margin(const Workspace<T>& ws, int c, double t, const T* state, const T* rates, Rate&& rate,
                          int& who) {
  const auto& sys = ws.sys;
  return visit_process(sys.process_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    using S = Dual<T, 1>;
    if constexpr (SwitchingProcess<E>) {
      S own[E::states], input[E::inputs > 0 ? E::inputs : 1];
      const std::int64_t first = sys.process_state[c];
      for (int i = 0; i < E::states; ++i) own[i] = S(state[first + i]), own[i].d[0] = rates[first + i];
      place_process_inputs(ws, c, t, state, rates, rate, E::inputs, input);
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + sys.process_param[c]);
      return E::margin(p, process_at<T, S>(ws, c, own, input), who);
    }
    return S(1);
  });
}

/// Take process c to its next piece at the present inputs; true when it moves its states.
template <class T>
bool process_cross(Workspace<T>& ws, int c, int who, T* state) {
  const auto& sys = ws.sys;
  return visit_process(sys.process_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    bool moved = false;
    if constexpr (SwitchingProcess<E>) {
      T own[E::states];
      T* at = state + sys.process_state[c];
      for (int i = 0; i < E::states; ++i) own[i] = at[i];
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + sys.process_param[c]);
      const T* input = ws.in.u + sys.process_input[c];
      ws.shared.piece[c] = E::cross(p, process_at<T, T>(ws, c, own, input), who, at);
      for (int i = 0; i < E::states; ++i) moved = moved || value(own[i] - at[i]) != 0;
    }
    return moved;
  });
}

/// The processes that switch.
template <class T>
void list_processes(Workspace<T>& ws) {
  ws.guard.n_processes = 0;
  for (int c = 0; c < ws.sys.processes; ++c) {
    const bool switches =
        visit_process(ws.sys.process_kind[c], [](auto tag) { return SwitchingProcess<typename decltype(tag)::type>; });
    if (switches) ws.guard.process[ws.guard.n_processes++] = c;
  }
}

/// Processes on the pieces that hold what they see now; each may pass a few on the way.
template <class T>
void find_process_pieces(Workspace<T>& ws) {
  constexpr int most = 64;
  bool moved = false;
  for (int i = 0; i < ws.guard.n_processes; ++i) {
    const int c = ws.guard.process[i];
    auto rate = [&](int d, T&) { return rate_of(ws, d); };
    for (int round = 0; round < most; ++round) {
      int who = 0;
      // the slopes of the states have no part in where they are
      if (value(process_margin(ws, c, ws.time, ws.state, ws.state, rate, who).v) >= 0) break;
      moved = process_cross(ws, c, who, ws.state) || moved;
    }
  }
  if (moved) shared_inputs(ws, ws.state);
}

}  // namespace clutchwork

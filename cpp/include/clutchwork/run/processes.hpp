#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/workspace.hpp>

#include <type_traits>

/// Processes and flows that switch between smooth pieces: docs/theory/events.md, rule 12.
namespace clutchwork {

/// Call f(tag, parameters, first reference, first state) for process c; those behind the last one are flows.
template <class T, class F>
decltype(auto) visit_process_or_flow(const Workspace<T>& ws, int c, F&& f) {
  const auto& sys = ws.sys;
  if (c < sys.processes) {
    return visit_process(sys.process_kind[c], [&](auto tag) {
      return f(tag, ws.params + sys.process_param[c], int(sys.process_input[c]), int(sys.process_state[c]));
    });
  }
  const int i = c - int(sys.processes);
  return visit_flow(sys.flow_kind[i],
                    [&](auto tag) { return f(tag, ws.params + sys.flow_param[i], int(sys.flow_input[i]), 0); });
}

/// A function that gives the rate of a direction and its time derivative, of whatever type: processes are compiled
/// once.
template <class T>
struct RateOf {
  const void* of;
  T (*read)(const void* of, int d, T& slope);
  template <class F>
  RateOf(const F& f)
      : of(&f), read([](const void* by, int d, T& slope) { return T((*static_cast<const F*>(by))(d, slope)); }) {}
  T operator()(int d, T& slope) const { return read(of, d, slope); }
};

/// The n inputs from a reference on at time t with their time derivatives, for given states; rate(d, slope) is that of
/// direction d.
template <class T>
[[gnu::noinline]] void place_process_inputs(const Workspace<T>& ws, int first, double t, const T* state, const T* rates,
                                            const RateOf<T>& rate, int n, Dual<T, 1>* out) {
  const auto& sys = ws.sys;
  for (int i = 0; i < n; ++i) {
    const int ref = first + i, code = sys.input_refs[ref], j = code - int(sys.inputs);
    T x = T(0), slope = T(0);
    if (j < 0) {
      x = T(signal_value(ws, code, t)), slope = T(signal_slope(ws, code, t));
    } else if (j < sys.shared) {
      const std::int64_t place = sys.states - sys.shared + j;
      x = T(sys.shared_offset[j]) + T(sys.shared_scale[j]) * state[place];
      slope = T(sys.shared_scale[j]) * rates[place];
    } else if (!is_sum(ws, code)) {
      Read what;
      const int k = branch_behind(ws, ref, what);
      if (what == Read::rate) x = rate(j - int(sys.shared), slope);
      if (k >= 0 && what != Read::rate) x = what == Read::heat ? ws.shared.heat[k] : ws.shared.supply[k];
    }
    out[i] = Dual<T, 1>(x), out[i].d[0] = slope;
  }
}

/// How far process c is from leaving its piece, and its time derivative; `who` would leave.
template <class T>
[[gnu::noinline]] Dual<T, 1> process_margin(const Workspace<T>& ws, int c, double t, const T* state, const T* rates,
                                            const std::type_identity_t<RateOf<T>>& rate, int& who) {
  return visit_process_or_flow(ws, c, [&](auto tag, const T* params, int ref, int first) {
    using E = typename decltype(tag)::type;
    using S = Dual<T, 1>;
    if constexpr (SwitchingProcess<E>) {
      S own[E::states > 0 ? E::states : 1], input[E::inputs > 0 ? E::inputs : 1];
      for (int i = 0; i < E::states; ++i) own[i] = S(state[first + i]), own[i].d[0] = rates[first + i];
      place_process_inputs(ws, ref, t, state, rates, rate, E::inputs, input);
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(params);
      return E::margin(p, process_at<T, S>(ws, c, own, input), who);
    }
    return S(1);
  });
}

/// Take process c to its next piece at the present inputs; true when it moves its states.
template <class T>
bool process_cross(Workspace<T>& ws, int c, int who, T* state) {
  return visit_process_or_flow(ws, c, [&](auto tag, const T* params, int ref, int first) {
    using E = typename decltype(tag)::type;
    bool moved = false;
    if constexpr (SwitchingProcess<E>) {
      T own[E::states > 0 ? E::states : 1];
      T* at = state + first;
      for (int i = 0; i < E::states; ++i) own[i] = at[i];
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(params);
      ws.shared.piece[c] = E::cross(p, process_at<T, T>(ws, c, own, ws.in.u + ref), who, at);
      for (int i = 0; i < E::states; ++i) moved = moved || value(own[i] - at[i]) != 0;
    }
    return moved;
  });
}

/// The processes and flows that switch.
template <class T>
void list_processes(Workspace<T>& ws) {
  ws.guard.n_processes = 0;
  for (int c = 0; c < ws.sys.processes + ws.sys.flows; ++c) {
    const bool switches = visit_process_or_flow(
        ws, c, [](auto tag, const T*, int, int) { return SwitchingProcess<typename decltype(tag)::type>; });
    if (switches) ws.guard.process[ws.guard.n_processes++] = c;
  }
}

/// Processes and flows on the pieces that hold what they see now; each may pass a few on the way.
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

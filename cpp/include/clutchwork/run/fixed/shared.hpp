#pragma once
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/fixed/torques.hpp>

/// States that several components read, over a step: docs/theory/fixed-steps.md (10)
namespace clutchwork::fixed {

/// Change of the states of process i, each with its own slope, so that a fast one does not ring.
inline void change_process(Run& ws, int i, real h) {
  const auto& sys = ws.sys;
  Fixed<real>& f = ws.fixed;
  visit_process(sys.process_kind[i], [&](auto tag) {
    using E = typename decltype(tag)::type;
    using S = Dual<real, 1>;
    const auto& p = *reinterpret_cast<const typename E::template Params<real>*>(ws.params + sys.process_param[i]);
    const int first = int(sys.process_state[i]);
    S own[E::states], rates[E::states], input[E::inputs > 0 ? E::inputs : 1];
    for (int k = 0; k < E::inputs; ++k) input[k] = S(ws.in.u[sys.process_input[i] + k]);
    for (int j = 0; j < E::states; ++j) {
      for (int k = 0; k < E::states; ++k) own[k] = S(f.state_ahead[first + k]);
      own[j] = S::variable(f.state_ahead[first + j], 0);
      E::state_rates(p, process_at<real, S>(ws, i, own, input), rates);
      const real slope = smaller(rates[j].d[0], 0.0), share = share_of(h * slope);
      const real off = ws.state[first + j] - f.state_ahead[first + j];
      f.state_change[first + j] = h * (ws.observed.state_rates[first + j] + slope * off) / (1 - share * h * slope);
    }
  });
}

/// Changes of all shared states, from the mean torques and the rates in the middle: the heat of a step is its work.
inline void change_shared(Run& ws, real h) {
  const auto& sys = ws.sys;
  Fixed<real>& f = ws.fixed;
  real* middle = f.predicted;
  for (int d = 0; d < ws.n_directions; ++d) middle[d] = f.start_rate[d] + 0.5 * f.rate_change[d];
  shared_rates(ws, middle, f.mean, f.state_ahead, ws.observed.state_rates);
  for (std::int64_t s = sys.states - sys.shared; s < sys.states; ++s)
    f.state_change[s] = h * ws.observed.state_rates[s];
  for (int i = 0; i < sys.processes; ++i) change_process(ws, i, h);
}

}  // namespace clutchwork::fixed

#pragma once
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/lanes/workspace.hpp>

/// Signals of the lanes, in place of those of one run.
namespace clutchwork {

/// Values of all references at the times of the lanes: where a signal does not vary it stays as it is.
template <int R>
CLUTCHWORK_INLINE void inputs_at(Workspace<Lanes<R>>& ws, const Lanes<R>& t) {
  Signals<Lanes<R>>& in = ws.in;
  for (int k = 0; k < in.n_varying; ++k) {
    const int ref = in.varying[k];
    const Lanes<R> s = t - in.start[ref], *c = in.cubic + 4 * ref;
    Lanes<R> x = select(in.linear[ref], c[0] + c[1] * s, cubic_value(c, s));
    if (in.waves[ref]) {
      for (int i = 0; i < n_lanes; ++i)
        if (ws.run[i] != nullptr) x[i] = signal_value(*ws.run[i], ws.run[i]->in.ref_signal[ref], t[i]);
    }
    in.u[ref] = select(in.varies[ref], x, in.u[ref]);
  }
}

/// Their time derivatives.
template <int R>
CLUTCHWORK_INLINE void input_slopes_at(Workspace<Lanes<R>>& ws, const Lanes<R>& t) {
  Signals<Lanes<R>>& in = ws.in;
  for (int k = 0; k < in.n_varying; ++k) {
    const int ref = in.varying[k];
    Lanes<R> x = cubic_slope(in.cubic + 4 * ref, t - in.start[ref]);
    if (in.waves[ref]) {
      for (int i = 0; i < n_lanes; ++i)
        if (ws.run[i] != nullptr) x[i] = signal_slope(*ws.run[i], ws.run[i]->in.ref_signal[ref], t[i]);
    }
    in.du[ref] = select(in.varies[ref], x, in.du[ref]);
  }
}

/// Of each lane, whether the load of a contact bends over time.
template <int R>
CLUTCHWORK_INLINE Mask<R> load_bends(const Workspace<Lanes<R>>& ws, int c) {
  return ws.contact.bends[c];
}

}  // namespace clutchwork

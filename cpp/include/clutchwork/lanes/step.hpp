#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/lanes/inputs.hpp>
#include <clutchwork/run/gauss.hpp>
#include <clutchwork/run/guards/line.hpp>
#include <clutchwork/run/guards/torques.hpp>
#include <clutchwork/run/integrator/rodas5p.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/run/step.hpp>

/// A step of eight lanes: the functions of one run, compiled for the registers of a processor. docs/theory/lanes.md
namespace clutchwork {

/// Lanes in which something may happen inside the step.
template <int R>
CLUTCHWORK_INLINE Mask<R> doubtful_inline(const Workspace<Lanes<R>>& ws, const Lanes<R>& h) {
  Mask<R> clear(true);
  Lanes<R> start, end;
  for (int l = 0; l < ws.guard.n_lines; ++l) {
    const LaneLine<R>& g = ws.guard.line[l];
    clear = clear && stays_clear(ws, g.branch, g.sign, g.level, h, ws.noise, start, end);
  }
  for (int a = 0; a < ws.held.n; ++a) clear = clear && holds_on(ws, a, h, start, end);
  // ends say little of what is held beside prescribed speeds that vary
  for (int p = 0; ws.held.n > 0 && p < ws.sys.prescribed; ++p) clear = clear && !ws.in.varies[ws.sys.n_input_refs + p];
  clear = clear && !nears_rest(ws);
  // open contacts that have started to move get their direction
  for (int k = ws.n_branches; ws.guard.n_undirected > 0 && k < ws.n_rates; ++k) {
    if (ws.branch[k].sign == 0) clear = clear && abs(ws.step_end.rate[k]) <= 1e-10;
  }
  return !clear;
}

// out of line: what is inlined for one run is several times as long for eight
template <int R>
[[gnu::noinline]] Lanes<R> branch_torque(const Workspace<Lanes<R>>& ws, const Branch<Lanes<R>>& b, const Lanes<R>& rate,
                                         const Lanes<R>* state, Lanes<R>* rates) {
  return branch_torque<Lanes<R>>(ws, b, rate, state, rates);
}
template <int R>
[[gnu::noinline]] Partial<Lanes<R>> branch_partial(const Workspace<Lanes<R>>& ws, const Branch<Lanes<R>>& b,
                                                   const Lanes<R>& rate, const Lanes<R>& rate_slope,
                                                   const Lanes<R>* state, Lanes<R>* rates,
                                                   const StatePartials<Lanes<R>>& out) {
  return branch_partial_inline<Lanes<R>>(ws, b, rate, rate_slope, state, rates, out);
}
template <int R, int NZ>
[[gnu::noinline]] void evaluate(LaneForm<R, NZ>& form, const Lanes<R>& t, const Lanes<R>* y, Lanes<R>* d) {
  evaluate_inline(form, t, y, d);
}
template <int R, int NZ, int NS>
  requires(NS >= 0)
CLUTCHWORK_INLINE void evaluate(LaneForm<R, NZ, NS>& form, const Lanes<R>& t, const Lanes<R>* y, Lanes<R>* d) {
  evaluate<R, NZ>(reinterpret_cast<LaneForm<R, NZ>&>(form), t, y, d);
}

/// Whether nothing overflows at the end of a step and in what is read of it: what a row tells of energy has the size of
/// the squares of the speeds.
template <int R>
CLUTCHWORK_INLINE Mask<R> is_sound(LaneForm<R>& form, Step<LaneForm<R>>& step) {
  const Workspace<Lanes<R>>& ws = form.ws;
  Lanes<R> sum(0);
  for (int i = 0; i < form.n(); ++i) sum += step.y1()[i] * step.y1()[i] + step.f1()[i] * 0;
  for (int j = 0; j < ws.out.n_seen; ++j) sum += ws.observed.torque[ws.out.seen[j]] * 0;
  for (int j = 0; j < ws.out.n_worked; ++j) sum += ws.out.work[j] * 0;
  return sum < 1e300;
}

/// Rates and torques of some branches at a share of the step of each lane.
template <int R>
[[gnu::noinline]] void observe_some(LaneForm<R>& form, Step<LaneForm<R>>& step, const Lanes<R>& s, const int* which,
                                    int count) {
  Workspace<Lanes<R>>& ws = form.ws;
  Lanes<R>*y = step.point(), *d = step.slope();
  interpolate(form, step, s, y);
  inputs_with(ws, step.t + s * step.h, y + form.nz());
  for (int i = 0; i < form.n(); ++i) d[i] = 0;
  for (int j = 0; j < count; ++j) {
    const int k = which[j];
    ws.observed.rate[k] = form.rate(k, y) + offset_rate(ws, k);
    ws.observed.torque[k] = branch_torque(ws, ws.branch[k], ws.observed.rate[k], y + form.nz(), d + form.nz());
    if (ws.out.motion) form.push(k, ws.observed.torque[k], d);
  }
}

/// Work of the branches whose work is read over the step of each lane. docs/theory/energy.md
template <int R>
CLUTCHWORK_INLINE void integrate_powers(LaneForm<R>& form, Step<LaneForm<R>>& step) {
  Workspace<Lanes<R>>& ws = form.ws;
  const int n = ws.out.n_worked, *which = ws.out.worked;
  for (int i = 0; i < 4 * n; ++i) ws.out.power[i] = 0;
  for (int g = 0; n > 0 && g < 4; ++g) {
    observe_some(form, step, Lanes<R>(gauss.node[g]), which, n);
    for (int k = 0; k < n; ++k) {
      const Lanes<R> power = ws.observed.torque[which[k]] * ws.observed.rate[which[k]];
      for (int j = 0; j < 4; ++j) ws.out.power[j * n + k] += power * Lanes<R>(gauss.coef[g][j]);
    }
  }
  for (int k = 0; k < n; ++k) ws.out.work[k] = cubic_integral(ws.out.power + k, n, Lanes<R>(1), step.h);
}

/// Call f with a step and its form, the number of speeds known to the compiler.
template <int R, int NZ = 1, class F>
CLUTCHWORK_INLINE void visit_lanes(void* form, void* step, F&& f) {
  if (static_cast<LaneForm<R>*>(form)->nz() == NZ)
    return f(*static_cast<LaneForm<R, NZ>*>(form), *static_cast<Step<LaneForm<R, NZ>>*>(step));
  if constexpr (NZ < small_speeds) visit_lanes<R, NZ + 1>(form, step, f);
}
/// The same with the number of states, NS or more: half of a loop over so few numbers is counting.
template <int R, int NZ, int NS = 0, class F>
CLUTCHWORK_INLINE void visit_states(LaneForm<R, NZ>& form, Step<LaneForm<R, NZ>>& step, F&& f) {
  if (form.ns() == NS)
    return f(reinterpret_cast<LaneForm<R, NZ, NS>&>(form), reinterpret_cast<Step<LaneForm<R, NZ, NS>>&>(step));
  if constexpr (NS < small_states) visit_states<R, NZ, NS + 1>(form, step, f);
}

/// Row k of so many in the step of each lane.
template <int R>
struct LaneRow {
  std::int64_t k, parts;
  Lanes<R> end;   ///< [s] of the step
  Lanes<R> time;  ///< [s] at which the row stands: it is found
};

/// What is compiled once for each width of registers. The lanes are in memory alike for all of them.
template <int R>
struct LaneStep {
  /// One step of all lanes; their errors, and whether their new states are finite.
  static void advance(void* form, void* step, void* error, void* finite) {
    visit_lanes<R>(form, step, [&](auto& any, auto& at) {
      visit_states(any, at, [&](auto& f, auto& s) {
        *static_cast<Lanes<R>*>(error) = Rodas5P::advance(f, s, s.h);
        *static_cast<Mask<R>*>(finite) = all_finite(f.n(), s.y1());
      });
    });
  }
  /// Derivatives and guards at its end, at these times.
  static void linearize_at(void* form, void* step, const void* times) {
    visit_lanes<R>(form, step, [&](auto& f, auto& s) {
      linearize_end_inline(f, s, *static_cast<const Lanes<R>*>(times), s.y1(), s.f1(), s.dt1(), f.ws.step_end);
    });
  }
  /// Lanes in which something may happen inside it.
  static void doubt(void* form, void* step, void* doubtful) {
    *static_cast<Mask<R>*>(doubtful) =
        doubtful_inline(static_cast<LaneForm<R>*>(form)->ws, static_cast<Step<LaneForm<R>>*>(step)->h);
  }
  /// What is read of a LaneRow, after `fit`; lanes in which it is finite.
  static void observe(void* form, void* step, void* row, void* sound) {
    auto& f = *static_cast<LaneForm<R>*>(form);
    auto& s = *static_cast<Step<LaneForm<R>>*>(step);
    auto& at = *static_cast<LaneRow<R>*>(row);
    const Lanes<R> share = share_of_row(at.k, at.parts, s.t, s.h, Lanes<R>(1), at.end, at.time);
    observe_some(f, s, share, f.ws.out.seen, f.ws.out.n_seen);
    if (f.ws.out.carried) multipliers(f.ws, f.ws.observed.torque, true, f.ws.observed.carried);
    // a row adds what is held to nothing
    for (int a = 0; f.ws.out.carried && a < f.ws.held.n; ++a) f.ws.observed.carried[a] += Lanes<R>(0);
    *static_cast<Mask<R>*>(sound) = is_sound(f, s);
  }
  /// Its interpolant, and the work that is read; lanes in which that is finite.
  static void fit(void* form, void* step, void* sound) {
    auto& f = *static_cast<LaneForm<R>*>(form);
    auto& s = *static_cast<Step<LaneForm<R>>*>(step);
    Rodas5P::prepare_dense(f, s);
    integrate_powers(f, s);
    *static_cast<Mask<R>*>(sound) = is_sound(f, s);
  }
};

/// The same as pointers: which one is taken depends on the processor.
struct LaneKernel {
  void (*advance)(void* form, void* step, void* error, void* finite);
  void (*linearize_at)(void* form, void* step, const void* times);
  void (*doubt)(void* form, void* step, void* doubtful);
  void (*observe)(void* form, void* step, void* row, void* sound);
  void (*fit)(void* form, void* step, void* sound);
};

}  // namespace clutchwork

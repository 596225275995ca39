#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/stops.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/motion/form.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/integrator/rodas5p.hpp>
#include <clutchwork/run/power.hpp>
#include <clutchwork/workspace.hpp>

/// What one step needs besides its integrator: both ends, its length, its errors.
namespace clutchwork {

/// Speeds at y brought onto the ties of transmissions, closed stops on them to their ends; ratios.jammed tells whether
/// that can be. docs/theory/varying-ratios.md (9)
template <class T>
void keep_ties(FullForm<T>& form, Step<FullForm<T>>& step, Real<T> t, T* y) {
  Workspace<T>& ws = form.ws;
  if (ws.ratios.n == 0) return;
  evaluate(form, t, y, step.slope());
  ws.ratios.jammed = settle_ties(form, y, step.y0());
  stay_at_ends(ws, y + form.nz());
}

/// Derivatives, rates, slopes, multipliers at one end of the step.
template <class Form, class T = typename Form::Scalar>
CLUTCHWORK_INLINE void linearize_end_inline(Form& form, Step<Form>& step, Real<T> t, const T* y, T* d, T* dt,
                                            StepEnd<T>& edge) {
  linearize(form, t, y, d, dt, edge);
  if constexpr (Form::small) {
    slopes(form, d, edge);
    sense(form, y, d, d, edge);
  } else {
    T* velocity = step.slope();
    for (int i = 0; i < form.nz(); ++i) velocity[i] = d[i];
    form.solve_mass(velocity);
    slopes(form, velocity, edge);
    sense(form, y, velocity, d, edge);
  }
}

template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] void linearize_at(Form& form, Step<Form>& step, Real<T> t, const T* y, T* d, T* dt,
                                    StepEnd<T>& edge) {
  linearize_end_inline(form, step, t, y, d, dt, edge);
}

/// A first step from the sizes of state and slope (E. Hairer, G. Wanner, Solving ODEs I, section II.4, shortened).
template <class Form>
double first_step(Form& form, Step<Form>& step, double span) {
  auto& ws = form.ws;
  if (ws.options.first_step > 0) return ws.options.first_step;
  auto* velocity = step.slope();
  for (int i = 0; i < form.n(); ++i) velocity[i] = step.f0()[i];
  form.solve_mass(velocity);
  const double size = error_norm(form, step.y0(), step.y0(), step.y0());
  const double speed = error_norm(form, velocity, step.y0(), step.y0());
  const double h = size < 1e-5 || speed < 1e-5 ? 1e-5 : 0.01 * size / speed;
  return smaller(larger(h, 1e-9), 0.1 * span);
}

/// Longest first step after an element has met another piece: half a radian of the swing of what it joins on its own
/// stiffness. An implicit step much longer would damp a whole collision away unseen. docs/theory/events.md, rule 13
template <class Form>
double collision_step(Form& form, int k) {
  const auto& ws = form.ws;
  const auto& b = ws.branch[k];
  if (b.law >= 0) return infinity;
  double square = 0;
  if constexpr (Form::full) {
    square = swing_whole(form, k);
  } else {
    double stiffness = 0;
    for (int s = 0; s < b.states; ++s)
      stiffness += abs(value(ws.jacobian.f_state[b.state + s] * ws.jacobian.g_rate[b.state + s]));
    square = stiffness * value(ws.geometry.own[b.direction]);
  }
  return square > 0 ? 0.5 / sqrt(square) : infinity;
}

/// Whether steps are short enough for the quadrature of the work.
template <class T>
CLUTCHWORK_INLINE bool resolves_work(const Workspace<T>& ws) {
  if constexpr (has_tangents<T>) {
    if (ws.moved.work_left_out) return true;
  }
  return ws.options.work;
}

/// Longest step that resolves the oscillating signals and elements, which the error estimate may not see: with work
/// half a radian of a sine or half a time constant of a decay, for the quadrature; else what the samples of the guards
/// need.
/// docs/theory/events.md, rule 6
template <class T>
double signal_step(const Workspace<T>& ws) {
  double fastest = 0;
  for (int k = 0; k < ws.in.n_varying; ++k) {
    const auto& signal = ws.in.signal[ws.in.ref_signal[ws.in.varying[k]]];
    if (!signal.linear) fastest = larger(fastest, segment_rate(signal.coef, ws.time - value(signal.start)));
  }
  if constexpr (!has_lanes<T>) {
    for (int i = 0; i < ws.guard.n_switching; ++i) {
      const int k = ws.guard.switching[i];
      if (ws.branch[k].law < 0) fastest = larger(fastest, own_pace(ws, ws.branch[k], ws.step_start.rate[k]));
    }
  }
  return fastest > 0 ? (resolves_work(ws) ? 0.5 : 1.5) / fastest : infinity;
}

/// Error of the work over a step in units of the tolerance, by halving. Where speeds are prescribed no state may feel
/// the torque, so nothing else keeps the steps short enough for the quadrature. Next to an end no point sees a bend:
/// there the cubics through the points of the step and of its halves miss the power by as much, in place of a
/// sixteenth. docs/theory/integrators.md (16)
template <class Form>
[[gnu::noinline]] double work_error(Form& form, Step<Form>& step) {
  using T = typename Form::Scalar;
  // of the step times what a cubic misses at the end: at most so much is unseen; of what the longer one misses
  constexpr double unseen = 0.02, as_much = 0.25;
  Workspace<T>& ws = form.ws;
  fit(form, step);
  T *whole = ws.out.whole, *halves = ws.out.halves;
  T *missed = ws.out.missed, *by_half = missed + 2 * ws.n_branches;
  for (int k = 0; k < ws.n_branches; ++k) whole[k] = halves[k] = T(0);
  for (int k = 0; k < 4 * ws.n_branches; ++k) missed[k] = T(0);
  // the step, its first half, its second one: of the step both ends are looked at, of each half that of the step
  for (int part = 0; part < 3; ++part) {
    const double start = part == 2 ? 0.5 : 0.0, width = part == 0 ? 1.0 : 0.5;
    T *sum = part == 0 ? whole : halves, *at = part == 0 ? missed : by_half;
    for (int g = 0; g < 4; ++g) {
      const auto& c = gauss.coef[g];
      step.calls->observe(form, step, start + width * gauss.node[g]);
      for (int k = 0; k < ws.n_branches; ++k) {
        const T power = ws.observed.torque[k] * ws.observed.rate[k];
        sum[k] += T(width * step.h * gauss.weight[g]) * power;
        if (part < 2) at[k] += T(c[0]) * power;
        if (part != 1) at[ws.n_branches + k] += T(c[0] + c[1] + c[2] + c[3]) * power;
      }
    }
  }
  double error = 0;
  for (int end = 0; end < 2; ++end) {
    step.calls->observe(form, step, end);
    for (int k = 0; k < ws.n_branches; ++k) {
      const T power = ws.observed.torque[k] * ws.observed.rate[k];
      const int i = end * ws.n_branches + k;
      const double done = value(ws.work[ws.branch[k].direction]);
      const double tolerance = ws.options.atol + ws.options.rtol * (abs(done) + abs(value(halves[k])));
      const double longer = abs(value(missed[i] - power)), shorter = abs(value(by_half[i] - power));
      error = larger(error, abs(value(whole[k] - halves[k])) / tolerance);
      if (shorter > as_much * longer) error = larger(error, unseen * step.h * shorter / tolerance);
    }
  }
  return error;
}

/// Rates and torques of the branches at the share s of a step, in ws.observed; the state there is step.point().
template <class Form>
[[gnu::noinline]] void observe_inside(Form& form, Step<Form>& step, double s) {
  interpolate(form, step, s, step.point());
  observe(form, step.t + s * step.h, step.point(), step.slope());
}

/// Whether all of a state is finite.
template <class T>
CLUTCHWORK_INLINE Truth<T> all_finite(int n, const T* y) {
  Real<T> sum = 0;
  for (int i = 0; i < n; ++i) sum += value(y[i]) * 0;
  return sum == 0;
}

/// Whether a sliding contact loses more than half of its slip in a step.
template <class T>
CLUTCHWORK_INLINE Truth<T> nears_rest(const Workspace<T>& ws) {
  Truth<T> slides_on(true);
  for (int k = 0; k < ws.n_branches; ++k) {
    if (ws.branch[k].law < 0 || ws.branch[k].compliant) continue;
    slides_on = slides_on && abs(value(ws.step_end.rate[k])) >= Real<T>(0.5) * abs(value(ws.step_start.rate[k]));
  }
  return !slides_on;
}

/// Name the branch whose torque is not finite.
template <class Form>
void blame(Form& form, Step<Form>& step) {
  auto& ws = form.ws;
  ws.detail.component = -1;
  observe(form, ws.time, step.y0(), step.slope());
  for (int k = 0; k < ws.n_branches; ++k) {
    const double x = value(ws.observed.torque[k]);
    if (x - x == 0) continue;
    ws.detail.component = ws.branch[k].direction;
    ws.detail.value = x;
    return;
  }
}

}  // namespace clutchwork

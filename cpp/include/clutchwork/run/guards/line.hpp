#pragma once
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/motion/mesh_loads.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/guards/inputs.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/locate.hpp>
#include <clutchwork/run/passive_events.hpp>
#include <clutchwork/workspace.hpp>

/// Guards that are linear in the state. docs/theory/events.md
namespace clutchwork {

/// First crossing of a guard that is linear in the state, before `limit`; -1: none. `rough`: there the interpolant is
/// off it, more than what counts as zero.
template <class Form>
double line_crossing(Form& form, Step<Form>& step, const LineGuard& guard, double g0, double g1, double noise,
                     double limit, bool& rough) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  fit(form, step);
  const int k = guard.branch;
  auto at = [&](double s) {
    interpolate(form, step, s, step.point());
    inputs_at(ws, step.t + s * step.h);
    return guard.sign * (value(form.rate(k, step.point()) + offset_rate(ws, k)) - guard.level);
  };
  const double q0 = guard.sign * value(form.rate(k, step.p(0))), q1 = guard.sign * value(form.rate(k, step.p(1))),
               q2 = guard.sign * value(form.rate(k, step.p(2)));
  // prescribed speeds that bend between both ends are no part of the interpolant
  const bool bend = rates_bend(ws);
  if (bend) input_slopes_at(ws, step.t);
  const double drift = bend ? guard.sign * step.h * value(offset_slope(ws, k)) : 0.0;
  const double change = bend ? guard.sign * value(form.rate(k, step.y1()) - form.rate(k, step.y0())) : g1 - g0;
  const double a1 = change + q0, a2 = q1 - q0, a3 = q2 - q1;
  // a guard that starts on its surface must leave it as the motion does, not as the interpolant does
  // docs/theory/events.md, rule 3
  const bool fresh = abs(g0) <= 1e3 * noise;
  const double leaving = guard.sign * step.h * value(ws.step_start.slope[k]);
  const double mend = fresh && leaving * (a1 + drift) <= 0 ? leaving - drift - a1 : 0.0;
  auto added = [&](double s) { return mend * s * (1 - s) * (1 - s) * (1 - s); };
  if (bend) {
    const double still = fresh ? noise : 0.0;
    auto mended = [&](double s) { return at(s) + still + added(s); };
    const double s = first_crossing(mended, g0 + still, g1 + still, limit);
    rough = s >= 0 && abs(added(s)) > 1e5 * noise;
    return s;
  }
  // Bernstein coefficients of the quartic
  double b[5] = {larger(g0, 0.0), g0 + (a1 + mend) / 4, g0 + a1 / 2 + a2 / 6, g0 + 0.75 * a1 + a2 / 2 + a3 / 4, g1};
  double scale = 0;
  for (double x : b) scale = larger(scale, abs(x));
  double low = 0, high = 1;
  if (!first_bracket(b, larger(1e-9 * scale, noise), 40, g1 < (fresh ? -noise : 0.0), low, high)) return -1;
  const double start = larger(g0, 0.0);
  auto poly = [&](double s) {
    const double r = 1 - s;
    return r * start + s * (g1 + r * (q0 + s * (q1 + s * q2) + r * r * mend));
  };
  const double f_low = larger(poly(low), 0.0), f_high = poly(high);
  if (f_high >= 0) return high;
  // one that leaves its surface may come back far sooner than the step ends
  const double s = locate(poly, low, f_low, high, f_high, fresh && leaving > 0 ? 50 : 12);
  rough = abs(added(s)) > 1e5 * noise;
  return s <= limit ? s : -1;
}

/// Whether a cubic through values and slopes proves that branch k stays on its side of a level; its distances at both
/// ends. One that swings far beyond their sum proves nothing: a stiff motion may swing more than once.
template <class T>
CLUTCHWORK_INLINE Truth<T> stays_clear(const Workspace<T>& ws, int k, Real<T> sign, Real<T> level, Real<T> h,
                                       Real<T> noise, Real<T>& g0, Real<T>& g1) {
  const auto &e0 = ws.step_start, &e1 = ws.step_end;
  g0 = sign * (value(e0.rate[k]) - level), g1 = sign * (value(e1.rate[k]) - level);
  // a start behind the surface, within what counts as zero, is on it: docs/theory/events.md, rule 4
  const Real<T> shift = select(g0 < 0, smaller(-g0, 1e3 * noise), Real<T>(0));
  g0 += shift, g1 += shift;
  const Real<T> c0 = g0 + sign * h * value(e0.slope[k]) / 3, c1 = g1 - sign * h * value(e1.slope[k]) / 3;
  return g1 >= 0 && c0 >= 0 && c1 >= 0 && c0 + c1 <= 4 * (g0 + g1);
}

/// Whether a rate stays where it is over the step, but for round-off of the torques: what is held rigidly at a kink.
template <class T>
bool idles(const Workspace<T>& ws, const LineGuard& guard, double h, double g0, double g1) {
  if (guard.kind != LineGuard::edge) return false;
  const auto &e0 = ws.step_start, &e1 = ws.step_end;
  const double own = value(ws.geometry.own[ws.branch[guard.branch].direction]);
  const double still = 1e-6 * ws.guard.zero + 1e-14 * h * torque_size(ws) * own;
  const double moves = h * larger(abs(value(e0.slope[guard.branch])), abs(value(e1.slope[guard.branch])));
  return larger(larger(abs(g0), abs(g1)), moves) <= still;
}

/// Whether a slip comes back at the instant at which it was let go, in a step that is too long to tell: what sets off
/// without an acceleration is beside the error of such a step. docs/theory/events.md, rule 3
template <class Form>
bool returns_at_once(const Workspace<typename Form::Scalar>& ws, const LineGuard& guard, const Step<Form>& step,
                     double s) {
  constexpr double shortest = 1e-8;
  if (guard.kind != LineGuard::slip || step.h <= shortest || s * step.h > 0.1 * shortest) return false;
  return stands_since(ws, ws.contact.met_at[ws.branch[guard.branch].direction - int(ws.sys.elements)]);
}

/// A zero of a line guard beside transmissions, found at s on the interpolant, where the state on their ties has it: by
/// secants nearby. docs/theory/varying-ratios.md (9)
template <class Form>
[[gnu::noinline]] double crossing_on_ties(Form& form, Step<Form>& step, const LineGuard& guard, double noise,
                                          double s) {
  constexpr int rounds = 6;
  constexpr double near = 0.05, apart = 1e-4;
  auto& ws = form.ws;
  auto at = [&](double x) {
    const double t = step.t + x * step.h;
    interpolate(form, step, x, step.point());
    observe(form, t, step.point(), step.slope());
    settle_ties(form, step.point());
    inputs_at(ws, t);
    return guard.sign * (value(form.rate(guard.branch, step.point()) + offset_rate(ws, guard.branch)) - guard.level);
  };
  double x = s, before = s * (1 - apart), f = at(x), f_before = at(before), best = s, least = abs(f);
  for (int k = 0; k < rounds && abs(f) > noise; ++k) {
    const double next = x - f * (x - before) / (f - f_before);
    if (!(next > 0 && next < 1 && abs(next - s) <= near)) return s;
    before = x, f_before = f, x = next, f = at(x);
    if (abs(f) < least) best = x, least = abs(f);
  }
  return best;
}

/// Level of a line guard with its derivatives.
template <class T>
T level_of(const Workspace<T>& ws, const LineGuard& guard) {
  const Branch<T>& b = ws.branch[guard.branch];
  const int d = b.direction, c = d - int(ws.sys.elements);
  if (guard.kind == LineGuard::edge) {
    const int sign = b.law >= 0 ? b.sign : 1, interval = b.piece % (edge_count(ws, d) + 1);
    return T(sign) * edge_at(ws, d, guard.sign == -sign ? interval : interval - 1);
  }
  // one that was forced to slip, or that is driven, is watched at zero
  const bool own = guard.kind == LineGuard::slip && abs(guard.level) == value(ws.sys.contact_tolerance[c]);
  return own ? T(guard.sign) * T(ws.sys.contact_tolerance[c]) : T(guard.level);
}

/// Slips that end, kinks over a rate, reversals, open contacts that pass zero: linear in the state.
struct LineCrossing {
  static constexpr const char* name = "line";
  static constexpr Effect effect = Effect::decides;

  template <class T>
  static bool watches(const Workspace<T>& ws) {
    return ws.guard.n_lines > 0;
  }
  /// Call f for each kink; a slip that is zero where a run begins is seen by its contact.
  template <class T, class F>
  static void each_border(const Workspace<T>& ws, F&& f) {
    for (int i = 0; i < ws.guard.n_lines; ++i) {
      if (ws.guard.line[i].kind == LineGuard::edge) f(i);
    }
  }
  template <class Form>
  CLUTCHWORK_INLINE static void find(Form& form, Step<Form>& step, Hit& hit) {
    auto& ws = form.ws;
    // round-off of a rate: far below the slip that counts as zero
    const double noise = 1e-3 * ws.guard.zero;
    for (int i = 0; i < ws.guard.n_lines; ++i) {
      const LineGuard& g = ws.guard.line[i];
      double g0, g1;
      if (stays_clear(ws, g.branch, g.sign, g.level, step.h, noise, g0, g1) || idles(ws, g, step.h, g0, g1)) continue;
      bool rough = false;
      double s = line_crossing(form, step, g, g0, g1, noise, hit.s, rough);
      if constexpr (Form::full) {
        if (ws.ratios.n > 0 && s > 0 && s < 1) s = crossing_on_ties(form, step, g, noise, s);
      }
      if (hit.take(s, i)) hit.rough = rough || returns_at_once(ws, g, step, s);
    }
  }
  template <class Form, class T = typename Form::Scalar>
  static T at(Form& form, Step<Form>&, const Hit& hit, double t, const T* y, int&) {
    const LineGuard& guard = form.ws.guard.line[hit.index];
    inputs_of(form, t, y);
    return T(guard.sign) * (form.rate(guard.branch, y) + offset_rate(form.ws, guard.branch) - level_of(form.ws, guard));
  }
  template <class Form, class T = typename Form::Scalar>
  static double scale(Form& form, const Hit& hit, const T* y) {
    auto& ws = form.ws;
    double size = form.rate_size(ws.guard.line[hit.index].branch, y);
    for (int i = 0; i < ws.sys.speeds; ++i) size = larger(size, 0.1 * abs(value(ws.v[i])));
    return larger(size, 1.0);
  }
  /// That of the motion, where nothing else moves it.
  template <class Form, class T = typename Form::Scalar>
  static bool rate(Form& form, const Hit& hit, const T* velocity, double& slope) {
    const LineGuard& guard = form.ws.guard.line[hit.index];
    slope = guard.sign * value(form.rate(guard.branch, velocity));
    return form.ws.sys.prescribed == 0;
  }
  template <class T>
  static int component(const Workspace<T>& ws, const Hit& hit) {
    return ws.branch[ws.guard.line[hit.index].branch].direction;
  }
  template <class Phase>
  static void settle(Phase& phase, const Hit& hit) {
    auto& ws = phase.ws();
    const LineGuard& guard = ws.guard.line[hit.index];
    if (guard.kind == LineGuard::slip)
      return phase.decide(Cause::slip_zero, ws.branch[guard.branch].direction - int(ws.sys.elements));
    if (guard.kind == LineGuard::turn) {
      if (!pass_law(phase.form(), phase.step(), guard.branch, hit.who)) return phase.leave(Status::zeno);
      return phase.go_on(true);
    }
    const int d = component(ws, hit);
    const bool jumps =
        guard.kind == LineGuard::edge && may_jump(ws, d) && jumps_between(ws, d, ws.piece[d], guard.sign < 0 ? 1 : -1);
    pass_line(phase.form(), guard);
    phase.go_on(jumps);
  }
};

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/input.hpp>
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/break_away.hpp>
#include <clutchwork/run/gaps.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/loads.hpp>
#include <clutchwork/run/locate.hpp>
#include <clutchwork/run/processes.hpp>
#include <clutchwork/workspace.hpp>

/// Where inside a step something changes: docs/theory/events.md.
namespace clutchwork {

/// Whether any prescribed speed varies, so that rates are no polynomials.
template <class T>
bool rates_bend(const Workspace<T>& ws) {
  for (int p = 0; p < ws.sys.prescribed; ++p) {
    if (ws.in.signal[ws.sys.prescribed_input[p]].varying) return true;
  }
  return false;
}

/// First crossing of a guard that is linear in the state, before `limit`; -1: none.
template <class Form>
double line_crossing(Form& form, Step<Form>& step, const LineGuard& guard, double g0, double g1, double noise,
                     double limit) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  fit(form, step);
  const int k = guard.branch;
  auto at = [&](double s) {
    interpolate(form, step, s, step.point());
    inputs_at(ws, step.t + s * step.h);
    return guard.sign * (value(form.rate(k, step.point()) + offset_rate(ws, k)) - guard.level);
  };
  if (rates_bend(ws)) return first_crossing(at, g0, g1, limit);
  // Bernstein coefficients of the quartic
  const double q0 = guard.sign * value(form.rate(k, step.p(0))), q1 = guard.sign * value(form.rate(k, step.p(1))),
               q2 = guard.sign * value(form.rate(k, step.p(2)));
  const double a1 = g1 - g0 + q0, a2 = q1 - q0, a3 = q2 - q1;
  // a guard that starts on its surface must leave it as the motion does, not as the interpolant does
  // docs/theory/events.md, rule 3
  const bool fresh = abs(g0) <= 1e3 * noise;
  const double leaving = guard.sign * step.h * value(ws.here.slope[k]);
  const double mend = fresh && leaving * a1 <= 0 ? leaving - a1 : 0.0;
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
  const double s = locate(poly, low, f_low, high, f_high);
  return s <= limit ? s : -1;
}

/// Whether some inputs follow the state, so that they are known inside a step from its interpolant alone.
template <class T>
bool inputs_follow(const Workspace<T>& ws) {
  return ws.in.n_shared_refs > 0 || ws.in.n_rate_refs > 0;
}

/// All inputs at the share s of a step.
template <class Form>
void inputs_in(Form& form, Step<Form>& step, double s) {
  auto& ws = form.ws;
  const double t = step.t + s * step.h;
  if (!inputs_follow(ws)) return inputs_at(ws, t);
  interpolate(form, step, s, step.point());
  inputs_of(form, t, step.point());
}

/// Time derivatives of the inputs that are rates, at the share s of a step.
template <class Form>
void slopes_in(Form& form, Step<Form>& step, double s) {
  auto& ws = form.ws;
  interpolate_slope(form, step, s, step.slope());
  input_slopes_at(ws, step.t + s * step.h);
  rate_slopes(ws, [&](int k) { return form.rate(k, step.slope()) + offset_slope(ws, k); });
}

/// Where a contact fails.
template <class Form>
void find_fault(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  if (inputs_follow(ws)) fit(form, step);
  for (int i = 0; i < ws.guard.n_faulty; ++i) {
    const int c = ws.guard.faulty[i];
    if (ws.contact.fault[c] != sound) continue;
    auto f = [&](double s) {
      inputs_in(form, step, s);
      return -fault_trigger(ws, c);
    };
    const double s = first_crossing(f, f(0), f(1), hit.s);
    if (!is_first(hit, s)) continue;
    fit(form, step);
    hit = {Hit::fault, c, s, -1};
  }
}

/// Where the law of a contact, locked or not, leaves a table that may not be left.
template <class Form>
void find_exit(Form& form, Step<Form>& step, Hit& hit) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  for (int i = 0; i < ws.guard.n_bounded; ++i) {
    const int c = ws.guard.bounded[i], k = ws.branch_of[ws.sys.elements + c];
    T seen = T(0);
    auto room = [&](double s, const T* y) {
      inputs_of(form, step.t + s * step.h, y);
      const T slip = k < 0 ? T(0) : form.rate(k, y) + offset_rate(ws, k);
      return value(table_room(ws, c, slip, seen));
    };
    const double start = room(0, step.y0()), end = room(1, step.y1());
    if (start >= 0 && end >= 0) continue;
    fit(form, step);
    auto f = [&](double s) {
      interpolate(form, step, s, step.point());
      return room(s, step.point());
    };
    const double s = start < 0 ? 0.0 : first_crossing(f, start, end, hit.s);
    if (!is_first(hit, s)) continue;
    f(s);
    ws.detail.value = value(seen);
    hit = {Hit::exit, c, s, -1};
  }
}

/// Where the law or the element of a branch leaves its piece, -1: not before what was hit; `who` leaves. Branch k has
/// its rates in the motion, one below zero is at rest.
template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] double piece_end(Form& form, Step<Form>& step, const Branch<T>& b, int k, const Hit& hit, int& who) {
  Workspace<T>& ws = form.ws;
  const int nz = form.nz();
  // round-off of a margin: a state at its limit has not passed it. docs/theory/events.md, rule 12
  constexpr double noise = 1e-12;
  const T still[most_ways] = {};
  auto at_end = [&](double t, const T* y, const T* f, const Edge<T>& edge) {
    inputs_of(form, t, y);
    rate_slopes(ws, [&](int j) { return edge.slope[j]; });
    const T *rate = k < 0 ? still : edge.rate + k, *slope = k < 0 ? still : edge.slope + k;
    return law_margin(ws, b, rate, slope, y + nz, f + nz, who);
  };
  const auto start = at_end(step.t, step.y0(), step.f0(), ws.here);
  const auto end = at_end(step.t + step.h, step.y1(), step.f1(), ws.there);
  const double change = abs(value(end.v - start.v));
  const double drift = step.h * larger(abs(value(start.d[0])), abs(value(end.d[0])));
  if (smaller(value(start.v), value(end.v)) > larger(change, drift)) return -1;
  fit(form, step);
  auto f = [&](double s) {
    interpolate(form, step, s, step.point());
    inputs_of(form, step.t + s * step.h, step.point());
    if (ws.in.n_rate_refs > 0) slopes_in(form, step, s);
    T rate[most_ways] = {};
    for (int w = 0; k >= 0 && w < b.ways; ++w) rate[w] = form.rate(k + w, step.point()) + offset_rate(ws, k + w);
    return noise + value(law_margin(ws, b, rate, still, step.point() + nz, step.f0() + nz, who).v);
  };
  const double s = first_crossing(f, noise + value(start.v), noise + value(end.v), hit.s);
  if (is_first(hit, s)) f(s);
  return s;
}

/// Where the laws of compliant contacts and the pieces of elements change.
template <class Form>
void find_law_hit(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  for (int i = 0; i < ws.guard.n_switching; ++i) {
    const int k = ws.guard.switching[i];
    int who = turned;
    const double s = piece_end(form, step, ws.branch[k], k, hit, who);
    if (is_first(hit, s)) hit = {Hit::law, k, s, who};
  }
}

/// Where the capacity of a locked contact bends, for its law is a table over what changes while it holds.
/// docs/theory/events.md, rule 12
template <class Form>
[[gnu::noinline]] void find_bend(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  for (int i = 0; i < ws.guard.n_bending; ++i) {
    const int c = ws.guard.bending[i];
    int who = turned;
    const double s = piece_end(form, step, make_branch(ws, int(ws.sys.elements) + c, forward), -1, hit, who);
    if (is_first(hit, s)) hit = {Hit::bend, c, s, who};
  }
}

/// Where processes leave their pieces. docs/theory/events.md, rule 12
template <class Form>
[[gnu::noinline]] void find_process_hit(Form& form, Step<Form>& step, Hit& hit) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  const int nz = form.nz();
  constexpr double noise = 1e-12;
  for (int i = 0; i < ws.guard.n_processes; ++i) {
    const int c = ws.guard.process[i];
    int who = 0;
    auto at_end = [&](double t, const T* y, const T* f, const Edge<T>& edge) {
      auto rate = [&](int d, T& slope) {
        const int k = ws.branch_of[d];
        if (k < 0 || k >= ws.n_branches) return T(0);
        return slope = edge.slope[k], edge.rate[k];
      };
      return process_margin(ws, c, t, y + nz, f + nz, rate, who);
    };
    const auto start = at_end(step.t, step.y0(), step.f0(), ws.here);
    const auto end = at_end(step.t + step.h, step.y1(), step.f1(), ws.there);
    const double change = abs(value(end.v - start.v));
    const double drift = step.h * larger(abs(value(start.d[0])), abs(value(end.d[0])));
    if (smaller(value(start.v), value(end.v)) > larger(change, drift)) continue;
    fit(form, step);
    auto f = [&](double s) {
      const double t = step.t + s * step.h;
      interpolate(form, step, s, step.point());
      inputs_at(ws, t);
      auto rate = [&](int d, T&) {
        const int k = ws.branch_of[d];
        return k < 0 || k >= ws.n_branches ? T(0) : form.rate(k, step.point()) + offset_rate(ws, k);
      };
      return noise + value(process_margin(ws, c, t, step.point() + nz, step.f0() + nz, rate, who).v);
    };
    const double s = first_crossing(f, noise + value(start.v), noise + value(end.v), hit.s);
    if (!is_first(hit, s)) continue;
    f(s);
    hit = {Hit::process, c, s, who};
  }
}

/// Whether a cubic through values and slopes proves that branch k stays on its side of a level; its distances at both
/// ends.
template <class T>
CLUTCHWORK_INLINE Truth<T> stays_clear(const Workspace<T>& ws, int k, Real<T> sign, Real<T> level, Real<T> h,
                                       Real<T> noise, Real<T>& g0, Real<T>& g1) {
  const auto &e0 = ws.here, &e1 = ws.there;
  g0 = sign * (value(e0.rate[k]) - level), g1 = sign * (value(e1.rate[k]) - level);
  // a start behind the surface, within what counts as zero, is on it: docs/theory/events.md, rule 4
  const Real<T> shift = select(g0 < 0, smaller(-g0, 1e3 * noise), Real<T>(0));
  g0 += shift, g1 += shift;
  const Real<T> c0 = g0 + sign * h * value(e0.slope[k]) / 3, c1 = g1 - sign * h * value(e1.slope[k]) / 3;
  return g1 >= 0 && c0 >= 0 && c1 >= 0;
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

/// Slips and kinks.
template <class Form>
CLUTCHWORK_INLINE void find_line(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  // round-off of a rate: far below the slip that counts as zero
  const double noise = 1e-3 * ws.guard.zero;
  for (int i = 0; i < ws.guard.n_lines; ++i) {
    const LineGuard& g = ws.guard.line[i];
    double g0, g1;
    if (stays_clear(ws, g.branch, g.sign, g.level, step.h, noise, g0, g1)) continue;
    double s = line_crossing(form, step, g, g0, g1, noise, hit.s);
    if constexpr (Form::full) {
      if (ws.ratios.n > 0 && s > 0 && s < 1) s = crossing_on_ties(form, step, g, noise, s);
    }
    if (is_first(hit, s)) hit = {Hit::line, i, s, -1};
  }
}

/// List the loads that may pass zero in the step at whose end the inputs are; bounds prove most of them clear.
template <class T>
void list_near_loads(Workspace<T>& ws, double h) {
  ws.guard.n_near = 0;
  for (int i = 0; i < ws.guard.n_loads; ++i) {
    if (!load_stays(ws, ws.guard.load[i], h)) ws.guard.near[ws.guard.n_near++] = ws.guard.load[i];
  }
}

/// Where the load of a contact passes zero.
template <class Form>
void find_load(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  for (int i = 0; i < ws.guard.n_near; ++i) {
    const int c = ws.guard.near[i];
    const double sign = ws.contact.pressed[c] ? 1.0 : -1.0;
    // where it has just passed zero it must leave it before it passes again
    inputs_in(form, step, 0.0);
    const double least = load_noise * ws.guard.load_size[c];
    const bool grazes = step.t - ws.guard.turned_at[c] <= 1e-3 && abs(value(load_of(ws, c))) <= least;
    const double noise = grazes ? least : 0.0, still = load_at_rest(ws, c);
    auto f = [&](double s) {
      inputs_in(form, step, s);
      return sign * value(load_of(ws, c)) + noise;
    };
    if (inputs_follow(ws)) fit(form, step);
    const double l0 = f(0), l1 = f(1);
    // one that has died away with a speed or a state does not pass zero by round-off
    if (abs(l0 - noise) <= still && abs(l1 - noise) <= still) continue;
    const double s = first_crossing(f, l0, abs(l1) <= 1e-12 * abs(l0) ? 0.0 : l1, hit.s);
    if (!is_first(hit, s)) continue;
    fit(form, step);
    hit = {Hit::load, c, s, -1};
  }
}

/// Where a load passes to the other line of the bound with which its contact slips. docs/theory/load-dependent.md, rule
/// 1
template <class Form>
[[gnu::noinline]] void find_flip(Form& form, Step<Form>& step, Hit& hit) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  for (int i = 0; i < ws.loads.n_sliding; ++i) {
    const int l = ws.loads.sliding[i], k = ws.loads.branch[i];
    const double start = value(ws.here.clearance[l]), end = value(ws.there.clearance[l]);
    const double drift = step.h * larger(abs(value(ws.here.closing[l])), abs(value(ws.there.closing[l])));
    if (smaller(start, end) > larger(abs(end - start), drift)) continue;
    fit(form, step);
    const double noise = 1e-12 * torque_size(ws);
    auto f = [&](double s) {
      torques_at(form, step, s);
      T by_load = T(0);
      return noise + value(line_clearance(ws, l, ws.seen.rate[k], by_load));
    };
    const double s = first_crossing(f, noise + start, noise + end, hit.s);
    if (is_first(hit, s)) hit = {Hit::flip, l, s, -1};
  }
}

/// First guard that turns negative inside the step.
template <class Form>
CLUTCHWORK_INLINE Hit find_hit(Form& form, Step<Form>& step) {
  auto& ws = form.ws;
  Hit hit;
  // before other guards move the inputs from the end of the step
  list_near_loads(ws, step.h);
  find_line(form, step, hit);
  if (ws.guard.n_switching > 0) find_law_hit(form, step, hit);
  if (ws.guard.n_bending > 0) find_bend(form, step, hit);
  if (ws.guard.n_processes > 0) find_process_hit(form, step, hit);
  if (ws.held.n > 0) find_break_away(form, step, hit);
  if (ws.held.n_sets > 0) find_set_limit(form, step, hit);
  if (ws.held.n_driven > 0) find_parting(form, step, hit);
  if (ws.guard.n_faulty > 0) find_fault(form, step, hit);
  if (ws.guard.n_bounded > 0) find_exit(form, step, hit);
  if (ws.loads.n_sliding > 0) find_flip(form, step, hit);
  if (ws.guard.n_near > 0) find_load(form, step, hit);
  if (ws.guard.n_gaps > 0) find_gap(form, step, hit);
  return hit;
}

}  // namespace clutchwork

#pragma once
#include <clutchwork/contacts/stops.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/locate.hpp>
#include <clutchwork/workspace.hpp>

/// Where in a step an open stop meets an end. docs/theory/play.md
namespace clutchwork {

/// Distance of a position from an end over a step, as a quartic in Bernstein form.
struct GapGuard {
  double b[5];

  double at(double s) const {
    const double r = 1 - s;
    return r * r * r * (r * b[0] + 4 * s * b[1]) + s * s * (6 * r * r * b[2] + s * (4 * r * b[3] + s * b[4]));
  }
  /// One that starts at zero leaves it as the motion does, with its slope over the step, not as the interpolant does.
  void mend(double slope) {
    if (slope * b[1] <= 0) b[1] = slope / 4;
  }
  /// First zero, before `limit`; -1: there is none.
  double crossing(bool fresh, double noise, double limit) const {
    double scale = 0, low = 0, high = 1;
    for (double x : b) scale = larger(scale, abs(x));
    if (!first_bracket(b, larger(1e-9 * scale, noise), 40, b[4] < (fresh ? -noise : 0.0), low, high)) return -1;
    const double f_low = larger(at(low), 0.0), f_high = at(high);
    // a bounce may be far shorter than the step
    const double s = f_high >= 0 ? high : locate([&](double x) { return at(x); }, low, f_low, high, f_high, 50);
    return s <= limit ? s : -1;
  }
  /// The same for one that starts at zero and at rest, which only leaves it as far as the steps can tell: dips by what
  /// these miss do not count.
  double late_crossing(double missed, double noise, double limit) const {
    const GapGuard lifted{{b[0], larger(b[1], 0.0) + missed, larger(b[2], 0.0) + missed, b[3] + missed, b[4]}};
    const double end = lifted.crossing(true, noise, limit);
    if (end < 0) return end;
    double top = 0;
    for (int i = 1; i < 16; ++i) {
      if (at(i * end / 16) > at(top)) top = i * end / 16;
    }
    const double f_top = at(top), f_end = at(end);
    return f_top > noise && f_end < 0 ? locate([&](double x) { return at(x); }, top, f_top, end, f_end) : end;
  }
};

/// Where the position of stop c meets its end on a side, before `limit`; -1: it does not. docs/theory/play.md
template <class Form>
double gap_crossing(Form& form, Step<Form>& step, int c, int side, double limit) {
  auto& ws = form.ws;
  const int i = form.nz() + place_of(ws, c), k = ws.branch_of[ws.sys.contact_place[c]];
  const double end = value(stop_end(ws, c, side)), noise = stop_noise(ws, c);
  if (!(abs(end) < infinity)) return -1;
  double g0 = side * (end - value(step.y0()[i])), g1 = side * (end - value(step.y1()[i]));
  const double leaves = -side * step.h * value(ws.step_start.rate[k]),
               arrives = -side * step.h * value(ws.step_end.rate[k]);
  // a start behind the end, within round-off, is on it
  if (g0 < 0) g1 -= g0, g0 = 0;
  if (g1 >= 0 && g0 + leaves / 3 >= 0 && g1 - arrives / 3 >= 0) return -1;
  fit(form, step);
  const double q0 = -side * value(step.p(0)[i]), q1 = -side * value(step.p(1)[i]), q2 = -side * value(step.p(2)[i]);
  const double a1 = g1 - g0 + q0, a2 = q1 - q0, a3 = q2 - q1;
  GapGuard guard{{g0, g0 + a1 / 4, g0 + a1 / 2 + a2 / 6, g0 + 0.75 * a1 + a2 / 2 + a3 / 4, g1}};
  const bool fresh = g0 <= noise, rests = abs(leaves) <= step.h * ws.guard.zero;
  if (fresh && rests) return guard.late_crossing(ws.options.rtol * abs(end) + ws.options.atol, noise, limit);
  if (fresh) guard.mend(leaves);
  return guard.crossing(fresh, noise, limit);
}

/// Where a stop that is open meets an end.
struct GapEnd : OfContact {
  static constexpr const char* name = "gap";
  static constexpr Effect effect = Effect::other;

  template <class T>
  static bool watches(const Workspace<T>& ws) {
    return ws.guard.n_gaps > 0;
  }
  template <class T>
  static void watch(Workspace<T>& ws) {
    ws.guard.n_gaps = 0;
    for (int c = 0; c < ws.sys.contacts; ++c) {
      if (is_stop(ws, c) && ws.contact.side[c] == 0) ws.guard.gap[ws.guard.n_gaps++] = c;
    }
  }
  template <class Form>
  [[gnu::noinline]] static void find(Form& form, Step<Form>& step, Hit& hit) {
    auto& ws = form.ws;
    for (int g = 0; g < ws.guard.n_gaps; ++g) {
      const int c = ws.guard.gap[g];
      for (int side = -1; side <= 1; side += 2) {
        const double s = gap_crossing(form, step, c, side, hit.s);
        hit.take(s, c, side);
      }
    }
  }
  template <class Form, class T = typename Form::Scalar>
  static T at(Form& form, Step<Form>&, const Hit& hit, double, const T* y, int&) {
    const Workspace<T>& ws = form.ws;
    return T(hit.who) * (stop_end(ws, hit.index, hit.who) - y[form.nz() + place_of(ws, hit.index)]);
  }
  template <class Form, class T = typename Form::Scalar>
  static double scale(Form& form, const Hit& hit, const T* y) {
    return larger(1e-3, abs(value(y[form.nz() + place_of(form.ws, hit.index)])));
  }
  template <class Form, class T = typename Form::Scalar>
  static bool rate(Form& form, const Hit& hit, const T* velocity, double& slope) {
    slope = -hit.who * value(velocity[form.nz() + place_of(form.ws, hit.index)]);
    return true;
  }
  /// The position is at the end.
  template <class Form>
  static void arrive(Form& form, Step<Form>& step, const Hit& hit) {
    step.y0()[form.nz() + place_of(form.ws, hit.index)] = stop_end(form.ws, hit.index, hit.who);
  }
  template <class Phase>
  static void settle(Phase& phase, const Hit& hit) {
    phase.decide(Cause::impact, hit.index);
  }
};

}  // namespace clutchwork

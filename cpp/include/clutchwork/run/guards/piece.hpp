#pragma once
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/guards/inputs.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/locate.hpp>
#include <clutchwork/run/passive_events.hpp>
#include <clutchwork/run/step.hpp>
#include <clutchwork/workspace.hpp>

/// Ends of the pieces of laws and elements. docs/theory/events.md, rule 12
namespace clutchwork {

/// What a guard that starts on its border misses of the slope with which the motion leaves that, where the interpolant
/// goes beyond it, over the step; 0: it leaves as the motion does. `at`: the guard over a share of the step and a
/// state. docs/theory/events.md, rule 3
template <class Form>
double missed_slope(Form& form, Step<Form>& step, double start, auto&& at) {
  constexpr double near = 1e-5;
  auto *y = step.point(), *velocity = step.u();
  for (int i = 0; i < form.n(); ++i) velocity[i] = step.f0()[i];
  form.solve_mass(velocity);
  auto off = [&](double s, bool moves) {
    interpolate(form, step, s, y);
    for (int i = 0; moves && i < form.n(); ++i) {
      if constexpr (!Form::small) {
        if (i < form.nz() && is_massless(form.ws, i)) continue;
      }
      y[i] = step.y0()[i] + velocity[i] * (s * step.h);
    }
    return at(s, y) - start;
  };
  // free of the curvature
  auto slope = [&](bool moves) { return (4 * off(0.5 * near, moves) - off(near, moves)) / near; };
  const double leaves = slope(true), shown = slope(false);
  return leaves > 0 && shown <= 0 ? leaves - shown : 0.0;
}

/// Where the law or the element of a branch leaves its piece, -1: not before what was hit; `who` leaves. Branch k has
/// its rates in the motion, one below zero is at rest.
template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] double piece_end(Form& form, Step<Form>& step, const Branch<T>& b, int k, const Hit& hit, int& who) {
  Workspace<T>& ws = form.ws;
  const int nz = form.nz();
  // round-off of a margin: a state at its limit has not passed it. docs/theory/events.md, rule 12
  constexpr double noise = 1e-12, fresh = 1e-9;
  const T still[most_ways] = {};
  auto at_end = [&](double t, const T* y, const T* f, const StepEnd<T>& edge) {
    inputs_of(form, t, y);
    rate_slopes(ws, [&](int j) { return edge.slope[j]; });
    const T *rate = k < 0 ? still : edge.rate + k, *slope = k < 0 ? still : edge.slope + k;
    return law_margin(ws, b, rate, slope, y + nz, f + nz, who);
  };
  const auto start = at_end(step.t, step.y0(), step.f0(), ws.step_start);
  const auto end = at_end(step.t + step.h, step.y1(), step.f1(), ws.step_end);
  if (is_ample(value(start.v), value(end.v), value(start.d[0]), value(end.d[0]), step.h)) return -1;
  fit(form, step);
  // what passes rest does not stay there
  const T* moves = k < 0 ? still : ws.step_start.slope + k;
  auto margin = [&](double s, const T* y) {
    inputs_of(form, step.t + s * step.h, y);
    if (s > 0 && ws.in.n_rate_refs > 0) slopes_in(form, step, s);
    T rate[most_ways] = {};
    for (int w = 0; k >= 0 && w < b.ways; ++w) rate[w] = form.rate(k + w, y) + offset_rate(ws, k + w);
    return value(law_margin(ws, b, rate, moves, y + nz, step.f0() + nz, who).v);
  };
  const bool starts = abs(value(start.v)) <= fresh;
  const double mend = starts ? missed_slope(form, step, value(start.v), margin) : 0.0;
  auto f = [&](double s) {
    interpolate(form, step, s, step.point());
    const double r = 1 - s;
    return noise + margin(s, step.point()) + mend * s * r * r * r;
  };
  const double s = first_crossing(f, noise + value(start.v), noise + value(end.v), hit.s);
  if (hit.is_after(s)) f(s);
  return s;
}

/// The margin of the piece of a branch at (t, y); branch k has its rates in the motion, one below zero is at rest.
template <class Form, class T = typename Form::Scalar>
T piece_margin(Form& form, Step<Form>& step, int k, double t, const T* y, int& who) {
  Workspace<T>& ws = form.ws;
  const Branch<T>& b = ws.branch[k];
  inputs_of(form, t, y);
  T rate[most_ways];
  for (int w = 0; w < b.ways; ++w) rate[w] = form.rate(k + w, y) + offset_rate(ws, k + w);
  return law_margin(ws, b, rate, ws.step_start.slope + k, y + form.nz(), step.f0() + form.nz(), who).v;
}

/// Where the laws of compliant contacts and the pieces of elements change.
struct PieceEnd : OwnScale {
  static constexpr const char* name = "law";
  static constexpr Effect effect = Effect::next_piece;

  template <class T>
  static bool watches(const Workspace<T>& ws) {
    return ws.guard.n_switching > 0;
  }
  template <class T>
  static void watch(Workspace<T>& ws) {
    ws.guard.n_switching = 0;
    for (int k = 0; k < ws.n_branches; ++k) {
      if (is_switching(ws.branch[k])) ws.guard.switching[ws.guard.n_switching++] = k;
    }
  }
  template <class T, class F>
  static void each_border(const Workspace<T>& ws, F&& f) {
    for (int i = 0; i < ws.guard.n_switching; ++i) f(ws.guard.switching[i]);
  }
  template <class Form>
  [[gnu::noinline]] static void find(Form& form, Step<Form>& step, Hit& hit) {
    auto& ws = form.ws;
    for (int i = 0; i < ws.guard.n_switching; ++i) {
      const int k = ws.guard.switching[i];
      int who = turned;
      const double s = piece_end(form, step, ws.branch[k], k, hit, who);
      hit.take(s, k, who);
    }
  }
  template <class Form, class T = typename Form::Scalar>
  static T at(Form& form, Step<Form>& step, const Hit& hit, double t, const T* y, int& who) {
    return piece_margin(form, step, hit.index, t, y, who);
  }
  template <class T>
  static int component(const Workspace<T>& ws, const Hit& hit) {
    return ws.branch[hit.index].direction;
  }
  template <class Phase>
  static void settle(Phase& phase, const Hit& hit) {
    if (!pass_law(phase.form(), phase.step(), hit.index, hit.who)) return phase.leave(Status::zeno);
    // one that comes back at once has met an interpolant that is off the motion there: docs/theory/events.md, rule 13
    constexpr int few = 4;
    const bool back = phase.ws().events.crowd[component(phase.ws(), hit)] > few;
    const auto most = back ? larger(8 * hit.s, 1e-3) * phase.taken_step().h : infinity;
    phase.go_on(true, true);
    phase.limit_step([&] { return smaller(most, collision_step(phase.taken_form(), hit.index)); });
  }
};

/// Where the capacity of a locked contact bends, for its law is a table over what changes while it holds: up to there
/// the end of the step says nothing of what it holds. docs/theory/events.md, rule 12
struct CapacityBend : OwnScale {
  static constexpr const char* name = "bend";
  static constexpr Effect effect = Effect::other;

  template <class T>
  static bool watches(const Workspace<T>& ws) {
    return ws.guard.n_bending > 0;
  }
  template <class T>
  static void watch(Workspace<T>& ws) {
    ws.guard.n_bending = 0;
    for (int c = 0; c < ws.sys.contacts; ++c) {
      const bool bends = ws.contact.mode[c] == locked && is_settling_law(ws.sys.contact_law[c]);
      if (bends) ws.guard.bending[ws.guard.n_bending++] = c;
    }
  }
  template <class Form>
  [[gnu::noinline]] static void find(Form& form, Step<Form>& step, Hit& hit) {
    auto& ws = form.ws;
    for (int i = 0; i < ws.guard.n_bending; ++i) {
      const int c = ws.guard.bending[i];
      int who = turned;
      const double s = piece_end(form, step, make_branch(ws, int(ws.sys.elements) + c, forward), -1, hit, who);
      if (hit.take(s, c, who)) hit.held_bends = true;
    }
  }
  template <class T, class F>
  static void each_border(const Workspace<T>& ws, F&& f) {
    for (int i = 0; i < ws.guard.n_bending; ++i) f(ws.guard.bending[i]);
  }
  /// Of one that rests at a point of its table.
  template <class Form, class T = typename Form::Scalar>
  static T border(Form& form, Step<Form>& step, Hit& hit, double t, const T* y) {
    if (hit.who != resting) return T(1);
    auto& ws = form.ws;
    const T still[most_ways] = {};
    inputs_of(form, t, y);
    const Branch<T> b = make_branch(ws, int(ws.sys.elements) + hit.index, forward);
    return law_margin(ws, b, still, still, y + form.nz(), step.f0() + form.nz(), hit.who).v;
  }
  template <class T>
  static int component(const Workspace<T>& ws, const Hit& hit) {
    return int(ws.sys.elements) + hit.index;
  }
  /// No motion depends on it: it has no derivatives.
  template <class Form, class T = typename Form::Scalar>
  static T at(Form&, Step<Form>&, const Hit&, double, const T*, int&) {
    return T(0);
  }
  template <class Phase>
  static void settle(Phase& phase, const Hit& hit) {
    if (!pass_bend(phase.ws(), hit.index, hit.who)) return phase.leave(Status::zeno);
    phase.go_on(false);
  }
};

}  // namespace clutchwork

#pragma once
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/clamp_loads.hpp>
#include <clutchwork/run/guards/inputs.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/locate.hpp>
#include <clutchwork/workspace.hpp>

/// Loads of contacts that pass zero. docs/theory/events.md
namespace clutchwork {

/// List the loads that may pass zero in the step at whose end the inputs are; bounds prove most of them clear.
template <class T>
void list_near_loads(Workspace<T>& ws, double h) {
  ws.guard.n_near = 0;
  for (int i = 0; i < ws.guard.n_loads; ++i) {
    if (!load_stays(ws, ws.guard.load[i], h)) ws.guard.near[ws.guard.n_near++] = ws.guard.load[i];
  }
}

/// Where the load of a contact passes zero.
struct LoadZero : OfContact {
  static constexpr const char* name = "load";
  static constexpr Effect effect = Effect::decides;

  template <class T>
  static bool watches(const Workspace<T>& ws) {
    return ws.guard.n_near > 0;
  }
  /// Call f for each load that follows the motion and is zero.
  template <class T, class F>
  static void each_border(const Workspace<T>& ws, F&& f) {
    for (int i = 0; i < ws.guard.n_loads; ++i) {
      const int c = ws.guard.load[i];
      const double still = load_at_rest(ws, c);
      if (still > 0 && abs(value(load_of(ws, c))) <= still) f(c);
    }
  }
  template <class Form>
  [[gnu::noinline]] static void find(Form& form, Step<Form>& step, Hit& hit) {
    auto& ws = form.ws;
    for (int i = 0; i < ws.guard.n_near; ++i) {
      const int c = ws.guard.near[i];
      const double sign = ws.contact.pressed[c] ? 1.0 : -1.0;
      // where it has just passed zero it must leave it before it passes again
      inputs_in(form, step, 0.0);
      const double still = load_at_rest(ws, c), least = larger(load_noise * ws.guard.load_size[c], still);
      const bool grazes = step.t - ws.guard.turned_at[c] <= 1e-3 && abs(value(load_of(ws, c))) <= least;
      const double noise = grazes ? least : 0.0;
      auto f = [&](double s) {
        inputs_in(form, step, s);
        return sign * value(load_of(ws, c)) + noise;
      };
      if (inputs_follow(ws)) fit(form, step);
      const double l0 = f(0), l1 = f(1);
      // one that has died away with a speed or a state does not pass zero by round-off
      if (abs(l0 - noise) <= still && abs(l1 - noise) <= still) continue;
      const double s = first_crossing(f, l0, abs(l1) <= 1e-12 * abs(l0) ? 0.0 : l1, hit.s);
      if (hit.take(s, c)) fit(form, step), hit.load_ends = true;
    }
  }
  template <class Form, class T = typename Form::Scalar>
  static T at(Form& form, Step<Form>&, const Hit& hit, double t, const T* y, int&) {
    inputs_of(form, t, y);
    return load_of(form.ws, hit.index);
  }
  template <class Form, class T = typename Form::Scalar>
  static double scale(Form& form, const Hit& hit, const T*) {
    const auto& ws = form.ws;
    // of a load of no known size: what a state of its usual size makes of it
    const double size = ws.guard.load_size[hit.index], usual = 1e3 * load_at_rest(ws, hit.index) / ws.options.atol;
    return larger(size > 0 ? size : usual, 1e-300);
  }
  /// Whether a load that follows states has died away: errors of the steps alone place where it passes zero.
  /// docs/theory/gradients.md (3)
  template <class T>
  static bool has_faded(const Workspace<T>& ws, const Hit& hit, double rate, double scale) {
    constexpr double tolerances = 100, slow = 1e-3;
    if (abs(rate) > slow * scale) return false;
    return abs(rate) * ws.moved.span <= 1e3 * tolerances * load_at_rest(ws, hit.index);
  }
  template <class Phase>
  static void settle(Phase& phase, const Hit& hit) {
    phase.decide(Cause::input, hit.index);
    turn_load(phase.ws(), hit.index);
  }
};

}  // namespace clutchwork

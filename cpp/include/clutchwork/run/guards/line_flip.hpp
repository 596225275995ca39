#pragma once
#include <clutchwork/motion/mesh_loads.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/guards/inputs.hpp>
#include <clutchwork/run/guards/torques.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/locate.hpp>
#include <clutchwork/workspace.hpp>

/// Loads of contacts that follow torques. docs/theory/load-dependent.md
namespace clutchwork {

/// Where a load passes to the other line of the bound with which its contact slips. docs/theory/load-dependent.md, rule
/// 1
struct LineFlip {
  static constexpr const char* name = "flip";
  static constexpr Effect effect = Effect::decides;

  template <class T>
  static bool watches(const Workspace<T>& ws) {
    return ws.loads.n_sliding > 0;
  }
  /// Call f for each load of a contact that slips.
  template <class T, class F>
  static void each_border(const Workspace<T>& ws, F&& f) {
    for (int i = 0; i < ws.loads.n_sliding; ++i) f(ws.loads.sliding[i]);
  }
  template <class Form>
  [[gnu::noinline]] static void find(Form& form, Step<Form>& step, Hit& hit) {
    using T = typename Form::Scalar;
    Workspace<T>& ws = form.ws;
    for (int i = 0; i < ws.loads.n_sliding; ++i) {
      const int l = ws.loads.sliding[i], k = ws.loads.branch[i];
      const double start = value(ws.step_start.clearance[l]), end = value(ws.step_end.clearance[l]);
      const bool ample = is_ample(start, end, value(ws.step_start.closing[l]), value(ws.step_end.closing[l]), step.h);
      if (ample && !ends_say_little(ws, hit)) continue;
      fit(form, step);
      const double noise = 1e-12 * torque_size(ws);
      auto f = [&](double s) {
        torques_at(form, step, s);
        T by_load = T(0);
        return noise + value(line_clearance(ws, l, ws.observed.rate[k], by_load));
      };
      const double s = first_crossing(f, noise + start, noise + end, hit.s);
      hit.take(s, l);
    }
  }
  template <class Form, class T = typename Form::Scalar>
  static T at(Form& form, Step<Form>& step, const Hit& hit, double t, const T* y, int&) {
    Workspace<T>& ws = form.ws;
    see_torques(form, step, t, y);
    T by_load = T(0);
    return line_clearance(ws, hit.index, ws.observed.rate[ws.branch_of[component(ws, hit)]], by_load);
  }
  template <class Form, class T = typename Form::Scalar>
  static double scale(Form& form, const Hit&, const T*) {
    return larger(torque_size(form.ws), 1e-300);
  }
  template <class T>
  static int component(const Workspace<T>& ws, const Hit& hit) {
    return int(ws.sys.elements) + int(ws.sys.load_contact[hit.index]);
  }
  template <class Phase>
  static void settle(Phase& phase, const Hit& hit) {
    auto& ws = phase.ws();
    const int c = ws.sys.load_contact[hit.index];
    ws.loads.line[hit.index] = 1 - ws.loads.line[hit.index];
    // nothing jumps there, however often: a torque that has died away is round-off
    if (phase.is_balanced()) return phase.go_on_as_before();
    if (events_crowd(ws, component(ws, hit))) return phase.leave(crowded(ws));
    ws.loads.jammed = c;
    phase.decide(Cause::jam, c);
  }
};

}  // namespace clutchwork

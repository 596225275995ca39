#pragma once
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/locate.hpp>
#include <clutchwork/run/passive_events.hpp>
#include <clutchwork/run/processes.hpp>
#include <clutchwork/workspace.hpp>

/// Ends of the pieces of processes and flows. docs/theory/events.md, rule 12
namespace clutchwork {

/// Where processes and flows leave their pieces.
struct ProcessEnd : OwnScale, OfNone {
  static constexpr const char* name = "process";
  static constexpr Effect effect = Effect::next_piece;

  template <class T>
  static bool watches(const Workspace<T>& ws) {
    return ws.guard.n_processes > 0;
  }
  template <class T>
  static void watch(Workspace<T>& ws) {
    list_processes(ws);
  }
  template <class T, class F>
  static void each_border(const Workspace<T>& ws, F&& f) {
    for (int i = 0; i < ws.guard.n_processes; ++i) f(ws.guard.process[i]);
  }
  template <class Form>
  [[gnu::noinline]] static void find(Form& form, Step<Form>& step, Hit& hit) {
    using T = typename Form::Scalar;
    Workspace<T>& ws = form.ws;
    const int nz = form.nz();
    constexpr double noise = 1e-12;
    for (int i = 0; i < ws.guard.n_processes; ++i) {
      const int c = ws.guard.process[i];
      int who = 0;
      auto at_end = [&](double t, const T* y, const T* f, const StepEnd<T>& edge) {
        auto rate = [&](int d, T& slope) {
          const int k = ws.branch_of[d];
          if (k < 0 || k >= ws.n_branches) return T(0);
          return slope = edge.slope[k], edge.rate[k];
        };
        return process_margin(ws, c, t, y + nz, f + nz, rate, who);
      };
      const auto start = at_end(step.t, step.y0(), step.f0(), ws.step_start);
      const auto end = at_end(step.t + step.h, step.y1(), step.f1(), ws.step_end);
      if (is_ample(value(start.v), value(end.v), value(start.d[0]), value(end.d[0]), step.h)) continue;
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
      if (!hit.is_after(s)) continue;
      f(s);
      hit.take(s, c, who);
    }
  }
  template <class Form, class T = typename Form::Scalar>
  static T at(Form& form, Step<Form>& step, const Hit& hit, double t, const T* y, int& who) {
    Workspace<T>& ws = form.ws;
    inputs_of(form, t, y);
    auto rate = [&](int d, T&) {
      const int k = ws.branch_of[d];
      return k < 0 || k >= ws.n_branches ? T(0) : form.rate(k, y) + offset_rate(ws, k);
    };
    return process_margin(ws, hit.index, t, y + form.nz(), step.f0() + form.nz(), rate, who).v;
  }
  /// States that it has set may be loads of contacts.
  template <class Phase>
  static void settle(Phase& phase, const Hit& hit) {
    bool moved = false;
    if (!pass_process(phase.form(), phase.step(), hit.index, hit.who, moved)) return phase.leave(Status::zeno);
    if (moved) return phase.decide(Cause::input);
    phase.go_on(true);
  }
};

}  // namespace clutchwork

#pragma once
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/clamp_loads.hpp>
#include <clutchwork/run/guards/inputs.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/locate.hpp>
#include <clutchwork/workspace.hpp>

/// Faults of contacts. docs/theory/events.md
namespace clutchwork {

/// Where a contact fails.
struct Failure : OwnScale, OfContact {
  static constexpr const char* name = "fault";
  static constexpr Effect effect = Effect::other;

  template <class T>
  static bool watches(const Workspace<T>& ws) {
    return ws.guard.n_faulty > 0;
  }
  template <class Form>
  [[gnu::noinline]] static void find(Form& form, Step<Form>& step, Hit& hit) {
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
      if (hit.take(s, c)) fit(form, step);
    }
  }
  template <class Form, class T = typename Form::Scalar>
  static T at(Form& form, Step<Form>&, const Hit& hit, double t, const T* y, int&) {
    inputs_of(form, t, y);
    return fault_margin(form.ws, hit.index);
  }
  template <class Phase>
  static void settle(Phase& phase, const Hit& hit) {
    phase.decide(Cause::fault, hit.index);
    fail(phase.ws(), hit.index);
  }
};

}  // namespace clutchwork

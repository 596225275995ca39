#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/guards/torques.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/locate.hpp>
#include <clutchwork/workspace.hpp>

/// Where prescribed speeds and transmissions part locked contacts. docs/theory/events.md, rule 11
namespace clutchwork {

/// Slip of a locked contact at s, which transmissions hold: the interpolant is brought onto their ties.
template <class Form, class T = typename Form::Scalar>
double slip_beside(Form& form, Step<Form>& step, int c, double s) {
  Workspace<T>& ws = form.ws;
  interpolate(form, step, s, step.point());
  inputs_at(ws, step.t + s * step.h);
  if constexpr (Form::full) {
    if (s > 0 && s < 1) observe(form, step.t + s * step.h, step.point(), step.slope()), settle_ties(form, step.point());
  }
  expand(form, step.point(), ws.out.v);
  const int d = int(ws.sys.elements) + c;
  T slip = rate_row(ws.sys, d).times(ws.out.v);
  for (int p = 0; p < ws.sys.prescribed; ++p) slip += prescribed_share(ws, d, p) * ws.in.prescribed[p];
  return value(slip);
}

/// Where a transmission parts what it held together itself: where the slip leaves what counts as zero.
template <class Form>
void find_parting_beside(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  fit(form, step);
  for (int i = 0; i < ws.held.n_driven; ++i) {
    const int redundant = ws.held.driven[i], c = ws.held.redundant[redundant];
    const double end = abs(slip_beside(form, step, c, 1.0)), zero = ws.guard.zero;
    if (end <= zero) continue;
    auto f = [&](double s) { return zero - abs(slip_beside(form, step, c, s)); };
    const double s = first_crossing(f, zero, zero - end, hit.s);
    hit.take(s, redundant);
  }
}

/// Where prescribed speeds part what locked contacts hold together. docs/theory/events.md, rule 11
struct Parting : OwnScale {
  static constexpr const char* name = "parting";
  static constexpr Effect effect = Effect::decides;

  template <class T>
  static bool watches(const Workspace<T>& ws) {
    return ws.held.n_driven > 0;
  }
  template <class Form>
  static void find(Form& form, Step<Form>& step, Hit& hit) {
    auto& ws = form.ws;
    if (ws.ratios.n > 0) return find_parting_beside(form, step, hit);
    const double zero = ws.guard.zero;
    for (int i = 0; i < ws.held.n_driven; ++i) {
      auto f = [&](double s) {
        double slip = 0;
        for (int p = 0; p < ws.sys.prescribed; ++p) {
          slip += driven_share(ws, ws.held.driven[i], p) *
                  value(signal_value(ws, ws.sys.prescribed_input[p], step.t + s * step.h));
        }
        return zero - abs(slip);
      };
      const double s = first_crossing(f, f(0), f(1), hit.s);
      if (hit.take(s, ws.held.driven[i])) fit(form, step);
    }
  }
  template <class Form, class T = typename Form::Scalar>
  static T at(Form& form, Step<Form>&, const Hit& hit, double t, const T* y, int&) {
    return abs(rate_at(form, component(form.ws, hit), t, y));
  }
  template <class T>
  static int component(const Workspace<T>& ws, const Hit& hit) {
    return int(ws.sys.elements) + ws.held.redundant[hit.index];
  }
  /// Torque that a contact has left against a slip, times the slip [W].
  template <class T>
  static double left_against(const Workspace<T>& ws, int c, double slip) {
    if (slip == 0) return 0;
    if (is_rigid(ws, c)) return infinity;
    T lower, upper;
    bounds_of_held(ws, c, lower, upper);
    if (ws.loads.of[c] >= 0) lower = -static_torque(ws, c, forward), upper = static_torque(ws, c, backward);
    const double torque = value(ws.event_context.torque[c]);
    return larger(slip > 0 ? torque - value(lower) : value(upper) - torque, 0.0) * abs(slip);
  }
  /// Of a driven set: what each contact would slip, were independent contact a to take all of the slip of redundant
  /// contact s, or each redundant one its own where a is below zero. `f` takes contact and slip.
  template <class T, class F>
  static void each_slip(const Workspace<T>& ws, int s, int a, F&& f) {
    const auto& h = ws.held;
    const std::int64_t nc = ws.sys.contacts;
    const double slip = value(h.rhs[s]), taken = a < 0 ? 0.0 : -slip / value(h.tie[s * nc + a]);
    if (a >= 0) f(h.contact[a], taken);
    for (int r = 0; r < h.n_redundant; ++r) {
      const double own = value(h.rhs[r]) + (a < 0 ? 0.0 : value(h.tie[r * nc + a]) * taken);
      f(h.redundant[r], abs(own) > 1e-6 * abs(slip) ? own : 0.0);
    }
  }
  /// Those slip that have the least left against the slip of redundant contact s.
  template <class T>
  [[gnu::noinline]] static void force_weakest(Workspace<T>& ws, int s) {
    const Held<T>& h = ws.held;
    double least = infinity;
    int weakest = -1;
    for (int a = -1; a < h.n; ++a) {
      if (a >= 0 && value(h.tie[s * ws.sys.contacts + a]) == 0) continue;
      double sum = 0;
      each_slip(ws, s, a, [&](int c, double slip) { sum += left_against(ws, c, slip); });
      if (sum < least) least = sum, weakest = a;
    }
    if (!(least < infinity)) return;
    each_slip(ws, s, weakest, [&](int c, double slip) {
      if (slip != 0) ws.contact.forced[c] = slip > 0 ? forward : backward;
    });
  }
  /// Parted again at the same instant: a decision has let nothing go, so little does it accelerate.
  /// docs/theory/events.md, rule 11
  template <class Phase, class T = typename Phase::Scalar>
  static void force(Phase& phase, const Hit& hit) {
    Workspace<T>& ws = phase.ws();
    Held<T>& h = ws.held;
    const int s = hit.index;
    const bool again = ws.guard.parted == h.redundant[s] && stands_since(ws, ws.guard.parted_at);
    if (!again || is_rigid(ws, h.redundant[s])) return;
    for (int r = 0; r < h.n_redundant; ++r)
      h.rhs[r] = T(slip_beside(phase.taken_form(), phase.taken_step(), h.redundant[r], hit.s));
    force_weakest(ws, s);
  }
  template <class Phase>
  static void settle(Phase& phase, const Hit& hit) {
    auto& ws = phase.ws();
    ws.guard.parted_at = ws.time, ws.guard.parted = ws.held.redundant[hit.index];
    phase.decide(Cause::torque_limit, ws.guard.parted);
  }
};

}  // namespace clutchwork

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
  /// Parted again at the same instant: a decision has let nothing go, so little does it accelerate. What holds least of
  /// the slip that is left slips.
  template <class Phase, class T = typename Phase::Scalar>
  static void force(Phase& phase, const Hit& hit) {
    Workspace<T>& ws = phase.ws();
    const int c = ws.held.redundant[hit.index];
    const auto& last = ws.event_context;
    const bool again = stands_since(ws, ws.guard.jumped_at) && last.cause == Cause::torque_limit && last.contact == c;
    if (!again || is_rigid(ws, c)) return;
    const double slip = slip_beside(phase.taken_form(), phase.taken_step(), c, hit.s);
    double least = infinity;
    int weakest = -1, way = 0;
    auto weigh = [&](int contact, double moved) {
      if (moved == 0 || is_rigid(ws, contact) || ws.loads.of[contact] >= 0) return;
      T lower, upper;
      bounds_of_held(ws, contact, lower, upper);
      const double strength = (moved > 0 ? -value(lower) : value(upper)) / abs(moved);
      if (strength < least) least = strength, weakest = contact, way = moved > 0 ? forward : backward;
    };
    weigh(c, slip);
    for (int a = 0; a < ws.held.n; ++a)
      weigh(ws.held.contact[a], -slip * value(ws.held.tie[hit.index * ws.sys.contacts + a]));
    if (least < infinity) ws.contact.forced[weakest] = way;
  }
  template <class Phase>
  static void settle(Phase& phase, const Hit& hit) {
    phase.decide(Cause::torque_limit, phase.ws().held.redundant[hit.index]);
  }
};

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/input.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/workspace.hpp>

/// Inputs inside a step.
namespace clutchwork {

/// Whether any prescribed speed varies, so that rates are no polynomials.
template <class T>
bool rates_bend(const Workspace<T>& ws) {
  for (int p = 0; p < ws.sys.prescribed; ++p) {
    if (ws.in.signal[ws.sys.prescribed_input[p]].varying) return true;
  }
  return false;
}

/// Whether the ends of a step say little of what is held between them: where a capacity may bend before what was found,
/// where a load ends before them, and where prescribed accelerations vary, of which drifts know nothing.
template <class T>
[[gnu::noinline]] bool ends_say_little(const Workspace<T>& ws, const Hit& hit) {
  return (ws.guard.n_bending > 0 && !hit.none()) || hit.load_ends || rates_bend(ws);
}

/// Whether some inputs follow the state, so that they are known inside a step from its interpolant alone.
template <class T>
bool inputs_follow(const Workspace<T>& ws) {
  return ws.in.n_shared_refs > 0 || ws.in.n_rate_refs > 0;
}

/// Whether speeds are prescribed, of which no state may feel a torque, beside inputs that vary.
template <class T>
bool drives_may_bend(const Workspace<T>& ws) {
  return ws.sys.prescribed > 0 && (ws.in.n_varying > 0 || inputs_follow(ws));
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

}  // namespace clutchwork

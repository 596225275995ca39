#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/workspace.hpp>

/// Torques of what is locked, inside a step.
namespace clutchwork {

/// Margin of a locked contact: how much torque is left before it slips, round-off conceded.
template <class T>
CLUTCHWORK_INLINE Real<T> margin(const Workspace<T>& ws, int a, T torque, T capacity) {
  capacity += ws.step_start.noise[a];
  const int way = free_way(ws, ws.held.contact[a]);
  if (way == 0) return value(capacity) - abs(value(torque));
  if (way < 0) return value(capacity - torque);
  return smaller(value(torque + capacity), value(freewheel_limit(ws, ws.held.contact[a]) - torque));
}

/// Whether the margin of a locked contact exceeds what can change in a step of length h; its margins at both ends.
template <class T>
CLUTCHWORK_INLINE Truth<T> holds_on(const Workspace<T>& ws, int a, Real<T> h, Real<T>& before, Real<T>& after) {
  const auto &e0 = ws.step_start, &e1 = ws.step_end;
  before = margin(ws, a, e0.multiplier[a], e0.capacity[a]);
  after = margin(ws, a, e1.multiplier[a], e1.capacity[a]);
  const Real<T> change = abs(value(e1.multiplier[a] - e0.multiplier[a])) + abs(value(e1.capacity[a] - e0.capacity[a]));
  const Real<T> drift = h * larger(abs(value(e0.drift[a])), abs(value(e1.drift[a])));
  const Real<T> swing = h * value(larger(e0.swing[a], e1.swing[a]));
  return smaller(before, after) > larger(change, drift + swing);
}

/// Torques of the independent contacts at s, into ws.observed.carried.
template <class Form>
void torques_at(Form& form, Step<Form>& step, double s) {
  auto& ws = form.ws;
  interpolate(form, step, s, step.point());
  const double t = step.t + s * step.h;
  inputs_at(ws, t);
  if (ws.sys.prescribed > 0) input_slopes_at(ws, t);
  observe(form, t, step.point(), step.slope());
  multipliers(ws, ws.observed.torque, true, ws.observed.carried);
  if (ws.sys.loads > 0) loads_seen(ws);
  ++ws.statistics.locations;
}

/// Round-off of the other end of the step, for a contact that holds less than that: all torques may be zero at the
/// start.
template <class T>
double more_noise(const Workspace<T>& ws, int a, T capacity) {
  const double more = value(ws.step_end.noise[a] - ws.step_start.noise[a]);
  return value(capacity) < more ? more : 0.0;
}

/// Margin of a locked contact where the torques were looked at last.
template <class T>
double margin_seen(const Workspace<T>& ws, int a) {
  const T torque = ws.observed.carried[a], capacity = capacity_at(ws, ws.held.contact[a], torque);
  return margin(ws, a, torque, capacity) + more_noise(ws, a, capacity);
}

/// Torques of the branches and the independent contacts at (t, y), into ws.observed.
template <class Form, class T = typename Form::Scalar>
void see_torques(Form& form, Step<Form>& step, double t, const T* y) {
  Workspace<T>& ws = form.ws;
  inputs_of(form, t, y);
  if (ws.sys.prescribed > 0) input_slopes_at(ws, t);
  observe(form, t, y, step.slope());
  multipliers(ws, ws.observed.torque, true, ws.observed.carried);
  if (ws.sys.loads > 0) loads_seen(ws);
}

/// Rate of a direction at y.
template <class Form, class T = typename Form::Scalar>
T rate_at(Form& form, int d, double t, const T* y) {
  Workspace<T>& ws = form.ws;
  inputs_of(form, t, y);
  expand(form, y, ws.out.v);
  T rate = rate_row(ws.sys, d).times(ws.out.v);
  for (int p = 0; p < ws.sys.prescribed; ++p) rate += prescribed_share(ws, d, p) * ws.in.prescribed[p];
  return rate;
}

}  // namespace clutchwork

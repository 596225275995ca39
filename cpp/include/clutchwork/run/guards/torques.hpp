#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/locate.hpp>
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
  if constexpr (Form::full) {
    // as rows have it
    if (ws.ratios.n > 0 && s > 0 && s < 1 && step.h > 0)
      settle_ties(form, step.point()), observe(form, t, step.point(), step.slope());
  }
  multipliers(ws, ws.observed.torque, true, ws.observed.carried);
  if (ws.sys.loads > 0) loads_seen(ws);
  ++ws.statistics.locations;
}

/// Whether the load of a contact passes zero in the step.
template <class T>
bool passes_no_load(const Workspace<T>& ws, int c) {
  if constexpr (has_lanes<T>) return false;
  const int l = ws.sys.loads > 0 ? ws.loads.of[c] : -1;
  return l >= 0 && value(ws.step_start.load[l]) * value(ws.step_end.load[l]) < 0;
}

/// Where a guard f is hit before `limit` on the way to a zero of a load of a locked contact, which holds least there
/// and may do so for an instant; -1: nowhere. `start`: f at the start.
template <class Form, class F>
[[gnu::noinline]] double first_at_no_load(Form& form, Step<Form>& step, F&& f, double start, double limit) {
  auto& ws = form.ws;
  double first = -1;
  for (int l = 0; l < ws.sys.loads; ++l) {
    const int c = ws.sys.load_contact[l];
    if (ws.contact.mode[c] != locked || !passes_no_load(ws, c)) continue;
    const double before = value(ws.step_start.load[l]), after = value(ws.step_end.load[l]);
    const double sign = before > 0 ? 1 : -1;
    auto load = [&](double s) {
      torques_at(form, step, s);
      return sign * value(ws.loads.now[l]);
    };
    const double none = locate(load, 0, abs(before), 1, -abs(after)), end = first < 0 ? limit : first;
    if (none >= end) continue;
    const double least = f(none);
    if (least < 0) first = locate(f, 0, larger(start, 0.0), none, least);
  }
  return first;
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
  const T torque = ws.observed.carried[a], capacity = capacity_left(ws, ws.held.contact[a], torque);
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

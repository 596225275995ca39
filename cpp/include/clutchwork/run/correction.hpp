#pragma once
#include <clutchwork/motion/form.hpp>
#include <clutchwork/motion/mesh_loads.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/integrator/rodas5p.hpp>
#include <clutchwork/run/stiffness.hpp>

/// What the interpolant of a step misses of the equations of motion, and states inside of it that are brought onto
/// them. docs/theory/events.md, rule 7
namespace clutchwork {

/// miss := what the interpolant at the share s misses of the forces d there; the largest of them. slope: memory.
template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] double residual(Form& form, Step<Form>& step, double s, const T* d, T* slope, T* miss) {
  const int nz = form.nz(), n = form.n();
  interpolate_slope(form, step, s, slope);
  for (int i = 0; i < n; ++i) slope[i] = -slope[i], miss[i] = d[i];
  form.add_mass_times(T(1), slope, miss);
  for (int i = nz; i < n; ++i) miss[i] += slope[i];
  double largest = 0;
  for (int i = 0; i < nz; ++i) largest = larger(largest, abs(value(miss[i])));
  return largest;
}

/// miss := change of the state that it asks for in a step of length h, with the Jacobian of either end; what is slow
/// hardly changes. False: it is singular.
template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] bool correct(Form& form, double h, T* miss) {
  if (!Rodas5P::factor(form, 1 / (Rodas5P::gamma * h))) return false;
  Rodas5P::solve(form, miss);
  return true;
}

/// A state y at the share s of a step and its forces d onto the equations of motion, where one motion follows another
/// closely, as behind a steep law: within the tolerance of the speeds its torque is open. Whether they are changed: not
/// where little is missed, where a tenth of that is left, or by a change that no tolerance would leave open.
template <class Form>
bool settle_stiff(Form& form, Step<Form>& step, double s, double* y, double* d) {
  // of the torques; of what is missed; in tolerances, and the loosest of these
  constexpr double enough = 1e-6, left = 0.1, most = 1e3, tight = 1e-6;
  Workspace<double>& ws = form.ws;
  if (!step.calls->stiff || !(Form::full || follows_closely(ws, step.h))) return false;
  double *slope = step.k(7), *change = step.k(6);
  const double missed = residual(form, step, s, d, slope, change);
  if (!(missed > enough * torque_size(ws)) || !correct(form, step.h, change)) return false;
  double fastest = 0;
  for (int i = 0; i < form.nz(); ++i) fastest = larger(fastest, abs(y[i]));
  for (int i = 0; i < form.nz(); ++i) {
    if (!(abs(change[i]) <= most * (ws.options.atol + smaller(ws.options.rtol, tight) * fastest))) return false;
  }
  const double t = step.t + s * step.h;
  for (int i = 0; i < form.n(); ++i) y[i] += change[i];
  observe(form, t, y, d);
  if (residual(form, step, s, d, slope, step.k(5)) <= left * missed) return true;
  interpolate(form, step, s, y);
  observe(form, t, y, d);
  return false;
}

}  // namespace clutchwork

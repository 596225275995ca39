#pragma once
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/motion/form.hpp>
#include <clutchwork/run/correction.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/massless.hpp>
#include <clutchwork/run/step.hpp>
#include <clutchwork/workspace.hpp>

/// What the interpolant of a step misses inside it, of which its estimate says nothing. docs/theory/events.md, rule 7
namespace clutchwork {

/// Error that the motion up to the share s of a step may have, in units of the tolerance: what the interpolant misses
/// of the equations of motion there, over that time. Only the end of a step is checked by its own estimate.
template <class Form>
double error_until(Form& form, Step<Form>& step, double s) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  T *y = step.point(), *slope = step.slope(), *miss = step.u();
  interpolate(form, step, s, y);
  evaluate(form, step.t + s * step.h, y, miss);
  form.solve_mass(miss);
  interpolate_slope(form, step, s, slope);
  for (int i = 0; i < form.n(); ++i) miss[i] = T(s * step.h) * (miss[i] - slope[i]);
  if constexpr (!Form::small) {
    // speeds without inertia have no equation of motion
    for (int i = 0; i < form.nz(); ++i) {
      if (ws.rows.mass.first[i] == ws.rows.mass.first[i + 1]) miss[i] = T(0);
    }
  }
  return error_norm(form, miss, step.y0(), y);
}

/// Error of the interpolant in the middle of a step by an implicit method, in units of the tolerance: what it misses of
/// the equations of motion there, of which a fast motion settles at once. The Jacobian is that of either end.
/// docs/theory/events.md, rule 7
template <class Form, class T = typename Form::Scalar>
double error_inside(Form& form, Step<Form>& step) {
  T *y = step.point(), *miss = step.u();
  interpolate(form, step, 0.5, y);
  evaluate(form, step.t + 0.5 * step.h, y, miss);
  residual(form, step, 0.5, miss, step.slope(), miss);
  if (!correct(form, step.h, miss)) return infinity;
  if constexpr (!Form::small) {
    // speeds without inertia are brought to their balance in each row
    const Compressed<T>& mass = form.ws.rows.mass;
    for (int i = 0; i < form.nz(); ++i) {
      if (mass.first[i] == mass.first[i + 1]) miss[i] = T(0);
    }
  }
  return error_norm(form, miss, step.y0(), y);
}

/// What an interpolant misses of the speeds without inertia at the share s of a step, in units of the tolerance.
template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] double massless_error(Form& form, Step<Form>& step, double s) {
  Workspace<T>& ws = form.ws;
  T *y = step.point(), *missing = step.u();
  interpolate(form, step, s, y);
  evaluate(form, step.t + s * step.h, y, missing);
  for (int i = 0; i < form.n(); ++i) missing[i] = i < form.nz() && is_massless(ws, i) ? missing[i] : T(0);
  return solve_held(form, missing) ? error_norm(form, missing, step.y0(), y) : infinity;
}

}  // namespace clutchwork

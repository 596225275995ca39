#pragma once
#include <clutchwork/motion/form.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/integrator/rodas5p.hpp>

/// One step of Newton's method inside of a step of the motion. docs/theory/events.md, rule 7
namespace clutchwork {

/// miss := by how much the interpolant must change at the share s of a step so that the equations of motion hold, of
/// which it has the forces there. The Jacobian is that of either end; what is slow hardly changes. False: no force
/// misses more than `least`, or it is singular.
template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] bool correction(Form& form, Step<Form>& step, double s, double least, T* miss, T* slope) {
  const int nz = form.nz(), n = form.n();
  interpolate_slope(form, step, s, slope);
  for (int i = 0; i < n; ++i) slope[i] = -slope[i];
  form.add_mass_times(T(1), slope, miss);
  bool misses = least < 0;
  for (int i = 0; i < nz; ++i) misses = misses || !(abs(value(miss[i])) <= least);
  if (!misses) return false;
  for (int i = nz; i < n; ++i) miss[i] += slope[i];
  if (!Rodas5P::factor(form, 1 / (Rodas5P::gamma * step.h))) return false;
  Rodas5P::solve(form, miss);
  return true;
}

}  // namespace clutchwork

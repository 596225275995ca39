#pragma once
#include <clutchwork/workspace.hpp>

/// Memory of one step and its dense output, shared by both methods.
namespace clutchwork {

/// Rows of a step in the workspace, of the length of the motion. N: where the compiler knows it, else 0.
template <class T, int N>
struct StepRows {
  T* data;
  const int n;
  StepRows(Workspace<T>& ws, int size) : data(ws.stages.rows), n(size) {}
  CLUTCHWORK_HOT T* row(int i) { return data + i * (N > 0 ? N : n); }
};

/// Rows of a step: the stages come first, then these. The stages are numbered from 0.
struct StepRow {
  enum Number : int { y0 = 8, y1, p, f0 = 13, f1, dt0, dt1, u, point, slope };
};

template <class Form>
struct Step;

/// What is called in every step: an integrator for a form, and looks at the motion. run/step_calls.hpp
template <class Form>
struct StepCalls {
  using T = typename Form::Scalar;
  Real<T> (*advance)(Form& form, Step<Form>& step, Real<T> h);
  void (*fit)(Form& form, Step<Form>& step);
  void (*linearize_at)(Form& form, Step<Form>& step, Real<T> t, const T* y, T* d, T* dt, StepEnd<T>& edge);
  void (*observe)(Form& form, Step<Form>& step, double s);
  bool stiff;      ///< made for stiff motion
  double restart;  ///< share of the step before an event with which it starts after it
};

/// A finished step from y0 to y1 with a quartic between:
/// (1-s) y0 + s y1 + s (1-s) (p0 + s p1 + s^2 p2), s in [0, 1].
template <class Form>
struct Step {
  using T = typename Form::Scalar;
  StepRows<T, Form::fixed_size> rows;
  Real<T> t = 0, h = 0;
  bool dense = false;                      ///< it has an interpolant
  const StepCalls<Form>* calls = nullptr;  ///< of its phase
  // of a run with derivatives: its values at time t inside the step on the equations of motion; nullptr: as they are
  const double* (*settled)(void* image, double t) = nullptr;
  void* image = nullptr;

  explicit Step(Form& form) : rows(form.ws, form.n()) {}
  CLUTCHWORK_HOT T* k(int i) { return rows.row(i); }
  CLUTCHWORK_HOT T* y0() { return rows.row(StepRow::y0); }
  CLUTCHWORK_HOT T* y1() { return rows.row(StepRow::y1); }
  CLUTCHWORK_HOT T* p(int i) { return rows.row(StepRow::p + i); }
  CLUTCHWORK_HOT T* f0() { return rows.row(StepRow::f0); }  // d at y0
  CLUTCHWORK_HOT T* f1() { return rows.row(StepRow::f1); }  // d at y1
  CLUTCHWORK_HOT T* dt0() { return rows.row(StepRow::dt0); }
  CLUTCHWORK_HOT T* dt1() { return rows.row(StepRow::dt1); }
  CLUTCHWORK_HOT T* u() { return rows.row(StepRow::u); }
  CLUTCHWORK_HOT T* point() { return rows.row(StepRow::point); }
  CLUTCHWORK_HOT T* slope() { return rows.row(StepRow::slope); }
};

/// Its interpolant, if it has none yet.
template <class Form>
CLUTCHWORK_HOT void fit(Form& form, Step<Form>& step) {
  if (!step.dense) step.calls->fit(form, step);
}

/// The state at t + s h into `out`.
template <class Form, class Share, class T = typename Form::Scalar>
CLUTCHWORK_HOT void interpolate(Form& form, Step<Form>& step, const Share& s, T* out) {
  const Real<T> x = Real<T>(s), r = Real<T>(Share(1) - s);
  const int n = form.n();
  const T *a = step.y0(), *b = step.y1(), *p0 = step.p(0), *p1 = step.p(1), *p2 = step.p(2);
  for (int i = 0; i < n; ++i) out[i] = r * a[i] + x * (b[i] + r * (p0[i] + x * (p1[i] + x * p2[i])));
}

/// Derivative of the interpolant by time into `out`.
template <class Form, class T = typename Form::Scalar>
void interpolate_slope(Form& form, Step<Form>& step, double s, T* out) {
  const int n = form.n();
  const Real<T> x = Real<T>(s), ih = 1 / step.h;
  for (int i = 0; i < n; ++i) {
    const T p0 = step.p(0)[i], p1 = step.p(1)[i], p2 = step.p(2)[i];
    const T a1 = step.y1()[i] - step.y0()[i] + p0, a2 = p1 - p0, a3 = p2 - p1, a4 = -p2;
    out[i] = (a1 + x * (Real<T>(2) * a2 + x * (Real<T>(3) * a3 + x * Real<T>(4) * a4))) * ih;
  }
}

/// Integral of the interpolant of component i from the start of the step to s.
template <class Form, class T = typename Form::Scalar>
T interpolant_integral(Step<Form>& step, int i, double s) {
  const Real<T> x = Real<T>(s);
  const T p0 = step.p(0)[i], p1 = step.p(1)[i], p2 = step.p(2)[i], y0 = step.y0()[i];
  const T a1 = step.y1()[i] - y0 + p0, a2 = p1 - p0, a3 = p2 - p1, a4 = -p2;
  using R = Real<T>;
  return R(step.h) * x * (y0 + x * (a1 / R(2) + x * (a2 / R(3) + x * (a3 / R(4) + x * a4 / R(5)))));
}

}  // namespace clutchwork

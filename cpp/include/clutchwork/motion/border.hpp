#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/workspace.hpp>

/// The border that shared states put around the motion in a linear solve: docs/theory/integrators.md.
namespace clutchwork {

/// Product of row i of the border with a vector of speeds and states.
template <class Form, class X, class T = typename Form::Scalar>
X border_times(const Form& form, int i, const X* x) {
  const Workspace<T>& ws = form.ws;
  const int ns = int(ws.sys.states), own = ns - int(ws.sys.shared), nz = form.nz();
  X sum = X(0);
  for (int k = 0; k < ws.n_branches; ++k) {
    const T c = ws.jacobian.by_rate[i * ws.n_directions + k];
    if (counts(c)) sum += c * form.rate(k, x);
  }
  for (int s = 0; s < own; ++s) sum += ws.jacobian.by_state[i * ns + s] * x[nz + s];
  return sum;
}

/// Answers of the motion to each shared state and the inverse of the Schur complement; `solve` solves the motion alone.
template <class Form, class Solve, class T = typename Form::Scalar>
bool factor_border(Form& form, T scale, Solve&& solve) {
  Workspace<T>& ws = form.ws;
  const int nx = int(ws.sys.shared), nz = form.nz(), n = nz + int(ws.sys.states),
            stride = int(ws.sys.speeds + ws.sys.states);
  // where a state acts on no torque there is no answer; scratch until the inversion
  int* acts = ws.shared.pivot;
  for (int j = 0; j < nx; ++j) {
    T* b = ws.shared.reach + j * stride;
    for (int i = 0; i < n; ++i) b[i] = T(0);
    bool any = false;
    for (int k = 0; k < ws.n_branches; ++k) {
      const T c = ws.jacobian.torque_by[k * nx + j];
      if (counts(c)) form.push(k, c, b), any = true;
    }
    if (any) solve(b);
    acts[j] = any;
  }
  T* s = ws.shared.inverse;
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < nx; ++j) {
      s[i * nx + j] = (i == j ? scale : T(0)) - ws.jacobian.by_shared[i * nx + j];
      if (acts[j] != 0) s[i * nx + j] -= border_times(form, i, ws.shared.reach + j * stride);
    }
  }
  return invert(nx, s, ws.shared.pivot);
}

/// Complete a solution of the motion alone: the shared part of b becomes theirs, the rest takes its answer to it.
/// `rhs` is scratch, of the shared states.
template <class Form, class X, class T = typename Form::Scalar>
void solve_border(const Form& form, X* b, X* rhs) {
  const Workspace<T>& ws = form.ws;
  const int nx = int(ws.sys.shared), own = int(ws.sys.states) - nx, nz = form.nz();
  const int stride = int(ws.sys.speeds + ws.sys.states);
  X* x = b + nz + own;
  for (int i = 0; i < nx; ++i) rhs[i] = x[i] + border_times(form, i, b);
  for (int i = 0; i < nx; ++i) x[i] = dot(nx, ws.shared.inverse + i * nx, rhs);
  for (int j = 0; j < nx; ++j) axpy(nz + own, x[j], ws.shared.reach + j * stride, b);
}

}  // namespace clutchwork

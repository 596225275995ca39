#pragma once
#include <clutchwork/motion/border.hpp>
#include <clutchwork/motion/full.hpp>
#include <clutchwork/workspace.hpp>

/// What the Jacobian of a motion, where it was linearized last, makes of derivatives. docs/theory/gradients.md (20)
namespace clutchwork {

template <class X>
void add_row(int n, const double* row, const X* x, X& to) {
  for (int i = 0; i < n; ++i) {
    if (row[i] != 0) add_times(row[i], x[i], to);
  }
}

/// d := d + J x.
template <class Form, class X>
[[gnu::noinline]] void add_linear(const Form& form, const X* x, X* d) {
  const Workspace<double>& ws = form.ws;
  const Jacobian<double>& j = ws.jacobian;
  const int n = form.n(), nz = form.nz(), nx = int(ws.sys.shared);
  if constexpr (Form::full) {
    for (int i = 0; i < n; ++i) add_row(n, ws.full.jacobian + i * n, x, d[i]);
    return;
  }
  const X *own = x + nz, *shared = x + n - nx;
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<double>& b = ws.branch[k];
    const X rate = form.rate(k, x);
    X torque = rate * j.partial[k].by_rate;
    add_row(b.states, j.f_state + b.state, own + b.state, torque);
    add_row(nx, j.torque_by + k * nx, shared, torque);
    form.push(k, torque, d);
    for (int s = 0; s < b.states; ++s) {
      X& to = d[nz + b.state + s];
      add_times(j.g_rate[b.state + s], rate, to);
      add_row(b.states, j.g_state + j.block[k] + s * b.states, own + b.state, to);
    }
  }
  for (int i = 0; i < nx; ++i) {
    d[n - nx + i] += border_times(form, i, x);
    add_row(nx, j.by_shared + i * nx, shared, d[n - nx + i]);
  }
}

/// J itself, of few numbers in the sparse form, none of them shared.
template <class Form, class Matrix>
[[gnu::noinline]] void take_jacobian(const Form& form, Matrix& to) {
  const Jacobian<double>& j = form.ws.jacobian;
  const Compressed<double>& rate = form.ws.rows.rate;
  to = {};
  for (int k = 0; k < form.ws.n_branches; ++k) {
    const Branch<double>& b = form.ws.branch[k];
    const int own = form.nz() + b.state;
    for (int e = rate.first[k]; e < rate.first[k + 1]; ++e) {
      const int at = rate.col[e];
      const double torque = j.partial[k].by_rate * rate.val[e];
      for (int f = rate.first[k]; f < rate.first[k + 1]; ++f) to.entry(rate.col[f], at) += rate.val[f] * torque;
      for (int s = 0; s < b.states; ++s) {
        to.entry(at, own + s) += rate.val[e] * j.f_state[b.state + s];
        to.entry(own + s, at) += j.g_rate[b.state + s] * rate.val[e];
      }
    }
    for (int s = 0; s < b.states * b.states; ++s)
      to.entry(own + s / b.states, own + s % b.states) = j.g_state[j.block[k] + s];
  }
}

}  // namespace clutchwork

#pragma once
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/snapshot.hpp>
#include <clutchwork/workspace.hpp>

/// Power over a step, and work from it: docs/theory/energy.md.
namespace clutchwork {

/// Nodes of the Gauss rule on [0, 1] and the coefficients of its Lagrange polynomials.
struct Gauss {
  static constexpr double node[4] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263};
  static constexpr double weight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                       0.17392742256872693};
  double coef[4][4];
  constexpr Gauss() : coef{} {
    for (int i = 0; i < 4; ++i) {
      double p[4] = {1, 0, 0, 0};
      for (int j = 0; j < 4; ++j) {
        if (j == i) continue;
        const double scale = 1 / (node[i] - node[j]);
        for (int k = 3; k >= 0; --k) p[k] = ((k > 0 ? p[k - 1] : 0) - node[j] * p[k]) * scale;
      }
      for (int k = 0; k < 4; ++k) coef[i][k] = p[k];
    }
  }
};
inline constexpr Gauss gauss{};

/// Power of every direction and source over the step up to s_end, as cubics in s / s_end.
template <class Form, class T = typename Form::Scalar>
void fit_power(Form& form, Step<Form>& step, double s_end) {
  Workspace<T>& ws = form.ws;
  const int nd = ws.n_directions, np = int(ws.sys.prescribed), n = nd + np;
  for (int i = 0; i < 4 * n; ++i) ws.out.power[i] = T(0);
  for (int g = 0; g < 4; ++g) {
    const double s = gauss.node[g] * s_end, t = step.t + s * step.h;
    Snapshot<T> shot{};
    if (np > 0) {
      shot = take_snapshot(form, step, s);
    } else {
      interpolate(form, step, s, step.point());
      observe(form, t, step.point(), step.slope());
    }
    for (int k = 0; k < ws.n_branches; ++k) {
      const T power = ws.seen.torque[k] * ws.seen.rate[k];
      for (int j = 0; j < 4; ++j) ws.out.power[j * n + ws.branch[k].direction] += power * T(gauss.coef[g][j]);
    }
    for (int p = 0; p < np; ++p) {
      const T power = source_torque(ws, shot, p) * ws.in.prescribed[p];
      for (int j = 0; j < 4; ++j) ws.out.power[j * n + nd + p] += power * T(gauss.coef[g][j]);
    }
  }
}

/// Integral of a fitted power from the start of the step to the share x of the fitted part of length h.
template <class T>
T fitted_work(const Workspace<T>& ws, int i, double x, double h) {
  const int n = ws.n_directions + int(ws.sys.prescribed);
  const T* c = ws.out.power + i;
  const T r = T(x);
  return T(h) * r * (c[0] + r * (c[n] / T(2) + r * (c[2 * n] / T(3) + r * c[3 * n] / T(4))));
}

}  // namespace clutchwork

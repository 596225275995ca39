#pragma once
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/gauss.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/snapshot.hpp>
#include <clutchwork/workspace.hpp>

/// Power over a step, and work from it: docs/theory/energy.md.
namespace clutchwork {

/// Whether angles and work are integrated: they are asked for, and somebody reads them.
template <class T>
CLUTCHWORK_INLINE bool has_angles(const Workspace<T>& ws) {
  return ws.options.angles && ws.out.lacks_angles < 2;
}
template <class T>
CLUTCHWORK_INLINE bool has_work(const Workspace<T>& ws) {
  return ws.options.work && ws.out.lacks_work < 2;
}

/// Numbers of fitted powers: directions, prescribed speeds, supplies, meters.
template <class T>
CLUTCHWORK_INLINE int fitted_powers(const Workspace<T>& ws) {
  return ws.n_directions + int(ws.sys.prescribed + ws.sys.supplies + ws.sys.meters);
}

/// Power that supply i gives where the branches were observed last: work on the shaft, and heat.
template <class T>
T supply_power(const Workspace<T>& ws, int i, const T* state) {
  const int k = ws.branch_of[ws.sys.supply_element[i]];
  const T torque = ws.observed.torque[k];
  return torque * ws.observed.rate[k] + branch_heat(ws, ws.branch[k], ws.observed.rate[k], state, Dual<T, 1>(torque)).v;
}

/// Power through a metered line: what it puts on its node, times the speed of that.
template <class T>
T metered_power(const Workspace<T>& ws, const Snapshot<T>& shot, int m) {
  const auto& sys = ws.sys;
  const T torque = meter_sum<T>(
      sys, m, [&](int n) { return node_value(sys, n, shot.dv, ws.in.prescribed_slope); },
      [&](int d) { return ws.out.torque[d]; });
  return torque * node_value(sys, sys.meter_node[m], shot.v, ws.in.prescribed);
}

/// Give the power of every direction, source, supply and meter at the share s of a step to `add`, in parts.
template <class Form, class Add>
void powers_at(Form& form, Step<Form>& step, double s, Add&& add) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  const int nd = ws.n_directions, np = int(ws.sys.prescribed);
  Snapshot<T> shot{};
  if (np > 0 || ws.sys.meters > 0)
    shot = take_snapshot(form, step, s, true);
  else
    step.calls->observe(form, step, s);
  for (int k = 0; k < ws.n_branches; ++k) add(ws.branch[k].direction, ws.observed.torque[k] * ws.observed.rate[k]);
  for (int p = 0; p < np; ++p) add(nd + p, source_torque(ws, shot, p) * ws.in.prescribed[p]);
  for (int i = 0; i < ws.sys.supplies; ++i) add(nd + np + i, supply_power(ws, i, step.point() + form.nz()));
  const int first = nd + np + int(ws.sys.supplies);
  for (int m = 0; m < ws.sys.meters; ++m) add(first + m, metered_power(ws, shot, m));
}

/// Their work so far.
template <class T>
CLUTCHWORK_INLINE T& work_of(Workspace<T>& ws, int i) {
  const int source = i - ws.n_directions, supply = source - int(ws.sys.prescribed);
  const int meter = supply - int(ws.sys.supplies);
  if (source < 0) return ws.work[i];
  if (supply < 0) return ws.prescribed_work[source];
  return meter < 0 ? ws.supplied[supply] : ws.metered[meter];
}

/// Powers over the step up to s_end, as cubics in s / s_end.
template <class Form, class T = typename Form::Scalar>
void fit_power(Form& form, Step<Form>& step, double s_end) {
  Workspace<T>& ws = form.ws;
  const int n = fitted_powers(ws);
  for (int i = 0; i < 4 * n; ++i) ws.out.power[i] = T(0);
  for (int g = 0; g < 4; ++g) {
    powers_at(form, step, gauss.node[g] * s_end, [&](int i, const T& power) {
      for (int j = 0; j < 4; ++j) ws.out.power[j * n + i] += power * Real<T>(gauss.coef[g][j]);
    });
  }
  ws.out.is_rough = -1;
}

/// Integral of a fitted power from the start of the step to the share x of the fitted part of length h.
template <class T>
T fitted_work(const Workspace<T>& ws, int i, double x, double h) {
  return cubic_integral(ws.out.power + i, fitted_powers(ws), Real<T>(x), Real<T>(h));
}

/// Whether inside of a step the integrals of the cubics miss more than the tolerance of the work: seen by what they
/// miss of the powers at both ends. docs/theory/integrators.md (17)
template <class Form>
bool cubics_miss(Form& form, Step<Form>& step, double s_end) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  const int n = fitted_powers(ws);
  const double h = s_end * step.h;
  const T* c = ws.out.power;
  T* missed = ws.out.since;
  for (int x = 0; x < 2; ++x) {
    for (int i = 0; i < n; ++i) missed[i] = T(x) * (c[n + i] + c[2 * n + i] + c[3 * n + i]) + c[i];
    powers_at(form, step, x * s_end, [&](int i, const T& power) { missed[i] -= power; });
    for (int i = 0; i < n; ++i) {
      const double done = abs(value(work_of(ws, i))) + abs(value(fitted_work(ws, i, 1.0, h)));
      if (0.1 * h * abs(value(missed[i])) > ws.options.atol + ws.options.rtol * done) return true;
    }
  }
  return false;
}

/// Work since the start of the step at the share s, into ws.out.since: of the cubics up to s_end, or where these are
/// too rough of a sum of its own.
template <class Form>
void work_until(Form& form, Step<Form>& step, double s, double s_end) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  const int n = fitted_powers(ws);
  T* since = ws.out.since;
  const bool inside = s < s_end;
  if (inside && ws.out.is_rough < 0) ws.out.is_rough = cubics_miss(form, step, s_end);
  if (!inside || ws.out.is_rough == 0) {
    for (int i = 0; i < n; ++i) since[i] = fitted_work(ws, i, s / s_end, s_end * step.h);
    return;
  }
  for (int i = 0; i < n; ++i) since[i] = T(0);
  for (int g = 0; g < 4; ++g) {
    const T width = T(s * step.h * gauss.weight[g]);
    powers_at(form, step, s * gauss.node[g], [&](int i, const T& power) { since[i] += width * power; });
  }
}

}  // namespace clutchwork

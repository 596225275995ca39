#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/workspace.hpp>

/// Rows of output and the integrals of angle and work: docs/theory/energy.md.
namespace clutchwork {

/// Where rows go. Grid: times are given. Steps: times are written.
struct Sink {
  double* times = nullptr;
  double* rows = nullptr;
  std::int64_t count = 0;  ///< rows that fit
  std::int64_t at = 0;     ///< rows filled
  bool steps = false;
};

/// Kinetic energy [J].
template <class T>
double kinetic_energy(const Workspace<T>& ws) {
  const System& sys = ws.sys;
  double e = 0;
  for (int n = 0; n < sys.nodes; ++n) {
    double w = 0;
    for (int i = 0; i < sys.speeds; ++i) w += sys.basis[n * sys.speeds + i] * value(ws.v[i]);
    for (int p = 0; p < sys.prescribed; ++p)
      w += sys.basis_prescribed[n * sys.prescribed + p] * value(ws.prescribed[p]);
    e += 0.5 * sys.inertia[n] * w * w;
  }
  return e;
}

/// Everything at one point of a step.
template <class T>
struct Snapshot {
  T *y, *d, *rate, *v, *dv;
};

/// State, torques of all directions and accelerations at s; output torques go to ws.output_torque.
template <class Form, class T = typename Form::Scalar>
Snapshot<T> take_snapshot(Form& form, Step<Form>& step, double s) {
  Workspace<T>& ws = form.ws;
  const System& sys = ws.sys;
  const int nv = int(sys.speeds), ne = int(sys.elements), nc = int(sys.contacts);
  const double t = step.t + s * step.h;
  T* v = ws.dense_v;
  Snapshot<T> shot{step.point(), step.slope(), ws.scratch, v, v + nv};
  interpolate(form, step, s, shot.y);
  inputs_at(ws, t);
  input_slopes_at(ws, t);
  observe(form, t, shot.y, shot.d, shot.rate, ws.torque);
  for (int k = ws.n_branches; k < ws.n_rates; ++k) shot.rate[k] = form.rate(k, shot.y) + offset_rate(ws, k);
  for (int d = 0; d < ne + nc; ++d) {
    const int k = ws.branch_of[d];
    ws.output_torque[d] = k >= 0 && k < ws.n_branches ? ws.torque[k] : T(0);
  }
  T* carried = ws.qp_g + 3 * nc;
  multipliers(ws, ws.torque, true, carried);
  locked_torques(ws, carried, [&](int c, T x) { ws.output_torque[ne + c] += x; });
  expand(form, shot.y, shot.v);
  bool algebraic = false;
  for (int i = 0; i < nv; ++i) algebraic = algebraic || sys.massless[i] != 0;
  if (algebraic && step.h > 0) {
    interpolate_slope(form, step, s, shot.d);
  } else {
    form.solve_mass(shot.d);
  }
  expand(form, shot.d, shot.dv, false);
  for (int i = 0; i < nv; ++i) {
    for (int p = 0; p < sys.prescribed; ++p) shot.dv[i] += ws.y_basis[i * sys.prescribed + p] * ws.prescribed_slope[p];
  }
  return shot;
}

/// Torque of the source behind prescribed speed p.
template <class T>
T source_torque(const Workspace<T>& ws, const Snapshot<T>& shot, int p) {
  const System& sys = ws.sys;
  const int np = int(sys.prescribed), nv = int(sys.speeds);
  T torque = T(0);
  for (int i = 0; i < nv; ++i) torque += T(sys.mass_prescribed[i * np + p]) * shot.dv[i];
  for (int n = 0; n < sys.nodes; ++n) {
    for (int o = 0; o < np; ++o) {
      torque += T(sys.basis_prescribed[n * np + p] * sys.inertia[n] * sys.basis_prescribed[n * np + o]) *
                ws.prescribed_slope[o];
    }
  }
  for (int d = 0; d < ws.n_directions; ++d) torque -= ws.output_torque[d] * prescribed_share(ws, d, p);
  return torque;
}

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
  for (int i = 0; i < 4 * n; ++i) ws.power[i] = T(0);
  for (int g = 0; g < 4; ++g) {
    const double s = gauss.node[g] * s_end, t = step.t + s * step.h;
    T* rate = ws.scratch;
    Snapshot<T> shot{};
    if (np > 0) {
      shot = take_snapshot(form, step, s);
      rate = shot.rate;
    } else {
      interpolate(form, step, s, step.point());
      observe(form, t, step.point(), step.slope(), rate, ws.torque);
    }
    for (int k = 0; k < ws.n_branches; ++k) {
      const T power = ws.torque[k] * rate[k];
      for (int j = 0; j < 4; ++j) ws.power[j * n + ws.branch[k].direction] += power * T(gauss.coef[g][j]);
    }
    for (int p = 0; p < np; ++p) {
      const T power = source_torque(ws, shot, p) * ws.prescribed[p];
      for (int j = 0; j < 4; ++j) ws.power[j * n + nd + p] += power * T(gauss.coef[g][j]);
    }
  }
}

/// Integral of a fitted power from the start of the step to the share x of the fitted part of length h.
template <class T>
T fitted_work(const Workspace<T>& ws, int i, double x, double h) {
  const int n = ws.n_directions + int(ws.sys.prescribed);
  const T* c = ws.power + i;
  const T r = T(x);
  return T(h) * r * (c[0] + r * (c[n] / T(2) + r * (c[2 * n] / T(3) + r * c[3 * n] / T(4))));
}

/// Integral of prescribed speed p from t over h.
template <class T>
T prescribed_angle(const Workspace<T>& ws, int p, double t, double h) {
  const Signal& signal = ws.signal[ws.sys.prescribed_input[p]];
  if (!signal.varying) return T(signal_value(ws, ws.sys.prescribed_input[p], t) * h);
  const double s = t - signal.start;
  return T(segment_integral(signal.coef, s + h) - segment_integral(signal.coef, s));
}

/// Angles of all nodes at s, from those at the start of the step.
template <class Form, class T = typename Form::Scalar>
void angles_at(Form& form, Step<Form>& step, double s, T* angle) {
  Workspace<T>& ws = form.ws;
  const System& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed), nz = form.nz();
  T *z = step.point(), *v = ws.dense_v + 2 * nv;
  for (int i = 0; i < nz; ++i) z[i] = interpolant_integral<Form>(step, i, s);
  expand(form, z, v, false);
  T* given = ws.dense_v + 4 * nv + sys.nodes;
  for (int p = 0; p < np; ++p) given[p] = prescribed_angle(ws, p, step.t, s * step.h);
  for (int i = 0; i < nv; ++i) {
    for (int p = 0; p < np; ++p) v[i] += ws.y_basis[i * np + p] * given[p];
  }
  for (int n = 0; n < sys.nodes; ++n) {
    T a = ws.angle[n];
    for (int i = 0; i < nv; ++i) a += T(sys.basis[n * nv + i]) * v[i];
    for (int p = 0; p < np; ++p) a += T(sys.basis_prescribed[n * np + p]) * given[p];
    angle[n] = a;
  }
}

/// Mode of a contact as the output tells it; one that never sticks moves the way it slips.
template <class T>
int mode_shown(const Workspace<T>& ws, const Snapshot<T>& shot, int c) {
  if (!ws.loaded[c]) return open;
  if (!ws.compliant[c] || ws.mode[c] == locked) return ws.mode[c];
  return value(shot.rate[ws.branch_of[ws.sys.elements + c]]) < 0 ? backward : forward;
}

/// Whether all numbers of a row and the kinetic energy are finite; else detail_row and detail_value tell what is not,
/// or the speed that has most of the energy.
template <class T>
bool is_finite(Workspace<T>& ws, const double* row) {
  const double* speed = row + ws.row.speed;
  auto energy_of = [&](std::int64_t n) { return ws.sys.inertia[n] * speed[n] * speed[n]; };
  double sum = 0, energy = 0;
  for (std::int64_t i = 0; i < ws.row.size; ++i) sum += row[i] * 0;
  for (std::int64_t n = 0; n < ws.sys.nodes; ++n) energy += energy_of(n);
  if (sum + energy * 0 == 0) return true;
  std::int64_t which = 0;
  if (sum == 0) {
    for (std::int64_t n = 1; n < ws.sys.nodes; ++n) which = energy_of(n) > energy_of(which) ? n : which;
    which += ws.row.speed;
  } else {
    while (row[which] - row[which] == 0) ++which;
  }
  ws.detail_component = -1;
  ws.detail_row = int(which);
  ws.detail_value = row[which];
  return false;
}

/// One row of output at s; work is fitted over the part of the step up to s_end. False: a number is not finite.
template <class Form, class T = typename Form::Scalar>
bool fill_row(Form& form, Step<Form>& step, double s, double s_end, double* row) {
  Workspace<T>& ws = form.ws;
  const System& sys = ws.sys;
  const RowLayout& at = ws.row;
  const int nv = int(sys.speeds), np = int(sys.prescribed), ne = int(sys.elements), nd = ws.n_directions;
  T* angle = ws.dense_v + 4 * nv;
  for (int n = 0; n < sys.nodes; ++n) angle[n] = ws.angle[n];
  if (ws.options.angles && s > 0) angles_at(form, step, s, angle);
  for (int n = 0; n < sys.nodes; ++n) row[at.angle + n] = value(angle[n]);
  const Snapshot<T> shot = take_snapshot(form, step, s);
  for (int n = 0; n < sys.nodes; ++n) {
    double w = 0, a = 0;
    for (int i = 0; i < nv; ++i)
      w += sys.basis[n * nv + i] * value(shot.v[i]), a += sys.basis[n * nv + i] * value(shot.dv[i]);
    for (int p = 0; p < np; ++p) {
      w += sys.basis_prescribed[n * np + p] * value(ws.prescribed[p]);
      a += sys.basis_prescribed[n * np + p] * value(ws.prescribed_slope[p]);
    }
    row[at.speed + n] = w;
    row[at.acceleration + n] = a;
  }
  for (int i = 0; i < sys.states; ++i) row[at.state + i] = value(shot.y[form.nz() + i]);
  const double x = s_end > 0 ? s / s_end : 0;
  const bool fitted = ws.options.work && s > 0;
  for (int d = 0; d < nd; ++d) {
    const std::int64_t k = d < ne ? at.element_torque + d : at.contact_torque + d - ne;
    const std::int64_t w = d < ne ? at.element_work + d : at.contact_work + d - ne;
    row[k] = value(ws.output_torque[d]);
    row[w] = value(ws.work[d] + (fitted ? fitted_work(ws, d, x, s_end * step.h) : T(0)));
  }
  for (int c = 0; c < sys.contacts; ++c) {
    row[at.contact_mode + c] = mode_shown(ws, shot, c);
    row[at.contact_capacity + c] =
        value(static_torque(ws, c, value(ws.output_torque[ne + c]) > 0 ? backward : forward));
  }
  if (sys.flows > 0) {
    shared_rates(ws, shot.rate, ws.torque, shot.y + form.nz(), shot.d + form.nz());
    for (int f = 0; f < sys.flows; ++f) row[at.flow + f] = value(flow_value(ws, f));
  }
  for (int p = 0; p < np; ++p) {
    row[at.prescribed_work + p] =
        value(ws.prescribed_work[p] + (fitted ? fitted_work(ws, nd + p, x, s_end * step.h) : T(0)));
  }
  for (int i = 0; i < sys.inputs; ++i) row[at.input + i] = signal_value(ws, i, step.t + s * step.h);
  return is_finite(ws, row);
}

/// Rows that fall into the step up to s_end. At its very end at most one, the left limit. `running`: all is well.
template <class Form>
Status emit(Form& form, Step<Form>& step, double s_end, Sink& sink) {
  const double end = step.t + s_end * step.h;
  const std::int64_t size = form.ws.row.size;
  if (sink.steps) {
    sink.times[sink.at] = end;
    if (!fill_row(form, step, s_end, s_end, sink.rows + size * sink.at)) return Status::not_finite;
    ++sink.at;
    return Status::running;
  }
  while (sink.at < sink.count && sink.times[sink.at] <= end) {
    const double t = sink.times[sink.at];
    const double s = step.h > 0 ? smaller(s_end, larger(0.0, (t - step.t) / step.h)) : 0;
    if (!fill_row(form, step, s, s_end, sink.rows + size * sink.at)) return Status::not_finite;
    ++sink.at;
    if (t == end) break;
    if (stop_asked(form.ws)) return Status::interrupted;
  }
  return Status::running;
}

/// Take the integrals over the step up to s into the state.
template <class Form>
void accumulate(Form& form, Step<Form>& step, double s) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  const int nd = ws.n_directions;
  if (ws.options.angles) angles_at(form, step, s, ws.angle);
  if (!ws.options.work) return;
  for (int d = 0; d < nd; ++d) ws.work[d] += fitted_work(ws, d, 1.0, s * step.h);
  for (int p = 0; p < ws.sys.prescribed; ++p) ws.prescribed_work[p] += fitted_work(ws, nd + p, 1.0, s * step.h);
}

}  // namespace clutchwork

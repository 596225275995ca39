#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/motion/lost_ratios.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/correction.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/massless.hpp>
#include <clutchwork/workspace.hpp>

/// Everything at one point of a step.
namespace clutchwork {

/// Kinetic energy [J].
template <class T>
T energy_of_motion(const Workspace<T>& ws) {
  const auto& sys = ws.sys;
  T e = T(0);
  for (int n = 0; n < sys.nodes; ++n) {
    T w = basis_row(sys, n).times(ws.v);
    for (int p = 0; p < sys.prescribed; ++p) w += T(sys.basis_prescribed[n * sys.prescribed + p]) * ws.in.prescribed[p];
    e += T(0.5) * T(sys.inertia[n]) * w * w;
  }
  return e;
}
template <class T>
Real<T> kinetic_energy(const Workspace<T>& ws) {
  return value(energy_of_motion(ws));
}

/// Everything at one point of a step.
template <class T>
struct Snapshot {
  T *y, *d, *rate, *v, *dv;
};

/// Accelerations of speeds without inertia: inside of a step those of the interpolant.
template <class Form, class T = typename Form::Scalar>
void see_massless(Form& form, Step<Form>& step, double s, const Snapshot<T>& shot) {
  if (!any_massless(form)) return;
  if (step.h == 0) return change_massless(form, step.t, shot.y, shot.d, step.k(6), step.k(7));
  T* slope = step.u();
  interpolate_slope(form, step, s, slope);
  for (int i = 0; i < form.nz(); ++i) {
    if (is_massless(form.ws, i)) shot.d[i] = slope[i];
  }
}

/// The share at which torques are seen that jump at s.
template <class T>
double before_jump(const Workspace<T>& ws, double s) {
  return s == ws.out.jumps_at ? ws.out.jumps_from : s;
}

/// State and inputs at s, with the torques of all branches there.
template <class Form, class T = typename Form::Scalar>
void look_at(Form& form, Step<Form>& step, double s, const Snapshot<T>& shot) {
  const double t = step.t + s * step.h;
  interpolate(form, step, s, shot.y);
  inputs_at(form.ws, t);
  input_slopes_at(form.ws, t);
  observe(form, t, shot.y, shot.d);
}

/// Of a point s, which was looked at, at the pole of a tie in the step, or right behind it, that which is before it:
/// the others hold no longer what they still do there. docs/theory/varying-ratios.md (22)
template <class Form, class T = typename Form::Scalar>
double before_lost_tie(Form& form, Step<Form>& step, double s, const Snapshot<T>& shot) {
  const auto& r = form.ws.ratios;
  if (r.n == 0 || r.lost < 0 || step.h == 0 || keeps_ties(r)) return s;
  // next to a pole nothing is left of the digits of its torque
  const double nearest = larger(1e-6, smaller(0.5, 1e-9 / step.h)), near = larger(1e-3, 1e-7 / step.h);
  const double most = value(r.plain.gram[r.lost * r.ties + r.lost]) == 0 ? s : smaller(s, near);
  for (double back = nearest; back < most; back *= 4) {
    look_at(form, step, s - back, shot);
    if (keeps_ties(r)) return s - back;
  }
  look_at(form, step, s, shot);
  return s;
}

/// Of an instant at which nothing is left of a tie whose ratio moves on, as one that leaves zero: right behind it,
/// where it holds again. docs/theory/varying-ratios.md (22)
template <class Form, class T = typename Form::Scalar>
void behind_lost_tie(Form& form, Step<Form>& step, const Snapshot<T>& shot) {
  // of the time
  constexpr double soon = 1e-9;
  Workspace<T>& ws = form.ws;
  const Ratios<T>& r = ws.ratios;
  if (r.n == 0 || step.h != 0) return;
  bool moves = false;
  for (int t = 0; t < r.ties && r.tie[t] >= 0; ++t) {
    const int k = r.place[2 * r.tie[t]];
    // what turns jams there
    const bool rests = abs(value(ws.full.plain.rate[k + 1])) <= 10 * ws.guard.zero;
    moves = moves || (rests && value(r.plain.gram[t * r.ties + t]) == 0 && value(r.plain.slope[r.tie[t]]) != 0);
  }
  if (!moves) return;
  const double later = step.t + soon * larger(1e-2, abs(step.t));
  inputs_at(ws, later);
  input_slopes_at(ws, later);
  observe(form, later, shot.y, shot.d);
}

/// A state inside of a step, which was looked at, onto the equations of motion. docs/theory/events.md, rule 7
template <class Form, class T = typename Form::Scalar>
void settle_inside(Form& form, Step<Form>& step, double s, const Snapshot<T>& shot) {
  if constexpr (has_tangents<T>) {
    const double t = step.t + s * step.h, *settled = step.settled(step.image, t);
    if (settled == nullptr) return;
    for (int i = 0; i < form.n(); ++i) shot.y[i].v = settled[i];
    observe(form, t, shot.y, shot.d);
  } else {
    settle_stiff(form, step, s, shot.y, shot.d);
  }
}

/// State, torques of all directions and accelerations at s; output torques go to ws.out.torque. `settles`: the motion
/// does not go on from there, so that what an interpolant misses may be mended.
template <class Form, class T = typename Form::Scalar>
Snapshot<T> take_snapshot(Form& form, Step<Form>& step, double s, bool settles = false) {
  Workspace<T>& ws = form.ws;
  const auto& sys = ws.sys;
  const int nv = int(sys.speeds), ne = int(sys.elements), nc = int(sys.contacts);
  Snapshot<T> shot{step.point(), step.slope(), ws.observed.rate, ws.out.v, ws.out.dv};
  s = before_jump(ws, s);
  look_at(form, step, s, shot);
  if constexpr (Form::full) s = before_lost_tie(form, step, s, shot), behind_lost_tie(form, step, shot);
  const double t = step.t + s * step.h;
  if (settles) settle_inside(form, step, s, shot);
  if constexpr (Form::full) {
    // an interpolant keeps the ties of transmissions less exactly than the ends of a step do
    if (ws.ratios.n > 0 && s > 0 && s < 1 && step.h > 0) settle_ties(form, shot.y), observe(form, t, shot.y, shot.d);
  }
  if constexpr (!Form::small && !has_tangents<T>) {
    if (s > 0 && s < 1 && any_massless(form)) settle_massless(form, t, shot.y, shot.d, step.u());
  }
  for (int k = ws.n_branches; k < ws.n_rates; ++k) shot.rate[k] = form.rate(k, shot.y) + offset_rate(ws, k);
  for (int d = 0; d < ne + nc; ++d) {
    const int k = ws.branch_of[d];
    ws.out.torque[d] = k >= 0 && k < ws.n_branches ? ws.observed.torque[k] : T(0);
  }
  multipliers(ws, ws.observed.torque, true, ws.observed.carried);
  if (sys.loads > 0) loads_seen(ws);
  locked_torques(ws, ws.observed.carried, [&](int c, T x) { ws.out.torque[ne + c] += x; });
  if constexpr (Form::full) {
    if (ws.ratios.n > 0 && ws.held.n_sets > 0) carry_shares(form);
  }
  if (sys.loads > 0) loads_of_all(ws, ws.out.torque, ws.loads.now);
  expand(form, shot.y, shot.v);
  form.solve_mass(shot.d);
  if constexpr (!Form::small) see_massless(form, step, s, shot);
  expand(form, shot.d, shot.dv, false);
  for (int i = 0; i < nv; ++i) {
    for (int p = 0; p < sys.prescribed; ++p)
      shot.dv[i] += ws.reduced.y_basis[i * sys.prescribed + p] * ws.in.prescribed_slope[p];
  }
  return shot;
}

/// Torque of the source behind prescribed speed p.
template <class T>
T source_torque(const Workspace<T>& ws, const Snapshot<T>& shot, int p) {
  const auto& sys = ws.sys;
  const int np = int(sys.prescribed), nv = int(sys.speeds);
  T torque = T(0);
  for (int i = 0; i < nv; ++i) torque += T(sys.mass_prescribed[i * np + p]) * shot.dv[i];
  for (int n = 0; n < sys.nodes; ++n) {
    for (int o = 0; o < np; ++o) {
      torque += T(sys.basis_prescribed[n * np + p] * sys.inertia[n] * sys.basis_prescribed[n * np + o]) *
                ws.in.prescribed_slope[o];
    }
  }
  for (int d = 0; d < ws.n_directions; ++d) torque -= ws.out.torque[d] * prescribed_share(ws, d, p);
  return torque;
}

/// How all contacts are right before an event, where the torques of all directions were looked at; slope(k) of branch
/// k.
template <class T, class F>
void note_contacts(Workspace<T>& ws, F&& slope) {
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int d = int(ws.sys.elements) + c, k = ws.branch_of[d];
    ws.event_context.torque[c] = ws.out.torque[d];
    ws.event_context.slope[c] = k >= 0 ? slope(k) : T(0);
    ws.event_context.mode[c] = ws.contact.mode[c];
  }
}

/// The same at s.
template <class Form>
void note_before(Form& form, Step<Form>& step, double s) {
  auto& ws = form.ws;
  const auto shot = take_snapshot(form, step, s);
  note_contacts(ws, [&](int k) { return form.rate(k, shot.d) + offset_slope(ws, k); });
}

/// Whether the derivatives at one end of a step tell all that a snapshot does: speeds without inertia and transmissions
/// ask for more.
template <class Form>
bool tells_all(const Form& form) {
  using T = typename Form::Scalar;
  if constexpr (has_tangents<T>) {
    return false;
  } else if constexpr (Form::small) {
    return true;
  } else {
    return form.ws.ratios.n == 0 && !any_massless(form);
  }
}

/// The same where a step starts, from its derivatives: without loads, which the shares of sets follow.
template <class Form>
void note_start(Form& form) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  const int ne = int(ws.sys.elements);
  for (int d = 0; d < ws.n_directions; ++d) {
    const int k = ws.branch_of[d];
    ws.out.torque[d] = T(0);
    if (k < 0 || k >= ws.n_branches) continue;
    if constexpr (Form::full)
      ws.out.torque[d] = ws.full.some.torque[k].v;
    else
      ws.out.torque[d] = ws.jacobian.partial[k].torque;
  }
  locked_torques(ws, ws.step_start.multiplier, [&](int c, T x) { ws.out.torque[ne + c] += x; });
  note_contacts(ws, [&](int k) { return ws.step_start.slope[k]; });
}

}  // namespace clutchwork

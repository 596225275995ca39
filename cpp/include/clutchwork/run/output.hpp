#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/power.hpp>
#include <clutchwork/run/snapshot.hpp>
#include <clutchwork/run/step_calls.hpp>
#include <clutchwork/workspace.hpp>

/// Rows of output and the integrals of angle and work: docs/theory/energy.md.
namespace clutchwork {

/// Where rows go. Grid: times are given. Steps: times are written.
struct Sink {
  double* times = nullptr;
  double* rows = nullptr;
  double* tangents = nullptr;    ///< derivatives of each number of the rows, of a run that has them
  std::int64_t count = 0;        ///< rows that fit
  std::int64_t at = 0;           ///< rows filled
  std::int64_t steps = 0;        ///< rows in every step, the last at its end; 0: a grid
  double spacing = infinity;     ///< [s] with one row in every step: more where it is longer
  double restarted = -infinity;  ///< [s] where a phase has started last
  std::int64_t restart_row = 0;  ///< rows before those of that start
  bool lean = false;             ///< the last row has only what is read of it
  bool behind = false;           ///< the last row is that behind a knot, which the next step knows better

  /// Equal parts of a step of a length that have a row each.
  std::int64_t parts_of(double length) const {
    if (!(spacing < infinity)) return steps;
    const double parts = length / spacing - 1e-9;
    const std::int64_t whole = std::int64_t(parts);
    return whole < 1 ? 1 : whole + std::int64_t(double(whole) < parts);
  }

  /// A phase starts at time t: of several decisions at one instant the last one is the right limit.
  void restart(double t) {
    if (t == restarted) {
      at = restart_row;
    } else {
      restarted = t, restart_row = at;
    }
  }
};

/// A number as a row shows it: plain, or with its derivatives.
template <class R, class T>
CLUTCHWORK_INLINE R shown(const T& x) {
  if constexpr (std::is_same_v<R, T>)
    return x;
  else
    return value(x);
}

/// Integral of prescribed speed p from t over h.
template <class T>
T prescribed_angle(const Workspace<T>& ws, int p, double t, double h) {
  const auto& signal = ws.in.signal[ws.sys.prescribed_input[p]];
  if (!signal.varying) return T(signal_value(ws, ws.sys.prescribed_input[p], t) * h);
  const Given<T> s = since_start(ws, signal, t);
  return T(segment_integral(signal.coef, s + Given<T>(h)) - segment_integral(signal.coef, s));
}

/// Angles of all nodes at s, from those at the start of the step.
template <class Form, class T = typename Form::Scalar>
void angles_at(Form& form, Step<Form>& step, double s, T* angle) {
  Workspace<T>& ws = form.ws;
  const auto& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed), nz = form.nz();
  T *z = step.point(), *v = ws.out.turned;
  for (int i = 0; i < nz; ++i) z[i] = interpolant_integral<Form>(step, i, s);
  expand(form, z, v, false);
  T* given = ws.out.prescribed_angle;
  for (int p = 0; p < np; ++p) given[p] = prescribed_angle(ws, p, step.t, s * step.h);
  for (int i = 0; i < nv; ++i) {
    for (int p = 0; p < np; ++p) v[i] += ws.reduced.y_basis[i * np + p] * given[p];
  }
  for (int n = 0; n < sys.nodes; ++n) {
    T a = ws.angle[n];
    const auto row = basis_row(sys, n);
    for (int e = 0; e < row.n; ++e) a += T(row.value[e]) * v[row.column[e]];
    for (int p = 0; p < np; ++p) a += T(sys.basis_prescribed[n * np + p]) * given[p];
    angle[n] = a;
  }
}

/// Mode of a contact as the output tells it; one that never sticks moves the way it slips.
template <class T>
int mode_shown(const Workspace<T>& ws, const Snapshot<T>& shot, int c) {
  if (!ws.contact.loaded[c]) return open;
  if (!ws.contact.compliant[c] || ws.contact.mode[c] == locked) return ws.contact.mode[c];
  return value(shot.rate[ws.branch_of[ws.sys.elements + c]]) < 0 ? backward : forward;
}

/// Whether all numbers of a row and the kinetic energy are finite; else detail_row and detail_value tell what is not,
/// or the speed that has most of the energy.
template <class T, class R>
bool is_finite(Workspace<T>& ws, const R* row) {
  const R* speed = row + ws.row.speed;
  auto energy_of = [&](std::int64_t n) { return value(ws.sys.inertia[n]) * speed[n] * speed[n]; };
  // sums of their own, which do not wait for each other
  R part[4] = {}, energy = 0;
  std::int64_t i = 0;
  for (; i + 4 <= ws.row.size; i += 4) {
    for (int k = 0; k < 4; ++k) part[k] += row[i + k] * 0;
  }
  for (; i < ws.row.size; ++i) part[0] += row[i] * 0;
  const R sum = part[0] + part[1] + part[2] + part[3];
  for (std::int64_t n = 0; n < ws.sys.nodes; ++n) energy += energy_of(n);
  if (sum + energy * 0 == 0) return true;
  std::int64_t which = 0;
  if (sum == 0) {
    for (std::int64_t n = 1; n < ws.sys.nodes; ++n) which = energy_of(n) > energy_of(which) ? n : which;
    which += ws.row.speed;
  } else {
    while (row[which] - row[which] == 0) ++which;
  }
  ws.detail.component = -1;
  ws.detail.row = int(which);
  ws.detail.value = double(row[which]);
  return false;
}

/// Angles, speeds and accelerations of the nodes. docs/theory/energy.md
template <class T, class R>
void fill_nodes(const Workspace<T>& ws, const Snapshot<T>& shot, R* row) {
  const auto& sys = ws.sys;
  const int np = int(sys.prescribed);
  for (int n = 0; n < sys.nodes; ++n) {
    const auto share = basis_row(sys, n);
    R w = shown<R>(share.times(shot.v)), a = shown<R>(share.times(shot.dv));
    for (int p = 0; p < np; ++p) {
      w += shown<R>(T(sys.basis_prescribed[n * np + p]) * ws.in.prescribed[p]);
      a += shown<R>(T(sys.basis_prescribed[n * np + p]) * ws.in.prescribed_slope[p]);
    }
    row[ws.row.angle + n] = shown<R>(ws.out.angle[n]);
    row[ws.row.speed + n] = w;
    row[ws.row.acceleration + n] = a;
  }
}

/// Which slip of contact c its torque resists; where it has none yet, that with which it begins to move.
template <class T>
int resisted(const Workspace<T>& ws, const Snapshot<T>& shot, int c) {
  const int d = int(ws.sys.elements) + c, k = ws.branch_of[d];
  auto slip = -value(ws.out.torque[d]);
  if (slip != 0 || !ws.contact.compliant[c] || k < 0) return slip < 0 ? backward : forward;
  slip = value(shot.rate[k]);
  if (slip != 0) return slip < 0 ? backward : forward;
  T begins = rate_row(ws.sys, d).times(shot.dv);
  for (int p = 0; p < ws.sys.prescribed; ++p) begins += prescribed_share(ws, d, p) * ws.in.prescribed_slope[p];
  return value(begins) < 0 ? backward : forward;
}

/// Modes and static torques of the contacts.
template <class T, class R>
void fill_contacts(const Workspace<T>& ws, const Snapshot<T>& shot, R* row) {
  for (int c = 0; c < ws.sys.contacts; ++c) {
    row[ws.row.contact_mode + c] = mode_shown(ws, shot, c);
    row[ws.row.contact_capacity + c] = shown<R>(static_torque(ws, c, resisted(ws, shot, c)));
  }
}

/// Torques of all directions, and work; `fitted`: with that since the start of the step.
template <class T, class R>
void fill_work(const Workspace<T>& ws, bool fitted, R* row) {
  const int ne = int(ws.sys.elements), nd = ws.n_directions;
  auto since = [&](int i) { return fitted ? ws.out.since[i] : T(0); };
  for (int d = 0; d < nd; ++d) {
    const std::int64_t k = d < ne ? ws.row.element_torque + d : ws.row.contact_torque + d - ne;
    const std::int64_t w = d < ne ? ws.row.element_work + d : ws.row.contact_work + d - ne;
    row[k] = shown<R>(ws.out.torque[d]);
    row[w] = shown<R>(ws.work[d] + since(d));
  }
  for (int p = 0; p < ws.sys.prescribed; ++p) {
    row[ws.row.prescribed_work + p] = shown<R>(ws.prescribed_work[p] + since(nd + p));
  }
  for (int i = 0; i < ws.sys.supplies; ++i) {
    row[ws.row.supply_energy + i] = shown<R>(ws.supplied[i] + since(nd + int(ws.sys.prescribed) + i));
  }
  const int first = nd + int(ws.sys.prescribed + ws.sys.supplies);
  for (int m = 0; m < ws.sys.meters; ++m) row[ws.row.meter_energy + m] = shown<R>(ws.metered[m] + since(first + m));
}

/// The numbers of one row of output at s.
template <class Form, class R, class T = typename Form::Scalar>
void fill_numbers(Form& form, Step<Form>& step, double s, double s_end, R* row) {
  Workspace<T>& ws = form.ws;
  const auto& sys = ws.sys;
  for (int n = 0; n < sys.nodes; ++n) ws.out.angle[n] = ws.angle[n];
  // the last row of a step is at its end within round-off
  const bool inside = s < s_end * (1 - 1e-9);
  if (has_angles(ws) && s > 0 && !(inside && ws.out.lacks_angles > 0)) angles_at(form, step, s, ws.out.angle);
  const bool fitted = has_work(ws) && s > 0 && !(inside && ws.out.lacks_work > 0);
  if (fitted) work_until(form, step, s, s_end);
  ws.out.until = s;
  // the ends of a step are the motion itself
  const double instant = 1e-12 * (abs(step.t) + step.h);
  const Snapshot<T> shot = take_snapshot(form, step, s, s * step.h > instant && (s_end - s) * step.h > instant);
  fill_nodes(ws, shot, row);
  for (int i = 0; i < sys.states; ++i) row[ws.row.state + i] = shown<R>(shot.y[form.nz() + i]);
  fill_work(ws, fitted, row);
  for (int i = 0; i < sys.supplies; ++i) {
    row[ws.row.supply_power + i] = shown<R>(supply_power(ws, i, shot.y + form.nz()));
  }
  fill_contacts(ws, shot, row);
  if (sys.flows > 0) {
    shared_rates(ws, shot.rate, ws.observed.torque, shot.y + form.nz(), shot.d + form.nz());
    for (int f = 0; f < sys.flows; ++f) row[ws.row.flow + f] = shown<R>(flow_value(ws, f));
  }
  for (int i = 0; i < sys.inputs; ++i) row[ws.row.input + i] = shown<R>(T(signal_value(ws, i, step.t + s * step.h)));
}

/// One row of output at s; work is fitted over the part of the step up to s_end. False: a number is not finite.
template <class Form, class T = typename Form::Scalar>
bool fill_row(Form& form, Step<Form>& step, double s, double s_end, Sink& sink) {
  const std::int64_t size = form.ws.row.size;
  double* row = sink.rows + size * sink.at;
  sink.lean = false;
  if constexpr (has_tangents<T>) {
    T* full = form.ws.moved.row;
    fill_numbers(form, step, s, s_end, full);
    double* kept = sink.tangents + size * sink.at * T::kept;
    for (std::int64_t i = 0; i < size; ++i) row[i] = value(full[i]), keep(full[i], kept + i * T::kept);
  } else {
    fill_numbers(form, step, s, s_end, row);
  }
  return is_finite(form.ws, row);
}

/// What is read of a row at s, which nobody compares with another, where that is no more than torques of branches,
/// states and signals. False: it is more, or not finite.
template <class Form, class T = typename Form::Scalar>
bool fill_read(Form& form, Step<Form>& step, double s, double* row) {
  Workspace<T>& ws = form.ws;
  const RowLayout& at = ws.row;
  const ReadNumbers& inside = ws.out.inside;
  if (step.calls->stiff && follows_closely(ws, step.h)) return false;
  step.calls->observe(form, step, s);
  double sum = 0;
  for (std::int64_t i = 0; i < inside.n; ++i) {
    const std::int64_t place = inside.place[i];
    const bool torque = place >= at.element_torque && place < at.element_work;
    const int k = torque ? ws.branch_of[place - at.element_torque] : -1;
    if (torque ? k < 0 || k >= ws.n_branches : place < at.state || (place >= at.element_work && place < at.input))
      return false;
    row[place] = torque              ? ws.observed.torque[k]
                 : place >= at.input ? signal_value(ws, int(place - at.input), step.t + s * step.h)
                                     : step.point()[form.nz() + (place - at.state)];
    sum += row[place] * 0;
  }
  return sum == 0;
}

/// The time of row k of so many that divide a step from `start` up to its share s_end, which is the time `end`; its
/// share.
template <class R>
CLUTCHWORK_INLINE R share_of_row(std::int64_t k, std::int64_t parts, R start, R h, R s_end, R end, R& t) {
  t = k == parts ? end : start + s_end * R(double(k)) / R(double(parts)) * h;
  // as a grid with this instant has it, but for the bare steps
  return parts == 1 ? s_end : smaller(s_end, (t - start) / h);
}

/// Rows that divide the step up to s_end into equal parts, the last one at its end. `running`: all is well.
template <class Form>
Status emit_parts(Form& form, Step<Form>& step, double s_end, double end, Sink& sink) {
  const std::int64_t parts = s_end > 0 ? sink.parts_of(end - step.t) : 1;
  auto& out = form.ws.out;
  if (sink.steps > 1) {
    // a step whose parts the time cannot tell apart has none, and what starts behind it is where it begins
    if (parts == 1 && out.skipped) end = out.shown;
    if (parts > 1) out.skipped = end - step.t <= 1e-12 * (1 + abs(end));
    if (parts > 1 && out.skipped) return Status::running;
    out.shown = end;
  }
  if (sink.behind && s_end > 0) {
    --sink.at;
    if (!fill_row(form, step, 0.0, s_end, sink)) return Status::not_finite;
    ++sink.at;
  }
  sink.behind = false;
  // rows at the end of a step are compared
  const bool lean = out.inside.n >= 0 && form.ws.sys.prescribed + form.ws.sys.loads == 0;
  for (std::int64_t k = 1; k <= parts; ++k) {
    double& t = sink.times[sink.at];
    double s = share_of_row<double>(k, parts, step.t, step.h, s_end, end, t);
    if (sink.spacing < infinity) {
      // the instants of a grid that divides what lies between two rows; at the end the state itself
      if (k < parts) t = step.t + double(k) * ((end - step.t) / double(parts));
      s = k < parts ? smaller(s_end, (t - step.t) / step.h) : s_end;
    }
    bool filled = false;
    // a build that must be small fills whole rows
    if constexpr (has_sizes<Form>)
      filled = k < parts && lean && fill_read(form, step, s, sink.rows + form.ws.row.size * sink.at);
    if (!filled && !fill_row(form, step, s, s_end, sink)) return Status::not_finite;
    ++sink.at;
  }
  return Status::running;
}

/// Rows that fall into the step up to s_end, which is the time `end`. At its very end at most one, the left limit.
/// `running`: all is well.
template <class Form>
Status emit(Form& form, Step<Form>& step, double s_end, double end, Sink& sink) {
  if (sink.steps > 0) return emit_parts(form, step, s_end, end, sink);
  while (sink.at < sink.count && sink.times[sink.at] <= end) {
    const double t = sink.times[sink.at];
    const double s = step.h > 0 ? smaller(s_end, larger(0.0, (t - step.t) / step.h)) : 0;
    if (!fill_row(form, step, s, s_end, sink)) return Status::not_finite;
    ++sink.at;
    if (t == end) break;
    if (form.ws.poll.stops()) return Status::interrupted;
  }
  return Status::running;
}

/// A step of no length at the present point, for reading rows and torques there.
template <class Form>
void rest_step(Form& form, Step<Form>& step) {
  step.t = form.ws.time;
  step.h = 0;
  for (int i = 0; i < form.n(); ++i) {
    step.y1()[i] = step.y0()[i];
    step.p(0)[i] = step.p(1)[i] = step.p(2)[i] = 0;
  }
}

/// Rows at the instant at which a phase starts. `running`: all is well.
template <class Form>
Status emit_start(Form& form, Step<Form>& step, Sink& sink, bool fresh) {
  if (fresh) sink.restart(form.ws.time);
  if (!(sink.steps > 0 ? fresh : sink.at < sink.count && sink.times[sink.at] <= form.ws.time)) return Status::running;
  rest_step(form, step);
  if (sink.steps == 0) {
    // a grid row here is the right limit of an event; further equal times wait for the end of the step
    while (sink.at < sink.count && sink.times[sink.at] <= form.ws.time) {
      if (!fill_row(form, step, 0.0, 0.0, sink)) return Status::not_finite;
      ++sink.at;
    }
    return Status::running;
  }
  return emit(form, step, 0.0, step.t, sink);
}

/// Whether speeds, accelerations, torques or states in the last row are others than in the row before it, by more than
/// round-off; of a shaft without inertia, before it that of the interpolant, by more than that may miss.
template <class T>
bool row_jumps(const Workspace<T>& ws, const Sink& sink) {
  if (sink.at < 2) return true;
  const double *behind = sink.rows + ws.row.size * (sink.at - 1), *before = behind - ws.row.size;
  auto jumps = [&](std::int64_t first, std::int64_t count, auto&& missed) {
    double size = 0;
    for (std::int64_t i = first; i < first + count; ++i) size = larger(size, larger(abs(before[i]), abs(behind[i])));
    bool any = false;
    for (std::int64_t i = 0; i < count; ++i) any = any || abs(behind[first + i] - before[first + i]) > missed(i) * size;
    return any;
  };
  const auto round_off = [](std::int64_t) { return 1e-9; };
  const auto of_node = [&](std::int64_t n) { return value(ws.sys.inertia[n]) > 0 ? 1e-9 : 1e-4; };
  // a state that is set may be read where no torque follows it yet, as the deflection of a tyre that leaves the road
  for (std::int64_t i = ws.row.state; i < ws.row.state + ws.sys.states; ++i) {
    if (jumps(i, 1, round_off)) return true;
  }
  // speeds jump where an impulse came before, at the same instant
  return jumps(ws.row.speed, ws.sys.nodes, of_node) || jumps(ws.row.acceleration, ws.sys.nodes, of_node) ||
         jumps(ws.row.element_torque, ws.sys.elements, round_off) ||
         jumps(ws.row.contact_torque, ws.sys.contacts, round_off);
}

/// Take the integrals over the step up to s into the state; `shown`: a row there has them.
template <class Form>
void accumulate(Form& form, Step<Form>& step, double s, bool shown) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  if (has_angles(ws) && !shown) angles_at(form, step, s, ws.angle);
  for (int n = 0; shown && has_angles(ws) && n < ws.sys.nodes; ++n) ws.angle[n] = ws.out.angle[n];
  if (!has_work(ws)) return;
  for (int i = 0; i < fitted_powers(ws); ++i)
    work_of(ws, i) += shown ? ws.out.since[i] : fitted_work(ws, i, 1.0, s * step.h);
}

}  // namespace clutchwork

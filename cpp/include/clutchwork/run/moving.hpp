#pragma once
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/stops.hpp>
#include <clutchwork/run/break_away.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/run/power.hpp>
#include <clutchwork/run/processes.hpp>
#include <clutchwork/run/step.hpp>
#include <clutchwork/workspace.hpp>

/// Derivatives through an event: its instant moves with the numbers of the model. docs/theory/gradients.md
namespace clutchwork {

// ------------------------------------------------------------------------------------------------------------- guards

/// Torques of the branches and the carriers at (t, y), into ws.seen.
template <class Form, class T = typename Form::Scalar>
void see_torques(Form& form, Step<Form>& step, double t, const T* y) {
  Workspace<T>& ws = form.ws;
  inputs_of(form, t, y);
  if (ws.sys.prescribed > 0) input_slopes_at(ws, t);
  observe(form, t, y, step.slope());
  multipliers(ws, ws.seen.torque, true, ws.seen.carried);
  if (ws.sys.loads > 0) loads_seen(ws);
}

/// How far a locked contact is from slipping.
template <class T>
T distance_from_slip(const Workspace<T>& ws, int c, T torque) {
  const T capacity = capacity_at(ws, c, torque);
  const int way = free_way(ws, c);
  if (way == 0) return capacity - abs(torque);
  if (way < 0) return capacity - torque;
  return smaller(torque + capacity, freewheel_limit(ws, c) - torque);
}

/// Rate of a direction at y.
template <class Form, class T = typename Form::Scalar>
T rate_at(Form& form, int d, double t, const T* y) {
  Workspace<T>& ws = form.ws;
  inputs_of(form, t, y);
  expand(form, y, ws.out.v);
  T rate = rate_row(ws.sys, d).times(ws.out.v);
  for (int p = 0; p < ws.sys.prescribed; ++p) rate += prescribed_share(ws, d, p) * ws.in.prescribed[p];
  return rate;
}

/// Level of a line guard with its derivatives.
template <class T>
T level_of(const Workspace<T>& ws, const LineGuard& guard) {
  const Branch<T>& b = ws.branch[guard.branch];
  const int d = b.direction, c = d - int(ws.sys.elements);
  if (guard.kind == LineGuard::edge) {
    const int sign = b.law >= 0 ? b.sign : 1, interval = b.piece % (edge_count(ws, d) + 1);
    return T(sign) * edge_at(ws, d, guard.sign == -sign ? interval : interval - 1);
  }
  // one that was forced to slip, or that is driven, is watched at zero
  const bool own = guard.kind == LineGuard::slip && abs(guard.level) == value(ws.sys.contact_tolerance[c]);
  return own ? T(guard.sign) * T(ws.sys.contact_tolerance[c]) : T(guard.level);
}

/// The guard that was hit at (t, y): zero at the event. Of a law or a process it is the least of several, that of
/// `who`.
template <class Form, class T = typename Form::Scalar>
T guard_at(Form& form, Step<Form>& step, const Hit& hit, double t, const T* y, int& who) {
  Workspace<T>& ws = form.ws;
  const int nz = form.nz(), ne = int(ws.sys.elements);
  ws.in.time = -infinity;
  switch (hit.what) {
    case Hit::line: {
      const LineGuard& guard = ws.guard.line[hit.index];
      inputs_of(form, t, y);
      return T(guard.sign) * (form.rate(guard.branch, y) + offset_rate(ws, guard.branch) - level_of(ws, guard));
    }
    case Hit::multiplier: {
      const int c = ws.held.contact[hit.index];
      if (is_rigid(ws, c)) return abs(rate_at(form, ne + c, t, y));
      see_torques(form, step, t, y);
      return distance_from_slip(ws, c, ws.seen.carried[hit.index]);
    }
    case Hit::set:
      see_torques(form, step, t, y);
      return set_room(ws, hit.index, ws.seen.carried, T(0), ws.loads.now);
    case Hit::parting:
      return abs(rate_at(form, ne + ws.held.spare[hit.index], t, y));
    case Hit::load:
      inputs_of(form, t, y);
      return load_of(ws, hit.index);
    case Hit::law: {
      const Branch<T>& b = ws.branch[hit.index];
      inputs_of(form, t, y);
      T rate[most_ways];
      const T still[most_ways] = {};
      for (int w = 0; w < b.ways; ++w) rate[w] = form.rate(hit.index + w, y) + offset_rate(ws, hit.index + w);
      return law_margin(ws, b, rate, still, y + nz, step.f0() + nz, who).v;
    }
    case Hit::fault:
      inputs_of(form, t, y);
      return fault_margin(ws, hit.index);
    case Hit::process: {
      inputs_of(form, t, y);
      auto rate = [&](int d, T&) {
        const int k = ws.branch_of[d];
        return k < 0 || k >= ws.n_branches ? T(0) : form.rate(k, y) + offset_rate(ws, k);
      };
      return process_margin(ws, hit.index, t, y + nz, step.f0() + nz, rate, who).v;
    }
    case Hit::flip: {
      see_torques(form, step, t, y);
      T by_load = T(0);
      return line_clearance(ws, hit.index, ws.seen.rate[ws.branch_of[ne + ws.sys.load_contact[hit.index]]], by_load);
    }
    case Hit::gap:
      return T(hit.who) * (stop_end(ws, hit.index, hit.who) - y[nz + place_of(ws, hit.index)]);
    case Hit::nothing:
    case Hit::exit:
    case Hit::bend:
      // the run ends there, or nothing that moves depends on it
      break;
  }
  return T(1);
}

/// Element or contact whose guard it is.
template <class T>
int component_of(const Workspace<T>& ws, const Hit& hit) {
  const int ne = int(ws.sys.elements);
  switch (hit.what) {
    case Hit::line:
      return ws.branch[ws.guard.line[hit.index].branch].direction;
    case Hit::law:
      return ws.branch[hit.index].direction;
    case Hit::multiplier:
      return ne + ws.held.contact[hit.index];
    case Hit::set:
      return ne + ws.held.set_member[ws.held.set_first[hit.index]];
    case Hit::parting:
      return ne + ws.held.spare[hit.index];
    case Hit::flip:
      return ne + int(ws.sys.load_contact[hit.index]);
    case Hit::load:
    case Hit::fault:
    case Hit::exit:
    case Hit::gap:
    case Hit::bend:
      return ne + hit.index;
    case Hit::process:
    case Hit::nothing:
      break;
  }
  return -1;
}

/// Size of what makes a guard, against which its rate is measured.
template <class Form, class T = typename Form::Scalar>
double guard_scale(Form& form, const Hit& hit, const T* y) {
  Workspace<T>& ws = form.ws;
  double size = 0;
  switch (hit.what) {
    case Hit::line:
      size = form.rate_size(ws.guard.line[hit.index].branch, y);
      for (int i = 0; i < ws.sys.speeds; ++i) size = larger(size, 0.1 * abs(value(ws.v[i])));
      return larger(size, 1.0);
    case Hit::multiplier:
      return larger(abs(value(ws.seen.carried[hit.index])), 1e-3 * torque_size(ws));
    case Hit::load:
      return larger(ws.guard.load_size[hit.index], 1e-300);
    case Hit::gap:
      return larger(1e-3, abs(value(y[form.nz() + place_of(ws, hit.index)])));
    case Hit::flip:
      return larger(torque_size(ws), 1e-300);
    // these have their own scale already, or are slips
    case Hit::set:
    case Hit::parting:
    case Hit::law:
    case Hit::fault:
    case Hit::process:
    case Hit::exit:
    case Hit::bend:
    case Hit::nothing:
      break;
  }
  return 1;
}

// ------------------------------------------------------------------------------------------------- to the event and on

/// Time derivative of the state at the present instant into `out`. Speeds without inertia have none of their own: those
/// of `algebraic`, where it is given.
template <class Form, class T = typename Form::Scalar>
void motion_now(Form& form, const T* y, const T* algebraic, T* out) {
  Workspace<T>& ws = form.ws;
  ws.in.time = -infinity;
  if (ws.sys.prescribed > 0) input_slopes_at(ws, ws.time);
  evaluate(form, ws.time, y, out);
  form.solve_mass(out);
  for (int i = 0; i < form.nz(); ++i) {
    if (ws.rows.mass.first[i] == ws.rows.mass.first[i + 1]) out[i] = algebraic == nullptr ? T(0) : algebraic[i];
  }
}

/// Angles and work at the present instant move by their rates times `by`.
template <class Form, class T = typename Form::Scalar>
void move_integrals(Form& form, Step<Form>& step, const T& by) {
  Workspace<T>& ws = form.ws;
  const auto& sys = ws.sys;
  const int np = int(sys.prescribed);
  rest_step(form, step);
  ws.in.time = -infinity;
  const Snapshot<T> shot = take_snapshot(form, step, 0.0);
  if (ws.options.angles) {
    for (int n = 0; n < sys.nodes; ++n) ws.angle[n] += node_value(sys, n, shot.v, ws.in.prescribed) * by;
  }
  if (!ws.options.work) return;
  for (int k = 0; k < ws.n_branches; ++k) ws.work[ws.branch[k].direction] += ws.seen.torque[k] * ws.seen.rate[k] * by;
  for (int p = 0; p < np; ++p) ws.prescribed_work[p] += source_torque(ws, shot, p) * ws.in.prescribed[p] * by;
  for (int i = 0; i < sys.supplies; ++i) ws.supplied[i] += supply_power(ws, i, shot.y + form.nz()) * by;
  for (int m = 0; m < sys.meters; ++m) ws.metered[m] += metered_power(ws, shot, m) * by;
}

/// From the derivatives at the instant of an event to those at the event, which moves. docs/theory/gradients.md (4)
template <class Form, class T = typename Form::Scalar>
void move_with(Form& form, Step<Form>& step, const T& shift, const T* algebraic = nullptr) {
  Workspace<T>& ws = form.ws;
  ws.moved.shift = T(0);
  ws.moved.here = shift, ws.moved.here_time = ws.time;
  if (is_zero(shift)) return;
  T* velocity = step.k(0);
  motion_now(form, step.y0(), algebraic, velocity);
  if (ws.options.angles || ws.options.work) move_integrals(form, step, shift);
  for (int i = 0; i < form.n(); ++i) step.y0()[i] += velocity[i] * shift;
  ws.moved.shift = shift;
  ws.in.time = -infinity;
}

/// Back to derivatives at a fixed instant, with the motion behind the event. True where there was something to do.
/// docs/theory/gradients.md (5)
template <class Form, class T = typename Form::Scalar>
bool leave_event(Form& form, Step<Form>& step) {
  Workspace<T>& ws = form.ws;
  const T shift = ws.moved.shift;
  if (is_zero(shift)) return false;
  ws.moved.shift = T(0);
  // constant signals have no part in it, those that vary are read again
  T* velocity = step.k(0);
  motion_now(form, step.y0(), static_cast<const T*>(nullptr), velocity);
  if (ws.options.angles || ws.options.work) move_integrals(form, step, -shift);
  for (int i = 0; i < form.n(); ++i) step.y0()[i] -= velocity[i] * shift;
  ws.in.time = -infinity;
  inputs_of(form, ws.time, step.y0());
  for (int i = 0; i < form.ns(); ++i) ws.state[i] = step.y0()[form.nz() + i];
  expand(form, step.y0(), ws.v);
  return true;
}

// ---------------------------------------------------------------------------------------------------------- how large

/// Sizes that derivatives have at least, so that no step looks for digits in round-off: of what each direction changes
/// the numbers of the model by. docs/theory/gradients.md (22)
template <class T>
void floor_sizes(Workspace<T>& ws) {
  constexpr double round_off = 1e-14;
  double sum[T::seen] = {}, sum_at_zero[T::seen] = {};
  int n[T::seen] = {}, n_at_zero[T::seen] = {};
  auto look_at = [&](const T* number, std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) {
      const double size = abs(value(number[i]));
      for (int j = 0; j < T::seen; ++j) {
        const double slope = abs(number[i].seen_slope(j));
        if (!(slope > 0)) continue;
        // a word that is zero has no size: one unit, where a direction changes no others
        if (size > 0)
          sum[j] += log(slope / size), ++n[j];
        else
          sum_at_zero[j] += log(slope), ++n_at_zero[j];
      }
    }
  };
  visit_fields(ws.sys, ws.moved.plain->sys, [&](auto& field, const auto*, std::int64_t count) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(*field)>, T>) look_at(field, count);
  });
  look_at(ws.moved.points, 3 * ws.moved.plain->sys.n_points);
  for (int j = 0; j < T::seen; ++j) {
    if (n[j] + n_at_zero[j] == 0) continue;
    const double mean = n[j] > 0 ? sum[j] / n[j] : sum_at_zero[j] / n_at_zero[j];
    ws.moved.size[j] = round_off / ws.options.rtol * exp(mean);
  }
}

// -------------------------------------------------------------------------------------------------------- how it moves

/// Note how an event was met.
template <class T>
void note_graze(Workspace<T>& ws, int what, int component, double index, const T& shift) {
  Moved<T>& m = ws.moved;
  const bool together = ws.time - m.last_time <= 1e-9 * (1 + abs(ws.time));
  const double apart = together ? largest_difference(shift, m.last) : 0.0;
  m.last = shift, m.last_time = ws.time;
  if (m.n < Moved<T>::room) m.graze[m.n++] = {ws.time, double(what), double(component), index, apart};
}

/// Contacts that come to rest with the one that was hit, but at another instant where a number changes: by how much
/// their instants differ is noted.
template <class T>
void note_others(Workspace<T>& ws, int located) {
  const double tolerance = slip_tolerance(ws);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int mode = ws.contact.mode[c];
    if (c == located || (mode != forward && mode != backward) || !may_stick(ws, c) || !ws.contact.pressed[c]) continue;
    // at the event, which moves, the slip of one that locks at the same instant does not change
    const T slip = rate_of(ws, int(ws.sys.elements) + c);
    const double slope = value(ws.happened.slope[c]);
    if (abs(value(slip)) > tolerance || slope == 0 || ws.moved.n == 0 || ws.moved.n > Moved<T>::room) continue;
    double& apart = ws.moved.graze[ws.moved.n - 1].together;
    apart = larger(apart, largest_difference(slip * T(-1 / slope), T(0)));
  }
}

/// How the knot moves at which the run is: that of a signal that jumps there, else of a prescribed speed that bends,
/// else of any.
template <class T>
T knot_shift(Workspace<T>& ws) {
  T shift = T(0);
  int weight = 0;
  auto is_prescribed = [&](int i) {
    bool found = false;
    for (int p = 0; p < ws.sys.prescribed; ++p) found = found || ws.sys.prescribed_input[p] == i;
    return found;
  };
  for (int i = 0; i < ws.sys.inputs; ++i) {
    if (!is_turning(ws, i)) continue;
    const T knot = without_value(ws.in.signal[i].knot);
    const Turn turn = turn_of(ws, i);
    const int own = turn.jumps() ? 3 : is_prescribed(i) && turn.bends() ? 2 : is_zero(knot) ? 0 : 1;
    if (own > 1) note_graze(ws, -1, i, infinity, knot);
    if (own > weight) shift = knot, weight = own;
  }
  return shift;
}

/// Time derivative of the guard that was hit: of what is linear in the state that of the motion, else by differences
/// along it, close enough that no other is less.
template <class Form, class T = typename Form::Scalar>
double guard_rate(Form& form, Step<Form>& step, const Hit& hit, const T* velocity) {
  constexpr double closest = 1e-5;
  Workspace<T>& ws = form.ws;
  if (hit.what == Hit::gap) return -hit.who * value(velocity[form.nz() + place_of(ws, hit.index)]);
  if (hit.what == Hit::line && ws.sys.prescribed == 0) {
    const LineGuard& guard = ws.guard.line[hit.index];
    return guard.sign * value(form.rate(guard.branch, velocity));
  }
  T* probe = step.k(1);
  double rate = 0;
  for (double share = 1; share > 0.5 * closest; share *= 0.1) {
    const double reach = 0.01 * share * larger(form.ws.moved.span, 1e-12);
    bool own = true;
    auto plain = [&](double along) {
      for (int i = 0; i < form.n(); ++i) probe[i] = T(value(step.y0()[i]) + along * reach * value(velocity[i]));
      int who = hit.who;
      const double found = value(guard_at(form, step, hit, form.ws.time + along * reach, probe, who));
      own = own && who == hit.who;
      return found;
    };
    rate = (8 * (plain(1) - plain(-1)) - (plain(2) - plain(-2))) / (12 * reach);
    if (own) break;
  }
  return rate;
}

/// Whether a guard did not pass zero where it was hit: what happened at the same instant has made it jump past.
template <class T>
bool has_jumped(const Workspace<T>& ws, double guard, double scale) {
  constexpr double least = 1e-9;
  return guard < -least * scale && ws.time - ws.moved.here_time <= 1e-12 * (1 + abs(ws.time));
}

/// How a hit moves: minus the derivative of its guard at a fixed instant over its time derivative; one that has jumped
/// moves with what made it jump. docs/theory/gradients.md (3)
template <class Form, class T = typename Form::Scalar>
T hit_shift(Form& form, Step<Form>& step, const Hit& hit, const T* velocity) {
  Workspace<T>& ws = form.ws;
  const int component = component_of(ws, hit);
  int who = hit.who;
  const T guard = guard_at(form, step, hit, ws.time, step.y0(), who);
  const double scale = guard_scale(form, hit, step.y0());
  if (has_jumped(ws, value(guard), scale)) {
    const T shift = ws.moved.here;
    note_graze(ws, int(hit.what), component, infinity, shift);
    return shift;
  }
  const double rate = guard_rate(form, step, hit, velocity);
  const T shift = rate != 0 ? without_value(guard) * T(-1 / rate) : T(0);
  note_graze(ws, int(hit.what), component, abs(rate) / scale, shift);
  return shift;
}

/// From the derivatives at the instant of a hit to those at the event.
template <class Form>
void move_to_hit(Form& form, Step<Form>& step, const Hit& hit) {
  using T = typename Form::Scalar;
  // what does not touch the motion moves nothing
  if (hit.what == Hit::bend) return;
  // the slope of the interpolant is there already
  T *velocity = step.k(0), *algebraic = step.k(2);
  motion_now(form, step.y0(), algebraic, velocity);
  move_with(form, step, hit_shift(form, step, hit, velocity), algebraic);
}

}  // namespace clutchwork

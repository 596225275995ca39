#pragma once
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/stops.hpp>
#include <clutchwork/run/guards/list.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/run/power.hpp>
#include <clutchwork/run/processes.hpp>
#include <clutchwork/run/step.hpp>
#include <clutchwork/workspace.hpp>

/// Derivatives through an event: its instant moves with the numbers of the model. docs/theory/gradients.md
namespace clutchwork {

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
  for (int k = 0; k < ws.n_branches; ++k)
    ws.work[ws.branch[k].direction] += ws.observed.torque[k] * ws.observed.rate[k] * by;
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

/// No motion and no derivative has had a size.
template <class T>
void forget_sizes(Workspace<T>& ws) {
  const std::int64_t n = ws.sys.speeds + ws.sys.states;
  for (std::int64_t i = 0; i < n; ++i) ws.moved.most[i] = 0;
  for (std::int64_t i = 0; i < n * T::seen; ++i) ws.moved.largest[i] = 0;
}

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

/// [1/s] how fast a guard passes zero that something else makes jump; one that stays there passes it never.
inline constexpr double with_jump = 1e300;

/// Note how an event was met.
template <class T>
void note_graze(Workspace<T>& ws, int what, int component, double index, const T& shift) {
  Moved<T>& m = ws.moved;
  const bool together = ws.time - m.last_time <= 1e-9 * (1 + abs(ws.time));
  const double apart = together ? largest_difference(shift, m.last) : 0.0;
  m.last = shift, m.last_time = ws.time;
  if (m.n == Moved<T>::room) return;
  m.instant[m.n] = shift;
  m.graze[m.n++] = {ws.time, double(what), double(component), index, apart};
}

/// A border on which something stays, whose instant does not move: once, from where it is there first, with the largest
/// derivative of its margin. How many there are follows from values alone, as runs by other numbers have the same.
template <class T>
void note_border(Workspace<T>& ws, int what, int component, const T& margin) {
  Moved<T>& m = ws.moved;
  const double apart = largest_difference(margin, T(0));
  for (int i = 0; i < m.n; ++i) {
    Graze& known = m.graze[i];
    if (known.what != what || known.component != component || known.index < infinity) continue;
    known.together = larger(known.together, apart);
    return;
  }
  if (m.n == Moved<T>::room) return;
  m.instant[m.n] = T(0);
  m.graze[m.n++] = {ws.time, double(what), double(component), infinity, apart};
}

/// What is left before a border at an instant.
template <class G, class Form, class T = typename Form::Scalar>
T border(Form& form, Step<Form>& step, Hit& hit, double time) {
  if constexpr (requires { G::border(form, step, hit, time, step.y0()); })
    return G::border(form, step, hit, time, step.y0());
  else
    return G::at(form, step, hit, time, step.y0(), hit.who);
}

/// Borders of a guard at which the present state is, and which move with the numbers: on which side it is is open.
/// `who`: resting for those that no motion leaves.
template <class G, class Form>
void note_borders_of(Form& form, Step<Form>& step, int place, int who = turned) {
  constexpr double near = 1e-9;
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  // a load may be turned by where a signal goes from here
  const double far = ws.in.next_knot < infinity ? 0.37 * (ws.in.next_knot - ws.time) : 1e-3 * (1 + abs(ws.time));
  const double looks[] = {0.0, std::is_same_v<G, LineFlip> ? far : 0.0};
  G::each_border(ws, [&](int index) {
    for (const double later : looks) {
      Hit hit;
      hit.what = place, hit.index = index, hit.who = who, ws.in.time = -infinity;
      const T margin = border<G>(form, step, hit, ws.time + later);
      if (abs(value(margin)) > (who == resting ? 1e-12 : near * G::scale(form, hit, step.y0()))) return;
      note_border(ws, place, G::component(ws, hit), margin);
      if (looks[1] == 0) return;
    }
  });
  ws.in.time = -infinity;
}

/// Which borders a state may be on for more than an instant.
enum class Borders {
  all,      ///< where the run begins
  carried,  ///< where what is carried has jumped: loads, and what holds one way alone
  held      ///< behind an event: what holds one way alone
};

/// Borders on which the run goes on: of pieces at its start, of loads that are zero from here on.
template <class Form>
void note_borders(Form& form, Step<Form>& step, Borders which) {
  GuardList::each([&](auto tag, int place) {
    using G = typename decltype(tag)::type;
    constexpr bool flips = std::is_same_v<G, LineFlip>;
    constexpr bool holds = std::is_same_v<G, TorqueLimit> || std::is_same_v<G, SetLimit>;
    if constexpr (requires { G::each_border(form.ws, [](int) {}); }) {
      if constexpr (G::effect != Effect::decides) note_borders_of<G>(form, step, place, resting);
      if (which == Borders::all || holds || (flips && which == Borders::carried)) note_borders_of<G>(form, step, place);
    }
  });
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
    const double slope = value(ws.event_context.slope[c]);
    if (abs(value(slip)) > tolerance || slope == 0 || ws.moved.n == 0 || ws.moved.n == Moved<T>::room) continue;
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

/// Time derivative of the guard that was hit: its own, else by differences along the motion, close enough that no other
/// is less and that it does not bend. docs/theory/gradients.md (3)
template <class G, class Form, class T = typename Form::Scalar>
double guard_rate(Form& form, Step<Form>& step, const Hit& hit, const T* velocity) {
  constexpr double closest = 1e-5, straight = 1e-5, kinked = 0.1;
  double rate = 0, least = infinity;
  if constexpr (requires { G::rate(form, hit, velocity, rate); }) {
    if (G::rate(form, hit, velocity, rate)) return rate;
  }
  T* probe = step.k(1);
  bool own = true, ahead = true;
  auto plain = [&](double later) {
    for (int i = 0; i < form.n(); ++i) probe[i] = T(value(step.y0()[i]) + later * value(velocity[i]));
    int who = hit.who;
    form.ws.in.time = -infinity;
    const double found = value(G::at(form, step, hit, form.ws.time + later, probe, who));
    own = own && who == hit.who, ahead = ahead && (later < 0 || who == hit.who);
    return found;
  };
  const double here = plain(0);
  double behind = 0, least_bent = infinity;
  for (double share = 1; share > 0.5 * closest; share *= 0.1) {
    const double reach = 0.01 * share * larger(form.ws.moved.span, 1e-12);
    own = ahead = true;
    const double next = plain(reach), last = plain(2 * reach);
    // what is smooth has nearly the same slope over twice the reach
    double near = (next - plain(-reach)) / (2 * reach), far = (last - plain(-2 * reach)) / (4 * reach);
    double found = (4 * near - far) / 3;
    const double first = (next - here) / reach, second = (last - here) / (2 * reach);
    const double bent = abs(first - second);
    if (ahead && bent <= straight * larger(abs(first), abs(second)) && bent < least_bent)
      behind = 2 * first - second, least_bent = bent;
    // before it another guard of the same element was less, as that which has just been passed
    if (!own && ahead) near = first, far = second, found = 2 * first - second, own = true;
    const double apart = own ? abs(near - far) : larger(abs(near - far), 1e300);
    if (apart < least || share == 1) rate = found, least = apart;
    // one with a kink at the hit, such as a load that is a trace below zero, has the slope of the side it is on there
    const bool bends = ahead && abs(first - near) > kinked * larger(abs(first), abs(near));
    if (own && !bends && apart <= straight * larger(abs(near), abs(far))) return found;
  }
  // what bends just before it is another event
  return least_bent < infinity ? behind : rate;
}

/// Whether a guard did not pass zero where it was hit: what happened at the same instant has made it jump past.
template <class T>
bool has_jumped(const Workspace<T>& ws, double guard, double scale) {
  constexpr double least = 1e-9;
  return guard < -least * scale && ws.time - ws.moved.here_time <= 1e-12 * (1 + abs(ws.time));
}

/// How a hit moves whose guard jumps there, and its rate, by a cubic through what is left shortly before it, or behind
/// it where that is infinite before: from as far as that is smooth, since round-off hides how much is left near by.
/// Without a rate nothing is known.
template <class G, class Form, class T = typename Form::Scalar>
T sudden_shift(Form& form, Step<Form>& step, const Hit& hit, const T* velocity, double& rate) {
  constexpr double farthest = 1e-2, closest = 1e-4, smooth = 1e-5;
  Workspace<T>& ws = form.ws;
  double side = G::told_from(ws);
  T *probe = step.k(1), guard = T(0);
  double least = infinity;
  for (double share = farthest; share > 0.5 * closest && least > smooth; share *= 0.1) {
    const double reach = side * share * larger(ws.moved.span, 1e-9);
    T left[4];
    bool tells = true;
    for (int k = 0; k < 4; ++k) {
      const double later = (k + 1) * reach;
      for (int i = 0; i < form.n(); ++i) probe[i] = step.y0()[i] + velocity[i] * later;
      ws.in.time = -infinity;
      left[k] = G::left(form, step, hit, ws.time + later, probe, side);
      tells = tells && value(left[k]) < infinity;
    }
    if (!tells) {
      // once more from the farthest on
      side = 1, share = 10 * farthest, least = infinity;
      continue;
    }
    auto sum = [&](double a, double b, double c, double d) {
      return T(a) * left[0] + T(b) * left[1] + T(c) * left[2] + T(d) * left[3];
    };
    const double slope = value(sum(-26, 57, -42, 11)) / (6 * reach), other = value(sum(-5, 8, -3, 0)) / (2 * reach);
    const double apart = slope != 0 ? abs(other / slope - 1) : 1e300;
    if (apart < least) rate = slope, guard = sum(4, -6, 4, -1), least = apart;
  }
  return rate != 0 ? without_value(guard) * T(-1 / rate) : T(0);
}

/// Loads of a set that pass zero together with what it holds: where they do so at other instants for other numbers is
/// noted, by the largest difference.
template <class Form, class T = typename Form::Scalar>
void note_loads(Form& form, Step<Form>& step, const Hit& hit, const T* velocity, const T& shift) {
  Workspace<T>& ws = form.ws;
  const int first = ws.held.set_first[hit.index], rank = ws.held.set_rank[hit.index];
  if (rank < 2 || ws.moved.n == 0) return;
  const double reach = 1e-4 * larger(ws.moved.span, 1e-9);
  T* probe = step.k(1);
  auto load = [&](int i, double later) {
    for (int k = 0; k < form.n(); ++k) probe[k] = step.y0()[k] + velocity[k] * later;
    ws.in.time = -infinity;
    see_torques(form, step, ws.time + later, probe);
    return ws.observed.carried[ws.held.set_place[i]];
  };
  double& apart = ws.moved.graze[ws.moved.n - 1].together;
  for (int i = first; i < first + rank; ++i) {
    const T here = load(i, 0.0), moves = without_value(here);
    const double change = value(load(i, reach)) - value(here), size = 1e-6 * torque_size(ws);
    if (abs(value(here)) > size || !(largest_difference(moves, T(0)) > 0)) continue;
    // one that stays at zero is there at any instant
    const bool stays = abs(change) <= 1e-6 * size;
    apart = stays ? with_jump : larger(apart, largest_difference(moves * T(-reach / change), shift));
  }
}

/// How a hit moves: minus the derivative of its guard at a fixed instant over its time derivative; one that has jumped
/// moves with what made it jump. docs/theory/gradients.md (3)
template <class G, class Form, class T = typename Form::Scalar>
T hit_shift(Form& form, Step<Form>& step, const Hit& hit, const T* velocity) {
  Workspace<T>& ws = form.ws;
  const int component = G::component(ws, hit);
  int who = hit.who;
  ws.in.time = -infinity;
  const T guard = G::at(form, step, hit, ws.time, step.y0(), who);
  const double scale = G::scale(form, hit, step.y0());
  if (has_jumped(ws, value(guard), scale)) {
    const T shift = ws.moved.here;
    note_graze(ws, hit.what, component, with_jump, shift);
    return shift;
  }
  if constexpr (requires { G::is_sudden(ws, hit, 0.0); }) {
    if (G::is_sudden(ws, hit, value(guard))) {
      double rate = 0;
      const T shift = sudden_shift<G>(form, step, hit, velocity, rate);
      note_graze(ws, hit.what, component, abs(rate), shift);
      note_loads(form, step, hit, velocity, shift);
      return shift;
    }
  }
  const double rate = guard_rate<G>(form, step, hit, velocity);
  bool moves = rate != 0;
  if constexpr (requires { G::has_faded(ws, hit, rate, scale); }) moves = moves && !G::has_faded(ws, hit, rate, scale);
  const T shift = moves ? without_value(guard) * T(-1 / rate) : T(0);
  note_graze(ws, hit.what, component, abs(rate) / scale, shift);
  return shift;
}

/// From the derivatives at the instant of a hit to those at the event. What nothing that moves depends on stays.
template <class Form>
void move_to_hit(Form& form, Step<Form>& step, const Hit& hit) {
  using T = typename Form::Scalar;
  // the slope of the interpolant is there already
  T *velocity = step.k(0), *algebraic = step.k(2);
  if (hit.held_bends) return;
  motion_now(form, step.y0(), algebraic, velocity);
  GuardList::visit(hit.what, [&](auto tag) {
    using G = typename decltype(tag)::type;
    move_with(form, step, hit_shift<G>(form, step, hit, velocity), algebraic);
  });
}

}  // namespace clutchwork

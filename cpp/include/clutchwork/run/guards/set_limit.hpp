#pragma once
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/set_margin.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/run/clamp_loads.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/guards/inputs.hpp>
#include <clutchwork/run/guards/torque_limit.hpp>
#include <clutchwork/run/guards/torques.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/locate.hpp>
#include <clutchwork/workspace.hpp>

/// Where locked contacts that depend on one another break away as a set. docs/theory/events.md
namespace clutchwork {

/// Round-off of the torques inside of a step: those at its start may be far larger, and those beside a pole.
template <class T>
T round_off(const Workspace<T>& ws) {
  return smaller(ws.step_start.noise[0], T(1e-12 * torque_size(ws)));
}

/// Largest torque of the independent contacts of a set.
template <class T>
double largest_load(const Workspace<T>& ws, int k, const T* torque) {
  double most = 0;
  const int first = ws.held.set_first[k];
  for (int i = first; i < first + ws.held.set_rank[k]; ++i)
    most = larger(most, abs(value(torque[ws.held.set_place[i]])));
  return most;
}

/// What set k has left of its limit load inside of a step, as a share of the load or as a torque; factors beyond `most`
/// count as that.
template <class Form>
struct RoomInside {
  Form& form;
  Step<Form>& step;
  int k;
  double most = ample;
  bool as_torque = false;

  [[gnu::noinline]] double operator()(double s) const {
    auto& ws = form.ws;
    torques_at(form, step, s);
    const double room = value(set_room(ws, k, ws.observed.carried, round_off(ws), ws.loads.now, most));
    return as_torque ? room * largest_load(ws, k, ws.observed.carried) : room;
  }
};

/// Lines of the bounds by which the set that was looked at last holds, as one number.
template <class T>
std::uint64_t lines_chosen(const Workspace<T>& ws) {
  std::uint64_t code = 1;
  for (int i = 0; i < 2 * int(ws.sys.loads); ++i) code = 31 * code + std::uint64_t(ws.set.line[i]);
  return code;
}

/// Where a set gives way, by its limit load f, that holds at both ends of a part of the step by other lines of its
/// bounds, -1: not before `limit`. By one choice of lines it holds in between as well, so that it only gives way where
/// the choice is another one. `middle_room`: f(0.5), where it was asked.
template <class T, class F>
[[gnu::noinline]] double first_between_lines(const Workspace<T>& ws, F&& f, double limit, double& middle_room) {
  constexpr int halvings = 30, parts = 4;
  double low = 0, above = f(0.0);
  auto own = lines_chosen(ws);
  for (int k = 1; k <= parts; ++k) {
    double high = limit * k / parts;
    const double end = high, room_there = f(end);
    const auto there = lines_chosen(ws);
    if (end == 0.5) middle_room = room_there;
    if (room_there < 0) return locate(f, low, above, end, room_there);
    for (int i = 0; i < halvings && own != there; ++i) {
      const double middle = 0.5 * (low + high), room = f(middle);
      if (room < 0) return locate(f, low, above, middle, room);
      lines_chosen(ws) == own ? (low = middle, above = room) : high = middle;
    }
    low = end, above = room_there, own = there;
  }
  return -1;
}

/// Where the limit load of a set is reached that has contacts that follow loads: its limit load has kinks where a load
/// changes its sign. Far from it at both ends, ahead of both and in the middle, it is taken to be far from it in
/// between.
template <class Form>
[[gnu::noinline]] void find_loaded_limit(Form& form, Step<Form>& step, int k, double least, Hit& hit) {
  auto& ws = form.ws;
  fit(form, step);
  const RoomInside<Form> f{form, step, k};
  const double before = value(ws.step_start.room[k]);
  hit.take(first_at_no_load(form, step, f, before, hit.s), k);
  double middle = -1;
  hit.take(first_between_lines(ws, f, hit.s, middle), k);
  if (!ends_say_little(ws, hit) && least >= ample - 1 && middle >= ample - 1) return;
  hit.take(first_dip(f, before, value(ws.step_end.room[k]), hit.s), k);
}

/// The same beside transmissions: at a ratio at which one of them leaves a contact of the set nothing to hold by, the
/// limit load is zero in an instant. It is seen by what the set holds far from there, beyond what counts as ample.
/// docs/theory/varying-ratios.md (22)
template <class Form>
[[gnu::noinline]] void find_limit_beside(Form& form, Step<Form>& step, int k, Hit& hit) {
  constexpr double most = 1e6;
  constexpr int rounds = 30;
  fit(form, step);
  const RoomInside<Form> f{form, step, k, most};
  const double limit = hit.none() ? 1.0 : hit.s;
  hit.take(first_dip(f, f(0), f(limit), limit, rounds), k);
}

/// A dependent set of locked contacts at its limit load.
struct SetLimit : OwnScale {
  static constexpr const char* name = "set";
  static constexpr Effect effect = Effect::decides;

  template <class T>
  static bool watches(const Workspace<T>& ws) {
    return ws.held.n_sets > 0;
  }
  /// Where a set gives way of which the load of a member bends, by what it has left of its limit load [N m]: where that
  /// member touches zero the set may hold more than what counts as ample at all samples around, which say nothing then.
  template <class Form>
  [[gnu::noinline]] static void find_bending_limit(Form& form, Step<Form>& step, int k, Hit& hit) {
    constexpr double most = 1e12;
    fit(form, step);
    const RoomInside<Form> f{form, step, k, most, true};
    hit.take(first_crossing(f, f(0), f(1), hit.s), k);
  }
  /// Call f for each set under next to no load with a member that holds one way alone.
  template <class T, class F>
  static void each_border(const Workspace<T>& ws, F&& f) {
    const double little = 1e-6 * torque_size(*ws.moved.plain);
    for (int k = 0; k < ws.held.n_sets; ++k) {
      bool one_way = false;
      for (int i = ws.held.set_first[k]; i < ws.held.set_first[k + 1]; ++i)
        one_way = one_way || free_way(ws, ws.held.set_member[i]) != 0;
      if (one_way && largest_load(ws, k, ws.step_start.multiplier) <= little) f(k);
    }
  }
  /// The load of such a set that moves most.
  template <class Form, class T = typename Form::Scalar>
  static T border(Form& form, Step<Form>& step, const Hit& hit, double t, const T* y) {
    Workspace<T>& ws = form.ws;
    see_torques(form, step, t, y);
    const int first = ws.held.set_first[hit.index];
    T most = T(0);
    for (int i = first; i < first + ws.held.set_rank[hit.index]; ++i) {
      const T load = without_value(ws.observed.carried[ws.held.set_place[i]]);
      if (largest_difference(load, T(0)) > largest_difference(most, T(0))) most = load;
    }
    return most;
  }
  template <class Form>
  [[gnu::noinline]] static void find(Form& form, Step<Form>& step, Hit& hit) {
    using T = typename Form::Scalar;
    Workspace<T>& ws = form.ws;
    for (int k = 0; k < ws.held.n_sets; ++k) {
      const double before = value(ws.step_start.room[k]), after = value(ws.step_end.room[k]);
      const double coming = room_ahead(ws, k, ws.step_start, step.h), gone = room_ahead(ws, k, ws.step_end, -step.h);
      const double change = larger(abs(after - before), larger(before - coming, after - gone));
      bool bends = false;
      for (int i = ws.held.set_first[k]; i < ws.held.set_first[k + 1]; ++i)
        bends = bends || load_bends(ws, ws.held.set_member[i]);
      if (ws.ratios.n > 0) find_limit_beside(form, step, k, hit);
      if (bends) find_bending_limit(form, step, k, hit);
      if (ws.sys.loads > 0 && holds_loads(ws)) {
        find_loaded_limit(form, step, k, smaller(smaller(before, after), smaller(coming, gone)), hit);
        continue;
      }
      if (bends || (!ends_say_little(ws, hit) && smaller(before, after) > change)) continue;
      fit(form, step);
      const RoomInside<Form> f{form, step, k};
      hit.take(first_crossing(f, before, after, hit.s), k);
    }
    if (hit.what == hit.asked) see_held(form, step, hit);
  }
  /// Where a set is seen before a limit that jumps: at it no share of its members holds it.
  template <class Form>
  [[gnu::noinline]] static void see_held(Form& form, Step<Form>& step, Hit& hit) {
    constexpr double bit = 4e-16, farthest = 1e-9;
    const RoomInside<Form> room_at{form, step, hit.index};
    if (room_at(hit.s) > -0.5) return;
    for (double back = bit; back <= farthest && back < hit.s; back *= 2) {
      const double room = room_at(hit.s - back);
      if (room >= 0 && room < infinity) return void(hit.held = hit.s - back);
    }
  }
  template <class Form, class T = typename Form::Scalar>
  static T at(Form& form, Step<Form>& step, const Hit& hit, double t, const T* y, int&) {
    see_torques(form, step, t, y);
    return set_room(form.ws, hit.index, form.ws.observed.carried, T(0), form.ws.loads.now);
  }
  /// Where what is left is told of a limit at which a set gives way that holds any multiple of its load or none: before
  /// it where members follow loads, else behind it.
  template <class T>
  static double told_from(const Workspace<T>& ws) {
    return ws.sys.loads > 0 && holds_loads(ws) ? -1.0 : 1.0;
  }
  /// `side`: behind it, 1, or before.
  template <class Form, class T = typename Form::Scalar>
  static T left(Form& form, Step<Form>& step, const Hit& hit, double t, const T* y, double side) {
    Workspace<T>& ws = form.ws;
    see_torques(form, step, t, y);
    if (side > 0) return set_deficit(ws, hit.index, ws.observed.carried, ws.loads.now);
    return set_slack(ws, hit.index, ws.observed.carried, ws.loads.now);
  }
  /// Whether it is such a one, by its guard at the limit, or nearly so: its load is next to none of that before.
  template <class T>
  static bool is_sudden(const Workspace<T>& ws, const Hit& hit, double guard) {
    if (abs(guard) > 0.5) return true;
    const double before = largest_load(*ws.moved.plain, hit.index, ws.moved.plain->step_start.multiplier);
    return told_from(ws) > 0 && largest_load(ws, hit.index, ws.observed.carried) <= 1e-2 * before;
  }
  template <class T>
  static int component(const Workspace<T>& ws, const Hit& hit) {
    return int(ws.sys.elements) + ws.held.set_member[ws.held.set_first[hit.index]];
  }
  /// Its contacts slip the way in which it gives way, seen as close behind the limit as that can be told.
  template <class Phase, class T = typename Phase::Scalar>
  static void force(Phase& phase, const Hit& hit) {
    constexpr int halvings = 20;
    const double s = larger(hit.s, 1e-6);
    for (int k = halvings + 1; k >= 0; --k) {
      see_at(phase, k > halvings ? s : s + (1 - s) / (1 << k));
      if (break_set(phase.ws(), hit.index, phase.ws().observed.carried, k == 0)) return;
    }
  }
  /// Torques and loads at the share s of the step.
  template <class Phase, class T = typename Phase::Scalar>
  static void see_at(Phase& phase, double s) {
    Workspace<T>& ws = phase.ws();
    auto& seen = phase.taken_form().ws;
    torques_at(phase.taken_form(), phase.taken_step(), s);
    if constexpr (has_tangents<T>) {
      for (int a = 0; a < ws.held.n; ++a) ws.observed.carried[a] = T(seen.observed.carried[a]);
      for (int l = 0; l < ws.sys.loads; ++l) ws.loads.now[l] = T(seen.loads.now[l]);
    }
  }
  /// Freewheels at their own limit give way for good.
  template <class Phase>
  static void settle(Phase& phase, const Hit& hit) {
    auto& ws = phase.ws();
    phase.decide(Cause::torque_limit);
    if (events_crowd(ws, component(ws, hit))) phase.end(Status::zeno);
    for (int i = ws.held.set_first[hit.index]; i < ws.held.set_first[hit.index + 1]; ++i) {
      const int c = ws.held.set_member[i];
      if (ws.contact.forced[c] == backward && rolls_over(ws, c)) fail(ws, c);
    }
  }
};

}  // namespace clutchwork

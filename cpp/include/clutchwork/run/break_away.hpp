#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/locate.hpp>
#include <clutchwork/workspace.hpp>

/// Where in a step locked contacts let go, alone, as a set, or where prescribed speeds part them:
/// docs/theory/events.md.
namespace clutchwork {

/// Margin of a locked contact: how much torque is left before it slips, round-off conceded.
template <class T>
CLUTCHWORK_INLINE Real<T> margin(const Workspace<T>& ws, int a, T torque, T capacity) {
  capacity += ws.here.noise[a];
  const int way = free_way(ws, ws.held.contact[a]);
  if (way == 0) return value(capacity) - abs(value(torque));
  if (way < 0) return value(capacity - torque);
  return smaller(value(torque + capacity), value(freewheel_limit(ws, ws.held.contact[a]) - torque));
}

/// Whether the margin of a locked contact exceeds what can change in a step of length h; its margins at both ends.
template <class T>
CLUTCHWORK_INLINE Truth<T> holds_on(const Workspace<T>& ws, int a, Real<T> h, Real<T>& before, Real<T>& after) {
  const auto &e0 = ws.here, &e1 = ws.there;
  before = margin(ws, a, e0.multiplier[a], e0.capacity[a]);
  after = margin(ws, a, e1.multiplier[a], e1.capacity[a]);
  const Real<T> change = abs(value(e1.multiplier[a] - e0.multiplier[a])) + abs(value(e1.capacity[a] - e0.capacity[a]));
  const Real<T> drift = h * larger(abs(value(e0.drift[a])), abs(value(e1.drift[a])));
  const Real<T> swing = h * value(larger(e0.swing[a], e1.swing[a]));
  return smaller(before, after) > larger(change, drift + swing);
}

/// Whether a freewheel was hit at the torque at which it gives way, and not where its torque ends.
template <class T>
bool rolls_over(const Workspace<T>& ws, int c) {
  return contact_one_way(ws, c) && value(freewheel_limit(ws, c)) < infinity && value(ws.happened.torque[c]) > 0;
}

/// Torques of the carriers at s, into ws.seen.carried.
template <class Form>
void torques_at(Form& form, Step<Form>& step, double s) {
  auto& ws = form.ws;
  interpolate(form, step, s, step.point());
  const double t = step.t + s * step.h;
  inputs_at(ws, t);
  if (ws.sys.prescribed > 0) input_slopes_at(ws, t);
  observe(form, t, step.point(), step.slope());
  multipliers(ws, ws.seen.torque, true, ws.seen.carried);
  if (ws.sys.loads > 0) loads_seen(ws);
  ++ws.statistics.locations;
}

/// Round-off of the other end of the step, for a contact that holds less than that: all torques may be zero at the
/// start.
template <class T>
double more_noise(const Workspace<T>& ws, int a, T capacity) {
  const double more = value(ws.there.noise[a] - ws.here.noise[a]);
  return value(capacity) < more ? more : 0.0;
}

/// Margin of a locked contact where the torques were looked at last.
template <class T>
double margin_seen(const Workspace<T>& ws, int a) {
  const T torque = ws.seen.carried[a], capacity = capacity_at(ws, ws.held.contact[a], torque);
  return margin(ws, a, torque, capacity) + more_noise(ws, a, capacity);
}

/// Smallest margin of the watched locked contacts at s, and whose it is.
template <class Form>
double least_margin(Form& form, Step<Form>& step, double s, const int* watched, int n, int& who) {
  auto& ws = form.ws;
  torques_at(form, step, s);
  double least = infinity;
  for (int i = 0; i < n; ++i) {
    const double m = margin_seen(ws, watched[i]);
    if (m < least) least = m, who = watched[i];
  }
  return least;
}

/// Where the prescribed speeds on both sides of a held contact part; -1: not before `limit`.
template <class Form>
double rigid_departure(Form& form, Step<Form>& step, int a, double limit) {
  auto& ws = form.ws;
  const int d = int(ws.sys.elements) + ws.held.contact[a];
  const double zero = ws.guard.zero;
  auto f = [&](double s) {
    double slip = 0;
    for (int p = 0; p < ws.sys.prescribed; ++p) {
      slip +=
          value(prescribed_share(ws, d, p)) * value(signal_value(ws, ws.sys.prescribed_input[p], step.t + s * step.h));
    }
    return zero - abs(slip);
  };
  return first_crossing(f, f(0), f(1), limit);
}

/// Torques of locked contacts: skipped while the margin exceeds what can change in the step.
template <class Form>
CLUTCHWORK_INLINE void find_break_away(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  int* watched = ws.guard.limit;
  int n = 0;
  double m0 = infinity, m1 = infinity;
  for (int a = 0; a < ws.held.n; ++a) {
    if (is_rigid(ws, ws.held.contact[a])) {
      const double s = rigid_departure(form, step, a, hit.s);
      if (!is_first(hit, s)) continue;
      fit(form, step);
      hit = {Hit::multiplier, a, s, -1};
      continue;
    }
    if (ws.held.in_set[a] != 0) continue;
    double before, after;
    const bool holds = holds_on(ws, a, step.h, before, after);
    // up to where a capacity bends, the end of the step says nothing
    if (holds && hit.what != Hit::bend) continue;
    watched[n++] = a;
    m0 = smaller(m0, before + more_noise(ws, a, ws.here.capacity[a]));
    m1 = smaller(m1, after + more_noise(ws, a, ws.there.capacity[a]));
  }
  if (n == 0) return;
  fit(form, step);
  int who = watched[0];
  auto f = [&](double s) { return least_margin(form, step, s, watched, n, who); };
  const double s = first_crossing(f, m0, m1, hit.s);
  if (!is_first(hit, s)) return;
  // where several are at their limits at once, the first that goes beyond
  double beyond = f(s);
  const int at_limit = who;
  for (int k = 12; k > 0 && beyond >= 0; --k) beyond = f(s + (hit.s - s) / (1 << k));
  torques_at(form, step, s);
  if (margin_seen(ws, who) > 1e-6 * value(capacity_at(ws, ws.held.contact[who], ws.seen.carried[who]))) who = at_limit;
  // what round-off alone has kept from the start of the run is at the start
  const bool kept = ws.statistics.steps <= 1 && s * step.h <= 1e-14 * (1 + abs(step.t));
  hit = {Hit::multiplier, who, kept ? 0.0 : s, -1};
}

/// The same for a set with contacts that follow loads: its limit load has kinks where a load changes its sign. Far from
/// it at both ends, ahead of both and in the middle, it is taken to be far from it in between.
template <class Form>
[[gnu::noinline]] void find_loaded_limit(Form& form, Step<Form>& step, int k, double least, Hit& hit) {
  auto& ws = form.ws;
  fit(form, step);
  auto f = [&](double s) {
    torques_at(form, step, s);
    return value(set_room(ws, k, ws.seen.carried, ws.here.noise[0], ws.loads.now));
  };
  if (hit.what != Hit::bend && least >= ample - 1 && f(0.5) >= ample - 1) return;
  const double s = first_dip(f, value(ws.here.room[k]), value(ws.there.room[k]), hit.s);
  if (is_first(hit, s)) hit = {Hit::set, k, s, -1};
}

/// Where a dependent set of locked contacts reaches its limit load.
template <class Form>
[[gnu::noinline]] void find_set_limit(Form& form, Step<Form>& step, Hit& hit) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  for (int k = 0; k < ws.held.n_sets; ++k) {
    const double before = value(ws.here.room[k]), after = value(ws.there.room[k]);
    const double coming = room_ahead(ws, k, ws.here, step.h), gone = room_ahead(ws, k, ws.there, -step.h);
    const double change = larger(abs(after - before), larger(before - coming, after - gone));
    bool bends = false;
    if (ws.sys.loads > 0 && holds_loads(ws)) {
      find_loaded_limit(form, step, k, smaller(smaller(before, after), smaller(coming, gone)), hit);
      continue;
    }
    for (int i = ws.held.set_first[k]; i < ws.held.set_first[k + 1]; ++i)
      bends = bends || load_bends(ws, ws.held.set_member[i]);
    if (!bends && hit.what != Hit::bend && smaller(before, after) > change) continue;
    fit(form, step);
    auto f = [&](double s) {
      torques_at(form, step, s);
      return value(set_room(ws, k, ws.seen.carried, ws.here.noise[0], ws.loads.now));
    };
    const double s = first_crossing(f, before, after, hit.s);
    if (is_first(hit, s)) hit = {Hit::set, k, s, -1};
  }
}

/// Slip of a locked contact at s, which transmissions hold: the interpolant is brought onto their ties.
template <class Form, class T = typename Form::Scalar>
double slip_beside(Form& form, Step<Form>& step, int c, double s) {
  Workspace<T>& ws = form.ws;
  interpolate(form, step, s, step.point());
  inputs_at(ws, step.t + s * step.h);
  if constexpr (Form::full) {
    if (s > 0 && s < 1) observe(form, step.t + s * step.h, step.point(), step.slope()), settle_ties(form, step.point());
  }
  expand(form, step.point(), ws.out.v);
  const int d = int(ws.sys.elements) + c;
  T slip = rate_row(ws.sys, d).times(ws.out.v);
  for (int p = 0; p < ws.sys.prescribed; ++p) slip += prescribed_share(ws, d, p) * ws.in.prescribed[p];
  return value(slip);
}

/// Where a transmission parts what it held together itself: where the slip leaves what counts as zero.
template <class Form>
void find_parting_beside(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  fit(form, step);
  for (int i = 0; i < ws.held.n_driven; ++i) {
    const int spare = ws.held.driven[i], c = ws.held.spare[spare];
    const double end = abs(slip_beside(form, step, c, 1.0)), zero = ws.guard.zero;
    if (end <= zero) continue;
    auto f = [&](double s) { return zero - abs(slip_beside(form, step, c, s)); };
    const double s = first_crossing(f, zero, zero - end, hit.s);
    if (is_first(hit, s)) hit = {Hit::parting, spare, s, -1};
  }
}

/// Where prescribed speeds part what locked contacts hold together. docs/theory/events.md, rule 11
template <class Form>
void find_parting(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  if (ws.ratios.n > 0) return find_parting_beside(form, step, hit);
  const double zero = ws.guard.zero;
  for (int i = 0; i < ws.held.n_driven; ++i) {
    auto f = [&](double s) {
      double slip = 0;
      for (int p = 0; p < ws.sys.prescribed; ++p) {
        slip += driven_share(ws, ws.held.driven[i], p) *
                value(signal_value(ws, ws.sys.prescribed_input[p], step.t + s * step.h));
      }
      return zero - abs(slip);
    };
    const double s = first_crossing(f, f(0), f(1), hit.s);
    if (!is_first(hit, s)) continue;
    fit(form, step);
    hit = {Hit::parting, ws.held.driven[i], s, -1};
  }
}

}  // namespace clutchwork

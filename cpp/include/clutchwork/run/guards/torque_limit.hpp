#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/lost_ratios.hpp>
#include <clutchwork/run/clamp_loads.hpp>
#include <clutchwork/run/guards/inputs.hpp>
#include <clutchwork/run/guards/torques.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/locate.hpp>
#include <clutchwork/workspace.hpp>

/// Where a locked contact breaks away. docs/theory/events.md
namespace clutchwork {

/// Whether a freewheel was hit at the torque at which it gives way, and not where its torque ends.
template <class T>
bool rolls_over(const Workspace<T>& ws, int c) {
  if (!contact_one_way(ws, c)) return false;
  // where its torque ends it is round-off of either sign
  const double limit = value(freewheel_limit(ws, c));
  return limit < infinity && value(ws.event_context.torque[c]) > 0.5 * limit;
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

/// Where the margin f of one locked contact passes zero before `limit`, else what was found.
template <class T, class F>
double first_alone(const Workspace<T>& ws, F&& f, int a, double h, double limit, double found) {
  double before, after;
  holds_on(ws, a, h, before, after);
  before += more_noise(ws, a, ws.step_start.capacity[a]), after += more_noise(ws, a, ws.step_end.capacity[a]);
  const double at = first_crossing(f, before, after, limit);
  return at >= 0 && (found < 0 || at < found) ? at : found;
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

/// Whether the torque of a locked contact has a pole in the step: a row turns over, or the torque passes from one sign
/// to the other and grows towards it from both ends. docs/theory/varying-ratios.md (22)
template <class T>
bool has_pole(const Workspace<T>& ws, int a) {
  if (ws.ratios.reversed >= 0) return true;
  const double before = value(ws.step_start.multiplier[a]), after = value(ws.step_end.multiplier[a]);
  return before * after < 0 && before * value(ws.step_start.drift[a]) > 0 && after * value(ws.step_end.drift[a]) < 0;
}

/// Whether the point that was evaluated last is before the pole: its tie is turned over to that at the end of the step,
/// or the sign of the torque is that at the start.
template <class T>
bool is_before_pole(const Workspace<T>& ws, bool same_sign) {
  const Ratios<T>& r = ws.ratios;
  if (r.reversed < 0) return same_sign;
  return tie_product(r, r.some, r.plain, r.reversed) < 0;
}

/// Where what is held with such a torque leaves its limit, on the way to the pole, by its margin f; -1: not before
/// `limit`. Where a tie turns over nothing is left of the digits of a margin next to the pole.
template <class T, class F>
[[gnu::noinline]] double before_pole(const Workspace<T>& ws, int a, F&& f, double margin_at_start, double limit) {
  const int halvings = ws.ratios.reversed >= 0 ? 24 : 40;
  const double sign = value(ws.step_start.multiplier[a]);
  double low = 0, above = larger(margin_at_start, 0.0), high = 1;
  for (int k = 0; k < halvings; ++k) {
    const double middle = 0.5 * (low + high), margin = f(middle);
    if (margin < 0) {
      const double s = locate(f, low, above, middle, margin);
      return s <= limit ? s : -1;
    }
    if (is_before_pole(ws, sign * value(ws.observed.carried[a]) > 0))
      low = middle, above = margin;
    else
      high = middle;
  }
  return -1;
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

/// Whether a redundant contact holds more now than independent contact a of its set.
template <class T>
bool has_stronger(const Workspace<T>& ws, int a) {
  const Held<T>& h = ws.held;
  auto strength = [&](int c) {
    T lower, upper;
    bounds_of_held(ws, c, lower, upper);
    return larger(value(-lower), value(upper));
  };
  for (int s = 0; s < h.n_redundant; ++s) {
    const int c = h.redundant[s];
    const bool shares = ws.loads.of[c] < 0 && value(h.tie[s * ws.sys.contacts + a]) != 0;
    if (shares && strength(c) > strength(h.contact[a])) return true;
  }
  return false;
}

/// Where an independent contact of a set, with whose torque gears in slip move, no longer holds that, and a stronger
/// one takes its place. docs/theory/load-dependent.md, rule 3
template <class Form>
[[gnu::noinline]] void find_handover(Form& form, Step<Form>& step, Hit& hit) {
  // of the capacity: one that starts at its limit has nowhere to pass it
  constexpr double least = 1e-9;
  auto& ws = form.ws;
  for (int a = 0; a < ws.held.n; ++a) {
    const int c = ws.held.contact[a];
    if (ws.held.in_set[a] == 0 || ws.loads.of[c] >= 0 || is_rigid(ws, c)) continue;
    double before, after;
    const bool holds = holds_on(ws, a, step.h, before, after);
    if (holds || before <= least * value(ws.step_start.capacity[a])) continue;
    fit(form, step);
    auto f = [&](double s) {
      torques_at(form, step, s);
      return margin_seen(ws, a);
    };
    const double s = first_crossing(f, before, after, hit.s);
    if (!hit.is_after(s)) continue;
    f(s);
    if (has_stronger(ws, a)) hit.take(s, a);
  }
}

/// The same where gears slip beside sets.
template <class Form>
CLUTCHWORK_INLINE void seek_handover(Form& form, Step<Form>& step, Hit& hit) {
  if constexpr (Form::full) {
    if (form.ws.held.n_sets > 0 && form.ws.loads.n_sliding > 0) find_handover(form, step, hit);
  }
}

/// A locked contact at its limit, or one whose sides prescribed speeds part.
struct TorqueLimit {
  static constexpr const char* name = "multiplier";
  static constexpr Effect effect = Effect::decides;

  template <class T>
  static bool watches(const Workspace<T>& ws) {
    return ws.held.n > 0;
  }
  /// Call f for each contact that holds one way alone, as a closed stop does, and next to nothing, or all that it can.
  template <class T, class F>
  static void each_border(const Workspace<T>& ws, F&& f) {
    const double little = 1e-6 * torque_size(*ws.moved.plain);
    for (int a = 0; a < ws.held.n; ++a) {
      const int c = ws.held.contact[a];
      if (ws.held.in_set[a] != 0 || is_rigid(ws, c)) continue;
      const T torque = ws.step_start.multiplier[a];
      const double size = abs(value(torque)), left = abs(value(distance_from_slip(ws, c, torque)));
      if (free_way(ws, c) != 0 ? size <= little : left <= 1e-9 * size) f(a);
    }
  }
  /// Skipped while the margin exceeds what can change in the step.
  template <class Form>
  CLUTCHWORK_INLINE static void find(Form& form, Step<Form>& step, Hit& hit) {
    auto& ws = form.ws;
    seek_handover(form, step, hit);
    int* watched = ws.guard.limit;
    int n = 0;
    double m0 = infinity, m1 = infinity;
    for (int a = 0; a < ws.held.n; ++a) {
      if (is_rigid(ws, ws.held.contact[a])) {
        const double s = rigid_departure(form, step, a, hit.s);
        if (hit.take(s, a)) fit(form, step);
        continue;
      }
      if (ws.held.in_set[a] != 0) continue;
      double before, after;
      const bool holds = holds_on(ws, a, step.h, before, after);
      const bool pole = ws.ratios.n > 0 && has_pole(ws, a);
      if (holds && !pole && !ends_say_little(ws, hit) && !passes_no_load(ws, ws.held.contact[a])) continue;
      if (pole) {
        fit(form, step);
        auto margin_of = [&](double s) {
          torques_at(form, step, s);
          return margin_seen(ws, a);
        };
        hit.take(before_pole(ws, a, margin_of, before, hit.s), a);
      }
      watched[n++] = a;
      m0 = smaller(m0, before + more_noise(ws, a, ws.step_start.capacity[a]));
      m1 = smaller(m1, after + more_noise(ws, a, ws.step_end.capacity[a]));
    }
    if (n == 0) return;
    fit(form, step);
    int first = 0, count = n, who = watched[0];
    auto f = [&](double x) { return least_margin(form, step, x, watched + first, count, who); };
    double s = first_crossing(f, m0, m1, hit.s);
    // a load that dips hides behind what has next to nothing left all the time: each of these alone
    for (count = 1; first < n && n > 1; ++first) {
      if (load_bends(ws, ws.held.contact[watched[first]]))
        s = first_alone(ws, f, watched[first], step.h, s < 0 ? hit.s : s, s);
    }
    first = 0, count = n;
    if constexpr (Form::full) {
      const double sharp = first_at_no_load(form, step, f, m0, s < 0 ? hit.s : s);
      if (sharp >= 0) s = sharp;
    }
    if (!hit.is_after(s)) return;
    // where several are at their limits at once, the first that goes beyond
    double beyond = f(s);
    const int at_limit = who;
    for (int k = 12; k > 0 && beyond >= 0; --k) beyond = f(s + (hit.s - s) / (1 << k));
    torques_at(form, step, s);
    if (margin_seen(ws, who) > 1e-6 * value(capacity_at(ws, ws.held.contact[who], ws.observed.carried[who])))
      who = at_limit;
    // what round-off alone has kept from the start of the run is at the start
    const bool kept = ws.statistics.steps <= 1 && s * step.h <= 1e-14 * (1 + abs(step.t));
    hit.take(kept ? 0.0 : s, who);
  }
  template <class Form, class T = typename Form::Scalar>
  static T at(Form& form, Step<Form>& step, const Hit& hit, double t, const T* y, int&) {
    Workspace<T>& ws = form.ws;
    const int c = ws.held.contact[hit.index];
    if (is_rigid(ws, c)) return abs(rate_at(form, int(ws.sys.elements) + c, t, y));
    see_torques(form, step, t, y);
    return distance_from_slip(ws, c, ws.observed.carried[hit.index]);
  }
  template <class Form, class T = typename Form::Scalar>
  static double scale(Form& form, const Hit& hit, const T*) {
    return larger(abs(value(form.ws.observed.carried[hit.index])), 1e-3 * torque_size(form.ws));
  }
  template <class T>
  static int component(const Workspace<T>& ws, const Hit& hit) {
    return int(ws.sys.elements) + ws.held.contact[hit.index];
  }
  /// It slips against its torque; a freewheel overruns, or gives way for good. docs/theory/contacts.md, rule 4
  template <class Phase>
  static void settle(Phase& phase, const Hit& hit) {
    auto& ws = phase.ws();
    const int c = ws.held.contact[hit.index];
    // the set goes on holding, by another one
    if (ws.held.in_set[hit.index] != 0 && !is_rigid(ws, c)) return phase.decide(Cause::other_event);
    phase.decide(Cause::torque_limit, c);
    if (rolls_over(ws, c)) return fail(ws, c);
    if (is_rigid(ws, c)) return;
    // at the start of a run all torques may be round-off
    const double start = value(ws.step_start.multiplier[hit.index]), noise = value(ws.step_start.noise[hit.index]);
    const bool told = hit.s > 0 || abs(start) > noise;
    const double pull = told ? value(ws.event_context.torque[c]) : value(ws.step_end.multiplier[hit.index]);
    const int way = free_way(ws, c);
    ws.contact.forced[c] = way != 0 ? way : pull > 0 ? backward : forward;
  }
};

}  // namespace clutchwork

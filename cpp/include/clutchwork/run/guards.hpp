#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/workspace.hpp>

/// Where inside a step something changes: docs/theory/events.md.
namespace clutchwork {

/// The first thing that happens inside a step.
struct Hit {
  enum What : int { nothing, line, multiplier, set, parting, load, law, fault, exit } what = nothing;
  int index = -1;  ///< guard, locked contact, dependent set, spare, contact, or branch
  double s = 1;    ///< where in the step, 0 to 1
  int who = -1;    ///< what of a law leaves its piece
};

/// Round-off of a load over its largest size: a load that has passed zero passes it again only from farther away.
inline constexpr double load_noise = 1e-11;

/// Whether a zero at s comes before what has been found.
CLUTCHWORK_INLINE bool is_first(const Hit& hit, double s) { return s >= 0 && (hit.what == Hit::nothing || s < hit.s); }

/// First interval in which a quartic in Bernstein form turns from not negative to negative. b[0] counts as not
/// negative; inner dips above -tolerance do not count, the end value does.
inline bool first_bracket(const double* b, double tolerance, int depth, bool last, double& low, double& high) {
  int changes = 0;
  bool dips = last && b[4] < 0, below = false;
  for (int i = 1; i < 5; ++i) {
    dips = dips || b[i] < -tolerance;
    changes += (b[i] < 0) != below;
    below = b[i] < 0;
  }
  if (!dips) return false;
  if (below && (changes == 1 || depth == 0)) return true;
  if (depth == 0) return false;
  // split in the middle
  double left[5], right[5], work[5];
  for (int i = 0; i < 5; ++i) work[i] = b[i];
  work[0] = larger(work[0], 0.0);
  for (int k = 0; k < 5; ++k) {
    left[k] = work[0];
    right[4 - k] = work[4 - k];
    for (int i = 0; i < 4 - k; ++i) work[i] = 0.5 * (work[i] + work[i + 1]);
  }
  const double middle = 0.5 * (low + high);
  double end = middle;
  if (first_bracket(left, tolerance, depth - 1, false, low, end)) return high = end, true;
  low = middle;
  return first_bracket(right, tolerance, depth - 1, last, low, high);
}

/// Root of a decreasing-through-zero function on [low, high] with f(low) >= 0 > f(high), to round-off (ITP).
template <class F>
double locate(F&& f, double low, double f_low, double high, double f_high) {
  // a guard that starts on its surface: step off it, or it is hit at once
  for (int k = 1; k < 12 && f_low <= 0; ++k) {
    const double x = low + (high - low) / double(1 << k), y = f(x);
    if (y > 0) low = x, f_low = y;
  }
  if (f_low <= 0) return low;
  for (int i = 0; i < 100 && high - low > 4e-16 * (1 + high); ++i) {
    // false position, bisection every third time
    double x = (low * f_high - high * f_low) / (f_high - f_low);
    if (i % 3 == 2 || !(x > low && x < high)) x = 0.5 * (low + high);
    if (x <= low || x >= high) break;
    const double y = f(x);
    if (y > 0) {
      low = x, f_low = y;
    } else if (y < 0) {
      high = x, f_high = y;
    } else {
      return x;
    }
  }
  return high;
}

/// First sample below zero among five inner points and the vertex of a parabola at the lowest; then its root.
template <class F>
double first_crossing(F&& f, double start, double end, double limit) {
  double x[8], y[8];
  int n = 0;
  x[n] = 0, y[n++] = larger(start, 0.0);
  for (int i = 1; i < 5; ++i) x[n] = 0.2 * i * limit, y[n] = f(x[n]), ++n;
  x[n] = limit, y[n++] = limit == 1 ? end : f(limit);
  int low = 0;
  for (int i = 1; i < n; ++i) {
    if (y[i] < 0) return locate(f, x[i - 1], y[i - 1], x[i], y[i]);
    if (y[i] < y[low]) low = i;
  }
  // vertex through the lowest sample and its neighbours; once more, closer, where it almost touches
  const int middle = low == 0 ? 1 : low == n - 1 ? n - 2 : low;
  double centre = x[middle], step = x[middle] - x[middle - 1];
  double left = y[middle - 1], here = y[middle], right = y[middle + 1];
  for (int round = 0; round < 2; ++round) {
    const double d = left - 2 * here + right;
    if (d <= 0) return -1;
    const double vertex = centre + 0.5 * step * (left - right) / d;
    if (vertex <= 0 || vertex >= limit || abs(vertex - centre) > step) return -1;
    const double bottom = f(vertex);
    if (bottom < 0) {
      int before = 0;
      while (before + 1 < n && x[before + 1] < vertex) ++before;
      return locate(f, x[before], y[before], vertex, bottom);
    }
    if (bottom > 0.01 * larger(left, right)) return -1;
    step *= 0.1;
    centre = vertex, here = bottom;
    left = f(larger(0.0, vertex - step)), right = f(smaller(limit, vertex + step));
  }
  return -1;
}

/// Whether any prescribed speed varies, so that rates are no polynomials.
template <class T>
bool rates_bend(const Workspace<T>& ws) {
  for (int p = 0; p < ws.sys.prescribed; ++p) {
    if (ws.signal[ws.sys.prescribed_input[p]].varying) return true;
  }
  return false;
}

/// First crossing of a guard that is linear in the state, before `limit`; -1: none.
template <class Form, class Integrator>
double line_crossing(Form& form, Step<Form>& step, const LineGuard& guard, double g0, double g1, double noise,
                     double limit) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  if (!step.dense) Integrator::prepare_dense(form, step);
  const int k = guard.branch;
  auto at = [&](double s) {
    interpolate(form, step, s, step.point());
    inputs_at(ws, step.t + s * step.h);
    return guard.sign * (value(form.rate(k, step.point()) + offset_rate(ws, k)) - guard.level);
  };
  if (rates_bend(ws)) return first_crossing(at, g0, g1, limit);
  // Bernstein coefficients of the quartic
  const double q0 = guard.sign * value(form.rate(k, step.p(0))), q1 = guard.sign * value(form.rate(k, step.p(1))),
               q2 = guard.sign * value(form.rate(k, step.p(2)));
  const double a1 = g1 - g0 + q0, a2 = q1 - q0, a3 = q2 - q1;
  // a guard that starts on its surface must leave it as the motion does, not as the interpolant does
  const bool fresh = abs(g0) <= 1e3 * noise;
  const double leaving = guard.sign * step.h * value(ws.here.slope[k]);
  const double mend = fresh && leaving * a1 <= 0 ? leaving - a1 : 0.0;
  double b[5] = {larger(g0, 0.0), g0 + (a1 + mend) / 4, g0 + a1 / 2 + a2 / 6, g0 + 0.75 * a1 + a2 / 2 + a3 / 4, g1};
  double scale = 0;
  for (double x : b) scale = larger(scale, abs(x));
  double low = 0, high = 1;
  if (!first_bracket(b, larger(1e-9 * scale, noise), 40, g1 < (fresh ? -noise : 0.0), low, high)) return -1;
  const double start = larger(g0, 0.0);
  auto poly = [&](double s) {
    const double r = 1 - s;
    return r * start + s * (g1 + r * (q0 + s * (q1 + s * q2) + r * r * mend));
  };
  const double f_low = larger(poly(low), 0.0), f_high = poly(high);
  if (f_high >= 0) return high;
  const double s = locate(poly, low, f_low, high, f_high);
  return s <= limit ? s : -1;
}

/// Margin of a locked contact: how much torque is left before it slips, round-off conceded.
template <class T>
CLUTCHWORK_INLINE double margin(const Workspace<T>& ws, int a, T torque, T capacity) {
  capacity += ws.here.noise[a];
  if (!contact_one_way(ws, ws.locked[a])) return value(capacity) - abs(value(torque));
  return smaller(value(torque + capacity), value(freewheel_limit(ws, ws.locked[a]) - torque));
}

/// Whether a freewheel was hit at the torque at which it gives way, and not where its torque ends.
template <class T>
bool rolls_over(const Workspace<T>& ws, int c) {
  return contact_one_way(ws, c) && value(freewheel_limit(ws, c)) < infinity && value(ws.torque_before[c]) > 0;
}

/// Torques of the carriers at s, into the output torques.
template <class Form>
void torques_at(Form& form, Step<Form>& step, double s) {
  auto& ws = form.ws;
  interpolate(form, step, s, step.point());
  const double t = step.t + s * step.h;
  inputs_at(ws, t);
  if (ws.sys.prescribed > 0) input_slopes_at(ws, t);
  observe(form, t, step.point(), step.slope(), ws.scratch, ws.torque);
  multipliers(ws, ws.torque, true, ws.output_torque);
  ++ws.statistics.locations;
}

/// Smallest margin of the watched locked contacts at s, and whose it is.
template <class Form>
double least_margin(Form& form, Step<Form>& step, double s, const int* watched, int n, int& who) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  torques_at(form, step, s);
  double least = infinity;
  for (int i = 0; i < n; ++i) {
    const int a = watched[i];
    const T torque = ws.output_torque[a];
    const double m = margin(ws, a, torque, capacity_at(ws, ws.locked[a], torque));
    if (m < least) least = m, who = a;
  }
  return least;
}

/// Where the prescribed speeds on both sides of a held contact part; -1: not before `limit`.
template <class Form>
double rigid_departure(Form& form, Step<Form>& step, int a, double limit) {
  auto& ws = form.ws;
  const int d = int(ws.sys.elements) + ws.locked[a];
  const double zero = slip_tolerance(ws);
  auto f = [&](double s) {
    double slip = 0;
    for (int p = 0; p < ws.sys.prescribed; ++p) {
      slip += value(prescribed_share(ws, d, p)) * signal_value(ws, ws.sys.prescribed_input[p], step.t + s * step.h);
    }
    return zero - abs(slip);
  };
  return first_crossing(f, f(0), f(1), limit);
}

/// All inputs at the share s of a step.
template <class Form>
void inputs_in(Form& form, Step<Form>& step, double s) {
  auto& ws = form.ws;
  const double t = step.t + s * step.h;
  if (ws.n_shared_refs == 0) return inputs_at(ws, t);
  interpolate(form, step, s, step.point());
  inputs_with(ws, t, step.point() + form.nz());
}

/// Where a contact fails.
template <class Form, class Integrator>
void find_fault(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  if (ws.n_shared_refs > 0 && !step.dense) Integrator::prepare_dense(form, step);
  for (int i = 0; i < ws.n_faulty; ++i) {
    const int c = ws.faulty[i];
    if (ws.fault[c] != sound) continue;
    auto f = [&](double s) {
      inputs_in(form, step, s);
      return -fault_trigger(ws, c);
    };
    const double s = first_crossing(f, f(0), f(1), hit.s);
    if (!is_first(hit, s)) continue;
    if (!step.dense) Integrator::prepare_dense(form, step);
    hit = {Hit::fault, c, s, -1};
  }
}

/// Where the law of a contact, locked or not, leaves a table that may not be left.
template <class Form, class Integrator>
void find_exit(Form& form, Step<Form>& step, Hit& hit) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  for (int i = 0; i < ws.n_bounded; ++i) {
    const int c = ws.bounded[i], k = ws.branch_of[ws.sys.elements + c];
    T seen = T(0);
    auto room = [&](double s, const T* y) {
      inputs_with(ws, step.t + s * step.h, y + form.nz());
      const T slip = k < 0 ? T(0) : form.rate(k, y) + offset_rate(ws, k);
      return value(table_room(ws, c, slip, seen));
    };
    const double start = room(0, step.y0()), end = room(1, step.y1());
    if (start >= 0 && end >= 0) continue;
    if (!step.dense) Integrator::prepare_dense(form, step);
    auto f = [&](double s) {
      interpolate(form, step, s, step.point());
      return room(s, step.point());
    };
    const double s = start < 0 ? 0.0 : first_crossing(f, start, end, hit.s);
    if (!is_first(hit, s)) continue;
    f(s);
    ws.detail_value = value(seen);
    hit = {Hit::exit, c, s, -1};
  }
}

/// Where the laws of compliant contacts and the pieces of elements change.
template <class Form, class Integrator>
void find_law_hit(Form& form, Step<Form>& step, Hit& hit) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  const int nz = form.nz();
  // round-off of a margin: a state at its limit has not passed it
  constexpr double noise = 1e-12;
  for (int i = 0; i < ws.n_switching; ++i) {
    const int k = ws.switching[i];
    const Branch<T>& b = ws.branch[k];
    int who = turned;
    const auto start = law_margin(ws, b, ws.here.rate[k], ws.here.slope[k], step.y0() + nz, step.f0() + nz, who);
    const auto end = law_margin(ws, b, ws.there.rate[k], ws.there.slope[k], step.y1() + nz, step.f1() + nz, who);
    const double change = abs(value(end.v - start.v));
    const double drift = step.h * larger(abs(value(start.d[0])), abs(value(end.d[0])));
    if (smaller(value(start.v), value(end.v)) > larger(change, drift)) continue;
    if (!step.dense) Integrator::prepare_dense(form, step);
    auto f = [&](double s) {
      interpolate(form, step, s, step.point());
      inputs_with(ws, step.t + s * step.h, step.point() + nz);
      const T rate = form.rate(k, step.point()) + offset_rate(ws, k);
      return noise + value(law_margin(ws, b, rate, T(0), step.point() + nz, step.f0() + nz, who).v);
    };
    const double s = first_crossing(f, noise + value(start.v), noise + value(end.v), hit.s);
    if (!is_first(hit, s)) continue;
    f(s);
    hit = {Hit::law, k, s, who};
  }
}

/// Slips and kinks: a cubic through values and slopes proves most of them clear.
template <class Form, class Integrator>
CLUTCHWORK_INLINE void find_line(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  const double h = step.h;
  const auto &e0 = ws.here, &e1 = ws.there;
  // round-off of a rate: far below the slip that counts as zero
  const double noise = 1e-3 * slip_tolerance(ws);
  for (int i = 0; i < ws.n_lines; ++i) {
    const LineGuard& g = ws.line[i];
    const int k = g.branch;
    double g0 = g.sign * (value(e0.rate[k]) - g.level), g1 = g.sign * (value(e1.rate[k]) - g.level);
    // a start behind the surface, within what counts as zero, is on it
    const double shift = g0 < 0 ? smaller(-g0, 1e3 * noise) : 0.0;
    g0 += shift, g1 += shift;
    const double c0 = g0 + g.sign * h * value(e0.slope[k]) / 3, c1 = g1 - g.sign * h * value(e1.slope[k]) / 3;
    if (g1 >= 0 && c0 >= 0 && c1 >= 0) continue;
    const double s = line_crossing<Form, Integrator>(form, step, g, g0, g1, noise, hit.s);
    if (is_first(hit, s)) hit = {Hit::line, i, s, -1};
  }
}

/// Torques of locked contacts: skipped while the margin exceeds what can change in the step.
template <class Form, class Integrator>
CLUTCHWORK_INLINE void find_break_away(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  const auto &e0 = ws.here, &e1 = ws.there;
  int* watched = ws.iscratch;
  int n = 0;
  double m0 = infinity, m1 = infinity;
  for (int a = 0; a < ws.n_locked; ++a) {
    if (is_rigid(ws, ws.locked[a])) {
      const double s = rigid_departure(form, step, a, hit.s);
      if (!is_first(hit, s)) continue;
      if (!step.dense) Integrator::prepare_dense(form, step);
      hit = {Hit::multiplier, a, s, -1};
      continue;
    }
    if (ws.in_set[a] != 0) continue;
    const double before = margin(ws, a, e0.multiplier[a], e0.capacity[a]),
                 after = margin(ws, a, e1.multiplier[a], e1.capacity[a]);
    const double change = abs(value(e1.multiplier[a] - e0.multiplier[a])) + abs(value(e1.capacity[a] - e0.capacity[a]));
    const double drift = step.h * larger(abs(value(e0.drift[a])), abs(value(e1.drift[a])));
    const double swing = step.h * value(larger(e0.swing[a], e1.swing[a]));
    if (smaller(before, after) > larger(change, drift + swing)) continue;
    watched[n++] = a;
    m0 = smaller(m0, before), m1 = smaller(m1, after);
  }
  if (n == 0) return;
  if (!step.dense) Integrator::prepare_dense(form, step);
  int who = watched[0];
  auto f = [&](double s) { return least_margin(form, step, s, watched, n, who); };
  const double s = first_crossing(f, m0, m1, hit.s);
  if (!is_first(hit, s)) return;
  f(s);
  hit = {Hit::multiplier, who, s, -1};
}

/// Where a dependent set of locked contacts reaches its limit load.
template <class Form, class Integrator>
[[gnu::noinline]] void find_set_limit(Form& form, Step<Form>& step, Hit& hit) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  for (int k = 0; k < ws.n_sets; ++k) {
    const double before = value(ws.here.room[k]), after = value(ws.there.room[k]);
    const double coming = room_ahead(ws, k, ws.here, step.h), gone = room_ahead(ws, k, ws.there, -step.h);
    const double change = larger(abs(after - before), larger(before - coming, after - gone));
    bool bends = false;
    for (int i = ws.set_first[k]; i < ws.set_first[k + 1]; ++i) bends = bends || load_bends(ws, ws.set_member[i]);
    if (!bends && smaller(before, after) > change) continue;
    if (!step.dense) Integrator::prepare_dense(form, step);
    auto f = [&](double s) {
      torques_at(form, step, s);
      return value(set_room(ws, k, ws.output_torque, ws.here.noise[0]));
    };
    const double s = first_crossing(f, before, after, hit.s);
    if (is_first(hit, s)) hit = {Hit::set, k, s, -1};
  }
}

/// Where prescribed speeds part what locked contacts hold together.
template <class Form, class Integrator>
void find_parting(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  const double zero = slip_tolerance(ws);
  for (int i = 0; i < ws.n_driven; ++i) {
    auto f = [&](double s) {
      double slip = 0;
      for (int p = 0; p < ws.sys.prescribed; ++p) {
        slip += driven_share(ws, ws.driven[i], p) * signal_value(ws, ws.sys.prescribed_input[p], step.t + s * step.h);
      }
      return zero - abs(slip);
    };
    const double s = first_crossing(f, f(0), f(1), hit.s);
    if (!is_first(hit, s)) continue;
    if (!step.dense) Integrator::prepare_dense(form, step);
    hit = {Hit::parting, ws.driven[i], s, -1};
  }
}

/// Where the load of a contact passes zero.
template <class Form, class Integrator>
void find_load(Form& form, Step<Form>& step, Hit& hit) {
  auto& ws = form.ws;
  for (int i = 0; i < ws.n_watch; ++i) {
    const int c = ws.watch[i];
    const double sign = ws.pressed[c] ? 1.0 : -1.0;
    // where it has just passed zero it must leave it before it passes again
    inputs_in(form, step, 0.0);
    const double least = load_noise * ws.load_size[c];
    const bool grazes = step.t - ws.turned_at[c] <= 1e-3 && abs(value(load_of(ws, c))) <= least;
    const double noise = grazes ? least : 0.0;
    auto f = [&](double s) {
      inputs_in(form, step, s);
      return sign * value(load_of(ws, c)) + noise;
    };
    if (ws.n_shared_refs > 0 && !step.dense) Integrator::prepare_dense(form, step);
    const double l0 = f(0), l1 = f(1);
    const double s = first_crossing(f, l0, abs(l1) <= 1e-12 * abs(l0) ? 0.0 : l1, hit.s);
    if (!is_first(hit, s)) continue;
    if (!step.dense) Integrator::prepare_dense(form, step);
    hit = {Hit::load, c, s, -1};
  }
}

/// First guard that turns negative inside the step.
template <class Form, class Integrator>
CLUTCHWORK_INLINE Hit find_hit(Form& form, Step<Form>& step) {
  auto& ws = form.ws;
  Hit hit;
  find_line<Form, Integrator>(form, step, hit);
  if (ws.n_switching > 0) find_law_hit<Form, Integrator>(form, step, hit);
  if (ws.n_locked > 0) find_break_away<Form, Integrator>(form, step, hit);
  if (ws.n_sets > 0) find_set_limit<Form, Integrator>(form, step, hit);
  if (ws.n_driven > 0) find_parting<Form, Integrator>(form, step, hit);
  if (ws.n_faulty > 0) find_fault<Form, Integrator>(form, step, hit);
  if (ws.n_bounded > 0) find_exit<Form, Integrator>(form, step, hit);
  if (ws.n_watch > 0) find_load<Form, Integrator>(form, step, hit);
  return hit;
}

}  // namespace clutchwork

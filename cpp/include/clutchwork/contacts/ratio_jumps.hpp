#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/contacts/impulses.hpp>
#include <clutchwork/contacts/ratios.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// Jumps of the ratios of transmissions. docs/theory/varying-ratios.md
namespace clutchwork {

/// Whether impulses along both directions of a transmission change both rates as they like.
template <class T>
bool may_vary(T p11, T p12, T p22) {
  return value(p11 * p22 - p12 * p12) > 1e-14 * value(p11 * p22);
}

/// Root of the mobility of the row of a transmission at a ratio where one rate follows from the other, with its sign:
/// it may pass zero.
template <class T>
T mobility_root(T p11, T p12, T p22, T ratio) {
  auto size = [](T p) { return value(p) > 0 ? sqrt(p) : T(0); };
  return size(p11) - ratio * (value(p12) < 0 ? -size(p22) : size(p22));
}

/// Impulses along both directions of a transmission that give its rates, of the means m1 and m2, the changes c1 and c2.
/// Where one of these follows from the other it is the work of both that is none. docs/theory/varying-ratios.md (12)
template <class T>
void impulses_for(T p11, T p12, T p22, T c1, T c2, T m1, T m2, T& j1, T& j2) {
  if (may_vary(p11, p12, p22)) {
    const T det = p11 * p22 - p12 * p12;
    j1 = (p22 * c1 - p12 * c2) / det, j2 = (p11 * c2 - p12 * c1) / det;
    return;
  }
  const bool first = value(p11) > value(p22);
  const T change = first ? c1 : c2, workless = first ? p11 * m2 - p12 * m1 : p12 * m2 - p22 * m1;
  j1 = j2 = T(0);
  if (value(workless) != 0) j1 = change * m2 / workless, j2 = -change * m1 / workless;
}

/// A transmission whose speeds are not those of its ratio, more than a jump leaves of them; -1: none.
template <class T>
int contradicted(const Workspace<T>& ws) {
  constexpr double most = 1e-6;
  for (int a = 0; a < ws.ratios.n; ++a) {
    if (follower_of(ws, a) >= 0) continue;
    const double first = value(rate_of(ws, first_of(ws, a))),
                 second = value(ws.ratios.value[a] * rate_of(ws, first_of(ws, a) + 1));
    if (abs(first - second) > 10 * slip_tolerance(ws) + most * (abs(first) + abs(second))) return a;
  }
  return -1;
}

/// The ratio of a transmission has jumped: the limit of a fast change, in which it acts alone, the others kept. The
/// square of its second rate goes with the inverse of the mobility of its row. From a ratio at which it holds nothing
/// that the others leave to move no such change leads to speeds that another one forbids: it jams.
/// docs/theory/varying-ratios.md (12)
template <class T>
void jump_ratio(Workspace<T>& ws, int a, T ratio) {
  Ratios<T>& r = ws.ratios;
  const int d = first_of(ws, a), nv = int(ws.sys.speeds);
  span_rows(ws, a), leave_directions(ws);
  const T *x1 = r.mass_weighted.val + d * nv, *x2 = x1 + nv;
  const T p11 = dot(nv, x1, x1), p12 = dot(nv, x1, x2), p22 = dot(nv, x2, x2);
  auto mobility = [&](T i) { return p11 - T(2) * i * p12 + i * i * p22; };
  const T r1 = rate_of(ws, d), r2 = rate_of(ws, d + 1), before = mobility(r.value[a]), after = mobility(ratio);
  const T from = r.value[a];
  r.value[a] = ratio;
  if (!(value(before) > 0) || !(value(after) > 0)) return;
  const T to =
      r2 * (may_vary(p11, p12, p22) ? sqrt(before / after)
                                    : mobility_root(p11, p12, p22, from) / mobility_root(p11, p12, p22, ratio));
  T j1, j2, *x = ws.decision.speed;
  impulses_for(p11, p12, p22, ratio * to - r1, to - r2, T(0.5) * (ratio * to + r1), T(0.5) * (to + r2), j1, j2);
  for (int i = 0; i < nv; ++i) x[i] = j1 * x1[i] + j2 * x2[i];
  backward_solve(nv, ws.geometry.inertia, ws.geometry.factor, x);
  for (int k = 0; k < r.rank; ++k) r.share[k] = -(j1 * r.part[d * r.n + k] + j2 * r.part[(d + 1) * r.n + k]);
  torques_of_rows(ws, [&](auto&& carry) { carry(d, j1), carry(d + 1, j2); });
  auto own = [&](int e) { return e == d ? j1 : e == d + 1 ? j2 : T(0); };
  meter_impulse(ws, x, [](int) { return T(0); }, [&](int e) { return impulse_of_row(ws, e) + own(e); });
  for (int i = 0; i < nv; ++i) ws.v[i] += x[i];
  for (int p = 0; p < ws.sys.prescribed; ++p) {
    T impulse = -impulse_on_source(ws, p) - j1 * prescribed_share(ws, d, p) - j2 * prescribed_share(ws, d + 1, p);
    for (int i = 0; i < nv; ++i) impulse += T(ws.sys.mass_prescribed[i * ws.sys.prescribed + p]) * x[i];
    ws.prescribed_work[p] += impulse * ws.in.prescribed[p];
  }
}

/// Ratios that have jumped, one after another.
template <class T>
void jump_ratios(Workspace<T>& ws, double tolerance) {
  Ratios<T>& r = ws.ratios;
  r.jammed = -1;
  if (!ratios_jump(ws)) return;
  for (int a = 0; a < r.n; ++a) r.value[a] = r.before[a];
  for (int a = 0; a < r.n; ++a) {
    const T ratio = ratio_now(ws, a).v;
    write_rows(ws);
    follower_of(ws, a) < 0 && value(ratio - r.before[a]) != 0 ? jump_ratio(ws, a, ratio) : void(r.value[a] = ratio);
  }
  write_rows(ws), move_followers(ws);
  r.jammed = contradicted(ws);
  part_moved(ws, tolerance);
}

}  // namespace clutchwork

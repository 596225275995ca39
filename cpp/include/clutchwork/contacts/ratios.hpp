#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/envelope.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/workspace.hpp>

/// Transmissions at one instant: their rows, what these leave of the directions, and jumps of the ratios.
/// docs/theory/varying-ratios.md
namespace clutchwork {

/// First direction of a transmission; the second one follows.
template <class T>
int first_of(const Workspace<T>& ws, int a) {
  return ws.sys.transmission_element[a];
}

/// Speed without inertia that follows from a transmission, -1: none.
template <class T>
int follower_of(const Workspace<T>& ws, int a) {
  return ws.sys.transmission_speed[a];
}

/// Calls f with the kind of transmission a and its parameters.
template <class T, class F>
void visit_transmission(const Workspace<T>& ws, int a, F&& f) {
  const int d = first_of(ws, a);
  visit_torque(ws.sys.element_kind[d], [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (TransmissionElement<E>)
      f(tag, *reinterpret_cast<const typename E::template Params<T>*>(ws.params + ws.sys.element_param[d]));
  });
}

/// Time derivative of an input: of a signal, or of the state of a process, from its equations.
template <class T>
T slope_of_input(Workspace<T>& ws, int ref) {
  const auto& sys = ws.sys;
  const int code = sys.input_refs[ref], j = code - int(sys.inputs);
  if (j < 0) return ws.in.du[ref];
  T slope = T(0);
  const int state = int(sys.states - sys.shared) + j;
  for (int i = 0; i < sys.processes; ++i) {
    visit_process(sys.process_kind[i], [&](auto tag) {
      using E = typename decltype(tag)::type;
      const int first = sys.process_state[i];
      if (state < first || state >= first + E::states) return;
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + sys.process_param[i]);
      for (int k = 0; k < E::inputs; ++k) {
        const int own = sys.process_input[i] + k, d = sys.input_refs[own] - int(sys.inputs + sys.shared);
        if (d >= 0 && d < ws.n_directions) ws.in.u[own] = rate_of(ws, d);
      }
      T rates[E::states];
      const T* inputs = ws.in.u + sys.process_input[i];
      E::state_rates(p, At<T>{T(0), ws.state + first, inputs, ws.shared.piece[i], points_of(ws)}, rates);
      slope = rates[state - first];
    });
  }
  return T(sys.shared_scale[j]) * slope;
}

/// Ratio of a transmission with its time derivative, at the present speeds and states.
template <class T>
Dual<T, 1> ratio_now(Workspace<T>& ws, int a) {
  using S = Dual<T, 1>;
  S out(T(0));
  visit_transmission(ws, a, [&](auto tag, const auto& p) {
    using E = typename decltype(tag)::type;
    const int d = first_of(ws, a), ref = ws.sys.element_input[d], first = ws.sys.element_state[d];
    S own[E::states > 0 ? E::states : 1], input[E::inputs > 0 ? E::inputs : 1];
    T rate[E::ways], rates[E::states > 0 ? E::states : 1];
    for (int w = 0; w < E::ways; ++w) rate[w] = rate_of(ws, d + w);
    for (int i = 0; i < E::states; ++i) own[i] = S(ws.state[first + i]);
    for (int i = 0; i < E::inputs; ++i) {
      input[i] = S(ws.in.u[ref + i]);
      input[i].d[0] = slope_of_input(ws, ref + i);
    }
    if constexpr (E::states > 0) {
      E::state_rates(p, At<T>{rate[0], ws.state + first, ws.in.u + ref, ws.piece[d], points_of(ws), rate}, rates);
      for (int i = 0; i < E::states; ++i) own[i].d[0] = rates[i];
    }
    out = E::ratio(p, At<S>{S(T(0)), own, input, ws.piece[d], points_of(ws)});
  });
  return out;
}

/// Change of the ratio of a transmission where each of its states and inputs grows by one.
template <class T>
T bend_of_ratio(const Workspace<T>& ws, int a) {
  using S = Dual<T, 1>;
  S out(T(0));
  visit_transmission(ws, a, [&](auto tag, const auto& p) {
    using E = typename decltype(tag)::type;
    const int d = first_of(ws, a), ref = ws.sys.element_input[d], first = ws.sys.element_state[d];
    S own[E::states > 0 ? E::states : 1], input[E::inputs > 0 ? E::inputs : 1];
    for (int i = 0; i < E::states; ++i) own[i] = S(ws.state[first + i]), own[i].d[0] = T(1);
    for (int i = 0; i < E::inputs; ++i) input[i] = S(ws.in.u[ref + i]), input[i].d[0] = T(1);
    out = E::ratio(p, At<S>{S(T(0)), own, input, ws.piece[d], points_of(ws)});
  });
  return out.d[0];
}

/// What the row of transmission a must give of the accelerations: ratio' rate 2, less the prescribed part.
/// docs/theory/varying-ratios.md (3)
template <class T>
T pull_of(Workspace<T>& ws, int a) {
  const int d = first_of(ws, a);
  T pull = ratio_now(ws, a).d[0] * rate_of(ws, d + 1);
  for (int p = 0; p < ws.sys.prescribed; ++p) {
    const T share = prescribed_share(ws, d, p) - ws.ratios.value[a] * prescribed_share(ws, d + 1, p);
    pull -= share * ws.in.prescribed_slope[p];
  }
  return pull;
}

/// x += factor times a direction over the speeds.
template <class T>
void add_direction(const Workspace<T>& ws, int d, T factor, T* x) {
  const auto row = rate_row(ws.sys, d);
  for (int e = 0; e < row.n; ++e) x[row.column[e]] += factor * T(row.value[e]);
}

/// Write down the rows of all transmissions at their ratios.
template <class T>
void write_rows(Workspace<T>& ws) {
  Ratios<T>& r = ws.ratios;
  const int nv = int(ws.sys.speeds);
  for (int a = 0; a < r.n; ++a) {
    T* row = r.row + a * nv;
    for (int i = 0; i < nv; ++i) row[i] = T(0);
    add_direction(ws, first_of(ws, a), T(1), row);
    add_direction(ws, first_of(ws, a) + 1, -r.value[a], row);
  }
}

/// A transmission in whose row the speed without inertia that follows from it has no share but round-off, so that
/// nothing determines that speed; -1: none. docs/theory/varying-ratios.md, shafts without inertia
template <class T>
int lost_follower(const Workspace<T>& ws) {
  constexpr double least = 1e-12, round_off = 1e-14;
  const Ratios<T>& r = ws.ratios;
  const int nv = int(ws.sys.speeds);
  for (int a = 0; a < r.n; ++a) {
    const int i = follower_of(ws, a);
    if (i < 0) continue;
    T share[2];
    for (int way = 0; way < 2; ++way) {
      const auto row = rate_row(ws.sys, first_of(ws, a) + way);
      share[way] = T(0);
      for (int e = 0; e < row.n; ++e) share[way] += row.column[e] == i ? T(row.value[e]) : T(0);
    }
    const double second = abs(value(share[1])), size = abs(value(share[0])) + abs(value(r.value[a])) * second;
    if (!(abs(value(r.row[a * nv + i])) > round_off * size + least * second * abs(value(bend_of_ratio(ws, a)))))
      return a;
  }
  return -1;
}

/// Take off x what moves the speeds that follow from transmissions, so that it is one over the others; `via`: the
/// shares of the rows, may be null. docs/theory/varying-ratios.md (7)
template <class T>
void take_off_followers(const Workspace<T>& ws, T* x, T* via) {
  const Ratios<T>& r = ws.ratios;
  const int nv = int(ws.sys.speeds);
  for (int a = r.n - 1; a >= 0; --a) {
    const int i = follower_of(ws, a);
    if (via != nullptr) via[a] = T(0);
    if (i < 0 || value(x[i]) == 0) continue;
    const T share = x[i] / r.row[a * nv + i];
    for (int j = 0; j < nv; ++j) {
      const double before = abs(value(x[j]));
      x[j] -= share * r.row[a * nv + j];
      // what cancels leaves no round-off
      if (abs(value(x[j])) <= 1e-14 * before) x[j] -= T(value(x[j]));
    }
    x[i] = T(0);
    if (via != nullptr) via[a] = share;
  }
}

/// Less what the rows span, twice because of round-off.
template <class T>
void take_off_span(const Workspace<T>& ws, T* x) {
  const Ratios<T>& r = ws.ratios;
  const int nv = int(ws.sys.speeds);
  for (int round = 0; round < 2; ++round) {
    for (int k = 0; k < r.rank; ++k) axpy(nv, -dot(nv, r.span + k * nv, x), r.span + k * nv, x);
  }
}

/// Of a direction of a contact that is shorter than this share of itself by the rows nothing is left; of an element,
/// which only moves others, what is more than the round-off of the span is. `shared`: the same of a contact that is
/// held in a set, which shares a load up to its pole.
inline constexpr double left_over = 1e-7, round_off_of_span = 1e-13, left_over_shared = 1e-9;

/// Orthonormal span of the rows that tie speeds with inertia, but for one (-1: none); of those that depend on others
/// nothing is left.
template <class T>
void span_rows(Workspace<T>& ws, int without = -1) {
  Ratios<T>& r = ws.ratios;
  const int nv = int(ws.sys.speeds);
  r.rank = 0, r.blur = round_off_of_span;
  for (int a = 0; a < r.n; ++a) {
    if (follower_of(ws, a) >= 0 || a == without) continue;
    T *x = r.span + r.rank * nv, *triangle = r.triangle + r.rank * r.n;
    for (int i = 0; i < nv; ++i) x[i] = r.row[a * nv + i];
    take_off_followers<T>(ws, x, nullptr);
    forward_solve(nv, ws.geometry.inertia, ws.geometry.factor, x);
    const double size = value(sqrt(dot(nv, x, x)));
    for (int k = 0; k < r.rank; ++k) triangle[k] = T(0);
    for (int round = 0; round < 2; ++round) {
      for (int k = 0; k < r.rank; ++k) {
        const T part = dot(nv, r.span + k * nv, x);
        triangle[k] += part;
        axpy(nv, -part, r.span + k * nv, x);
      }
    }
    const T length = sqrt(dot(nv, x, x));
    if (!(value(length) > left_over * size)) continue;
    for (int i = 0; i < nv; ++i) x[i] /= length;
    triangle[r.rank] = length;
    r.blur = larger(r.blur, round_off_of_span * size / value(length));
    r.order[r.rank++] = a;
  }
}

/// What the rows leave of all directions, and the mobility of the contacts from it.
template <class T>
void leave_directions(Workspace<T>& ws, double left = left_over) {
  Ratios<T>& r = ws.ratios;
  const int nv = int(ws.sys.speeds), ne = int(ws.sys.elements), nc = int(ws.sys.contacts);
  for (int d = 0; d < ws.n_directions; ++d) {
    T* x = r.mass_weighted.val + d * nv;
    r.mass_weighted.first[d] = d * nv;
    for (int i = 0; i < nv; ++i) x[i] = T(0), r.mass_weighted.col[d * nv + i] = i;
    add_direction(ws, d, T(1), x);
    take_off_followers(ws, x, r.via + d * r.n);
    forward_solve(nv, ws.geometry.inertia, ws.geometry.factor, x);
    r.whole[d] = dot(nv, x, x);
    for (int k = 0; k < r.rank; ++k) r.part[d * r.n + k] = dot(nv, r.span + k * nv, x);
    take_off_span(ws, x);
    r.own[d] = dot(nv, x, x), r.missed[d] = T(0);
    const double least = d < ne ? smaller(r.blur, left) : left;
    if (value(r.own[d]) > least * least * value(r.whole[d])) continue;
    for (int i = 0; i < nv; ++i) x[i] = T(0);
    r.missed[d] = T(sqrt(value(r.own[d]))), r.own[d] = T(0);
  }
  r.mass_weighted.first[ws.n_directions] = ws.n_directions * nv;
  for (int c = 0; c < nc; ++c) {
    for (int b = 0; b <= c; ++b)
      r.mobility[ws.geometry.near.sky[c] + b] =
          dot(nv, r.mass_weighted.val + (ne + c) * nv, r.mass_weighted.val + (ne + b) * nv);
  }
}

/// Part of an acceleration, mass-weighted, that makes the rows give `wanted`; nothing else moves.
/// docs/theory/varying-ratios.md (5)
template <class T>
void follow_rows(const Workspace<T>& ws, const T* wanted, T* x) {
  const Ratios<T>& r = ws.ratios;
  const int nv = int(ws.sys.speeds);
  for (int k = 0; k < r.rank; ++k) {
    T s = wanted[r.order[k]];
    for (int j = 0; j < k; ++j) s -= r.triangle[k * r.n + j] * r.share[j];
    r.share[k] = s / r.triangle[k * r.n + k];
  }
  for (int k = 0; k < r.rank; ++k) axpy(nv, r.share[k], r.span + k * nv, x);
}

/// Loads by torques where transmissions do no work: the virtual motion of each keeps their rows too, by a motion along
/// their span and of the speeds that follow. docs/theory/load-dependent.md (12)
template <class T>
void leave_loads(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  Ratios<T>& r = ws.ratios;
  const int nv = int(sys.speeds), ne = int(sys.elements), np = int(sys.prescribed), nd = ws.n_directions;
  T *x = ws.decision.speed, *tied = r.tied;
  for (int l = 0; l < sys.loads; ++l) {
    auto rate = [&](int d) {
      return T(d < ne ? sys.load_element_rate[l * ne + d] : sys.load_contact_rate[l * sys.contacts + d - ne]);
    };
    auto without = [&](int d) {
      T s = rate(d);
      for (int b = 0; b < r.n; ++b) s -= follower_of(ws, b) < 0 ? T(0) : r.via[d * r.n + b] * tied[b];
      return s;
    };
    for (int a = 0; a < r.n; ++a) tied[a] = rate(first_of(ws, a)) - r.value[a] * rate(first_of(ws, a) + 1);
    for (int a = 0; a < r.n; ++a) r.wanted[a] = r.value[a] * without(first_of(ws, a) + 1) - without(first_of(ws, a));
    for (int i = 0; i < nv; ++i) x[i] = ws.loads.momentum[l * nv + i];
    follow_rows(ws, r.wanted, x);
    for (int d = 0; d < nd; ++d) {
      T s = dot(nv, x, r.mass_weighted.val + d * nv) - without(d);
      for (int k = 0; k < r.rank; ++k) s -= r.part[d * r.n + k] * r.share[k];
      ws.loads.beside_torque[l * nd + d] = s;
    }
    T* drawn = ws.loads.by_drawn + l * r.n;
    for (int k = 0; k < r.rank; ++k) drawn[k] = dot(nv, x, r.span + k * nv);
    for (int p = 0; p < np; ++p) {
      T s = ws.loads.by_slope[l * np + p];
      for (int k = 0; k < r.rank; ++k)
        s += drawn[k] * dot(nv, r.span + k * nv, ws.geometry.prescribed_momentum + p * nv);
      ws.loads.beside_slope[l * np + p] = s;
    }
  }
}

/// The ratios before what happens now.
template <class T>
void keep_ratios(Workspace<T>& ws) {
  for (int a = 0; a < ws.ratios.n; ++a) ws.ratios.before[a] = ratio_now(ws, a).v;
}

/// Whether a ratio is another one than before.
template <class T>
bool ratios_jump(Workspace<T>& ws) {
  for (int a = 0; a < ws.ratios.n; ++a) {
    if (value(ratio_now(ws, a).v - ws.ratios.before[a]) != 0) return true;
  }
  return false;
}

template <class P>
void exchange(P& a, P& b) {
  const P other = a;
  a = b, b = other;
}

/// Ratios by which the rows of transmissions are written down: those of the present inputs, those before the event, or
/// those that were written down last.
enum class Written { now, before, last };

/// Whether the ratio of a transmission is zero where its first rate is given: its row is along the second direction
/// alone, whatever the ratio.
template <class T>
bool leaves_zero(Workspace<T>& ws, int a) {
  const T* own = ws.ratios.inside ? ws.ratios.own : ws.geometry.own;
  return value(ratio_now(ws, a).v) == 0 && follower_of(ws, a) < 0 && value(own[first_of(ws, a)]) == 0;
}

/// [s] how much later a ratio is looked at that leaves zero.
inline constexpr double soon = 1e-9;

/// The ratio of a transmission in a decision: one that leaves zero beside what is given is that of a nanosecond later.
/// docs/theory/varying-ratios.md (6)
template <class T>
T ratio_to_decide(Workspace<T>& ws, int a) {
  const Dual<T, 1> ratio = ratio_now(ws, a);
  return leaves_zero(ws, a) ? T(soon) * ratio.d[0] : ratio.v;
}

/// A transmission whose ratio leaves zero beside what is given, against a motion that it would have to change by a
/// jump; -1: none. docs/theory/varying-ratios.md (6)
template <class T>
int leaves_zero_against(Workspace<T>& ws) {
  for (int a = 0; a < ws.ratios.n; ++a) {
    if (!leaves_zero(ws, a)) continue;
    const double way = abs(value(ratio_now(ws, a).d[0]));
    if (way > 0 && abs(value(pull_of(ws, a))) > 1e3 * slip_tolerance(ws) * way) return a;
  }
  return -1;
}

/// While it lives, directions and mobility are what the transmissions leave of them.
template <class T>
class BesideRatios {
  Workspace<T>& ws_;
  bool entered_;

  void swap() {
    exchange(ws_.geometry.mass_weighted, ws_.ratios.mass_weighted);
    exchange(ws_.geometry.own, ws_.ratios.own);
    exchange(ws_.geometry.mobility, ws_.ratios.mobility);
    exchange(ws_.loads.by_torque, ws_.loads.beside_torque);
    exchange(ws_.loads.by_slope, ws_.loads.beside_slope);
    ws_.ratios.inside = !ws_.ratios.inside;
  }

 public:
  explicit BesideRatios(Workspace<T>& ws, Written which = Written::now, double left = left_over)
      : ws_(ws), entered_(ws.ratios.n > 0) {
    if (!entered_) return;
    Ratios<T>& r = ws.ratios;
    for (int a = 0; a < r.n && which != Written::last; ++a) {
      r.value[a] = which == Written::before ? r.before[a] : ratio_to_decide(ws, a);
      // round-off at a dead point
      if (abs(value(r.value[a])) <= 1e-15 * abs(value(bend_of_ratio(ws, a)))) r.value[a] = T(0);
    }
    write_rows(ws), span_rows(ws), leave_directions(ws, left), leave_loads(ws);
    swap();
  }
  BesideRatios(const BesideRatios&) = delete;
  ~BesideRatios() {
    if (entered_) swap();
  }
};

/// What the rows of the transmissions over the speeds with inertia must give, from what they must give over all.
template <class T>
void without_followers(const Workspace<T>& ws, T* wanted) {
  const Ratios<T>& r = ws.ratios;
  for (int a = 0; a < r.n; ++a) {
    if (follower_of(ws, a) >= 0) continue;
    const int d = first_of(ws, a);
    for (int b = 0; b < r.n; ++b) {
      if (follower_of(ws, b) < 0) continue;
      wanted[a] -= (r.via[d * r.n + b] - r.value[a] * r.via[(d + 1) * r.n + b]) * wanted[b];
    }
  }
}

/// The transmissions take their part in a mass-weighted acceleration.
template <class T>
void accelerate_rows(Workspace<T>& ws, T* q) {
  Ratios<T>& r = ws.ratios;
  for (int a = 0; a < r.n; ++a) r.pull[a] = pull_of(ws, a);
  take_off_span(ws, q);
  T* wanted = r.wanted;
  for (int a = 0; a < r.n; ++a) wanted[a] = r.pull[a];
  without_followers(ws, wanted);
  follow_rows(ws, wanted, q);
  for (int k = 0; k < r.rank; ++k) r.drawn[k] = r.share[k];
}

/// Torques, or impulses, of the transmissions in ratios.torque: those with inertia on both sides from what the span
/// takes of a motion, in ratios.share; the others carry what acts on the speeds that follow from them, by the
/// directions that `each` calls with number and torque. docs/theory/varying-ratios.md (8)
template <class T, class Each>
void torques_of_rows(Workspace<T>& ws, Each&& each) {
  Ratios<T>& r = ws.ratios;
  for (int a = 0; a < r.n; ++a) r.torque[a] = T(0);
  for (int k = r.rank - 1; k >= 0; --k) {
    T s = r.share[k];
    for (int j = k + 1; j < r.rank; ++j) s -= r.triangle[j * r.n + k] * r.torque[r.order[j]];
    r.torque[r.order[k]] = s / r.triangle[k * r.n + k];
  }
  auto carry = [&](int d, T torque) {
    for (int b = 0; b < r.n; ++b) {
      if (follower_of(ws, b) >= 0) r.torque[b] -= r.via[d * r.n + b] * torque;
    }
  };
  each(carry);
  for (int k = 0; k < r.rank; ++k) {
    const int a = r.order[k], d = first_of(ws, a);
    carry(d, r.torque[a]), carry(d + 1, -r.value[a] * r.torque[a]);
  }
}

/// Impulse of a transmission along direction d, of those in ratios.torque; zero where that is none of its own.
template <class T>
T impulse_of_row(const Workspace<T>& ws, int d) {
  const Ratios<T>& r = ws.ratios;
  for (int a = 0; a < r.n; ++a) {
    if (first_of(ws, a) == d) return r.torque[a];
    if (first_of(ws, a) + 1 == d) return -r.value[a] * r.torque[a];
  }
  return T(0);
}

/// Impulse of the source behind prescribed speed p by those of the transmissions.
template <class T>
T impulse_on_source(const Workspace<T>& ws, int p) {
  T impulse = T(0);
  for (int a = 0; a < ws.ratios.n; ++a) {
    const int d = first_of(ws, a);
    impulse += ws.ratios.torque[a] * (prescribed_share(ws, d, p) - ws.ratios.value[a] * prescribed_share(ws, d + 1, p));
  }
  return impulse;
}

/// Part of the acceleration of a direction that the rows give it: along their span, and through speeds without inertia.
template <class T>
T pulled(const Workspace<T>& ws, int d) {
  const Ratios<T>& r = ws.ratios;
  T a = T(0);
  for (int k = 0; k < r.rank; ++k) a += r.part[d * r.n + k] * r.drawn[k];
  for (int b = 0; b < r.n; ++b) a += r.via[d * r.n + b] * r.pull[b];
  return a;
}

/// Whether transmissions leave a contact no motion of its own in the decision that is made.
template <class T>
bool is_tied(const Workspace<T>& ws, int c) {
  const int d = int(ws.sys.elements) + c;
  return ws.ratios.inside && value(ws.geometry.own[d]) == 0 && value(ws.ratios.whole[d]) > 0;
}

/// Speeds without inertia that follow from transmissions, from the others.
template <class T>
void move_followers(Workspace<T>& ws) {
  const int nv = int(ws.sys.speeds);
  for (int a = 0; a < ws.ratios.n; ++a) {
    const int i = follower_of(ws, a);
    if (i < 0) continue;
    const T miss = rate_of(ws, first_of(ws, a)) - ws.ratios.value[a] * rate_of(ws, first_of(ws, a) + 1);
    ws.v[i] -= miss / ws.ratios.row[a * nv + i];
  }
}

/// Contacts that were locked and have been moved now slip.
template <class T>
void part_moved(Workspace<T>& ws, double tolerance) {
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const double slip = value(rate_of(ws, int(ws.sys.elements) + c));
    if (abs(slip) > tolerance) ws.contact.mode[c] = slip > 0 ? forward : backward;
  }
}

/// Speeds brought onto the rows, the momentum across them untouched: round-off, and what a step has missed.
/// docs/theory/varying-ratios.md (9)
template <class T>
void settle_rows(Workspace<T>& ws) {
  Ratios<T>& r = ws.ratios;
  const int nv = int(ws.sys.speeds);
  T *miss = r.wanted, *x = ws.decision.speed;
  move_followers(ws);
  for (int a = 0; a < r.n; ++a) {
    const T ahead = leaves_zero(ws, a) ? T(soon) * pull_of(ws, a) : r.value[a] * rate_of(ws, first_of(ws, a) + 1);
    miss[a] = ahead - rate_of(ws, first_of(ws, a));
  }
  for (int i = 0; i < nv; ++i) x[i] = T(0);
  follow_rows(ws, miss, x);
  backward_solve(nv, ws.geometry.inertia, ws.geometry.factor, x);
  for (int i = 0; i < nv; ++i) ws.v[i] += x[i];
  move_followers(ws);
}

}  // namespace clutchwork

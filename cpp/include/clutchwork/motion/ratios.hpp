#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/ratios.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/form.hpp>
#include <clutchwork/workspace.hpp>

/// Transmissions in a phase: their torques at every point, over any scalar. docs/theory/varying-ratios.md
namespace clutchwork {

/// The memory of a point by its scalar.
template <class T>
const Tied<T>& tied(const Ratios<T>& r, const T&) {
  return r.plain;
}
template <class T>
const Tied<Dual<T, 1>>& tied(const Ratios<T>& r, const Dual<T, 1>&) {
  return r.drift;
}
template <class T>
const Tied<Dual<T, Full<T>::chunk>>& tied(const Ratios<T>& r, const Dual<T, Full<T>::chunk>&) {
  return r.some;
}

/// Number of locked contacts whose directions vary.
template <class T>
int varying_held(const Workspace<T>& ws) {
  return ws.held.n - ws.held.n_fixed;
}

/// Rows and ties of the present phase, and how the reduced speeds answer to the rows.
template <class Form, class T = typename Form::Scalar>
void prepare_ratios(Form& form) {
  Workspace<T>& ws = form.ws;
  Ratios<T>& r = ws.ratios;
  const int nz = form.nz(), nc = varying_held(ws);
  r.rows = 2 * r.n + nc, r.ties = 0;
  for (int a = 0; a < r.n; ++a) {
    const int i = follower_of(ws, a), k = ws.branch_of[first_of(ws, a)];
    r.place[2 * a] = k, r.place[2 * a + 1] = k + 1;
    r.column[a] = i < 0 ? -1 : ws.rows.number[i];
    if (i < 0) r.tie[r.ties++] = a;
  }
  for (int c = 0, more = ws.n_rates; c < nc; ++c) {
    const int k = ws.branch_of[ws.sys.elements + ws.held.contact[ws.held.n_fixed + c]];
    r.place[2 * r.n + c] = k < 0 ? more++ : k;
    r.tie[r.ties++] = -1;
  }
  for (int k = 0; k < r.rows; ++k) {
    T* x = r.along + k * nz;
    for (int i = 0; i < nz; ++i) x[i] = T(0);
    ws.rows.rate.add(r.place[k], T(1), x);
    for (int a = 0; a < r.n; ++a) {
      r.follows[k * r.n + a] = r.column[a] < 0 ? T(0) : x[r.column[a]];
      if (r.column[a] >= 0) x[r.column[a]] = T(0);
    }
    form.solve_mass(x);
  }
  for (int k = 0; k < r.rows; ++k) {
    for (int l = 0; l < r.rows; ++l) r.between[k * r.rows + l] = ws.rows.rate.times(r.place[k], r.along + l * nz);
  }
}

/// A number over time as a scalar: its derivative stands in the column of time, where there is one.
template <class T>
void over_time(T x, T, int, T& out) {
  out = x;
}
template <class T, int N>
void over_time(T x, T slope, int time, Dual<T, N>& out) {
  out = Dual<T, N>(x);
  if (time >= 0 && time < N) out.d[time] = slope;
}

/// Time derivative of a reference, over the scalar of a point.
template <class T, class S>
S slope_of_reference(const Workspace<T>& ws, const Whole<S>& e, int n, int ref) {
  const auto& sys = ws.sys;
  const int j = ws.in.ref_signal[ref] - int(sys.inputs);
  S out;
  if (j < 0) {
    over_time(ws.in.du[ref], T(signal_curvature(ws, ws.in.ref_signal[ref], ws.in.time)), e.time, out);
  } else {
    out = T(sys.shared_scale[j]) * e.d[n - int(sys.shared) + j];
  }
  return out;
}

/// Ratio of transmission a with its time derivative, the rates of all states being known, and what its row must give.
template <class T, class S>
void ratio_at(const Workspace<T>& ws, const Whole<S>& e, int nz, int a) {
  using D = Dual<S, 1>;
  const Ratios<T>& r = ws.ratios;
  const Tied<S>& w = tied(r, e.y[0]);
  const int n = nz + int(ws.sys.states), np = int(ws.sys.prescribed), k = r.place[2 * a];
  visit_transmission(ws, a, [&](auto tag, const auto& p) {
    using E = typename decltype(tag)::type;
    const Branch<T>& b = ws.branch[k];
    const int ref = int(b.input - ws.in.u);
    D own[E::states > 0 ? E::states : 1], input[E::inputs > 0 ? E::inputs : 1];
    for (int i = 0; i < E::states; ++i) {
      own[i] = D(e.y[nz + b.state + i]);
      own[i].d[0] = e.d[nz + b.state + i];
    }
    for (int i = 0; i < E::inputs; ++i) {
      input[i] = D(e.input[ref + i]);
      input[i].d[0] = slope_of_reference(ws, e, n, ref + i);
    }
    const D ratio = E::ratio(p, At<D>{D(S(T(0))), own, input, b.piece, points_of(ws)});
    w.ratio[a] = ratio.v, w.slope[a] = ratio.d[0];
    if constexpr (std::is_same_v<S, T>) {
      r.present[a] = ratio.v;
    } else {
      r.present[a] = ratio.v.v;
    }
  });
  w.pull[a] = w.slope[a] * e.rate[k + 1];
  for (int p = 0; p < np; ++p) {
    const S slope = slope_of_reference(ws, e, n, int(ws.sys.n_input_refs) + p);
    w.pull[a] -= (ws.reduced.offset[k * np + p] - w.ratio[a] * ws.reduced.offset[(k + 1) * np + p]) * slope;
  }
}

/// Share of the speed that follows from transmission b in the row of transmission a.
template <class T, class S>
S share_of_follower(const Ratios<T>& r, const Tied<S>& w, int a, int b) {
  return r.follows[2 * a * r.n + b] - w.ratio[a] * r.follows[(2 * a + 1) * r.n + b];
}

/// The rows answer to a torque along row k.
template <class T, class S>
void answer(const Ratios<T>& r, const Tied<S>& w, int k, const S& torque) {
  for (int l = 0; l < r.rows; ++l) w.acceleration[l] += r.between[l * r.rows + k] * torque;
}

/// Transmissions whose speed follows carry what acts on it. docs/theory/varying-ratios.md (7)
template <class T, class S>
void carry_followers(const Ratios<T>& r, const Tied<S>& w, const S* d) {
  for (int a = r.n - 1; a >= 0; --a) {
    w.torque[a] = S(T(0));
    if (r.column[a] < 0) continue;
    S load = d[r.column[a]];
    for (int b = a + 1; b < r.n; ++b) {
      if (r.column[b] >= 0) load += share_of_follower(r, w, b, a) * w.torque[b];
    }
    w.torque[a] = -load / share_of_follower(r, w, a, a);
    answer(r, w, 2 * a, w.torque[a]), answer(r, w, 2 * a + 1, -w.ratio[a] * w.torque[a]);
  }
}

/// Tie t over the rows, without the speeds that follow.
template <class T, class S>
void resolve_tie(const Ratios<T>& r, const Tied<S>& w, int t) {
  S *share = w.share + t * r.rows, *via = w.via + t * r.n;
  const int a = r.tie[t];
  for (int k = 0; k < r.rows; ++k) share[k] = S(T(0));
  if (a >= 0) {
    share[2 * a] = S(T(1)), share[2 * a + 1] = -w.ratio[a];
  } else {
    share[r.rows - r.ties + t] = S(T(1));
  }
  for (int b = r.n - 1; b >= 0; --b) {
    via[b] = S(T(0));
    if (r.column[b] < 0) continue;
    S moved = S(T(0));
    for (int k = 0; k < r.rows; ++k) {
      if (value(r.follows[k * r.n + b]) != 0) moved += r.follows[k * r.n + b] * share[k];
    }
    via[b] = moved / share_of_follower(r, w, b, b);
    share[2 * b] -= via[b], share[2 * b + 1] += via[b] * w.ratio[b];
  }
}

/// Factor L D L' of the mobility of the ties; one that depends on those before it, to the round-off of all of them,
/// counts as none. docs/theory/varying-ratios.md (6)
template <class T, class S>
void factor_ties(const Ratios<T>& r, const Tied<S>& w) {
  constexpr double least = 1e-15;
  const int m = r.ties;
  S* sizes = w.wanted;
  for (int t = 0; t < m; ++t) {
    double size = 0;
    const S* own = w.share + t * r.rows;
    for (int u = 0; u <= t; ++u) {
      S s = S(T(0));
      for (int k = 0; k < r.rows; ++k) {
        for (int l = 0; l < r.rows; ++l) {
          if (value(r.between[k * r.rows + l]) == 0) continue;
          const S x = r.between[k * r.rows + l] * own[k] * w.share[u * r.rows + l];
          s += x;
          if (u == t) size += abs(value(x));
        }
      }
      for (int j = 0; j < u; ++j) s -= w.gram[t * m + j] * w.gram[u * m + j] * w.gram[j * m + j];
      w.gram[t * m + u] = s;
      if (u < t) w.gram[t * m + u] = value(w.gram[u * m + u]) != 0 ? s / w.gram[u * m + u] : S(T(0));
    }
    for (int j = 0; j < t; ++j) size += value(sizes[j]) * value(w.gram[t * m + j]) * value(w.gram[t * m + j]);
    sizes[t] = S(T(size));
    if (!(value(w.gram[t * m + t]) > least * size)) w.gram[t * m + t] = S(T(0));
  }
}

/// Torques x of the ties for what they are to give.
template <class T, class S>
void solve_ties(const Ratios<T>& r, const Tied<S>& w, S* x) {
  const int m = r.ties;
  for (int t = 0; t < m; ++t) {
    for (int j = 0; j < t; ++j) x[t] -= w.gram[t * m + j] * x[j];
  }
  for (int t = m - 1; t >= 0; --t) {
    x[t] = value(w.gram[t * m + t]) != 0 ? x[t] / w.gram[t * m + t] : S(T(0));
    for (int u = t + 1; u < m; ++u) {
      if (value(w.gram[t * m + t]) != 0) x[t] -= w.gram[u * m + t] * x[u];
    }
  }
}

/// What a tie must give besides what the known torques do, from what each row must.
template <class T, class S>
S wanted_of_tie(const Ratios<T>& r, const Tied<S>& w, int t, const S& own, const S* of_transmission) {
  S s = own;
  for (int b = 0; b < r.n; ++b) {
    if (r.column[b] >= 0) s -= w.via[t * r.n + b] * of_transmission[b];
  }
  return s;
}

/// Ratios and ties at e.y, where the rates of all states are known.
template <class T, class S>
void shape_ratios(const Workspace<T>& ws, const Whole<S>& e, int nz) {
  const Ratios<T>& r = ws.ratios;
  const Tied<S>& w = tied(r, e.y[0]);
  for (int a = 0; a < r.n; ++a) ratio_at(ws, e, nz, a);
  for (int t = 0; t < r.ties; ++t) resolve_tie(r, w, t);
  factor_ties(r, w);
}

/// What the rows of the transmissions must give.
template <class T, class S>
void want_pulls(const Workspace<T>& ws, const Whole<S>& e, int nz) {
  const Ratios<T>& r = ws.ratios;
  const Tied<S>& w = tied(r, e.y[0]);
  const int np = int(ws.sys.prescribed);
  for (int t = 0; t < r.ties; ++t) {
    const int a = r.tie[t], k = a >= 0 ? 0 : r.place[r.rows - r.ties + t];
    S own = a >= 0 ? w.pull[a] : S(T(0));
    for (int p = 0; a < 0 && p < np; ++p)
      own -= ws.reduced.offset[k * np + p] *
             slope_of_reference(ws, e, nz + int(ws.sys.states), int(ws.sys.n_input_refs) + p);
    w.wanted[t] = wanted_of_tie(r, w, t, own, w.pull);
  }
}

/// Torques of the transmissions and of the locked contacts whose directions vary, with d those of all others and in
/// `wanted` what the ties must give besides. docs/theory/varying-ratios.md (4) to (8)
template <class T, class S>
void carry(const Ratios<T>& r, const Tied<S>& w, const S* d, int nz) {
  const int held = r.rows - 2 * r.n;
  for (int k = 0; k < r.rows; ++k) {
    w.acceleration[k] = S(T(0));
    for (int i = 0; i < nz; ++i) {
      if (value(r.along[k * nz + i]) != 0) w.acceleration[k] += r.along[k * nz + i] * d[i];
    }
  }
  carry_followers(r, w, d);
  for (int t = 0; t < r.ties; ++t) {
    for (int l = 0; l < r.rows; ++l) w.wanted[t] -= w.share[t * r.rows + l] * w.acceleration[l];
  }
  solve_ties(r, w, w.wanted);
  for (int t = 0; t < r.ties; ++t) {
    (r.tie[t] >= 0 ? w.torque[r.tie[t]] : w.held[t - (r.ties - held)]) = w.wanted[t];
    for (int b = 0; b < r.n; ++b) {
      if (r.column[b] >= 0) w.torque[b] -= w.via[t * r.n + b] * w.wanted[t];
    }
    for (int k = 0; k < r.rows; ++k) answer(r, w, k, w.share[t * r.rows + k] * w.wanted[t]);
  }
}

/// The torques of transmissions and of locked contacts that vary, d those of all others; then d is complete.
template <class T, class S>
void whole_ratios(const Workspace<T>& ws, const Whole<S>& e, int nz) {
  const Ratios<T>& r = ws.ratios;
  const Tied<S>& w = tied(r, e.y[0]);
  shape_ratios(ws, e, nz), want_pulls(ws, e, nz);
  carry(r, w, e.d, nz);
  push_ratios(ws, e, ws.rows.rate);
  move_followers_whole(r, w, e.d);
}

/// Load l by the torques of the transmissions and of the locked contacts that vary.
template <class T, class S>
S load_beside(const Workspace<T>& ws, const Tied<S>& w, int l) {
  const Ratios<T>& r = ws.ratios;
  const T *by_branch = ws.loads.by_branch + l * ws.n_directions, *by_held = ws.loads.by_held + l * ws.sys.contacts;
  S load = S(T(0));
  for (int a = 0; a < r.n; ++a) {
    const int k = r.place[2 * a];
    load += (S(by_branch[k]) - w.ratio[a] * by_branch[k + 1]) * w.torque[a];
  }
  for (int c = 0; c < r.rows - 2 * r.n; ++c) add_times(by_held[c], w.held[c], load);
  return load;
}

/// What transmissions carry of the torques that follow loads, and of all others, which stand in e.d: the system of the
/// former is completed. docs/theory/load-dependent.md (13)
template <class T, class S>
[[gnu::noinline]] void couple_loads(const Workspace<T>& ws, const Whole<S>& e, int nz) {
  const Ratios<T>& r = ws.ratios;
  const Tied<S>& w = tied(r, e.y[0]);
  const Compressed<T>& rows = ws.rows.rate;
  const int m = ws.loads.n_sliding;
  shape_ratios(ws, e, nz), want_pulls(ws, e, nz);
  carry(r, w, e.d, nz);
  for (int i = 0; i < m; ++i) e.followed[i] -= e.steepness[i] * load_beside(ws, w, ws.loads.sliding[i]);
  for (int j = 0; j < m; ++j) {
    const int k = ws.loads.branch[j];
    for (int i = 0; i < nz; ++i) w.push[i] = S(T(0));
    for (int i = rows.first[k]; i < rows.first[k + 1]; ++i) w.push[rows.col[i]] = S(rows.val[i]);
    for (int t = 0; t < r.ties; ++t) w.wanted[t] = S(T(0));
    carry(r, w, w.push, nz);
    for (int i = 0; i < m; ++i) e.coupling[i * m + j] += e.steepness[i] * load_beside(ws, w, ws.loads.sliding[i]);
  }
}

/// Push the torques of the transmissions, and of the locked contacts that vary.
template <class T, class S>
void push_ratios(const Workspace<T>& ws, const Whole<S>& e, const Compressed<T>& rows) {
  const Ratios<T>& r = ws.ratios;
  const Tied<S>& w = tied(r, e.y[0]);
  auto push = [&](int k, const S& torque) {
    for (int i = rows.first[k]; i < rows.first[k + 1]; ++i) add_times(rows.val[i], torque, e.d[rows.col[i]]);
  };
  for (int a = 0; a < r.n; ++a) {
    const int k = r.place[2 * a];
    e.torque[k] = w.torque[a], e.torque[k + 1] = -w.ratio[a] * w.torque[a];
    push(k, e.torque[k]), push(k + 1, e.torque[k + 1]);
  }
  for (int k = 2 * r.n; k < r.rows; ++k) push(r.place[k], w.held[k - 2 * r.n]);
}

/// Accelerations of the speeds that follow, from those of the rows.
template <class T, class S>
void move_followers_whole(const Ratios<T>& r, const Tied<S>& w, S* d) {
  for (int a = 0; a < r.n; ++a) {
    if (r.column[a] < 0) continue;
    S rest = w.pull[a] - w.acceleration[2 * a] + w.ratio[a] * w.acceleration[2 * a + 1];
    for (int b = 0; b < a; ++b) {
      if (r.column[b] >= 0) rest -= share_of_follower(r, w, a, b) * d[r.column[b]];
    }
    d[r.column[a]] = rest / share_of_follower(r, w, a, a);
  }
}

/// Of the fastest speed, more than an integration drifts off the ties in a step.
template <class T>
double most_drift(const Workspace<T>& ws) {
  return larger(1e-3, smaller(1e-2, 10 * ws.options.rtol));
}

/// The transmission that took most energy when speeds were brought onto the ties last; -1: a locked contact did.
template <class T>
int hardest_tie(const Ratios<T>& r) {
  const Tied<T>& w = r.plain;
  int hardest = -1;
  double most = 0;
  for (int t = 0; t < r.ties && r.tie[t] >= 0; ++t) {
    const double taken = value(w.wanted[t] * w.wanted[t] * w.gram[t * r.ties + t]);
    if (taken > most) most = taken, hardest = r.tie[t];
  }
  return hardest;
}

/// The locked contact whose direction varies that took most energy there; -1: none.
template <class T>
int hardest_contact(const Workspace<T>& ws) {
  const Ratios<T>& r = ws.ratios;
  const Tied<T>& w = r.plain;
  int hardest = -1;
  double most = 0;
  for (int t = 0; t < r.ties; ++t) {
    const double taken = value(w.wanted[t] * w.wanted[t] * w.gram[t * r.ties + t]);
    if (r.tie[t] >= 0 || !(taken > most)) continue;
    most = taken, hardest = ws.held.contact[ws.held.n_fixed + r.rows - r.ties + t - 2 * r.n];
  }
  return hardest;
}

/// A transmission whose row counted as none at the start of a step and would now, by ties.wanted, stop by a jump what
/// it joins, which moved as in `missed`; -1: none. docs/theory/varying-ratios.md, drift
template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] int caught_tie(const Form& form, const T* missed) {
  const Workspace<T>& ws = form.ws;
  const Ratios<T>& r = ws.ratios;
  const int nz = form.nz();
  for (int t = 0; t < r.ties && r.tie[t] >= 0; ++t) {
    if (value(r.some.gram[t * r.ties + t]) != 0) continue;
    double most = 0, fastest = 0;
    for (int round = 0; round < 2; ++round) {
      for (int i = 0; i < nz; ++i) {
        double along = 0;
        for (int k = 0; k < r.rows; ++k) along += value(r.plain.share[t * r.rows + k] * r.along[k * nz + i]);
        if (round == 0) most = larger(most, abs(along));
        if (round == 1 && abs(along) > 1e-9 * most) fastest = larger(fastest, abs(value(missed[i])));
      }
    }
    const double moved = most * abs(value(r.plain.wanted[t]));
    if (moved > 1e3 * ws.guard.zero + most_drift(ws) * fastest) return r.tie[t];
  }
  return -1;
}

/// Speeds y brought onto the ties at the point that was evaluated last, the momentum across them untouched. A
/// transmission that nothing can keep there, for what ties its speeds is prescribed, or that would have to stop by a
/// jump what has left its ratio; -1: none. `before`: at the start of a step, which may lead to rest.
/// docs/theory/varying-ratios.md (9)
template <class Form, class T = typename Form::Scalar>
int settle_ties(Form& form, T* y, const T* before = nullptr) {
  Workspace<T>& ws = form.ws;
  const Ratios<T>& r = ws.ratios;
  const Tied<T>& w = r.plain;
  const int nz = form.nz(), np = int(ws.sys.prescribed);
  auto rate = [&](int k) {
    T s = ws.rows.rate.times(r.place[k], y);
    for (int p = 0; p < np; ++p) s += ws.reduced.offset[r.place[k] * np + p] * ws.in.prescribed[p];
    return s;
  };
  for (int a = 0; a < r.n; ++a) w.pull[a] = w.ratio[a] * rate(2 * a + 1) - rate(2 * a);
  for (int t = 0; t < r.ties; ++t) {
    const T own = r.tie[t] >= 0 ? w.pull[r.tie[t]] : -rate(r.rows - r.ties + t);
    w.wanted[t] = wanted_of_tie(r, w, t, own, w.pull);
  }
  solve_ties(r, w, w.wanted);
  T* missed = w.push;
  for (int i = 0; i < nz; ++i) missed[i] = y[i];
  for (int t = 0; t < r.ties; ++t) {
    for (int k = 0; k < r.rows; ++k) axpy(nz, w.share[t * r.rows + k] * w.wanted[t], r.along + k * nz, y);
  }
  double fastest = 0, moved = 0;
  for (int i = 0; i < nz; ++i) {
    fastest = larger(fastest, abs(value(missed[i])));
    if (before != nullptr) fastest = larger(fastest, abs(value(before[i])));
    moved = larger(moved, abs(value(y[i] - missed[i])));
  }
  for (int a = 0; a < r.n; ++a) {
    if (r.column[a] < 0) continue;
    const T miss = w.ratio[a] * rate(2 * a + 1) - rate(2 * a);
    y[r.column[a]] += miss / share_of_follower(r, w, a, a);
  }
  constexpr double most = 1e-6;
  for (int t = 0; t < r.ties && r.tie[t] >= 0; ++t) {
    if (value(w.gram[t * r.ties + t]) != 0) continue;
    const int a = r.tie[t];
    const double first = value(rate(2 * a)), second = value(w.ratio[a] * rate(2 * a + 1));
    if (abs(first - second) > 10 * ws.guard.zero + most * (abs(first) + abs(second))) return a;
  }
  ws.ratios.stopped = -1;
  // at the start of a phase, and with derivatives, no point before is known
  if constexpr (!has_tangents<T>) {
    const int caught = before != nullptr && before != y ? caught_tie(form, missed) : -1;
    if (caught >= 0) return caught;
  }
  if (!(moved > 1e3 * ws.guard.zero + most_drift(ws) * fastest)) return -1;
  const int hardest = hardest_tie(r);
  if (hardest < 0) ws.ratios.stopped = hardest_contact(ws);
  return hardest;
}

/// Locked contacts that share a load pass it on otherwise than the independent contacts would alone: transmissions take
/// the difference, at the point that was evaluated last. docs/theory/varying-ratios.md (21)
template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] void carry_shares(Form& form) {
  Workspace<T>& ws = form.ws;
  const Ratios<T>& r = ws.ratios;
  const Tied<T>& w = r.plain;
  const int ne = int(ws.sys.elements), nv = int(ws.sys.speeds), nz = form.nz();
  T *torque = ws.reduced.column, *reduced = w.push;
  for (int i = 0; i < nv; ++i) torque[i] = T(0);
  for (int k = 0; k < ws.held.n_sets; ++k) {
    const int first = ws.held.set_first[k];
    for (int i = first; i < ws.held.set_first[k + 1]; ++i) {
      const int d = ne + ws.held.set_member[i], own = ws.branch_of[d];
      T more = ws.out.torque[d];
      if (own >= 0 && own < ws.n_branches) more -= ws.observed.torque[own];
      if (i - first < ws.held.set_rank[k]) more -= ws.observed.carried[ws.held.set_place[i]];
      add_direction(ws, d, more, torque);
    }
  }
  for (int i = 0; i < nz; ++i) reduced[i] = T(0);
  for (int i = 0; i < nv; ++i) ws.rows.expansion.add(i, torque[i], reduced);
  for (int t = 0; t < r.ties; ++t) w.wanted[t] = T(0);
  carry(r, w, reduced, nz);
  for (int a = 0; a < r.n; ++a) {
    const int d = first_of(ws, a), k = r.place[2 * a];
    ws.observed.torque[k] += w.torque[a], ws.observed.torque[k + 1] -= w.ratio[a] * w.torque[a];
    ws.out.torque[d] = ws.observed.torque[k], ws.out.torque[d + 1] = ws.observed.torque[k + 1];
  }
}

/// Torques of the locked contacts whose directions vary, behind those of the others.
template <class T, class S, class Of>
void varying_multipliers(const Workspace<T>& ws, const Tied<S>& w, T* out, Of&& of) {
  for (int c = 0; c < varying_held(ws); ++c) out[ws.held.n_fixed + c] = of(w.held[c]);
}

}  // namespace clutchwork

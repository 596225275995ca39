#pragma once
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/motion/form.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/watch.hpp>
#include <clutchwork/workspace.hpp>

/// Speeds without inertia: where their torques balance, and how they change. docs/theory/reduction.md, shafts without
/// inertia
namespace clutchwork {

/// A huge inertia holds all other speeds, where no pivots are chosen.
inline constexpr double held_inertia = 1e30;

template <class T>
bool is_massless(const Workspace<T>& ws, int i) {
  return ws.rows.mass.first[i] == ws.rows.mass.first[i + 1];
}
template <class Form>
bool any_massless(const Form& form) {
  for (int i = 0; i < form.nz(); ++i) {
    if (is_massless(form.ws, i)) return true;
  }
  return false;
}

/// b := change of the speeds without inertia by which b is missing in the balance of torques that was linearized last;
/// of all others b is the change itself in the full form, and that times their huge inertia else. False: it is
/// singular.
template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] bool solve_held(Form& form, T* b) {
  Workspace<T>& ws = form.ws;
  if constexpr (Form::full) {
    if (!form.factor_held()) return false;
    form.solve_whole(b, form.nz());
  } else {
    T* stiff = ws.stages.stiff;
    for (int k = 0; k < ws.n_branches; ++k) stiff[k] = ws.jacobian.partial[k].by_rate;
    if (!form.factor(T(held_inertia), stiff)) return false;
    form.solve(b);
  }
  return true;
}

/// Whether a rate is on the present piece of a branch, within what counts as zero.
template <class T>
bool is_on_piece(const Workspace<T>& ws, const Branch<T>& b, int edges, double rate) {
  const int interval = b.piece % (edges + 1);
  const double zero = slip_tolerance(ws);
  return (interval == 0 || rate >= value(edge_at(ws, b.direction, interval - 1)) - zero) &&
         (interval == edges || rate <= value(edge_at(ws, b.direction, interval)) + zero);
}

/// The elements that feel a speed without inertia go to the pieces that hold their rates at y; whether any does.
template <class Form, class T = typename Form::Scalar>
bool follow_pieces(Form& form, const T* y) {
  Workspace<T>& ws = form.ws;
  const Compressed<T>& rows = ws.rows.rate;
  bool moved = false;
  for (int k = 0; k < ws.n_branches; ++k) {
    Branch<T>& b = ws.branch[k];
    bool feels = false;
    for (int e = rows.first[k]; e < rows.first[k + b.ways]; ++e) feels = feels || is_massless(ws, rows.col[e]);
    if (b.law >= 0 || !feels) continue;
    T rate[most_ways];
    for (int w = 0; w < b.ways; ++w) rate[w] = form.rate(k + w, y) + offset_rate(ws, k + w);
    const int before = b.piece, edges = edge_count(ws, b.direction);
    if (edges > 0 && !is_on_piece(ws, b, edges, value(rate[0])))
      b.piece += piece_of(ws, b.direction, value(rate[0])) - b.piece % (edges + 1);
    if (is_settling(b.kind)) b.piece = settled_piece(ws, b, rate);
    ws.piece[b.direction] = b.piece;
    moved = moved || b.piece != before;
  }
  return moved;
}

/// Partial derivatives at y, out of line: they are taken for few instants.
template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] void linearize_apart(Form& form, double t, const T* y, T* d, T* dt) {
  linearize(form, t, y, d, dt, form.ws.step_start);
}

/// What is missing in the balance at y, whose pieces hold; `moved`: others do than before.
template <class Form>
[[gnu::noinline]] double imbalance(Form& form, Step<Form>& step, bool& moved) {
  auto& ws = form.ws;
  moved = follow_pieces(form, step.y0()) || moved;
  linearize_apart(form, ws.time, step.y0(), step.f0(), step.dt0());
  double square = 0;
  for (int i = 0; i < form.nz(); ++i) {
    if (is_massless(ws, i)) square += value(step.f0()[i]) * value(step.f0()[i]);
  }
  return square;
}

/// What is missing in a balance of torques, and their sizes.
struct Imbalance {
  double missing = 0, size = 0;
  /// Whether that is more than a share of the torques.
  bool exceeds(double share) const { return missing > share * size; }
};

/// That of the speeds without inertia, of which d is the balance.
template <class Form, class T = typename Form::Scalar>
Imbalance imbalance_of(Form& form, const T* d) {
  Workspace<T>& ws = form.ws;
  const Compressed<T>& rows = ws.rows.rate;
  Imbalance found;
  for (int k = 0; k < ws.n_branches; ++k) {
    for (int e = rows.first[k]; e < rows.first[k + 1]; ++e) {
      if (is_massless(ws, rows.col[e])) found.size += abs(value(rows.val[e] * ws.observed.torque[k]));
    }
  }
  for (int i = 0; i < form.nz(); ++i) {
    if (is_massless(ws, i)) found.missing = larger(found.missing, abs(value(d[i])));
  }
  return found;
}

/// Newton over the pieces of the elements at speeds without inertia, from the present ones on, with shorter steps where
/// a whole one misses. Whether it has found their balance; `moved`: pieces have changed.
template <class Form>
[[gnu::noinline]] bool find_balance(Form& form, Step<Form>& step, double fastest, bool& moved) {
  constexpr int least = 8, most = 64, halvings = 30;
  constexpr double small = 1e-9, enough = 1e-6;
  using T = typename Form::Scalar;
  auto& ws = form.ws;
  const int nz = form.nz();
  T *b = step.slope(), *y = step.y0();
  double change = infinity;
  double missing = imbalance(form, step, moved);
  for (int round = 0; round < least || (round < most && change > small * (1 + fastest)); ++round) {
    change = 0;
    for (int i = 0; i < nz; ++i) b[i] = is_massless(ws, i) ? step.f0()[i] : T(0);
    if (!solve_held(form, b)) {
      change = infinity;
      break;
    }
    for (int i = 0; i < nz; ++i) change = larger(change, abs(value(b[i])));
    for (int i = 0; i < nz; ++i) y[i] += b[i];
    const bool close = change <= small * (1 + fastest);
    double share = 1, left = imbalance(form, step, moved);
    for (int k = 0; k < halvings && !close && !(left < missing); ++k) {
      share *= 0.5;
      for (int i = 0; i < nz; ++i) y[i] -= T(share) * b[i];
      left = imbalance(form, step, moved);
    }
    missing = left;
  }
  if (change <= small * (1 + fastest)) return true;
  observe(form, ws.time, y, b);
  return !imbalance_of(form, b).exceeds(enough);
}

/// The speed i without inertia to where what drives it off ends, the way it is driven, as an ever smaller inertia would
/// go. It is looked at from `from` away on: two balances that have just met may hold it closer by. Whether there is
/// such a place. docs/theory/reduction.md (9)
template <class Form>
[[gnu::noinline]] bool run_off(Form& form, Step<Form>& step, int i, double way, double from, bool& moved) {
  constexpr double near = 1e2, far = 1e12;
  constexpr int halvings = 40;
  using T = typename Form::Scalar;
  T* y = step.y0();
  const T start = y[i];
  double at = from, before = 0;
  auto is_driven = [&](double there) {
    y[i] = start + T(way * there);
    imbalance(form, step, moved);
    return way * value(step.f0()[i]) > 0;
  };
  while (at < near * from && !is_driven(at)) at *= 2;
  // balances that are closer together than a tenth of their speed count as none
  const double least = 1e-2 * (1 + abs(value(start)));
  double stride = at;
  for (bool driven = at < near * from; driven && at < far; driven = is_driven(at)) {
    before = at, stride = smaller(2 * stride, 0.1 * (least + abs(value(y[i]))));
    at += stride;
  }
  const bool ends = before > 0 && at < far;
  for (int k = 0; k < halvings && ends; ++k) {
    const double middle = 0.5 * (before + at);
    (is_driven(middle) ? before : at) = middle;
  }
  if (!ends) y[i] = start;
  return ends;
}

/// Whether a balance of speeds without inertia holds them: beside it each is driven back, whatever the others do. Else
/// Newton's method has found what no motion stays at.
template <class Form>
bool holds(Form& form, Step<Form>& step, bool& moved) {
  using T = typename Form::Scalar;
  T* y = step.y0();
  bool all = true;
  for (int i = 0; i < form.nz() && all; ++i) {
    if (!is_massless(form.ws, i)) continue;
    const T balance = y[i];
    const double aside = 1e-6 * (1 + abs(value(balance)));
    auto driven = [&](double way) {
      y[i] = balance + T(way);
      imbalance(form, step, moved);
      return value(step.f0()[i]);
    };
    all = !(driven(aside) > 0 && driven(-aside) < 0);
    y[i] = balance;
  }
  imbalance(form, step, moved);
  return all;
}

/// Speeds without inertia to where their torques balance, from the present ones on: by Newton's method, else one after
/// the other the way it is driven. True where they have jumped. docs/theory/reduction.md (9)
template <class Form>
bool balance_massless(Form& form, Step<Form>& step) {
  constexpr double small = 1e-9, jump = 1e-4;
  constexpr int tries = 8;
  using T = typename Form::Scalar;
  auto& ws = form.ws;
  if (!any_massless(form)) return false;
  const int nz = form.nz();
  T* y = step.y0();
  double fastest = 0;
  int n_massless = 0;
  for (int i = 0; i < nz; ++i) {
    step.y1()[i] = y[i];
    fastest = larger(fastest, abs(value(y[i])));
    n_massless += is_massless(ws, i);
  }
  auto has_jumped = [&] {
    double way = 0;
    for (int i = 0; i < nz; ++i) way = larger(way, abs(value(y[i] - step.y1()[i])));
    return way > jump * (1 + fastest);
  };
  bool moved = false;
  const bool found = find_balance(form, step, fastest, moved);
  // a shaft alone goes to the first balance on its way; of several, which may be coupled, one that holds is right
  if (!found || (has_jumped() && (n_massless == 1 || !holds(form, step, moved)))) {
    // from where the motion stood, not from where the method went
    for (int i = 0; i < nz; ++i) y[i] = step.y1()[i];
    for (int k = 0; k == 0 || (k < tries && !find_balance(form, step, fastest, moved)); ++k) {
      for (int i = 0; i < nz; ++i) {
        if (!is_massless(ws, i)) continue;
        imbalance(form, step, moved);
        run_off(form, step, i, value(step.f0()[i]) < 0 ? -1 : 1, small * (1 + fastest), moved);
      }
    }
  }
  const bool jumped = has_jumped();
  expand(form, y, ws.v);
  ws.guard.zero = slip_tolerance(ws);
  if (moved) list_lines(ws);
  return jumped;
}

/// Speeds without inertia of y, inside of a step, to where their torques balance: an interpolant has them less exactly
/// than the ends. Newton by what was linearized last; d is their balance, b memory. docs/theory/reduction.md (9)
template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] void settle_massless(Form& form, double t, T* y, T* d, T* b) {
  constexpr int rounds = 4;
  constexpr double enough = 1e-9;
  Workspace<T>& ws = form.ws;
  const int nz = form.nz();
  Imbalance left = imbalance_of(form, d);
  for (int round = 0; round < rounds && left.exceeds(enough); ++round) {
    for (int i = 0; i < nz; ++i) b[i] = is_massless(ws, i) ? d[i] : T(0);
    if (!solve_held(form, b)) return;
    for (int i = 0; i < nz; ++i) y[i] += b[i];
    observe(form, t, y, d);
    const double before = left.missing;
    left = imbalance_of(form, d);
    // torques may fade to round-off, of which the same share stays missing
    if (left.missing < before) continue;
    for (int i = 0; i < nz; ++i) y[i] -= b[i];
    return observe(form, t, y, d);
  }
}

/// Rates of change of the speeds without inertia along the motion, of which d has the others and those of the states:
/// their balance at (t, y) holds on. docs/theory/reduction.md (9)
template <class Form, class T = typename Form::Scalar>
[[gnu::noinline]] void change_massless(Form& form, double t, const T* y, T* d, T* b, T* dt) {
  Workspace<T>& ws = form.ws;
  const int nz = form.nz(), n = form.n();
  linearize_apart(form, t, y, b, dt);
  for (int i = 0; i < nz; ++i) b[i] = T(0);
  if constexpr (Form::full) {
    for (int i = 0; i < nz; ++i) {
      for (int j = nz; j < n; ++j) b[i] += ws.full.jacobian[i * n + j] * d[j];
    }
  } else {
    const int nx = int(ws.sys.shared);
    for (int k = 0; k < ws.n_branches; ++k) {
      T drift = T(0);
      for (int s = ws.branch[k].state; s < ws.branch[k].state + ws.branch[k].states; ++s)
        drift += ws.jacobian.f_state[s] * d[nz + s];
      for (int j = 0; j < nx; ++j) drift += ws.jacobian.torque_by[k * nx + j] * d[n - nx + j];
      form.push(k, drift, b);
    }
  }
  for (int i = 0; i < nz; ++i) {
    b[i] = is_massless(ws, i) ? b[i] + dt[i] : Form::full ? d[i] : T(0);
    if (is_massless(ws, i)) d[i] = T(0);
  }
  if constexpr (!Form::full) form.add_mass_times(T(held_inertia), d, b);
  if (!solve_held(form, b)) return;
  for (int i = 0; i < nz; ++i) {
    if (is_massless(ws, i)) d[i] = b[i];
  }
}

}  // namespace clutchwork

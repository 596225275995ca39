#pragma once
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/integrator/rodas5p.hpp>
#include <clutchwork/run/mirror.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/run/step.hpp>
#include <clutchwork/run/step_calls.hpp>
#include <clutchwork/workspace.hpp>

#include <utility>

/// Steps of a run with derivatives: a plain step, and the derivatives along it. docs/theory/gradients.md (20)
namespace clutchwork {

template <class Form>
struct PlainForm;
template <class T>
struct PlainForm<SparseForm<T>> {
  using type = SparseForm<double>;
};
template <class T>
struct PlainForm<FullForm<T>> {
  using type = FullForm<double>;
};

/// A phase of a run with derivatives: its plain image, and derivatives along the plain steps.
template <class Form>
class Variation {
  using T = typename Form::Scalar;
  using Plain = typename PlainForm<Form>::type;
  // of a step: how far ahead the change of the slopes with time is looked at
  static constexpr double ahead = 1e-3;
  // a direction may miss so much of itself in a part, of rtol: the error of the motion moves derivatives by more
  static constexpr double allowed = 3;

  Form& form_;
  Step<Form>& step_;
  Workspace<T>& ws_;
  const StepCalls<Plain> calls_;
  double from_ = 0, to_ = 1, share_ = 1;  ///< present part of the plain step, and its length
  // shares of the step at which the image has been linearized: at its Jacobian, and at the other one; -1: elsewhere
  double at_ = -1, other_at_ = -1;
  bool is_whole_ = false;                      ///< the image has the factor of the whole step
  bool known_ = false;                         ///< the slopes at the start of the next part
  bool rows_move_ = true, mass_moves_ = true;  ///< with the numbers of the model

 public:
  Plain form;
  Step<Plain> step;

  Variation(Form& own, Step<Form>& own_step)
      : form_(own),
        step_(own_step),
        ws_(own.ws),
        calls_(PlainCalls<Plain, Rodas5P>::all()),
        form(prepared(own.ws)),
        step(form) {
    step.calls = &calls_;
  }

  /// The image is where the run is, and has looked at it.
  void reflect_here() {
    reflect(ws_, *ws_.moved.plain, false);
    form.mass_factored = false;
    rows_move_ = moves(ws_.rows.rate.val, ws_.rows.rate.first[ws_.n_branches]);
    mass_moves_ = moves(ws_.rows.mass.val, ws_.rows.mass.first[form.nz()]);
    take_values(step_.y0(), form.n(), step.y0());
    known_ = false;
    look_here();
  }
  void look_here() {
    form.ws.in.time = -infinity;
    calls_.look(form, step, ws_.time, step.y0(), step.f0(), step.dt0(), form.ws.here);
    give_edge(form.ws.here, ws_.here);
    at_ = 0, other_at_ = -1;
  }
  void look_at_end(double end) {
    calls_.look(form, step, end, step.y1(), step.f1(), step.dt1(), form.ws.there);
    give_edge(form.ws.there, ws_.there);
    at_ = 1;
  }

  /// The plain step; its error in units of the tolerance. It leaves the Jacobian of its start to the derivatives.
  double advance(double h) {
    if (other_at_ == 0) swap_jacobians();
    step.t = ws_.time;
    const double error = calls_.advance(form, step, h);
    is_whole_ = true;
    swap_jacobians();
    return error;
  }

  /// A step of the derivatives from where they are, at the share `from` of the plain step, which ends at the time
  /// `end`, to `until` or less far; how far it got, -1: its length has become too short.
  double follow(double from, double until, double end) {
    fit(form, step);
    for (;;) {
      const double left = (until - from) * step.h, pace = ws_.moved.pace;
      const bool last = left <= 1.001 * pace;
      // the rest in equal parts
      const double h = last ? left : left / double(std::int64_t(left / pace) + 1);
      const double to = last ? until : from + h / step.h;
      if (!(h > 1e-14 * larger(1e-2, abs(step.t)))) return last ? leap(from, until) : -1;
      if (!prepare(from, h)) return -1;
      linearize_at(to, end);
      from_ = from, to_ = to, share_ = h / step.h;
      const double error = vary(h);
      const double growth = 0.9 * pow(larger(error, 1e-10), -0.2);
      if (error <= 1) {
        // one that was cut says nothing of longer ones
        ws_.moved.pace = last ? larger(pace, h * smaller(6.0, growth)) : h * smaller(6.0, growth);
        for (int i = 0; i < form.n(); ++i) step_.f1()[i] = step_.dt1()[i];
        known_ = !has_ties();
        set_values();
        return to;
      }
      ws_.moved.pace = h * (error < 1e300 ? larger(0.2, smaller(0.9, growth)) : 0.1);
    }
  }
  /// The interpolant of the present part.
  void fit_part() {
    if (step_.dense) return;
    fit(form_, step_);
    fit_values();
  }
  /// Where no time passes.
  void rest() {
    rest_step(form_, step_);
    step_.dense = true;
  }
  /// Go on from the end of the step.
  void accept() {
    for (int i = 0; i < form.n(); ++i) {
      step.y0()[i] = step.y1()[i], step.f0()[i] = step.f1()[i], step.dt0()[i] = step.dt1()[i];
    }
    const Edge<double> edge = form.ws.here;
    form.ws.here = form.ws.there, form.ws.there = edge;
    form.ws.time = ws_.time;
    give_edge(form.ws.here, ws_.here), give_edge(form.ws.there, ws_.there);
    if (ws_.options.work) take_values(ws_.work, ws_.n_directions, form.ws.work);
    at_ = 0, other_at_ = -1;
  }

 private:
  static Workspace<double>& prepared(Workspace<T>& ws) {
    reflect(ws, *ws.moved.plain, true);
    return *ws.moved.plain;
  }

  /// Whether any of n numbers has derivatives.
  static bool moves(const T* x, int n) {
    for (int i = 0; i < n; ++i) {
      if (!is_constant(x[i])) return true;
    }
    return false;
  }
  /// Speeds are brought back onto ties after a part.
  bool has_ties() const { return Form::full && ws_.ratios.n > 0; }

  /// Too short for a step: the derivatives stay.
  double leap(double from, double until) {
    for (int i = 0; i < form.n(); ++i) step_.y1()[i] = step_.y0()[i];
    for (int q = 0; q < 3; ++q) {
      for (int i = 0; i < form.n(); ++i) step_.p(q)[i] = T(0);
    }
    step_.t = step.t + from * step.h, step_.h = (until - from) * step.h, step_.dense = true;
    from_ = from, to_ = until, known_ = false;
    set_values(), fit_values();
    return until;
  }

  void swap_jacobians() {
    std::swap(form.ws.jacobian, ws_.moved.other);
    // where the blocks stand is no derivative, and the same at both ends
    std::swap(form.ws.jacobian.block, ws_.moved.other.block);
    if constexpr (Form::full) std::swap(form.ws.full.jacobian, ws_.moved.other_whole);
    std::swap(at_, other_at_);
  }
  /// The image is linearized at a share of the step; of its end it is known what a look there finds.
  void linearize_at(double share, double end) {
    if (at_ == share) return;
    if (share == 1) return look_at_end(end);
    interpolate(form, step, share, step.point());
    linearize(form, step.t + share * step.h, step.point(), step.u(), step.slope(), form.ws.there);
    at_ = share;
  }

  /// The factor for a step of the derivatives, and the other Jacobian with it: those of the plain step where they go
  /// all the way with it.
  bool prepare(double from, double h) {
    if (is_whole_ && from == 0 && h == step.h) return true;
    is_whole_ = false;
    if (other_at_ == from) {
      swap_jacobians();
    } else {
      linearize_at(from, infinity);
    }
    const bool regular = Rodas5P::factor(form, 1 / (Rodas5P::gamma * h));
    swap_jacobians();
    return regular;
  }

  /// The values at the end of the present part, beside the derivatives.
  void set_values() {
    double* end = step.point();
    if (to_ < 1) interpolate(form, step, to_, end);
    for (int i = 0; i < form.n(); ++i) step_.y1()[i].v = to_ < 1 ? end[i] : step.y1()[i];
  }
  /// Those of its interpolant: the same quartic over the part.
  void fit_values() {
    const double from = from_, d = to_ - from;
    for (int i = 0; i < form.n(); ++i) {
      const double p0 = step.p(0)[i], p1 = step.p(1)[i], p2 = step.p(2)[i], a = step.y0()[i];
      const double c1 = step.y1()[i] - a + p0, c2 = p1 - p0, c3 = p2 - p1, c4 = -p2;
      const double m1 = d * (c1 + from * (2 * c2 + from * (3 * c3 + from * 4 * c4)));
      const double m2 = d * d * (c2 + from * (3 * c3 + from * 6 * c4)), m3 = d * d * d * (c3 + from * 4 * c4);
      const double q0 = m1 - (step_.y1()[i].v - step_.y0()[i].v), q1 = m2 + q0;
      step_.p(0)[i].v = q0, step_.p(1)[i].v = q1, step_.p(2)[i].v = m3 + q1;
    }
  }

  void give_edge(const Edge<double>& from, Edge<T>& to) {
    for (int k = 0; k < ws_.n_rates; ++k) to.rate[k] = T(from.rate[k]), to.slope[k] = T(from.slope[k]);
    for (int a = 0; a < ws_.held.n; ++a) to.multiplier[a] = T(from.multiplier[a]);
  }

  /// Derivatives of the slopes at the share s of the present part of the step, whose state has the derivatives of `y`,
  /// into `d`.
  void slopes_at(double s, const T* y, T* d) {
    const double at = from_ + s * share_, t = step.t + at * step.h;
    T* whole = step_.point();
    interpolate(form, step, at, step.point());
    for (int i = 0; i < form.n(); ++i) whole[i] = y[i], whole[i].v = step.point()[i];
    if (Form::full || rows_move_ || ws_.sys.shared > 0) {
      evaluate(form_, t, whole, d);
    } else {
      evaluate_over_plain_rows(t, whole, d);
    }
    if (mass_moves_) take_from_mass(d);
    for (int i = 0; i < form.n(); ++i) d[i].v = 0;
  }
  /// As evaluate, where the rows of the branches have no derivatives.
  void evaluate_over_plain_rows(double t, const T* y, T* d) {
    const int nz = form.nz();
    inputs_with(ws_, t, y + nz);
    for (int i = 0; i < form.n(); ++i) d[i] = T(0);
    for (int k = 0; k < ws_.n_branches; ++k) {
      const T rate = form.rate(k, y) + offset_rate(ws_, k);
      form.push(k, branch_torque(ws_, ws_.branch[k], rate, y + nz, d + nz), d);
    }
  }
  /// What a mass that changes takes of the slopes.
  void take_from_mass(T* d) {
    double* velocity = step.slope();
    for (int i = 0; i < form.nz(); ++i) velocity[i] = value(d[i]);
    form.solve_mass(velocity);
    T* moved = step_.slope();
    for (int i = 0; i < form.nz(); ++i) {
      const bool massless = ws_.rows.mass.first[i] == ws_.rows.mass.first[i + 1];
      moved[i] = T(massless ? 0.0 : velocity[i]);
    }
    form_.add_mass_times(T(-1), moved, d);
  }

  /// d := d + J x, with J where the image has been linearized last.
  void add_linear(const T* x, T* d) {
    const Workspace<double>& ws = form.ws;
    const Jacobian<double>& j = ws.jacobian;
    const int n = form.n(), nz = form.nz(), nx = int(ws.sys.shared);
    if constexpr (Form::full) {
      for (int i = 0; i < n; ++i) add_row(n, ws.full.jacobian + i * n, x, d[i]);
      return;
    }
    const T *own = x + nz, *shared = x + n - nx;
    for (int k = 0; k < ws.n_branches; ++k) {
      const Branch<double>& b = ws.branch[k];
      const T rate = form.rate(k, x);
      T torque = rate * j.partial[k].by_rate;
      add_row(b.states, j.f_state + b.state, own + b.state, torque);
      add_row(nx, j.torque_by + k * nx, shared, torque);
      form.push(k, torque, d);
      for (int s = 0; s < b.states; ++s) {
        T& to = d[nz + b.state + s];
        add_times(j.g_rate[b.state + s], rate, to);
        add_row(b.states, j.g_state + j.block[k] + s * b.states, own + b.state, to);
      }
    }
    for (int i = 0; i < nx; ++i) {
      d[n - nx + i] += border_times(form, i, x);
      add_row(nx, j.by_shared + i * nx, shared, d[n - nx + i]);
    }
  }
  static void add_row(int n, const double* row, const T* x, T& to) {
    for (int i = 0; i < n; ++i) {
      if (row[i] != 0) add_times(row[i], x[i], to);
    }
  }

  /// Change of the slopes with time along the motion at the start of a part of length h, to second order.
  void drift_at_start(double h, const T* start, T* drift) {
    T *first = step_.f1(), *near = step_.k(1), *far = step_.k(2);
    slopes_at(ahead, start, near), slopes_at(2 * ahead, start, far);
    const double per = 1 / (2 * ahead * h);
    for (int i = 0; i < form.n(); ++i) {
      T x = near[i] * (4 * per);
      add_times(-3 * per, first[i], x), add_times(-per, far[i], x);
      drift[i] = x;
    }
  }

  /// The derivatives at the end of a part of the step of length h; their error in units of the tolerance.
  /// docs/theory/gradients.md (20)
  double vary(double h) {
    const int n = form.n();
    step_.t = step.t + from_ * step.h, step_.h = h, step_.dense = false;
    T *start = step_.y1(), *u = step_.u(), *drift = step_.dt0(), *first = step_.f1(), *last = step_.dt1();
    for (int i = 0; i < n; ++i) start[i] = u[i] = step_.y0()[i], start[i].v = u[i].v = 0;
    if (!known_) slopes_at(0, start, first);
    known_ = true;
    drift_at_start(h, start, drift);
    for (int s = 0; s < 8; ++s) {
      T* k = step_.k(s);
      if (s > 0) stage_from(s, start, u);
      // the last three stages are at one instant, where the slopes are linear in the derivatives
      if (s > 5) add_linear(step_.k(s - 1), last);
      if (s == 5) slopes_at(1, u, last);
      if (s > 0 && s < 5) slopes_at(Rodas5P::node[s], u, k);
      for (int i = 0; i < n && (s == 0 || s >= 5); ++i) k[i] = s == 0 ? first[i] : last[i];
      if (s > 0) add_stages(s, h, k);
      for (int i = 0; i < n && s < 5; ++i) add_times(h * Rodas5P::d[s], drift[i], k[i]);
      swap_jacobians();
      Rodas5P::solve(form, k, ws_.shared.rhs);
      swap_jacobians();
    }
    add_linear(step_.k(7), last);
    for (int i = 0; i < n; ++i) start[i] = u[i] + step_.k(7)[i];
    return error_of(step_.k(7), start);
  }
  /// The derivatives at stage s.
  void stage_from(int s, const T* start, T* u) {
    for (int i = 0; i < form.n(); ++i) {
      if (s >= 6) {
        u[i] += step_.k(s - 1)[i];
        continue;
      }
      T x = start[i];
      for (int j = 0; j < s; ++j) add_times(Rodas5P::a[s][j], step_.k(j)[i], x);
      u[i] = x;
    }
  }
  /// k := k + M / h times the stages before.
  void add_stages(int s, double h, T* k) {
    const int nz = form.nz();
    T* mix = step_.p(0);
    for (int i = 0; i < form.n(); ++i) {
      T x = T(0);
      for (int j = 0; j < s; ++j) add_times(Rodas5P::c[s][j], step_.k(j)[i], x);
      mix[i] = x;
    }
    form.add_mass_times(1 / h, mix, k);
    for (int i = nz; i < form.n(); ++i) add_times(1 / h, mix[i], k[i]);
  }

  /// Sizes of the components of each direction over those of the motion, to f(component, size of the motion).
  template <class F>
  void each_component(const T* x, F&& f) const {
    const Workspace<double>& plain = form.ws;
    const int nv = int(plain.sys.speeds), nz = form.nz();
    const double least = plain.options.atol / plain.options.rtol;
    double fastest = 0;
    for (int i = 0; i < nv; ++i) fastest = larger(fastest, plain.reduced.size[i]);
    for (int i = 0; i < nv; ++i) {
      T moved = T(0);
      each_share(form, i, [&](double z, int j) { moved += x[j] * z; });
      f(moved, least + larger(plain.reduced.size[i], 1e-3 * fastest));
    }
    for (int i = 0; i < form.ns(); ++i) {
      const double most = larger(abs(step0(nz + i)), abs(step1(nz + i)));
      f(x[nz + i], plain.reduced.floor[i] / plain.options.rtol + most);
    }
  }
  double step0(int i) const { return const_cast<Step<Plain>&>(step).y0()[i]; }
  double step1(int i) const { return const_cast<Step<Plain>&>(step).y1()[i]; }

  /// Error of the derivatives in units of the tolerance, each direction of the largest size that it has had.
  /// docs/theory/gradients.md (21)
  double error_of(const T* missed, const T* end) {
    constexpr int seen = T::seen;
    double sum[seen] = {}, worst = 0;
    double* size = ws_.moved.size;
    each_component(end, [&](const T& x, double of) {
      for (int j = 0; j < seen; ++j) size[j] = larger(size[j], abs(x.seen_slope(j)) / of);
    });
    each_component(missed, [&](const T& x, double of) {
      for (int j = 0; j < seen; ++j) sum[j] += (x.seen_slope(j) / of) * (x.seen_slope(j) / of);
    });
    const double count = double(ws_.sys.speeds + form.ns());
    for (int j = 0; j < seen; ++j) {
      if (size[j] > 0) worst = larger(worst, sqrt(sum[j] / count) / (allowed * ws_.options.rtol * size[j]));
    }
    return worst;
  }
};

}  // namespace clutchwork

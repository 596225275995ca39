#pragma once
#include <clutchwork/components/slopes.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/integrator/rodas5p.hpp>
#include <clutchwork/run/mirror.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/run/step.hpp>
#include <clutchwork/run/step_calls.hpp>
#include <clutchwork/run/step_size.hpp>
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
  template <class X>
  using As = SlopesAs<T, X>;
  // of a part: how far ahead the change of the slopes with time is looked at, twice; loose tolerances need one look
  static constexpr double ahead = 1e-3, loose = 1e-8;
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
  const double look_once_;                     ///< of a part, ahead of its start
  double reached_[T::seen] = {};               ///< sizes of the directions up to the end of the part that is tried
  bool rows_move_ = true, mass_moves_ = true;  ///< with the numbers of the model

 public:
  Plain form;
  Step<Plain> step;

  Variation(Form& own, Step<Form>& own_step)
      : form_(own),
        step_(own_step),
        ws_(own.ws),
        calls_{nullptr,
               PlainCalls<Plain, Rodas5P>::fit,
               clutchwork::linearize_at<Plain>,
               observe_inside<Plain>,
               Rodas5P::stiff,
               Rodas5P::restart},
        look_once_(1e-2 * pow(own.ws.options.rtol, 0.4)),
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
    linearize_start();
  }
  void linearize_start() {
    form.ws.in.time = -infinity;
    calls_.linearize_at(form, step, ws_.time, step.y0(), step.f0(), step.dt0(), form.ws.step_start);
    give_end(form.ws.step_start, ws_.step_start);
    at_ = 0, other_at_ = -1;
  }
  void linearize_end(double end) {
    calls_.linearize_at(form, step, end, step.y1(), step.f1(), step.dt1(), form.ws.step_end);
    give_end(form.ws.step_end, ws_.step_end);
    at_ = 1;
  }

  /// The plain step; its error in units of the tolerance. It leaves the Jacobian of its start to the derivatives.
  double advance(double h) {
    if (other_at_ == 0) swap_jacobians();
    step.t = ws_.time;
    const double error = plain_step(h);
    is_whole_ = true;
    swap_jacobians();
    return error;
  }

  /// A step of the derivatives from where they are, at the share `from` of the plain step, which ends at the time
  /// `end`, to `until` or less far; how far it got, -1: its length has become too short.
  double follow(double from, double until, double end) {
    fit(form, step);
    if (step.t + until * step.h <= ws_.moved.begin) return leap(from, until);
    auto as = [&](auto tag) { return follow_as<typename decltype(tag)::type>(from, until, end); };
    return T::over(ws_.moved.directions, as);
  }
  /// The interpolant of the present part.
  void fit_part() {
    if (step_.dense) return;
    T::over(ws_.moved.directions, [&](auto tag) { fit_slopes<typename decltype(tag)::type>(); });
    step_.dense = true;
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
    const StepEnd<double> edge = form.ws.step_start;
    form.ws.step_start = form.ws.step_end, form.ws.step_end = edge;
    form.ws.time = ws_.time;
    if (ws_.options.work) take_values(ws_.work, ws_.n_directions, form.ws.work);
    at_ = 0, other_at_ = -1;
  }

 private:
  /// As Rodas5P::advance, to the same bits, with sums of stages of which each has its own length.
  double plain_step(double h) {
    if (!Rodas5P::factor(form, 1 / (Rodas5P::gamma * h))) return infinity;
    const int n = form.n();
    double *u = step.u(), *mix = step.slope();
    step.h = h, step.dense = false;
    for (int i = 0; i < n; ++i) u[i] = step.y0()[i], step.k(0)[i] = step.f0()[i];
    each_stage([&](auto stage) {
      constexpr int s = stage.value;
      double* k = step.k(s);
      if (s > 0) {
        stage_from<s>(step.k(0), step.y0(), u);
        evaluate(form, step.t + Rodas5P::node[s] * h, u, k);
        add_stages<s>(step.k(0), mix, h, k);
      }
      for (int i = 0; i < n && s < 5; ++i) k[i] += h * Rodas5P::d[s] * step.dt0()[i];
      Rodas5P::solve(form, k);
    });
    form.ws.statistics.evaluations += 7;
    for (int i = 0; i < n; ++i) step.y1()[i] = u[i] + step.k(7)[i];
    return error_norm(form, step.k(7), step.y0(), step.y1());
  }

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

  /// The derivatives stay: it is too short for a step, or none has begun.
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

  /// Parts that are no longer count whatever they miss: a law that bends without an event, as one that is clipped,
  /// bends derivatives within one of them, and moves them by no more than it takes. docs/theory/gradients.md (21)
  double shortest() const {
    // of what time can tell apart, a part that missed too much is at least a tenth as long
    constexpr double share = 1e-3, apart = 4e-13;
    return larger(share * ws_.options.rtol * step.h, apart * larger(1e-2, abs(step.t)));
  }

  /// As follow, with the derivatives as an X.
  template <class X>
  double follow_as(double from, double until, double end) {
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
      const double error = vary<X>(h);
      const bool kink = error > 1 && error < 1e300 && h <= shortest();
      const double growth = kink ? 6 : 0.9 * fifth_root_of_inverse(larger(error, 1e-10));
      if (error <= 1 || kink) {
        // one that was cut says nothing of longer ones
        ws_.moved.pace = last ? larger(pace, h * smaller(6.0, growth)) : h * smaller(6.0, growth);
        // a part that counts for nothing may end anywhere
        for (int j = 0; j < As<X>::count; ++j) ws_.moved.size[j] = reached_[j];
        for (int i = 0; i < form.n(); ++i) row<X>(SlopeRow::first)[i] = row<X>(SlopeRow::last)[i];
        known_ = !has_ties();
        set_values();
        return to;
      }
      ws_.moved.pace = h * (error < 1e300 ? larger(0.2, smaller(0.9, growth)) : 0.1);
    }
  }

  /// A row of derivatives alone.
  template <class X>
  X* row(int i) {
    return reinterpret_cast<X*>(ws_.moved.slopes) + i * form.n();
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
    if (share == 1) return linearize_end(end);
    interpolate(form, step, share, step.point());
    linearize(form, step.t + share * step.h, step.point(), step.u(), step.slope(), form.ws.step_end);
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
  /// The derivatives of its interpolant.
  template <class X>
  void fit_slopes() {
    for (int q = 0; q < 3; ++q) {
      for (int i = 0; i < form.n(); ++i) {
        X x = X(0);
        for (int s = 0; s < 8; ++s) add_times(Rodas5P::dense[q][s], row<X>(s)[i], x);
        step_.p(q)[i] = As<X>::number(0, x);
      }
    }
  }
  /// Its values: the same quartic over the part.
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

  void give_end(const StepEnd<double>& from, StepEnd<T>& to) {
    for (int k = 0; k < ws_.n_rates; ++k) to.rate[k] = T(from.rate[k]), to.slope[k] = T(from.slope[k]);
    for (int a = 0; a < ws_.held.n; ++a) to.multiplier[a] = T(from.multiplier[a]);
  }

  /// Derivatives of the slopes at the share s of the present part of the step, where those of the state are `y`, into
  /// `d`.
  template <class X>
  [[gnu::noinline]] void slopes_at(double s, const X* y, X* d) {
    const double at = from_ + s * share_, t = step.t + at * step.h;
    const bool all = Form::full || rows_move_ || ws_.sys.shared > 0;
    T *whole = step_.point(), *made = step_.p(2);
    interpolate(form, step, at, step.point());
    for (int i = all ? 0 : form.nz(); i < form.n(); ++i) whole[i] = As<X>::number(step.point()[i], y[i]);
    if (all) {
      evaluate(form_, t, whole, made);
      for (int i = 0; i < form.n(); ++i) d[i] = As<X>::of(made[i]), step.slope()[i] = value(made[i]);
    } else {
      evaluate_over_plain_rows(t, whole, y, d);
    }
    if (mass_moves_) take_from_mass(d);
  }
  /// As evaluate, where the rows of the branches have no derivatives. The slopes themselves go to step.slope().
  template <class X>
  void evaluate_over_plain_rows(double t, const T* whole, const X* y, X* d) {
    const int nz = form.nz();
    T* own = step_.p(2);
    double* plain = step.slope();
    inputs_with(ws_, t, whole + nz);
    for (int i = 0; i < form.n(); ++i) d[i] = X(0);
    for (int i = nz; i < form.n(); ++i) own[i] = T(0);
    for (int i = 0; mass_moves_ && i < form.n(); ++i) plain[i] = 0;
    for (int k = 0; k < ws_.n_branches; ++k) {
      T rate = As<X>::number(form.rate(k, step.point()), form.rate(k, y));
      if (ws_.sys.prescribed > 0) rate += offset_rate(ws_, k);
      const T torque = branch_torque(ws_, ws_.branch[k], rate, whole + nz, own + nz);
      form.push(k, As<X>::of(torque), d);
      if (mass_moves_) form.push(k, value(torque), plain);
    }
    for (int i = nz; i < form.n(); ++i) d[i] = As<X>::of(own[i]);
  }
  /// What a mass that changes takes of the slopes.
  template <class X>
  void take_from_mass(X* d) {
    double* velocity = step.slope();
    form.solve_mass(velocity);
    T *moved = step_.slope(), *taken = step_.p(2);
    for (int i = 0; i < form.nz(); ++i) {
      const bool massless = ws_.rows.mass.first[i] == ws_.rows.mass.first[i + 1];
      moved[i] = T(massless ? 0.0 : velocity[i]), taken[i] = T(0);
    }
    form_.add_mass_times(T(-1), moved, taken);
    for (int i = 0; i < form.nz(); ++i) d[i] += As<X>::of(taken[i]);
  }

  /// d := d + J x, with J where the image has been linearized last.
  template <class X>
  [[gnu::noinline]] void add_linear(const X* x, X* d) {
    const Workspace<double>& ws = form.ws;
    const Jacobian<double>& j = ws.jacobian;
    const int n = form.n(), nz = form.nz(), nx = int(ws.sys.shared);
    if constexpr (Form::full) {
      for (int i = 0; i < n; ++i) add_row(n, ws.full.jacobian + i * n, x, d[i]);
      return;
    }
    const X *own = x + nz, *shared = x + n - nx;
    for (int k = 0; k < ws.n_branches; ++k) {
      const Branch<double>& b = ws.branch[k];
      const X rate = form.rate(k, x);
      X torque = rate * j.partial[k].by_rate;
      add_row(b.states, j.f_state + b.state, own + b.state, torque);
      add_row(nx, j.torque_by + k * nx, shared, torque);
      form.push(k, torque, d);
      for (int s = 0; s < b.states; ++s) {
        X& to = d[nz + b.state + s];
        add_times(j.g_rate[b.state + s], rate, to);
        add_row(b.states, j.g_state + j.block[k] + s * b.states, own + b.state, to);
      }
    }
    for (int i = 0; i < nx; ++i) {
      d[n - nx + i] += border_times(form, i, x);
      add_row(nx, j.by_shared + i * nx, shared, d[n - nx + i]);
    }
  }
  template <class X>
  static void add_row(int n, const double* row, const X* x, X& to) {
    for (int i = 0; i < n; ++i) {
      if (row[i] != 0) add_times(row[i], x[i], to);
    }
  }

  /// Change of the slopes with time along the motion at the start of a part of length h: to first order close by where
  /// that is all that the tolerance sees, else to second order. docs/theory/gradients.md (20)
  template <class X>
  void drift_at_start(double h, const X* start, X* drift) {
    const X* first = row<X>(SlopeRow::first);
    X *near = row<X>(1), *far = row<X>(2);
    const bool once = ws_.options.rtol >= loose;
    const double reach = once ? look_once_ : ahead, per = 1 / (reach * h);
    slopes_at(reach, start, near);
    if (!once) slopes_at(2 * reach, start, far);
    for (int i = 0; i < form.n(); ++i) {
      X x = near[i] * (once ? per : 2 * per);
      add_times(once ? -per : -1.5 * per, first[i], x);
      if (!once) add_times(-0.5 * per, far[i], x);
      drift[i] = x;
    }
  }

  /// The derivatives at the end of a part of the step of length h; their error in units of the tolerance.
  /// docs/theory/gradients.md (20)
  template <class X>
  double vary(double h) {
    const int n = form.n();
    step_.t = step.t + from_ * step.h, step_.h = h, step_.dense = false;
    X *start = row<X>(SlopeRow::start), *u = row<X>(SlopeRow::u), *drift = row<X>(SlopeRow::drift);
    X *first = row<X>(SlopeRow::first), *last = row<X>(SlopeRow::last);
    for (int i = 0; i < n; ++i) start[i] = u[i] = As<X>::of(step_.y0()[i]);
    if (!known_) slopes_at(0, start, first);
    known_ = true;
    drift_at_start(h, start, drift);
    // the factor is that of the Jacobian at the start
    swap_jacobians();
    each_stage([&](auto stage) {
      constexpr int s = stage.value;
      X* k = row<X>(s);
      if (s > 0) stage_from<s>(row<X>(0), start, u);
      if (s > 0 && s < 6) slopes_at(Rodas5P::node[s], u, s < 5 ? k : last);
      // the last three stages are at one instant, where the slopes are linear in the derivatives
      if (s > 5) add_linear_at_end(row<X>(s - 1), last);
      for (int i = 0; i < n && (s == 0 || s >= 5); ++i) k[i] = s == 0 ? first[i] : last[i];
      if (s > 0) add_stages<s>(row<X>(0), row<X>(SlopeRow::mix), h, k);
      for (int i = 0; i < n && s < 5; ++i) add_times(h * Rodas5P::d[s], drift[i], k[i]);
      solve(k);
    });
    const X* missed = row<X>(7);
    add_linear_at_end(missed, last);
    swap_jacobians();
    for (int i = 0; i < n; ++i) u[i] += missed[i], step_.y1()[i] = As<X>::number(0, u[i]);
    return error_of(missed, u);
  }
  template <class F, int... s>
  static void each_stage(F&& f, std::integer_sequence<int, s...>) {
    (f(std::integral_constant<int, s>{}), ...);
  }
  template <class F>
  static void each_stage(F&& f) {
    each_stage(f, std::make_integer_sequence<int, 8>{});
  }
  template <class X>
  [[gnu::noinline]] void solve(X* k) {
    Rodas5P::solve(form, k, row<X>(SlopeRow::rhs));
  }
  /// With the other Jacobian, that of the end.
  template <class X>
  void add_linear_at_end(const X* x, X* d) {
    swap_jacobians();
    add_linear(x, d);
    swap_jacobians();
  }
  /// Where stage s begins, from the rows of those before.
  template <int s, class X>
  void stage_from(const X* stages, const X* start, X* u) {
    const int n = form.n();
    for (int i = 0; i < n; ++i) {
      if constexpr (s >= 6) {
        u[i] += stages[(s - 1) * n + i];
      } else {
        X x = start[i];
        for (int j = 0; j < s; ++j) add_times(Rodas5P::a[s][j], stages[j * n + i], x);
        u[i] = x;
      }
    }
  }
  /// k := k + M / h times the stages before.
  template <int s, class X>
  void add_stages(const X* stages, X* mix, double h, X* k) {
    const int n = form.n(), nz = form.nz();
    for (int i = 0; i < n; ++i) {
      X x = X(0);
      for (int j = 0; j < s; ++j) add_times(Rodas5P::c[s][j], stages[j * n + i], x);
      mix[i] = x;
    }
    form.add_mass_times(1 / h, mix, k);
    for (int i = nz; i < n; ++i) add_times(1 / h, mix[i], k[i]);
  }

  /// Sizes of the components of each direction over those of the motion, to f(component, size of the motion).
  template <class X, class F>
  void each_component(const X* x, F&& f) const {
    const Workspace<double>& plain = form.ws;
    const int nv = int(plain.sys.speeds), nz = form.nz();
    const double least = plain.options.atol / plain.options.rtol;
    double fastest = 0;
    for (int i = 0; i < nv; ++i) fastest = larger(fastest, plain.reduced.size[i]);
    for (int i = 0; i < nv; ++i) {
      auto moved = typename As<X>::Seen(0);
      each_share(form, i, [&](double z, int j) { moved += As<X>::seen(x[j]) * z; });
      f(moved, least + larger(plain.reduced.size[i], 1e-3 * fastest));
    }
    for (int i = 0; i < form.ns(); ++i) {
      const double most = larger(abs(step0(nz + i)), abs(step1(nz + i)));
      f(As<X>::seen(x[nz + i]), plain.reduced.floor[i] / plain.options.rtol + most);
    }
  }
  double step0(int i) const { return const_cast<Step<Plain>&>(step).y0()[i]; }
  double step1(int i) const { return const_cast<Step<Plain>&>(step).y1()[i]; }

  /// Error of the derivatives in units of the tolerance, each direction of the largest size that it has had.
  /// docs/theory/gradients.md (21)
  template <class X>
  double error_of(const X* missed, const X* end) {
    constexpr int seen = As<X>::count;
    double sum[seen] = {}, worst = 0;
    double* size = reached_;
    for (int j = 0; j < seen; ++j) size[j] = ws_.moved.size[j];
    each_component(end, [&](const auto& x, double of) {
      for (int j = 0; j < seen; ++j) size[j] = larger(size[j], abs(As<X>::at(x, j)) / of);
    });
    each_component(missed, [&](const auto& x, double of) {
      for (int j = 0; j < seen; ++j) sum[j] += (As<X>::at(x, j) / of) * (As<X>::at(x, j) / of);
    });
    const double count = double(ws_.sys.speeds + form.ns());
    for (int j = 0; j < seen; ++j) {
      if (size[j] > 0) worst = larger(worst, sqrt(sum[j] / count) / (allowed * ws_.options.rtol * size[j]));
    }
    return worst;
  }
};

}  // namespace clutchwork

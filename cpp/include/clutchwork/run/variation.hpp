#pragma once
#include <clutchwork/components/slopes.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/correction.hpp>
#include <clutchwork/run/derivative_error.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/integrator/rodas5p.hpp>
#include <clutchwork/run/linear_step.hpp>
#include <clutchwork/run/linear_terms.hpp>
#include <clutchwork/run/mirror.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/run/slopes_along.hpp>
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
  static constexpr int few = 8, very_few = 4, lanes = T::lanes;
  // of a part: how far ahead the change of the slopes with time is looked at, twice; loose tolerances need one look
  static constexpr double ahead = 1e-3, loose = 1e-8;

  Form& form_;
  Step<Form>& step_;
  Workspace<T>& ws_;
  const StepCalls<Plain> calls_;
  double from_ = 0, to_ = 1, share_ = 1;  ///< present part of the plain step, and its length
  // shares of the step at which the image has been linearized: at its Jacobian, and at the other one; -1: elsewhere
  double at_ = -1, other_at_ = -1;
  bool is_whole_ = false;                 ///< the image has the factor of the whole step
  bool known_ = false;                    ///< the slopes at the start of the next part
  const double look_once_;                ///< of a part, ahead of its start
  LinearStep<very_few, lanes> smallest_;  ///< matrices of a part, of so few numbers
  LinearStep<few, lanes> small_;
  bool mass_known_ = false;  ///< to them, of the present phase
  StepRecord<T> record_;     ///< of the part that is tried, for the tape

 public:
  Plain form;
  Step<Plain> step;

 private:
  SlopesAlong<Form, Plain> slopes_;
  const DerivativeError<T, Plain> errors_;

 public:
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
        step(form),
        slopes_(own, own_step, form, step),
        errors_{own.ws, form, step} {
    step.calls = &calls_;
    step_.image = this;
    step_.settled = [](void* image, double t) { return static_cast<Variation*>(image)->settled_at(t); };
  }

  /// The image is where the run is, and has looked at it.
  void reflect_here() {
    reflect(ws_, *ws_.moved.plain, false);
    form.mass_factored = false;
    slopes_.reflect();
    take_values(step_.y0(), form.n(), step.y0());
    known_ = mass_known_ = false;
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

  /// The factor of the plain step was overwritten.
  void forget_factor() { is_whole_ = false; }

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
    if (step.t + until * step.h <= ws_.moved.begin || slopes_.stay_zero()) return leap(from, until);
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
  /// The values at time t inside the plain step, on the equations of motion; nullptr: as they are.
  const double* settled_at(double t) {
    double *y = step.k(3), *d = step.k(4);
    const double share = (t - step.t) / step.h;
    interpolate(form, step, share, y);
    inputs_at(form.ws, t);
    observe(form, t, y, d);
    forget_factor();
    return settle_stiff(form, step, share, y, d) ? y : nullptr;
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
    if constexpr (!Form::full) {
      if (is_few()) return form.n() <= very_few ? plain_step_with(smallest_, h) : plain_step_with(small_, h);
    }
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

  /// The same for few numbers, by the inverse.
  template <int N>
  [[gnu::noinline]] double plain_step_with(LinearStep<N, lanes>& linear, double h) {
    using S = OneDirection<N, lanes>;
    const int n = form.n();
    step.h = h, step.dense = false;
    take_mass(linear), take_inverse(linear);
    S start, drift, slope, k[8], u;
    for (int i = 0; i < n; ++i) start.put(i, step.y0()[i]), drift.put(i, h * step.dt0()[i]);
    for (int i = 0; i < n; ++i) slope.put(i, step.f0()[i]);
    LinearStep<N, lanes>::each_stage([&](auto stage) CLUTCHWORK_HOT_LAMBDA {
      constexpr int s = stage.value;
      if constexpr (s > 0) {
        LinearStep<N, lanes>::template point<s>(start, k, u);
        evaluate(form, step.t + Rodas5P::node[s] * h, u.data(), slope.data());
      } else {
        u = start;
      }
      linear.template solve<s>(h, drift, slope, k);
    });
    form.ws.statistics.evaluations += 7;
    for (int s = 0; s < 8; ++s) {
      for (int i = 0; i < n; ++i) step.k(s)[i] = k[s].get(i);
    }
    for (int i = 0; i < n; ++i) step.y1()[i] = u.get(i) + k[7].get(i);
    return error_norm(form, step.k(7), step.y0(), step.y1());
  }
  template <int N>
  void take_mass(LinearStep<N, lanes>& linear) {
    if (mass_known_) return;
    linear.n = form.n(), mass_known_ = true;
    linear.mass = {};
    const Compressed<double>& mass = form.ws.rows.mass;
    for (int i = 0; i < form.nz(); ++i) {
      for (int e = mass.first[i]; e < mass.first[i + 1]; ++e)
        linear.mass.entry(i, mass.col[e]) = linear.mass.entry(mass.col[e], i) = mass.val[e];
    }
    for (int i = form.nz(); i < form.n(); ++i) linear.mass.entry(i, i) = 1;
  }
  /// Where the image has the factor and the Jacobian of the start.
  template <int N>
  void take_inverse(LinearStep<N, lanes>& linear) {
    Slopes<N, lanes> x[N];
    for (int i = 0; i < linear.n; ++i) reinterpret_cast<double*>(x + i)[i] = 1;
    Rodas5P::solve(form, x, x);
    for (int i = 0; i < linear.n; ++i) {
      for (int j = 0; j < linear.n; ++j) linear.inverse.entry(i, j) = reinterpret_cast<const double*>(x + i)[j];
    }
  }

  static Workspace<double>& prepared(Workspace<T>& ws) {
    reflect(ws, *ws.moved.plain, true);
    return *ws.moved.plain;
  }

  /// Speeds are brought back onto ties after a part.
  bool has_ties() const { return Form::full && ws_.ratios.n > 0; }

  /// The derivatives stay: it is too short for a step, or nothing has begun to move.
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
      from_ = from, to_ = to, share_ = h / step.h;
      const double error = vary_by_size<X>(h, end);
      const bool kink = error > 1 && error < 1e300 && h <= shortest();
      const double growth = kink ? 6 : 0.9 * fifth_root_of_inverse(larger(error, 1e-10));
      if (error <= 1 || kink) {
        // one that was cut says nothing of longer ones
        ws_.moved.pace = last ? larger(pace, h * smaller(6.0, growth)) : h * smaller(6.0, growth);
        // a part that counts for nothing may end anywhere
        std::swap(ws_.moved.largest, ws_.moved.reached);
        keep_few<X>();
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
    if constexpr (!std::is_same_v<X, typename As<X>::Seen>) {
      if (is_few()) return record_.fit(step_);
    }
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

  /// Derivatives of the slopes at the share s of the present part, where those of the state are `y`, into `d`.
  template <class X>
  void slopes_at(double s, const X* y, X* d) {
    slopes_.at(from_ + s * share_, y, d, false);
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
  double vary(double h, double end) {
    const int n = form.n();
    linearize_at(to_, end);
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
    return errors_.template of<X>([&](int i) { return As<X>::seen(missed[i]); },
                                  [&](int i) { return As<X>::seen(u[i]); });
  }

  // -------------------------------------------------------------------------------------------------- of few numbers

  /// Whether a part is taken with matrices of all numbers.
  bool is_few() const {
    if constexpr (Form::full)
      return false;
    else
      return form.n() <= few && ws_.sys.shared == 0;
  }

  /// Where the slopes by the numbers of the model alone are kept, at the instants of a part at which they are known.
  template <class X>
  struct Loads {
    X* at[Lobatto::count];
  };
  template <class X>
  Loads<X> load_rows() {
    return {{row<X>(SlopeRow::first), row<X>(LoadRow::second), row<X>(LoadRow::third), row<X>(LoadRow::fourth),
             row<X>(SlopeRow::last)}};
  }

  template <class X>
  double vary_by_size(double h, double end) {
    if constexpr (!Form::full) {
      if (is_few()) return form.n() <= very_few ? vary_with<X>(smallest_, h, end) : vary_with<X>(small_, h, end);
    }
    return vary<X>(h, end);
  }
  /// As vary, with the equations as a quartic between five instants. docs/theory/gradients.md (23)
  template <class X, int N>
  [[gnu::noinline]] double vary_with(LinearStep<N, lanes>& linear, double h, double end) {
    using Seen = typename As<X>::Seen;
    using S = std::conditional_t<std::is_same_v<Seen, double>, OneDirection<N, lanes>, ManyDirections<N, lanes>>;
    const int n = form.n();
    const Loads<X> loads = load_rows<X>();
    step_.t = step.t + from_ * step.h, step_.h = h, step_.dense = false;
    X* still = row<X>(SlopeRow::start);
    for (int i = 0; i < n; ++i) still[i] = X(0);
    linearize_part(linear, h, end, [&](int m) { slopes_.here(from_ + Lobatto::node[m] * share_, still, loads.at[m]); });
    if (!known_) slopes_.at(from_, still, loads.at[0], true);
    slopes_.at(to_, still, loads.at[Lobatto::count - 1], true);
    known_ = true;
    S start{}, load[Lobatto::count]{}, k[8], last;
    for (int m = 0; m < Lobatto::count; ++m) {
      for (int i = 0; i < n; ++i) load[m].put(i, As<X>::seen(loads.at[m][i]));
    }
    for (int i = 0; i < n; ++i) start.put(i, As<X>::seen_of(step_.y0()[i]));
    linear.take(start, load, k, last);
    if constexpr (std::is_same_v<X, Seen>) {
      for (int s = 0; s < 8; ++s) {
        for (int i = 0; i < n; ++i) row<X>(s)[i] = k[s].get(i);
      }
      for (int i = 0; i < n; ++i) step_.y1()[i] = As<X>::number(0, last.get(i));
    } else {
      record_.take(n, k, last);
    }
    return errors_.template of<X>([&](int i) { return k[7].get(i); }, [&](int i) { return last.get(i); });
  }

  /// The matrices of a part of length h; the image has the factor of its start, and is linearized at its end. f(m) at
  /// the instants inside of it, whose point is there.
  template <int N, class F>
  void linearize_part(LinearStep<N, lanes>& linear, double h, double end, F&& f) {
    linear.h = h;
    swap_jacobians();
    if (!known_) take_jacobian(form, linear.known[0]);
    // that of the whole step is known
    if (!is_whole_) take_inverse(linear);
    for (int m = 1; m < Lobatto::count - 1; ++m) {
      linearize_inside(from_ + Lobatto::node[m] * share_);
      take_jacobian(form, linear.known[m]);
      f(m);
    }
    swap_jacobians();
    linearize_at(to_, end);
    take_jacobian(form, linear.known[Lobatto::count - 1]);
    linear.prepare();
  }
  /// Its derivatives by the state alone, at a share of the step; what the guards know of its end stays.
  void linearize_inside(double share) {
    Workspace<double>& ws = form.ws;
    double *y = step.point(), *state = y + form.nz();
    interpolate(form, step, share, y);
    inputs_with(ws, step.t + share * step.h, state);
    for (int k = 0; k < ws.n_branches; ++k) {
      const double rate = form.rate(k, y) + offset_rate(ws, k);
      ws.jacobian.partial[k] =
          branch_partial(ws, ws.branch[k], rate, 0.0, state, step.slope() + form.nz(), state_partials(ws, k));
    }
    at_ = share;
  }

  /// What is known of the end of a part that counts serves the next one; a tape gets a note of the part.
  template <class X>
  void keep_few() {
    if constexpr (!Form::full) {
      if (is_few()) form.n() <= very_few ? keep_matrices<X>(smallest_) : keep_matrices<X>(small_);
    }
  }
  template <class X, int N>
  void keep_matrices(LinearStep<N, lanes>& linear) {
    if constexpr (!std::is_same_v<X, typename As<X>::Seen>) {
      record_.note(linear, step_.y0(), load_rows<X>().at, step_.y1());
    }
    linear.known[0] = linear.known[Lobatto::count - 1];
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
    add_linear(form, x, d);
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
};

}  // namespace clutchwork

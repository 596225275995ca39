#pragma once
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/integrator/rodas5p.hpp>
#include <clutchwork/run/mirror.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/run/step.hpp>
#include <clutchwork/run/step_calls.hpp>
#include <clutchwork/workspace.hpp>
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

/// Constants in the place of numbers with derivatives.
template <class T>
void take_constants(const double* from, std::int64_t n, T* to) {
  for (std::int64_t i = 0; i < n; ++i) to[i] = T(from[i]);
}

/// The factor of a plain step, for the derivatives: it is the same for all of them.
template <class T>
void share_factor(const Workspace<double>& from, Workspace<T>& to, bool full) {
  const int ns = int(to.sys.states), nz = to.reduced.nz, n = nz + ns;
  if (full) {
    take_constants(from.full.factor, n * n, to.full.factor);
    for (int i = 0; i < n; ++i) to.full.pivot[i] = from.full.pivot[i];
    const int used = from.full.first[2 * n];
    for (int i = 0; i <= 2 * n; ++i) to.full.first[i] = from.full.first[i];
    for (int i = 0; i < used; ++i) to.full.part[i] = T(from.full.part[i]), to.full.column[i] = from.full.column[i];
    return;
  }
  take_constants(from.rows.envelope, nz == 0 ? 0 : from.rows.sky[nz - 1] + nz, to.rows.envelope);
  if (ns == 0) return;
  take_constants(from.jacobian.f_state, ns, to.jacobian.f_state);
  take_constants(from.jacobian.g_rate, ns, to.jacobian.g_rate);
  for (int k = 0; k < to.n_branches; ++k) {
    const int at = to.jacobian.block[k], m = to.branch[k].states;
    take_constants(from.stages.inverse + at, m * m, to.stages.inverse + at);
  }
  const std::int64_t nx = to.sys.shared;
  if (nx == 0) return;
  take_constants(from.shared.by_rate, nx * to.n_directions, to.shared.by_rate);
  take_constants(from.shared.by_state, nx * ns, to.shared.by_state);
  take_constants(from.shared.inverse, nx * nx, to.shared.inverse);
  take_constants(from.shared.reach, nx * (to.sys.speeds + ns), to.shared.reach);
}

/// A phase of a run with derivatives: its plain image, and derivatives along the plain steps.
template <class Form>
class Variation {
  using T = typename Form::Scalar;
  using Plain = typename PlainForm<Form>::type;
  // of a step: how far ahead the change of the slopes with time is looked at
  static constexpr double ahead = 1e-3;

  Form& form_;
  Step<Form>& step_;
  Workspace<T>& ws_;
  const StepCalls<Plain> calls_;
  double from_ = 0, share_ = 1;  ///< present part of the plain step
  bool pristine_ = false;        ///< the image has the factor of its step

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
    take_values(step_.y0(), form.n(), step.y0());
    look_here();
  }
  void look_here() {
    form.ws.in.time = -infinity;
    calls_.look(form, step, ws_.time, step.y0(), step.f0(), step.dt0(), form.ws.here);
    give_edge(form.ws.here, ws_.here);
  }
  void look_at_end(double end) {
    calls_.look(form, step, end, step.y1(), step.f1(), step.dt1(), form.ws.there);
    give_edge(form.ws.there, ws_.there);
  }

  /// The plain step; its error in units of the tolerance.
  double advance(double h) {
    step.t = ws_.time;
    const double error = calls_.advance(form, step, h);
    if (error <= 1) share_factor(form.ws, ws_, Form::full);
    pristine_ = true;
    return error;
  }

  /// A step of the derivatives from where they are, at the share `from` of the plain step, to `until` or less far; how
  /// far it got, -1: its length has become too short.
  double follow(double from, double until) {
    fit(form, step);
    for (;;) {
      const double left = (until - from) * step.h, pace = ws_.moved.pace;
      const bool last = left <= 1.001 * pace;
      // the rest in equal parts
      const double h = last ? left : left / double(std::int64_t(left / pace) + 1);
      const double to = last ? until : from + h / step.h;
      if (!(h > 1e-14 * larger(1e-2, abs(step.t)))) return last ? leap(from, until) : -1;
      if (!ready(from, h)) return -1;
      from_ = from, share_ = h / step.h;
      const double error = vary(from, h);
      const double growth = 0.9 * pow(larger(error, 1e-10), -0.2);
      if (error <= 1) {
        // one that was cut says nothing of longer ones
        ws_.moved.pace = last ? larger(pace, h * smaller(6.0, growth)) : h * smaller(6.0, growth);
        set_values(from, to);
        return to;
      }
      ws_.moved.pace = h * (error < 1e300 ? larger(0.2, smaller(0.9, growth)) : 0.1);
    }
  }
  /// Where no time passes.
  void rest() {
    rest_step(form_, step_);
    step_.dense = true;
  }
  /// Whether the image has been linearized elsewhere since.
  bool was_moved() const { return !pristine_; }

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
  }

 private:
  static Workspace<double>& prepared(Workspace<T>& ws) {
    reflect(ws, *ws.moved.plain, true);
    return *ws.moved.plain;
  }

  /// Too short for a step: the derivatives stay.
  double leap(double from, double until) {
    for (int i = 0; i < form.n(); ++i) step_.y1()[i] = step_.y0()[i];
    for (int q = 0; q < 3; ++q) {
      for (int i = 0; i < form.n(); ++i) step_.p(q)[i] = T(0);
    }
    step_.t = step.t + from * step.h, step_.h = (until - from) * step.h;
    set_values(from, until);
    return until;
  }

  /// The factor for a step of the derivatives: that of the plain step where they go all the way with it.
  bool ready(double from, double h) {
    if (pristine_ && from == 0 && h == step.h) return true;
    pristine_ = false;
    double *y = step.point(), *d = step.u(), *dt = step.slope();
    interpolate(form, step, from, y);
    linearize(form, step.t + from * step.h, y, d, dt, form.ws.there);
    if (!Rodas5P::factor(form, 1 / (Rodas5P::gamma * h))) return false;
    share_factor(form.ws, ws_, Form::full);
    return true;
  }

  /// The values of a part of the plain step, beside the derivatives.
  void set_values(double from, double to) {
    const double d = to - from;
    double* end = step.point();
    if (to < 1) interpolate(form, step, to, end);
    for (int i = 0; i < form.n(); ++i) {
      const double p0 = step.p(0)[i], p1 = step.p(1)[i], p2 = step.p(2)[i], a = step.y0()[i];
      const double c1 = step.y1()[i] - a + p0, c2 = p1 - p0, c3 = p2 - p1, c4 = -p2;
      // the same quartic over the part
      const double m1 = d * (c1 + from * (2 * c2 + from * (3 * c3 + from * 4 * c4)));
      const double m2 = d * d * (c2 + from * (3 * c3 + from * 6 * c4)), m3 = d * d * d * (c3 + from * 4 * c4);
      T *first = step_.y0() + i, *last = step_.y1() + i;
      last->v = to < 1 ? end[i] : step.y1()[i];
      const double q0 = m1 - (last->v - first->v), q1 = m2 + q0;
      step_.p(0)[i].v = q0, step_.p(1)[i].v = q1, step_.p(2)[i].v = m3 + q1;
    }
    step_.dense = true;
  }

  void give_edge(const Edge<double>& from, Edge<T>& to) {
    for (int k = 0; k < ws_.n_rates; ++k) to.rate[k] = T(from.rate[k]), to.slope[k] = T(from.slope[k]);
    for (int a = 0; a < ws_.held.n; ++a) to.multiplier[a] = T(from.multiplier[a]);
  }

  /// Derivatives of the slopes at the share s of the present part of the step, whose state has the derivatives of `y`,
  /// into `d`.
  void slopes_at(double s, const T* y, T* d) {
    double *point = step.point(), *velocity = step.slope();
    T* whole = step_.point();
    const double at = from_ + s * share_;
    interpolate(form, step, at, point);
    for (int i = 0; i < form.n(); ++i) whole[i] = y[i], whole[i].v = point[i];
    evaluate(form_, step.t + at * step.h, whole, d);
    // the mass may have derivatives too
    for (int i = 0; i < form.nz(); ++i) velocity[i] = value(d[i]);
    form.solve_mass(velocity);
    T* moved = step_.slope();
    for (int i = 0; i < form.nz(); ++i) {
      const bool massless = ws_.rows.mass.first[i] == ws_.rows.mass.first[i + 1];
      moved[i] = T(massless ? 0.0 : velocity[i]);
    }
    form_.add_mass_times(T(-1), moved, d);
    for (int i = 0; i < form.n(); ++i) d[i].v = 0;
  }

  /// The derivatives at the end of a part of the step of length h; their error in units of the tolerance.
  double vary(double from, double h) {
    constexpr auto& R = Rodas5P::a;
    const int n = form.n(), nz = form.nz();
    const double ih = 1 / h;
    step_.t = step.t + from * step.h, step_.h = h;
    T *start = step_.y1(), *u = step_.u(), *drift = step_.dt0(), *mix = step_.p(0);
    for (int i = 0; i < n; ++i) start[i] = step_.y0()[i], start[i].v = 0;
    // change of the slopes with time along the motion, to second order
    T *first = step_.k(0), *near = step_.k(1), *far = step_.k(2);
    slopes_at(0, start, first), slopes_at(ahead, start, near), slopes_at(2 * ahead, start, far);
    const double per = 1 / (2 * ahead * h);
    for (int i = 0; i < n; ++i) drift[i] = (near[i] * 4.0 - first[i] * 3.0 - far[i]) * per;
    for (int s = 0; s < 8; ++s) {
      T* k = step_.k(s);
      if (s > 0) {
        for (int i = 0; i < n; ++i) {
          if (s >= 6) {
            u[i] += step_.k(s - 1)[i];
            continue;
          }
          T x = start[i];
          for (int j = 0; j < s; ++j) x += step_.k(j)[i] * R[s][j];
          u[i] = x;
        }
        slopes_at(Rodas5P::node[s], u, k);
        for (int i = 0; i < n; ++i) {
          T x = T(0);
          for (int j = 0; j < s; ++j) x += step_.k(j)[i] * Rodas5P::c[s][j];
          mix[i] = x;
        }
        form_.add_mass_times(T(ih), mix, k);
        for (int i = nz; i < n; ++i) k[i] += mix[i] * ih;
      }
      if (s < 5) {
        for (int i = 0; i < n; ++i) k[i] += drift[i] * (h * Rodas5P::d[s]);
      }
      Rodas5P::solve(form_, k);
      for (int i = 0; i < n; ++i) k[i].v = 0;
    }
    for (int i = 0; i < n; ++i) start[i] = u[i] + step_.k(7)[i];
    const double error = error_of(step_.k(7), start);
    Rodas5P::prepare_dense(form_, step_);
    return error;
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
      if (size[j] > 0) worst = larger(worst, sqrt(sum[j] / count) / (ws_.options.rtol * size[j]));
    }
    return worst;
  }
};

}  // namespace clutchwork

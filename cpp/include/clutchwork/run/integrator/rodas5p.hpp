#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/layout.gen.hpp>
#include <clutchwork/motion/border.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/workspace.hpp>

/// Rodas5P: stiffly accurate Rosenbrock method of order 5(4) with dense output of order 4.
/// G. Steinebach, BIT Numerical Mathematics 63, 27 (2023), doi 10.1007/s10543-023-00967-x.
namespace clutchwork {

struct Rodas5P {
  static constexpr Method method = Method::rodas5p;
  static constexpr bool stiff = true;
  static constexpr double restart = 0.25;
  static constexpr int most_small_states = small_states;
  static constexpr double gamma = 0.21193756319429014;
  static constexpr double a[6][5] = {
      {0},
      {3.0},
      {2.849394379747939, 0.45842242204463923},
      {-6.954028509809101, 2.489845061869568, -10.358996098473584},
      {2.8029986275628964, 0.5072464736228206, -0.3988312541770524, -0.04721187230404641},
      {-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256, 0.030198172008377946}};
  static constexpr double c[8][7] = {
      {0},
      {-14.155112264123755},
      {-17.97296035885952, -2.859693295451294},
      {147.12150275711716, -1.41221402718213, 71.68940251302358},
      {165.43517024871676, -0.4592823456491126, 42.90938336958603, -5.961986721573306},
      {24.854864614690072, -3.0009227002832186, 47.4931110020768, 5.5814197821558125, -0.6610691825249471},
      {30.91273214028599, -3.1208243349937974, 77.79954646070892, 34.28646028294783, -19.097331116725623,
       -28.087943162872662},
      {37.80277123390563, -3.2571969029072276, 112.26918849496327, 66.9347231244047, -40.06618937091002,
       -54.66780262877968, -9.48861652309627}};
  static constexpr double node[8] = {
      0, 0.6358126895828704, 0.4095798393397535, 0.9769306725060716, 0.4288403609558664, 1, 1, 1};
  static constexpr double d[8] = {
      0.21193756319429014, -0.42387512638858027, -0.3384627126235924, 1.8046452872882734, 2.325825639765069, 0, 0, 0};
  static constexpr double dense[3][8] = {
      {25.948786856663858, -2.5579724845846235, 10.433815404888879, -2.3679251022685204, 0.524948541321073,
       1.1241088310450404, 0.4272876194431874, -0.17202221070155493},
      {-9.91568850695171, -0.9689944594115154, 3.0438037242978453, -24.495224566215796, 20.176138334709044,
       15.98066361424651, -6.789040303419874, -6.710236069923372},
      {11.419903575922262, 2.8879645146136994, 72.92137995996029, 80.12511834622643, -52.072871366152654,
       -59.78993625266729, -0.15582684282751913, 4.883087185713722}};

  /// Fold the states of the branches into effective dampings and factor. docs/theory/integrators.md
  template <class Form, class T = typename Form::Scalar>
  static CLUTCHWORK_HOT Truth<T> factor(Form& form, T scale) {
    if constexpr (Form::full) return form.factor_whole(scale);
    const Truth<T> regular = factor_motion(form, scale);
    if constexpr (!Form::small) {
      if (regular && form.ws.sys.shared > 0) return factor_border(form, scale, [&](T* b) { solve_motion(form, b); });
    }
    return regular;
  }

  /// b := (scale M - J)^-1 b. `rhs` is scratch, of the shared states. A plain factor solves for derivatives too.
  template <class Form, class X>
  static CLUTCHWORK_HOT void solve(Form& form, X* b, X* rhs) {
    if constexpr (Form::full) return form.solve_whole(b, form.n());
    solve_motion(form, b);
    if (form.ws.sys.shared > 0) solve_border(form, b, rhs);
  }

  template <class Form, class T = typename Form::Scalar>
  static CLUTCHWORK_HOT void solve(Form& form, T* b) {
    if constexpr (Form::small)
      solve_motion(form, b);
    else
      solve(form, b, form.ws.shared.rhs);
  }

  /// As factor, with the shared states held.
  template <class Form, class T = typename Form::Scalar>
  static CLUTCHWORK_HOT Truth<T> factor_motion(Form& form, T scale) {
    Workspace<T>& ws = form.ws;
    T* stiff = ws.stages.stiff;
    if constexpr (Form::small) form.n_own = 0;
    for (int k = 0; k < ws.n_branches; ++k) {
      const Branch<T>& b = ws.branch[k];
      stiff[k] = ws.jacobian.partial[k].by_rate;
      if (b.states == 0) continue;
      if constexpr (Form::small) form.own[form.n_own++] = k;
      T* inverse = ws.stages.inverse + ws.jacobian.block[k];
      const T* g = ws.jacobian.g_state + ws.jacobian.block[k];
      if (b.states == 1) {
        inverse[0] = T(1) / (scale - g[0]);
        const T push = ws.jacobian.f_state[b.state], rate = ws.jacobian.g_rate[b.state];
        stiff[k] += push * inverse[0] * rate;
        if constexpr (Form::has_one_state)
          form.one = {ws.reduced.row_z + k * form.nz(), inverse[0], push, T(0) + inverse[0] * rate};
        continue;
      }
      // no component with more states computes with lanes
      if constexpr (!has_lanes<T>) {
        const int m = b.states;
        for (int i = 0; i < m * m; ++i) inverse[i] = -g[i];
        for (int i = 0; i < m; ++i) inverse[i * m + i] += scale;
        if (!invert(m, inverse, ws.stages.pivot)) return false;
        for (int i = 0; i < m; ++i)
          stiff[k] += ws.jacobian.f_state[b.state + i] * dot(m, inverse + i * m, ws.jacobian.g_rate + b.state);
      }
    }
    return form.factor(scale, stiff);
  }

  /// Call f for each branch with states.
  template <class Form, class F>
  static CLUTCHWORK_HOT void each_own(const Form& form, F&& f) {
    if constexpr (Form::small) {
      for (int i = 0; i < form.n_own; ++i) f(form.own[i]);
    } else {
      for (int k = 0; k < form.ws.n_branches; ++k) {
        if (form.ws.branch[k].states > 0) f(k);
      }
    }
  }

  /// As solve, with the shared states held: own states condensed out and put back.
  template <class Form, class X, class T = typename Form::Scalar>
  static CLUTCHWORK_HOT void solve_motion(Form& form, X* b) {
    Workspace<T>& ws = form.ws;
    const int nz = form.nz();
    if (form.ns() == 0) {
      form.solve(b);
      return;
    }
    X* own = b + nz;
    if constexpr (Form::has_one_state) {
      // the same operations, without the way to its numbers
      if (form.n_own == 0) return form.solve(b);
      const auto& one = form.one;
      const T found = own[0] * one.inverse, push = found * one.push;
      for (int i = 0; i < nz; ++i) b[i] += one.row[i] * push;
      form.solve(b);
      own[0] = found + one.gain * few_products(nz, one.row, b);
      return;
    }
    each_own(form, [&](int k) CLUTCHWORK_HOT_LAMBDA {
      const Branch<T>& br = ws.branch[k];
      const T* inverse = ws.stages.inverse + ws.jacobian.block[k];
      X push = X(0);
      if (br.states == 1) {
        own[br.state] = own[br.state] * inverse[0];
        push = own[br.state] * ws.jacobian.f_state[br.state];
      } else {
        X found[most_own_states > 0 ? most_own_states : 1];
        for (int i = 0; i < br.states; ++i) found[i] = dot(br.states, inverse + i * br.states, own + br.state);
        for (int i = 0; i < br.states; ++i) own[br.state + i] = found[i];
        push = dot(br.states, ws.jacobian.f_state + br.state, found);
      }
      form.push(k, push, b);
    });
    form.solve(b);
    each_own(form, [&](int k) CLUTCHWORK_HOT_LAMBDA {
      const Branch<T>& br = ws.branch[k];
      const T* inverse = ws.stages.inverse + ws.jacobian.block[k];
      const X rate = form.rate(k, b);
      for (int i = 0; i < br.states; ++i)
        add_times(dot(br.states, inverse + i * br.states, ws.jacobian.g_rate + br.state), rate, own[br.state + i]);
    });
  }

  /// The point of stage s from those before, in u.
  template <class Form, class T = typename Form::Scalar>
  static CLUTCHWORK_HOT void stage_point(Form& form, Step<Form>& step, int s, T* u) {
    const int n = form.n();
    if (s >= 6) {
      for (int i = 0; i < n; ++i) u[i] += step.k(s - 1)[i];
      return;
    }
    for (int i = 0; i < n; ++i) {
      T x = step.y0()[i];
      for (int j = 0; j < s; ++j) x += Real<T>(a[s][j]) * step.k(j)[i];
      u[i] = x;
    }
  }

  /// Right-hand side of stage s: slopes there, and the stages before.
  template <class Form, class T = typename Form::Scalar>
  static CLUTCHWORK_HOT void stage_slope(Form& form, Step<Form>& step, int s, const T* u, T* mix, T* k) {
    const int n = form.n(), nz = form.nz(), ns = form.ns();
    const Real<T> ih = Real<T>(1) / step.h;
    evaluate(form, step.t + Real<T>(node[s]) * step.h, u, k);
    for (int i = 0; i < n; ++i) {
      T x = T(0);
      for (int j = 0; j < s; ++j) x += Real<T>(c[s][j]) * step.k(j)[i];
      mix[i] = x;
    }
    form.add_mass_times(T(ih), mix, k);
    for (int i = nz; i < nz + ns; ++i) k[i] += ih * mix[i];
  }

  /// One step of length h from step.y0 with f0 and dt0 known; returns the error in units of the tolerance.
  template <class Form, class T = typename Form::Scalar>
  static CLUTCHWORK_HOT Real<T> advance(Form& form, Step<Form>& step, Real<T> h) {
    const int n = form.n();
    const Truth<T> regular = factor(form, T(Real<T>(1) / (Real<T>(gamma) * h)));
    if (none(regular)) return infinity;
    step.h = h;
    step.dense = false;
    T *u = step.u(), *y0 = step.y0();
    T sum[Form::fixed_size > 0 ? Form::fixed_size : 1];
    T* mix = Form::fixed_size > 0 ? sum : step.slope();
    for (int s = 0; s < 8; ++s) {
      T* k = step.k(s);
      if (s == 0) {
        for (int i = 0; i < n; ++i) u[i] = y0[i];
        for (int i = 0; i < n; ++i) k[i] = step.f0()[i];
      } else {
        stage_point(form, step, s, u);
        stage_slope(form, step, s, u, mix, k);
      }
      if (s < 5) {
        const Real<T> hd = h * Real<T>(d[s]);
        for (int i = 0; i < n; ++i) k[i] += hd * step.dt0()[i];
      }
      solve(form, k);
    }
    form.ws.statistics.evaluations += count_where(regular, 7);
    for (int i = 0; i < n; ++i) step.y1()[i] = u[i] + step.k(7)[i];
    return select(regular, error_norm(form, step.k(7), y0, step.y1()), Real<T>(infinity));
  }

  /// Coefficients of the quartic.
  template <class Form, class T = typename Form::Scalar>
  static CLUTCHWORK_HOT void prepare_dense(Form& form, Step<Form>& step) {
    const int n = form.n();
    for (int q = 0; q < 3; ++q) {
      for (int i = 0; i < n; ++i) {
        T x = T(0);
        for (int s = 0; s < 8; ++s) x += Real<T>(dense[q][s]) * step.k(s)[i];
        step.p(q)[i] = x;
      }
    }
    step.dense = true;
  }
};

}  // namespace clutchwork

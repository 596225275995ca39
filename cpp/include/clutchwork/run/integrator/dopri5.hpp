#pragma once
#include <clutchwork/components/scalar.hpp>
#include <clutchwork/layout.gen.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/integrator/memory.hpp>

/// DOPRI5: explicit Runge-Kutta pair of order 5(4) with dense output of order 4.
/// J. R. Dormand, P. J. Prince, J. Comput. Appl. Math. 6 (1980), doi 10.1016/0771-050X(80)90013-3;
/// dense output after E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, section II.6.
namespace clutchwork {

struct Dopri5 {
  static constexpr Method method = Method::dopri5;
  static constexpr bool stiff = false;
  static constexpr double restart = 0.5;
  static constexpr int most_small_states = 0;
  static constexpr double dense_share = 20;  ///< error inside a step over its estimate, and room
  static constexpr double a[7][6] = {{0},
                                     {1. / 5},
                                     {3. / 40, 9. / 40},
                                     {44. / 45, -56. / 15, 32. / 9},
                                     {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
                                     {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656},
                                     {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84}};
  static constexpr double node[7] = {0, .2, .3, .8, 8. / 9, 1, 1};
  static constexpr double error[7] = {71. / 57600, 0, -71. / 16695, 71. / 1920, -17253. / 339200, 22. / 525, -1. / 40};
  static constexpr double dense[7] = {-12715105075. / 11282082432.,  0,
                                      87487479700. / 32700410799.,   -10690763975. / 1880347072.,
                                      701980252875. / 199316789632., -1453857185. / 822651844.,
                                      69997945. / 29380423.};

  /// dy/dt from d = (M dz/dt, states).
  template <class Form, class T = typename Form::Scalar>
  static CLUTCHWORK_INLINE void slope(Form& form, double t, const T* y, T* k) {
    evaluate(form, t, y, k);
    form.solve_mass(k);
  }

  /// One step of length h from step.y0 with f0 known; returns the error in units of the tolerance.
  template <class Form, class T = typename Form::Scalar>
  static CLUTCHWORK_INLINE double advance(Form& form, Step<Form>& step, double h) {
    const int n = form.n();
    step.h = h;
    step.dense = false;
    for (int i = 0; i < n; ++i) step.k(0)[i] = step.f0()[i];
    form.solve_mass(step.k(0));
    T* u = step.u();
    for (int s = 1; s < 7; ++s) {
      for (int i = 0; i < n; ++i) {
        T x = T(0);
        for (int j = 0; j < s; ++j) x += T(a[s][j]) * step.k(j)[i];
        u[i] = step.y0()[i] + T(h) * x;
      }
      slope(form, step.t + node[s] * h, u, step.k(s));
    }
    form.ws.statistics.evaluations += 6;
    T* e = step.point();
    for (int i = 0; i < n; ++i) {
      T x = T(0);
      for (int s = 0; s < 7; ++s) x += T(error[s]) * step.k(s)[i];
      e[i] = T(h) * x;
      step.y1()[i] = u[i];
    }
    // rows come from the dense output, of order 4, whose error is many times that of the step
    return dense_share * error_norm(form, e, step.y0(), step.y1());
  }

  /// Coefficients of the quartic.
  template <class Form, class T = typename Form::Scalar>
  static CLUTCHWORK_INLINE void prepare_dense(Form& form, Step<Form>& step) {
    const int n = form.n();
    const T h = T(step.h);
    for (int i = 0; i < n; ++i) {
      const T change = step.y1()[i] - step.y0()[i], r2 = h * step.k(0)[i] - change;
      T r4 = T(0);
      for (int s = 0; s < 7; ++s) r4 += T(dense[s]) * step.k(s)[i];
      r4 = h * r4;
      const T r3 = change - h * step.k(6)[i] - r2;
      step.p(0)[i] = r2;
      step.p(1)[i] = r3 + r4;
      step.p(2)[i] = -r4;
    }
    step.dense = true;
  }
};

}  // namespace clutchwork

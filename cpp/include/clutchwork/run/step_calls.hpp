#pragma once
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/step.hpp>

#include <type_traits>

/// What a phase calls in every step. For few speeds that is compiled for each size, all else once for all sizes.
/// decisions/0041-light.md
namespace clutchwork {

/// The calls of any form.
template <class Form, class Integrator>
struct PlainCalls {
  using T = typename Form::Scalar;
  [[gnu::noinline]] static Real<T> advance(Form& form, Step<Form>& step, Real<T> h) {
    return Integrator::advance(form, step, h);
  }
  [[gnu::noinline]] static void fit(Form& form, Step<Form>& step) { Integrator::prepare_dense(form, step); }
  static constexpr StepCalls<Form> all() {
    return {advance, fit, linearize_at<Form>, observe_inside<Form>, Integrator::stiff, Integrator::restart};
  }
};

/// Those of few speeds for one size, over the rows that any size has.
template <class T, int NZ, int NS>
struct SizedLook {
  using Any = SmallForm<T>;
  using Form = SmallForm<T, NZ, NS>;
  [[gnu::noinline]] static void linearize_at(Any& any, Step<Any>&, Real<T> t, const T* y, T* d, T* dt,
                                             StepEnd<T>& edge) {
    Form form(any.ws);
    Step<Form> step(form);
    linearize_end_inline(form, step, t, y, d, dt, edge);
  }
  [[gnu::noinline]] static void observe(Any& any, Step<Any>& step, double s) {
    Form form(any.ws);
    Step<Form> sized(form);
    sized.t = step.t, sized.h = step.h;
    observe_inside(form, sized, s);
  }
};
template <class T, class Integrator, int NZ, int NS>
struct SizedCalls {
  using Any = SmallForm<T>;
  using Form = SmallForm<T, NZ, NS>;
  [[gnu::noinline]] static Real<T> advance(Any& any, Step<Any>& step, Real<T> h) {
    Form form(any.ws);
    Step<Form> sized(form);
    sized.t = step.t;
    const Real<T> error = Integrator::advance(form, sized, h);
    step.h = sized.h, step.dense = sized.dense;
    return error;
  }
  [[gnu::noinline]] static void fit(Any& any, Step<Any>& step) {
    Form form(any.ws);
    Step<Form> sized(form);
    sized.h = step.h;
    Integrator::prepare_dense(form, sized);
    step.dense = true;
  }
  static constexpr StepCalls<Any> all() {
    using Sized = SizedLook<T, NZ, NS>;
    return {advance, fit, Sized::linearize_at, Sized::observe, Integrator::stiff, Integrator::restart};
  }
};

/// Whether the steps of few speeds are compiled for each size; a build that must be small has one for all, to the same
/// bits. docs/guide/wasm.md
template <class Form>
inline constexpr bool has_sizes = false;
#ifndef CLUTCHWORK_ONE_SIZE
template <>
inline constexpr bool has_sizes<SmallForm<double>> = true;
#endif

/// The calls of an integrator for a motion in a form.
template <class Integrator, class Form, int NZ = 1, int NS = 0>
StepCalls<Form> step_calls(const Form& form) {
  if constexpr (!has_sizes<Form> || NZ > small_speeds) {
    return PlainCalls<Form, Integrator>::all();
  } else if constexpr (NS > small_states || NS > Integrator::most_small_states) {
    return step_calls<Integrator, Form, NZ + 1, 0>(form);
  } else {
    if (form.nz() == NZ && form.ns() == NS) return SizedCalls<typename Form::Scalar, Integrator, NZ, NS>::all();
    return step_calls<Integrator, Form, NZ, NS + 1>(form);
  }
}

/// Those of a phase; one with derivatives takes plain steps: run/variation.hpp.
template <class Integrator, class Form>
StepCalls<Form> phase_calls(const Form& form) {
  using Calls = PlainCalls<Form, Integrator>;
  if constexpr (has_tangents<typename Form::Scalar>)
    return {nullptr, Calls::fit, nullptr, observe_inside<Form>, Integrator::stiff, Integrator::restart};
  else
    return step_calls<Integrator>(form);
}

}  // namespace clutchwork

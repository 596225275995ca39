#pragma once
#include <clutchwork/components/program.hpp>

namespace clutchwork::laws {

/// Coefficient over signed slip and states, whose rates are expressions. docs/theory/friction-laws.md
struct DynamicFormula : declared::DynamicFormula {
  template <class T>
  struct Params {
    Curve<T> expression;  ///< 1
    Curve<T> at_rest;     ///< 1
    Curve<T> rates;       ///< 1
  };

  template <class T>
  static int count(const Params<T>& p) {
    return int(common(p.rates.count)) - 1;
  }
  /// Coefficient and rates together, which share most of what they compute.
  template <class T, class S>
  static S coefficient_and_rates(const Params<T>& p, const At<S>& at, S* out) {
    const Program<T, Point<S>> program(p, at.points);
    Registers<S> r;
    program.run(at, around(at), count(p), program.for_rates(), r.at);
    const Point<S>* word = at.points + 3 * int(common(p.rates.first));
    for (int i = 0, n = count(p); i < n; ++i) out[i] = r.at[int(common(word[3 * (i + 1)]))];
    return r.at[program.coefficient()];
  }
  template <class T, class S>
  static S coefficient(const Params<T>& p, const At<S>& at) {
    const Program<T, Point<S>> program(p, at.points);
    Registers<S> r;
    program.run(at, around(at), count(p), program.for_coefficient(), r.at);
    return r.at[program.coefficient()];
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    coefficient_and_rates(p, at, rates);
  }
  template <class T, class S>
  static S hold(const Params<T>& p, const At<S>& at) {
    const Program<T, Point<S>> program(p, at.points);
    Registers<S> r;
    program.run(at, around(at), count(p), program.for_all(), r.at);
    return r.at[program.at_rest()];
  }
  static bool is_sound(const Params<double>& p, const double* points, std::int64_t room) {
    const int n = count(p);
    if (n < 0 || n > states || !is_program(p, points, room, n)) return false;
    const double *head = points + 3 * int(p.at_rest.first), *word = points + 3 * int(p.rates.first);
    for (int i = 0; i < n; ++i) {
      if (!is_whole_below(word[3 * (i + 1)], 3 + n + head[3] + head[4] + head[5])) return false;
    }
    return true;
  }

 private:
  template <class S>
  static Surroundings<S> around(const At<S>& at) {
    return {at.input[Input::temperature], at.input[Input::pressure]};
  }
};

}  // namespace clutchwork::laws

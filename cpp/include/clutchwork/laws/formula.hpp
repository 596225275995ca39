#pragma once
#include <clutchwork/components/program.hpp>

namespace clutchwork::laws {

/// Kinetic and static coefficient as expressions. docs/theory/friction-laws.md
struct Formula : declared::Formula {
  template <class T>
  struct Params {
    Curve<T> expression;  ///< 1
    Curve<T> at_rest;     ///< 1
  };
  static constexpr bool lanes = true;

  template <class T, class S>
  static S slide(const Params<T>& p, const At<S>& at) {
    const Program<T, Point<S>> program(p, at.points);
    Registers<S> r;
    program.run(at, around(at), 0, program.for_coefficient(), r.at);
    // beyond the slips at which it was looked at
    return larger(r.at[program.coefficient()], S(0));
  }
  /// The kinetic coefficient is a floor, at whatever temperature and pressure; where one has no value, nothing holds.
  template <class T, class S>
  static S hold(const Params<T>& p, const At<S>& at) {
    const Program<T, Point<S>> program(p, at.points);
    Registers<S> r;
    program.run(at, around(at), 0, program.for_all(), r.at);
    const S rest = r.at[program.at_rest()], kinetic = larger(r.at[program.coefficient()], S(0));
    return select(kinetic > rest, kinetic, select(kinetic <= rest, rest, kinetic + rest));
  }
  static bool is_sound(const Params<double>& p, const double* points, std::int64_t room) {
    return is_program(p, points, room, 0);
  }

 private:
  template <class S>
  static Surroundings<S> around(const At<S>& at) {
    return {at.input[Input::temperature], at.input[Input::pressure]};
  }
};

}  // namespace clutchwork::laws

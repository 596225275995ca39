#pragma once
#include <clutchwork/run/advance.hpp>

/// What is compiled apart, to build on several cores. Scalar: double.
#define CLUTCHWORK_SIZED(KEYWORD, NZ)                         \
  KEYWORD template struct SizedLook<double, NZ, 0>;           \
  KEYWORD template struct SizedLook<double, NZ, 1>;           \
  KEYWORD template struct SizedLook<double, NZ, 2>;           \
  KEYWORD template struct SizedCalls<double, Rodas5P, NZ, 0>; \
  KEYWORD template struct SizedCalls<double, Rodas5P, NZ, 1>; \
  KEYWORD template struct SizedCalls<double, Rodas5P, NZ, 2>; \
  KEYWORD template struct SizedCalls<double, Dopri5, NZ, 0>;
#define CLUTCHWORK_PHASES(KEYWORD, FORM) \
  KEYWORD template Status run_phase<FORM<double>>(Workspace<double>&, double, Sink&);
/// Groups of runs take the steps of these phases themselves.
#define CLUTCHWORK_SMALL_PHASES(KEYWORD)           \
  KEYWORD template class Phase<SmallForm<double>>; \
  CLUTCHWORK_PHASES(KEYWORD, SmallForm)

/// What is the same in all forms.
#define CLUTCHWORK_SHARED(KEYWORD)                                                                                     \
  KEYWORD template double branch_torque_once(const Workspace<double>&, const Branch<double>&, double, const double*,   \
                                             double*);                                                                 \
  KEYWORD template double compliant_torque(const Workspace<double>&, const Branch<double>&, double, const double*,     \
                                           double*);                                                                   \
  KEYWORD template Partial<double> branch_partial(const Workspace<double>&, const Branch<double>&, double, double,     \
                                                  const double*, double*, const StatePartials<double>&);               \
  KEYWORD template void branch_by_input(const Workspace<double>&, const Branch<double>&, double, const double*,        \
                                        double*);                                                                      \
  KEYWORD template Dual<double, 1> branch_heat(const Workspace<double>&, const Branch<double>&, double, const double*, \
                                               const Dual<double, 1>&);                                                \
  KEYWORD template Dual<double, 1> law_margin(const Workspace<double>&, const Branch<double>&, const double*,          \
                                              const double*, const double*, const double*, int&);                      \
  KEYWORD template int law_cross(const Workspace<double>&, const Branch<double>&, const double*, int, double*);        \
  KEYWORD template double contact_limit(const System&, const double*, int, const double*, const double*,               \
                                        const double*, int);                                                           \
  KEYWORD template double table_room(const Workspace<double>&, int, double, double&);                                  \
  KEYWORD template double edge_at(const Workspace<double>&, int, int);                                                 \
  KEYWORD template int edge_count(const Workspace<double>&, int);                                                      \
  KEYWORD template bool refresh_loads(Workspace<double>&);                                                             \
  KEYWORD template bool load_may_turn(Workspace<double>&, int);                                                        \
  KEYWORD template void load_inputs(Workspace<double>&, double);                                                       \
  KEYWORD template void list_lines(Workspace<double>&);                                                                \
  KEYWORD template DependentSet<double> dependent_set(Workspace<double>&, int, const double*, double);

namespace clutchwork {
static_assert(small_speeds == 4 && small_states == 2 && Dopri5::most_small_states == 0, "name all sizes in this file");

#ifndef CLUTCHWORK_COMPONENTS
CLUTCHWORK_SHARED(extern)
#endif
#ifndef CLUTCHWORK_STEPS
CLUTCHWORK_SIZED(extern, 1)
CLUTCHWORK_SIZED(extern, 2)
CLUTCHWORK_SIZED(extern, 3)
CLUTCHWORK_SIZED(extern, 4)
#endif
#ifndef CLUTCHWORK_FIXED
extern template Status advance_fixed(Workspace<double>&, double, Sink&, bool);
#endif
#ifndef CLUTCHWORK_INSTANCES
CLUTCHWORK_SMALL_PHASES(extern)
CLUTCHWORK_PHASES(extern, SparseForm)
CLUTCHWORK_PHASES(extern, FullForm)
#endif
}  // namespace clutchwork

#include <clutchwork/run/linear_step.hpp>

/// Steps of few derivatives for registers of two numbers, made fast: what else takes them is compiled to be small, and
/// the linker keeps the first copy of a function.
namespace clutchwork {

template struct LinearStep<4, 2>;
template struct LinearStep<8, 2>;
#define CLUTCHWORK_STEPS(STATE, N) \
  template void LinearStep<N, 2>::take(const STATE<N, 2>&, const STATE<N, 2>*, STATE<N, 2>*, STATE<N, 2>&) const;
CLUTCHWORK_STEPS(OneDirection, 4)
CLUTCHWORK_STEPS(OneDirection, 8)
CLUTCHWORK_STEPS(ManyDirections, 4)
CLUTCHWORK_STEPS(ManyDirections, 8)
#undef CLUTCHWORK_STEPS
template void LinearStep<4, 2>::give_back(const OneDirection<4, 2>&, const OneDirection<4, 2>*, OneDirection<4, 2>&,
                                          OneDirection<4, 2>*) const;
template void LinearStep<8, 2>::give_back(const OneDirection<8, 2>&, const OneDirection<8, 2>*, OneDirection<8, 2>&,
                                          OneDirection<8, 2>*) const;

}  // namespace clutchwork

#include "lanes_wide.hpp"

#ifdef CLUTCHWORK_WIDE
// what all share stays as it is
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

// compiled for AVX2, so everything of the core has names of its own: a processor without it must not meet a copy
#define clutchwork clutchwork_wide
#include <clutchwork/lanes/step.hpp>

using Wide = clutchwork::LaneStep<4>;

void clutchwork_wide_advance(void* form, void* step, void* error, void* finite) {
  Wide::advance(form, step, error, finite);
}
void clutchwork_wide_look(void* form, void* step, const void* times) { Wide::linearize_at(form, step, times); }
void clutchwork_wide_doubt(void* form, void* step, void* doubtful) { Wide::doubt(form, step, doubtful); }
void clutchwork_wide_observe(void* form, void* step, const void* share, void* sound) {
  Wide::observe(form, step, share, sound);
}
void clutchwork_wide_fit(void* form, void* step, void* sound) { Wide::fit(form, step, sound); }
#endif

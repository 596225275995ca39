#include "tangents.hpp"

#ifdef CLUTCHWORK_WIDE
// what all share stays as it is
#include <clutchwork/derivatives.h>

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <type_traits>

// compiled for AVX2, so everything of the core has names of its own: a processor without it must not meet a copy
#define clutchwork clutchwork_wide
#include "tangent_run.hpp"

const cw_tangent_calls clutchwork_tangents_wide = clutchwork::TangentCalls<CW_DIRECTIONS, 4>::table();
#endif

#include "lanes_wide.hpp"

#ifdef CLUTCHWORK_WIDE
// what all share stays as it is
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

// compiled for AVX2, so everything of the core has names of its own: a processor without it must not meet a copy
#define clutchwork clutchwork_wide
#include <clutchwork/lanes/step.hpp>

using Wide = clutchwork::LaneStep<4>;
CLUTCHWORK_DEFINE_LANES(clutchwork_wide, Wide)
#endif

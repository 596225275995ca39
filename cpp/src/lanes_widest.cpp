#include "lanes_wide.hpp"

#ifdef CLUTCHWORK_WIDEST
// what all share stays as it is
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

// the same for AVX-512: one register holds all lanes
#define clutchwork clutchwork_widest
#include <clutchwork/lanes/step.hpp>

using Widest = clutchwork::LaneStep<8>;
CLUTCHWORK_DEFINE_LANES(clutchwork_widest, Widest)
#endif

#include <clutchwork/derivatives.h>

#ifndef CLUTCHWORK_WIDE_ALONE
#include "tangent_run.hpp"

const cw_tangent_calls clutchwork_tangents_plain = clutchwork::TangentCalls<CW_DIRECTIONS, 2>::table();
#endif

#pragma once
#include <clutchwork/elements/bearing_friction.hpp>

namespace clutchwork::elements {

/// Clutch of constant load.
struct TorqueLimiter : BearingFriction {};

}  // namespace clutchwork::elements

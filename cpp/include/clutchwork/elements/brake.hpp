#pragma once
#include <clutchwork/elements/clutch.hpp>

namespace clutchwork::elements {

/// Friction brake: a clutch whose base is the housing.
struct Brake : Clutch {};

}  // namespace clutchwork::elements

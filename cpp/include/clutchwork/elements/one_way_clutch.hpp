#pragma once
#include <clutchwork/elements/clutch.hpp>

namespace clutchwork::elements {

/// Freewheel that blocks negative slip, with a friction clutch in parallel.
struct OneWayClutch : Clutch {
  static constexpr bool one_way = true;
};

}  // namespace clutchwork::elements

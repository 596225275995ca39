#pragma once
#include <clutchwork/components/scalar.hpp>
#include <clutchwork/layout.gen.hpp>

/// Where a run failed, and whether it is to stop.
namespace clutchwork {

inline constexpr double infinity = __builtin_huge_val();

/// Where a failure happened.
struct Detail {
  int component = -1;  ///< elements, then contacts; -1: none
  double value = 0;
  int row = -1;  ///< number in a row that is not finite
};

/// Asked once per step and row, of the caller; other than zero: stop.
struct Poll {
  int (*ask)(void*) = nullptr;
  void* context = nullptr;

  CLUTCHWORK_HOT bool stops() const { return ask != nullptr && ask(context) != 0; }
};

}  // namespace clutchwork

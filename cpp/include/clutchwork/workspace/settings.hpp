#pragma once
#include <clutchwork/components/scalar.hpp>

#include <cstdint>

/// What a run is asked for, and what it counts.
namespace clutchwork {

inline constexpr double infinity = __builtin_huge_val();

enum Mode : int { backward = -1, locked = 0, forward = 1, open = 2 };
enum class Cause : int { initial, slip_zero, torque_limit, input, consequence, impulse, restart, passing, fault };
enum class Method : int { automatic, rodas5p, dopri5 };
inline constexpr int last_method = 2;  ///< without `automatic`

/// Counters of a run.
struct Statistics {
  std::int64_t steps = 0, rejected = 0, evaluations = 0, jacobians = 0, events = 0, phases = 0, locations = 0;
};

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

  CLUTCHWORK_INLINE bool stops() const { return ask != nullptr && ask(context) != 0; }
};

}  // namespace clutchwork

#pragma once
#include <clutchwork/run/advance.hpp>

/// Groups of runs in lanes: docs/theory/lanes.md.
namespace clutchwork {

/// Most runs that advance together.
inline constexpr int most_together = 8;

/// Bytes of memory that a group with this model needs.
std::int64_t group_size(const System& sys);

/// Advance runs, at most most_together, each with the result that it has alone; runs of models with another structure
/// than the first one are advanced one by one.
void advance_group(Workspace<double>* const* runs, Sink* sinks, Status* statuses, int n, double t_end, void* memory);

}  // namespace clutchwork

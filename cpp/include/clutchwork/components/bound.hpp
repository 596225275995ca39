#pragma once
#include <clutchwork/components/scalar.hpp>

/// What a contact can hold that follows a load.
namespace clutchwork {

/// Most torque against slip in one direction: the larger of two lines over the load. docs/theory/load-dependent.md (1)
template <class S>
struct Bound {
  S slope[2], offset[2];

  CLUTCHWORK_HOT S on(int line, const S& load) const { return slope[line] * load + offset[line]; }
  CLUTCHWORK_HOT int line_at(const S& load) const { return value(on(1, load)) > value(on(0, load)) ? 1 : 0; }
  CLUTCHWORK_HOT S at(const S& load) const { return on(line_at(load), load); }
};

}  // namespace clutchwork

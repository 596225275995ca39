#pragma once
#include <clutchwork/components/scalar.hpp>

/// What is found first inside a step.
namespace clutchwork {

/// The first thing that happens inside a step.
struct Hit {
  enum What : int {
    nothing,
    line,
    multiplier,
    set,
    parting,
    load,
    law,
    bend,
    fault,
    exit,
    process,
    flip,
    gap
  } what = nothing;
  int index = -1;  ///< guard, locked contact, dependent set, spare, contact, branch, or process
  double s = 1;    ///< where in the step, 0 to 1
  int who = -1;    ///< what of a law leaves its piece; the end that a stop meets
};

/// What the caller of a run with derivatives knows a kind by; null behind the last one.
constexpr const char* name_of(Hit::What what) {
  switch (what) {
    case Hit::nothing:
      return "nothing";
    case Hit::line:
      return "line";
    case Hit::multiplier:
      return "multiplier";
    case Hit::set:
      return "set";
    case Hit::parting:
      return "parting";
    case Hit::load:
      return "load";
    case Hit::law:
      return "law";
    case Hit::bend:
      return "bend";
    case Hit::fault:
      return "fault";
    case Hit::exit:
      return "exit";
    case Hit::process:
      return "process";
    case Hit::flip:
      return "flip";
    case Hit::gap:
      return "gap";
  }
  return nullptr;
}

/// Round-off of a load over its largest size: a load that has passed zero passes it again only from farther away.
/// docs/theory/events.md, rule 10
inline constexpr double load_noise = 1e-11;

/// Whether a zero at s comes before what has been found.
CLUTCHWORK_INLINE bool is_first(const Hit& hit, double s) { return s >= 0 && (hit.what == Hit::nothing || s < hit.s); }

}  // namespace clutchwork

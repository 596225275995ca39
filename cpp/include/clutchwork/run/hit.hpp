#pragma once
#include <clutchwork/components/scalar.hpp>
#include <clutchwork/workspace.hpp>

/// What is found first inside a step.
namespace clutchwork {

/// The first thing that happens inside a step, and of which guard.
struct Hit {
  int what = -1;            ///< place of its guard in the list of guards, -1: nothing
  int index = -1;           ///< guard, locked contact, dependent set, redundant contact, contact, branch, or process
  double s = 1;             ///< where in the step, 0 to 1
  int who = -1;             ///< what of a law leaves its piece; the end that a stop meets
  bool held_bends = false;  ///< what is held bends there
  bool rough = false;       ///< the interpolant is elsewhere there
  int asked = -1;           ///< place of the guard that looks
  double held = -1;         ///< where what jumps there is seen as it was before, -1: nothing does
  bool load_ends = false;   ///< a load ends in the step, and what it moves bends

  CLUTCHWORK_INLINE bool none() const { return what < 0; }

  /// Whether a zero at s comes before what has been found.
  CLUTCHWORK_INLINE bool is_after(double at) const { return at >= 0 && (none() || at < s); }

  /// What the guard that looks has found at a share of the step, where that is first.
  CLUTCHWORK_INLINE bool take(double at, int found, int leaves = -1) {
    if (!is_after(at)) return false;
    what = asked, index = found, s = at, who = leaves, held_bends = rough = false, held = -1;
    return true;
  }
};

/// What a guard does: it decides about contacts, takes a law or a process to its next piece, or neither.
enum class Effect { decides, next_piece, other };

/// Whether a margin exceeds what can change in a step of length h, by its values and slopes at both ends.
template <class R>
CLUTCHWORK_INLINE auto is_ample(R start, R end, R start_slope, R end_slope, R h) {
  return smaller(start, end) > larger(abs(end - start), h * larger(abs(start_slope), abs(end_slope)));
}

/// A guard that has its own scale already, or is a slip.
struct OwnScale {
  template <class Form, class T = typename Form::Scalar>
  static double scale(Form&, const Hit&, const T*) {
    return 1;
  }
};

/// A guard of contacts.
struct OfContact {
  template <class T>
  static int component(const Workspace<T>& ws, const Hit& hit) {
    return int(ws.sys.elements) + hit.index;
  }
};

/// A guard of what has no direction.
struct OfNone {
  template <class T>
  static int component(const Workspace<T>&, const Hit&) {
    return -1;
  }
};

/// Round-off of a load over its largest size: a load that has passed zero passes it again only from farther away.
/// docs/theory/events.md, rule 10
inline constexpr double load_noise = 1e-11;

}  // namespace clutchwork

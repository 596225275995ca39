#pragma once
#include <clutchwork/workspace/arena.hpp>
#include <clutchwork/workspace/settings.hpp>

/// Signals and the components that read them.
namespace clutchwork {

/// Numbers of a segment: a cubic and two waves, amplitude exp(-decay s) sin(omega s + phase). The second one is there
/// only beside a first one: what has passed a filter is a wave and what is left of the start.
inline constexpr int segment_size = 12;

/// Cursor of one signal, over a number of the model.
template <class G>
struct SignalOf {
  std::int64_t segment = 0;
  Instant<G> start = Instant<G>(0);  ///< [s] start of the present segment
  Instant<G> knot = Instant<G>(0);   ///< [s] start of the next one
  const G* coef = nullptr;
  G held = G(0);  ///< value of a signal that is set from outside
  bool varying = false, linear = true, idle = false;
  bool given = false;  ///< it was set from outside, and follows its segments no more
  int set = 0;         ///< segments that were set in place of those of the system, 0: none
  bool fresh = false;  ///< it has other segments from the present instant on, and stays at the left limit until then
};

using Signal = SignalOf<double>;

/// What components read, through references to signals, shared states, and rates, heats and supplied powers of
/// directions; the prescribed speeds come last.
template <class T>
struct Signals {
  SignalOf<Given<T>>* signal = nullptr;
  Instant<Given<T>>* set_time = nullptr;  ///< of the segments that were set, where the system has its own
  Given<T>* set_coef = nullptr;
  int n_refs = 0, n_varying = 0;
  int *ref_signal = nullptr, *varying = nullptr;
  T *u = nullptr, *du = nullptr;  ///< value of each reference; its time derivative where it is a signal or a rate
  double time = -infinity;        ///< [s] of the values
  double next_knot = infinity;    ///< [s]
  int alone = -1;                 ///< the only signal that was set since the inputs were loaded; -1: none, or more
  double knot_behind = infinity;  ///< [s] next knot without that
  bool expected = false;          ///< values may be set between calls
  T *prescribed = nullptr, *prescribed_slope = nullptr, *prescribed_before = nullptr;

  // references that are no signals: shared states first, then what directions have
  int *shared_ref = nullptr, *direction_ref = nullptr, *rate_ref = nullptr;
  int n_shared_refs = 0, n_direction_refs = 0;
  int n_rate_refs = 0;  ///< rates of elements, which torques may read in the full form; direction_ref has them too
  T* shared_slope = nullptr;  ///< time derivative of each reference to a shared state, else zero

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.take(p.shared_ref, n.references), a.take(p.direction_ref, n.references), a.take(p.shared_slope, n.references);
    a.take(p.rate_ref, n.references);
    // signals point into what was set
    const auto room = has_tangents<T> && n.prescribed == 0 ? 0 : n.segments;
    a.scratch(p.set_time, room), a.scratch(p.set_coef, segment_size * room);
    a.take(p.signal, n.signals), a.take(p.ref_signal, n.references), a.take(p.varying, n.references);
    a.take(p.u, n.references), a.take(p.du, n.references), a.take(p.prescribed_before, n.prescribed);
  }
};

/// An active component: one direction, one torque; an element of several ways is as many of them, one after another.
template <class T>
struct Branch {
  const T* params;
  const T* law_params;
  const T* input;
  const T* input_slope;
  const T* law_input;
  const T* law_input_slope;
  int inputs, law_inputs;
  int kind, law;      ///< law is -1 for a torque element
  int direction;      ///< number among elements, then contacts
  int state, states;  ///< own states: offset and number
  int ways;           ///< number of ways of which this is the first, most often 1; 0: another way of the one before
  int piece;          ///< smooth piece of the element or of the law
  int sign;           ///< direction of slip of a contact
  bool pressed;       ///< a contact with a load; a freewheel without one still blocks
  bool compliant;     ///< a contact whose law never sticks: smooth over signed slip
  bool follows;       ///< a contact whose torque follows a load
  bool shaped;        ///< a contact whose torque per load is not the coefficient itself
};

/// Value and partial derivatives of one branch.
template <class T>
struct Partial {
  T torque, by_rate, by_time;
};

}  // namespace clutchwork

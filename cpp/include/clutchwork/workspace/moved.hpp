#pragma once
#include <clutchwork/workspace/arena.hpp>
#include <clutchwork/workspace/motion.hpp>
#include <clutchwork/workspace/run.hpp>
#include <clutchwork/workspace/settings.hpp>

/// How the instants of events move with the numbers of the model: docs/theory/gradients.md
namespace clutchwork {

template <class T>
struct Workspace;

/// A guard that was hit: how fast it passed zero, over its own size. docs/theory/gradients.md (6)
struct Graze {
  double time;       ///< [s]
  double what;       ///< Hit::What, -1: knots of signals, or `passed_unseen`
  double component;  ///< elements, then contacts; -1: none
  double index;      ///< [1/s] size of its time derivative over its scale
  double together;   ///< [s] largest difference of the derivatives of two events at this instant, 0: there are none;
                     ///< at the start of the run those of the event, or of a margin, as it does not move
};

inline constexpr int graze_size = 5;
/// What of a graze: a jump of a torque that no guard sees.
inline constexpr int passed_unseen = 1000;

/// Rows of derivatives along a step: the stages come first, then these.
struct SlopeRow {
  enum Number : int { start = 8, u, drift, first, last, mix, rhs, count };
};
/// The same where a step of few numbers is taken by its matrices, which have no stages there.
struct LoadRow {
  enum Number : int { second = SlopeRow::u, third = SlopeRow::drift, fourth = SlopeRow::mix };
};

/// Of a run with derivatives.
template <class T>
struct Moved {
  static constexpr int room = 512;  ///< for grazes
  T shift = T(0);                   ///< [s] derivatives of the present instant while an event is settled
  T here = T(0);                    ///< those of the event or knot met last, the start of the run before the first
  double here_time = -infinity;     ///< [s] of it
  T last = T(0);                    ///< those of the event before
  double last_time = -infinity;     ///< [s] of the event before
  T* event = nullptr;               ///< of each event in the buffer
  Graze* graze = nullptr;
  T* instant = nullptr;  ///< [s] derivatives of the instant of each of them
  T* points = nullptr;   ///< of the curves
  T* row = nullptr;      ///< one row of output
  int n = 0;
  Workspace<double>* plain = nullptr;  ///< its image without derivatives
  double span = 0;                     ///< [s] steps that are taken where an event is met
  double pace = infinity;              ///< [s] that a step of the derivatives may take
  std::int64_t parts = 0;              ///< of steps that the derivatives have taken
  int directions = T::seen;            ///< that are asked for, the first ones
  double begin = -infinity;            ///< [s] until then nothing moves
  double size[T::seen] = {};           ///< least that each direction has, over the size of the motion
  double* most = nullptr;              ///< largest size that each speed and state has had
  // of each of them: the largest of each direction so far, and that with the part that is tried
  double *largest = nullptr, *reached = nullptr;
  bool work_left_out = false;            ///< steps are those of a run with work, which has no derivatives here
  typename T::Widest* slopes = nullptr;  ///< derivatives alone along a step: rows of the length of the motion
  Jacobian<double> other;                ///< of the image, at the other end of a step of the derivatives
  double* other_whole = nullptr;         ///< the same of the full form
  int* moves = nullptr;                  ///< of each direction: whether its torque has numbers with derivatives

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& s) {
    a.scratch(p.row, s.row), a.scratch(p.slopes, SlopeRow::count * (s.speeds + s.states));
    a.scratch(p.moves, s.directions), a.scratch(p.most, s.speeds + s.states);
    a.scratch(p.largest, T::seen * (s.speeds + s.states)), a.scratch(p.reached, T::seen * (s.speeds + s.states));
    const auto unknowns = s.full ? s.speeds + s.states : 0;
    Jacobian<double>::lay_out(p.other, a, s), a.scratch(p.other_whole, unknowns * unknowns);
    a.scratch(p.event, EventBuffer::room + 3 * s.contacts), a.scratch(p.graze, room);
    a.scratch(p.instant, room);
  }
};

/// Plain numbers have none; where they are single, so are the points of the curves.
template <class T>
  requires(!has_tangents<T> && !NumberOf<T>::single)
struct Moved<T> {
  template <class P, class A>
  static void lay_out(P&, A&, const Sizes&) {}
};

/// Beside a run of single precision: its curves, and the run in double that decides where it begins.
template <class T>
  requires(NumberOf<T>::single)
struct Moved<T> {
  T* points = nullptr;
  Workspace<double>* outer = nullptr;

  template <class P, class A>
  static void lay_out(P&, A&, const Sizes&) {}
};

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/input.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/run/step.hpp>
#include <clutchwork/workspace.hpp>

#include <bit>
#include <cstdint>

/// What decides the length of the next step of a phase, whatever its form and its integrator.
namespace clutchwork {

/// A length to seven binary digits, so that round-off in an error estimate does not reach the steps.
/// docs/theory/integrators.md (14)
inline double rounded_step(double h) {
  constexpr std::uint64_t last = std::uint64_t(1) << (52 - 6);
  const std::uint64_t bits = (std::bit_cast<std::uint64_t>(h) + last / 2) & ~(last - 1);
  return std::bit_cast<double>(bits);
}

/// Where a phase is between its steps.
template <class T>
struct StepSize {
  Workspace<T>& ws_;
  Sink& sink_;
  const double t_end_;
  double h_ = 0;       ///< [s] next step
  double reach_ = 0;   ///< [s] present step
  double stop_ = 0;    ///< [s] time that it must not pass
  double error_ = 0;   ///< of the present step in units of the tolerance
  double before_ = 0;  ///< [s] length of the step that was cut to end on an event
  int landings_ = 0;
  bool rejected_ = false, cut_ = false, over_ = false;
  Status status_ = Status::running;
  T* rows_ = nullptr;  ///< of the step: StepRow
  int width_ = 0;      ///< of each row

  StepSize(Workspace<T>& ws, double t_end, Sink& sink) : ws_(ws), sink_(sink), t_end_(t_end) {}

  /// Whether the next step is the first one behind a jump.
  bool follows_jump() const { return ws_.guard.jumped_at == ws_.time; }

  /// Numbers of one row of the step.
  T* row(int number) const { return rows_ + number * width_; }

  /// Whether a knot or the end is reached.
  CLUTCHWORK_INLINE bool is_due() const { return ws_.time >= ws_.in.next_knot || ws_.time >= t_end_; }

  /// Rows inside the next step, at most.
  std::int64_t most_rows() const {
    return sink_.spacing < infinity ? sink_.parts_of(smaller(1.001 * h_, t_end_ - ws_.time)) : sink_.steps;
  }

  Status what_is_spent() const {
    if (sink_.steps > 0 && sink_.at + most_rows() + 2 > sink_.count) return Status::rows_full;
    if (ws_.events.n >= EventBuffer::room) return Status::events_full;
    if (ws_.statistics.steps + ws_.statistics.rejected >= ws_.options.max_steps) return Status::too_many_steps;
    return ws_.poll.stops() ? Status::interrupted : Status::running;
  }

  /// The length of the next step, onto knots and the end exactly.
  CLUTCHWORK_INLINE void plan_step() {
    stop_ = smaller(t_end_, ws_.in.next_knot);
    reach_ = smaller(smaller(h_, signal_step(ws_)), ws_.options.max_step);
    cut_ = ws_.time + 1.0001 * reach_ >= stop_;
    if (cut_) reach_ = stop_ - ws_.time;
  }
  CLUTCHWORK_INLINE double end_of_step() const { return cut_ ? stop_ : ws_.time + reach_; }

  /// The time at a share of the step: at its end the same to the last bit as the run then has.
  CLUTCHWORK_INLINE double time_at(double s) const { return s >= 1 ? end_of_step() : ws_.time + s * reach_; }

  /// Whether a step is next to none of the time: rows and accelerations would be of its round-off.
  CLUTCHWORK_INLINE bool is_too_short(double h) const { return !(h > 1e-14 * larger(1e-2, abs(ws_.time))); }

  /// A shorter step. False: it is too short.
  CLUTCHWORK_INLINE bool shorten() {
    ++ws_.statistics.rejected;
    h_ = rounded_step(reach_ * (error_ < 1e300 ? larger(0.2, 0.9 * fifth_root_of_inverse(error_)) : 0.1));
    rejected_ = true;
    before_ = 0;
    return !is_too_short(h_);
  }

  /// Whether rows fall into the step up to the share s.
  CLUTCHWORK_INLINE bool has_rows(double s) const {
    const double end = time_at(s);
    // where no time passes the row is there already
    return end > ws_.time && (sink_.steps > 0 || (sink_.at < sink_.count && sink_.times[sink_.at] <= end));
  }

  /// Time and length of the next step after one that counts.
  CLUTCHWORK_INLINE void move_on() {
    ws_.time = end_of_step();
    const double growth = 0.9 * fifth_root_of_inverse(larger(error_, 1e-10));
    const double next = rounded_step(reach_ * smaller(rejected_ ? 1.0 : 6.0, larger(0.2, growth)));
    h_ = cut_ ? larger(next, h_) : larger(next, before_);
    rejected_ = false;
    before_ = 0, landings_ = 0;
    ws_.last_step = h_;
  }
};

}  // namespace clutchwork

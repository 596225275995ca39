#pragma once
#include <clutchwork/lanes/exchange.hpp>
#include <clutchwork/lanes/mode.hpp>
#include <clutchwork/lanes/rows.hpp>
#include <clutchwork/lanes/step.hpp>
#include <clutchwork/run/phase.hpp>
#include <clutchwork/run/step_size.hpp>
#include <clutchwork/run/stiffness.hpp>

/// The phases of up to eight runs in one mode, stepped together: docs/theory/lanes.md.
namespace clutchwork {

/// A phase whose steps are taken in a lane.
using LanePhase = Phase<SmallForm<double>>;

/// Takes the steps; everything that happens in one run alone is left to its own phase. A lane leaves when its phase is
/// over or its mode is another one; the others go on.
class Together {
  Workspace<Lanes<2>>& ws_;
  const LaneKernel& kernel_;
  LanePhase* const* phase_;  ///< of each lane, null: nobody
  LaneForm<2> form_;
  Step<LaneForm<2>> step_;
  Lanes<2> end_{0};                  ///< [s] of the present step
  const int n_;                      ///< speeds and states
  const std::int64_t parts_;         ///< rows of a step
  const ReadNumbers read_, inside_;  ///< what is read of them
  int n_active_ = 0;
  bool active_[n_lanes] = {}, counts_[n_lanes] = {}, visited_[n_lanes] = {};
  bool alone_[n_lanes] = {};       ///< what happens in its step is left to its phase
  bool wants_more_[n_lanes] = {};  ///< than the lanes give, in every step

 public:
  /// Phases that have begun, all in one mode; `first` is one of those that are there.
  Together(Workspace<Lanes<2>>& ws, const LaneKernel& kernel, LanePhase* const* phases, int first)
      : ws_(ws),
        kernel_(kernel),
        phase_(phases),
        form_(form_of(ws, pace_of(phases[first]).ws_)),
        step_(form_),
        n_(form_.n()),
        parts_(pace_of(phases[first]).sink_.steps),
        read_(run_of(first).out.read),
        inside_(run_of(first).out.inside) {
    take_mode(ws_, run_of(first));
    list_output(ws_, run_of(first), step_);
    for (int i = 0; i < n_lanes; ++i) enter(i, phase_[i] != nullptr ? i : first);
    list_varying(ws_);
  }

  /// Until fewer than two lanes are left.
  void run() {
    while (true) {
      plan();
      if (n_active_ < 2) break;
      take_step();
      settle();
    }
    // what the lanes hold of a run that is left goes back to it
    for (int i = 0; i < n_lanes; ++i)
      if (active_[i]) rest(i);
  }

 private:
  static StepSize<double>& pace_of(LanePhase* phase) { return *phase; }
  StepSize<double>& pace(int i) { return pace_of(phase_[i]); }
  Workspace<double>& run_of(int i) { return pace(i).ws_; }

  static LaneForm<2> form_of(Workspace<Lanes<2>>& ws, const Workspace<double>& run) {
    return LaneForm<2>(ws, run.reduced.nz, int(run.sys.states));
  }

  /// A lane without a phase computes what another one does.
  void enter(int i, int like) {
    StepSize<double>& one = pace(like);
    active_[i] = i == like;
    n_active_ += active_[i];
    ws_.run[i] = active_[i] ? &one.ws_ : nullptr;
    wants_more_[i] = wants_more(one);
    put_motion(ws_, one.ws_, i);
    load(one, i);
    step_.t[i] = end_[i] = one.ws_.time, step_.h[i] = one.h_;
  }

  /// Where a phase stands, into its lane.
  void load(StepSize<double>& one, int i) {
    // rows and guards may have read the signals elsewhere
    inputs_at(one.ws_, one.ws_.time), input_slopes_at(one.ws_, one.ws_.time);
    put(step_.y0(), one.row(StepRow::y0), n_, i), put(step_.f0(), one.row(StepRow::f0), n_, i);
    put(step_.dt0(), one.row(StepRow::dt0), n_, i);
    put_end(ws_.step_start, one.ws_.step_start, ws_.n_rates, ws_.held.n, i);
    put_jacobian(ws_, one.ws_, i), put_inputs(ws_, one.ws_, i), put_lines(ws_, one.ws_, i);
  }

  /// Back to the phase: where the lane stands.
  void rest(int i) {
    StepSize<double>& one = pace(i);
    get(one.row(StepRow::y0), step_.y0(), n_, i), get(one.row(StepRow::f0), step_.f0(), n_, i);
    get(one.row(StepRow::dt0), step_.dt0(), n_, i);
    get_end(one.ws_.step_start, ws_.step_start, ws_.n_rates, ws_.held.n, i);
    get_jacobian(one.ws_, ws_, i);
    get(one.ws_.in.u, ws_.in.u, ws_.in.n_refs, i), get(one.ws_.in.du, ws_.in.du, ws_.in.n_refs, i);
    one.ws_.in.time = end_[i];
  }

  /// Back to the phase: a whole step.
  void unload(int i) {
    StepSize<double>& one = pace(i);
    rest(i);
    get(one.row(StepRow::y1), step_.y1(), n_, i), get(one.row(StepRow::f1), step_.f1(), n_, i);
    get(one.row(StepRow::dt1), step_.dt1(), n_, i);
    for (int s = 0; s < 8; ++s) get(one.row(s), step_.k(s), n_, i);
    get_end(one.ws_.step_end, ws_.step_end, ws_.n_rates, ws_.held.n, i);
  }

  void leave(int i) {
    active_[i] = false;
    ws_.run[i] = nullptr;
    --n_active_;
  }

  /// Whether a phase that has done something on its own stays in its lane.
  void go_on(int i) {
    if (pace(i).over_ || !may_share(run_of(i)) || !same_mode(ws_, run_of(i))) return leave(i);
    load(pace(i), i);
    end_[i] = run_of(i).time;
  }

  /// Knots, the end, a budget that is spent; then the length of the next step of each lane.
  void plan() {
    bool changed = false;
    for (int i = 0; i < n_lanes; ++i) {
      if (!active_[i]) continue;
      StepSize<double>& one = pace(i);
      if (one.is_due()) {
        rest(i);
        phase_[i]->settle_due();
        go_on(i);
        changed = true;
      } else {
        const Status spent = one.what_is_spent();
        if (spent != Status::running) {
          rest(i);
          phase_[i]->leave(spent);
          leave(i);
        }
      }
      if (!active_[i]) continue;
      one.plan_step();
      step_.t[i] = one.ws_.time, step_.h[i] = one.reach_;
    }
    if (changed) list_varying(ws_);
  }

  void take_step() {
    Lanes<2> error;
    Mask<2> finite, counts(false);
    ws_.statistics.evaluations = 0;
    kernel_.advance(&form_, &step_, &error, &finite);
    for (int i = 0; i < n_lanes; ++i) {
      counts_[i] = visited_[i] = false;
      if (!active_[i]) continue;
      run_of(i).statistics.evaluations += std::int64_t(ws_.statistics.evaluations[i]);
      counts_[i] = judge(i, finite[i] ? error[i] : infinity);
      if (!counts_[i]) continue;
      counts.set(i, true);
      ++run_of(i).statistics.jacobians;
      end_[i] = pace(i).end_of_step();
    }
    // lanes that do not count look again at where they are
    for (int j = 0; j < n_; ++j) step_.y1()[j] = select(counts, step_.y1()[j], step_.y0()[j]);
    kernel_.linearize_at(&form_, &step_, &end_);
  }

  /// Whether the step of a lane counts.
  bool judge(int i, double error) {
    StepSize<double>& one = pace(i);
    one.error_ = error;
    if (error <= 1) {
      ++one.ws_.statistics.steps;
      return true;
    }
    if (!one.shorten()) {
      rest(i);
      phase_[i]->collapse();
      leave(i);
    }
    return false;
  }

  /// Each lane goes on: alone through what may happen inside its step, else to its end.
  void settle() {
    Mask<2> doubtful;
    kernel_.doubt(&form_, &step_, &doubtful);
    bool work = false, rows = false;
    for (int i = 0; i < n_lanes; ++i) {
      alone_[i] = !active_[i] || !counts_[i] || is_left_alone(i) || (parts_ > 0 && follows_closely(i));
      if (alone_[i]) continue;
      work = work || (has_work(run_of(i)) && ws_.out.n_worked > 0);
      rows = rows || parts_ > 0;
    }
    if (work || rows) write(rows);
    for (int i = 0; i < n_lanes; ++i) {
      if (!active_[i] || !counts_[i]) continue;
      visited_[i] = alone_[i] || doubtful[i] || may_settle(i);
      bool nothing = true;
      if (visited_[i]) {
        unload(i);
        nothing = phase_[i]->settle_given(!alone_[i]);
      } else {
        pace(i).move_on();
      }
      if (nothing) take_written(i);
    }
    pass_on();
  }

  /// Whether something may settle within the step of a lane behind a jump.
  bool may_settle(int i) {
    StepSize<double>& one = pace(i);
    if (!one.follows_jump()) return false;
    get_jacobian(one.ws_, ws_, i);
    return may_settle_within(one.ws_, one.reach_);
  }

  /// Whether rows inside the step of a lane must be settled, each on its own.
  bool follows_closely(int i) {
    const Workspace<double>& run = run_of(i);
    for (int k = 0; k < ws_.n_branches; ++k) {
      const double mobility = run.geometry.own[run.branch[k].direction];
      if (is_steep(mobility, ws_.jacobian.partial[k].by_rate[i], pace(i).reach_)) return true;
    }
    return false;
  }

  /// Whether what is wanted of any step is more than the lanes give.
  bool wants_more(const StepSize<double>& one) const {
    const Workspace<double>& run = one.ws_;
    const bool others = run.sys.prescribed + run.sys.supplies + run.sys.meters > 0;
    const bool other_work = others || run.out.read.place != read_.place || run.out.read.n != read_.n;
    return has_angles(run) || (has_work(run) && other_work) || one.sink_.steps != parts_ ||
           (parts_ > 0 && (run.out.inside.place != inside_.place || run.out.inside.n != inside_.n));
  }

  /// Whether what is wanted of the step of a lane is more than that.
  bool is_left_alone(int i) {
    const StepSize<double>& one = pace(i);
    if (wants_more_[i]) return true;
    if (parts_ == 0) return one.has_rows(1);
    // rows at knots are compared with those behind them
    return !ws_.out.rows || one.cut_ || one.reach_ < shortest_with_rows * (1 + abs(one.end_of_step()));
  }
  // far above what the time can tell apart
  static constexpr double shortest_with_rows = 1e-11;

  /// Work and rows of the steps in which nothing happens.
  void write(bool rows) {
    Mask<2> sound;
    kernel_.fit(&form_, &step_, &sound);
    for (int i = 0; i < n_lanes; ++i) alone_[i] = alone_[i] || !sound[i];
    for (std::int64_t k = 1; rows && k <= parts_; ++k) write_rows(k);
    // the lanes have the signals as they are at the ends
    inputs_at(ws_, end_);
  }

  /// What was written of a step becomes part of its run.
  void take_written(int i) {
    Workspace<double>& run = run_of(i);
    for (int k = 0; has_work(run) && k < ws_.out.n_worked; ++k)
      run.work[run.branch[ws_.out.worked[k]].direction] += ws_.out.work[k][i];
    pace(i).sink_.at += parts_;
    if (parts_ > 0) run.out.skipped = false, run.out.shown = end_[i], pace(i).sink_.lean = true;
  }

  /// Row k of each step.
  void write_rows(std::int64_t k) {
    Mask<2> sound;
    LaneRow<2> row{k, parts_, end_, end_};
    kernel_.observe(&form_, &step_, &row, &sound);
    for (int i = 0; i < n_lanes; ++i) {
      alone_[i] = alone_[i] || !sound[i];
      if (alone_[i]) continue;
      const Sink& sink = pace(i).sink_;
      const std::int64_t at = sink.at + k - 1;
      sink.times[at] = row.time[i];
      write_row(run_of(i), ws_.out, step_, i, row.time[i], sink.rows + run_of(i).row.size * at);
    }
  }

  /// The end of the step is the start of the next one, but for those who have gone elsewhere.
  void pass_on() {
    for (int j = 0; j < n_; ++j) {
      step_.y0()[j] = step_.y1()[j];
      step_.f0()[j] = step_.f1()[j];
      step_.dt0()[j] = step_.dt1()[j];
    }
    const StepEnd<Lanes<2>> edge = ws_.step_start;
    ws_.step_start = ws_.step_end;
    ws_.step_end = edge;
    bool changed = false;
    for (int i = 0; i < n_lanes; ++i) {
      if (!visited_[i]) continue;
      go_on(i);
      changed = true;
    }
    if (changed) list_varying(ws_);
  }
};

}  // namespace clutchwork

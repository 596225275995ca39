#pragma once
#include <clutchwork/components/input.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/ratios.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/lost_ratios.hpp>
#include <clutchwork/run/clamp_loads.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/event_sensitivity.hpp>
#include <clutchwork/run/guards/list.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/massless.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/run/passive_events.hpp>
#include <clutchwork/run/power.hpp>
#include <clutchwork/run/seizing.hpp>
#include <clutchwork/run/snapshot.hpp>
#include <clutchwork/run/step.hpp>
#include <clutchwork/run/step_calls.hpp>
#include <clutchwork/run/step_error.hpp>
#include <clutchwork/run/step_size.hpp>
#include <clutchwork/run/stiffness.hpp>
#include <clutchwork/run/variation.hpp>
#include <clutchwork/workspace.hpp>

/// One smooth phase: from an event to the next one.
namespace clutchwork {

/// A plain phase has no variation.
struct NoVariation {
  NoVariation(auto&, auto&) {}
};

/// Integration until an event, the end time, or a full buffer.
template <class Form>
class Phase : public StepSize<typename Form::Scalar> {
  using T = typename Form::Scalar;
  using Base = StepSize<T>;
  using Base::landings_, Base::rejected_, Base::cut_, Base::over_, Base::status_;
  using Base::what_is_spent, Base::plan_step, Base::end_of_step, Base::time_at, Base::shorten, Base::has_rows,
      Base::move_on, Base::is_too_short;
  using Base::ws_, Base::sink_, Base::t_end_, Base::h_, Base::reach_, Base::stop_, Base::error_, Base::before_;
  // a step may be repeated so often to end on an event
  static constexpr int most_landings = 4;
  // of the tolerance: cuts come on top of steps, and there may be one every few steps
  static constexpr double most_cut_error = 0.3;
  // the same of speeds without inertia, which follow from the others to their last digits
  static constexpr double most_light_error = 1e-3;
  // of a step towards rest: where inside it is checked; how much of the tolerance an interpolant may miss inside
  static constexpr double inner = 0.7, most_inner_error = 10;
  // of the tolerance: an interpolant that says nothing of a slip
  static constexpr double much_missed = 1e3;
  // steps at the limit of stability, of the length over the fastest rate, before an implicit method goes on
  static constexpr int most_strained = 8;
  static constexpr double strain = 1.5;
  // of the time: the last step of a run that loses a speed is no longer
  static constexpr double shortest = 1e-9;

  Form form_;
  Step<Form> step_;
  const StepCalls<Form> calls_;
  bool passes_ = false;  ///< the step has passed a ratio at which a speed without inertia follows from nothing
  [[no_unique_address]] std::conditional_t<has_tangents<T>, Variation<Form>, NoVariation> varied_;

 public:
  using Scalar = T;
  using FormType = Form;

  template <class Integrator>
  Phase(Workspace<T>& ws, double t_end, Sink& sink, Tag<Integrator>)
      : Base(ws, t_end, sink), form_(ws), step_(form_), calls_(phase_calls<Integrator>(form_)), varied_(form_, step_) {
    Base::rows_ = step_.k(0), Base::width_ = form_.n();
    step_.calls = &calls_;
  }

  /// `running`: an event is waiting to be settled.
  Status run() {
    begin();
    return resume();
  }

  /// The same for a phase that has begun.
  [[gnu::noinline]] Status resume() {
    while (!over_) {
      if (may_step() && take_step()) settle_step();
    }
    return status_;
  }

  // What a phase does on its own while its steps are taken with others: docs/theory/lanes.md.

  /// A knot, or the end. False: the phase is over.
  [[gnu::noinline]] bool settle_due() { return may_step(); }
  /// Whatever happens inside the step, of which the rows of both ends and the stages are given. `written`: rows and
  /// work are there for the case that nothing happens; true: nothing did.
  [[gnu::noinline]] bool settle_given(bool written) {
    step_.t = ws_.time, step_.h = reach_, step_.dense = false;
    return settle_step(written);
  }
  /// The step has become too short. The inputs are those of its last stage.
  void collapse() { end_collapsed(*this, error_ <= 1e300); }
  /// To where the phase stands.
  [[gnu::noinline]] void leave(Status status) {
    // a run that is left, to make room for rows, goes on as if it were not
    const double zero = ws_.guard.zero;
    export_state(form_, step_.y0());
    ws_.guard.zero = zero;
    // these leave between two steps
    const bool whole = status == Status::done || status == Status::rows_full || status == Status::events_full;
    ws_.linearized = whole && tells_all(form_);
    status_ = status;
    over_ = true;
  }

  [[gnu::noinline]] void begin() {
    const bool fresh = ws_.fresh_phase, event = fresh && !ws_.stiffened, linearized = ws_.linearized && !fresh;
    ws_.linearized = false;
    if (fresh) ws_.guard.zero = slip_tolerance(ws_);
    if constexpr (!Form::small) {
      if (fresh) form_.solve_mass(ws_.reduced.y);
    }
    for (int i = 0; i < form_.n(); ++i) step_.y0()[i] = ws_.reduced.y[i];
    if constexpr (Form::full) {
      if (ws_.ratios.n > 0) prepare_ratios(form_);
      if (fresh) keep_ties(form_, step_, ws_.time, step_.y0());
      if (ws_.ratios.jammed >= 0) return jam(*this, ws_.ratios.jammed);
      if (fresh && ws_.ratios.n > 0 && ws_.ratios.stopped >= 0) return stop_at(*this, ws_.ratios.stopped);
    }
    if constexpr (!Form::small) {
      if (fresh && balance_massless(form_, step_) && event && may_decide_again()) return decide_again();
    }
    if constexpr (has_tangents<T>) {
      if (event && leave_event(form_, step_)) balance_massless(form_, step_);
    }
    ws_.fresh_phase = ws_.stiffened = false;
    // at a knot the row is the right limit, which comes after it
    const Status shown = ws_.time < ws_.in.next_knot ? emit_start(form_, step_, sink_, event) : Status::running;
    if (shown != Status::running) return leave(shown);
    // counted as one, so that a run counts alike wherever it is left
    linearized ? void(++ws_.statistics.jacobians) : linearize_start();
    if constexpr (has_tangents<T>) note_borders_here(event);
    h_ = first_length(event);
  }

  /// Borders on which the phase may begin.
  void note_borders_here(bool event)
    requires has_tangents<T>
  {
    const bool start = ws_.statistics.steps == 0, knot = ws_.event_context.cause == Cause::input;
    if (event || start) note_borders(form_, step_, start ? Borders::all : knot ? Borders::carried : Borders::held);
  }

  double first_length(bool event) {
    // kept, so that a run takes the same steps whether or not it is asked for a row here
    if (event) ws_.last_step *= calls_.restart;
    return ws_.last_step > 0 ? ws_.last_step : first_step(taken_form(), taken_step(), t_end_ - ws_.time);
  }

  // What guards ask for where they were hit.

  Workspace<T>& ws() { return ws_; }
  Form& form() { return form_; }
  Step<Form>& step() { return step_; }
  // the form and the step in which the run goes on and guards are sought: of a run with derivatives its plain image
  CLUTCHWORK_INLINE auto& taken_form() {
    if constexpr (has_tangents<T>)
      return varied_.form;
    else
      return form_;
  }
  CLUTCHWORK_INLINE auto& taken_step() {
    if constexpr (has_tangents<T>)
      return varied_.step;
    else
      return step_;
  }
  /// The modes must be decided anew.
  void decide(Cause cause, int contact = -1) {
    ws_.event_context.cause = cause;
    ws_.event_context.contact = contact;
    over_ = true;
  }
  /// The same where speeds have jumped at the present instant: the modes were decided with others.
  void decide_again() {
    ws_.guard.balanced_at = ws_.time;
    export_state(form_, step_.y0());
    for (int c = 0; c < ws_.sys.contacts; ++c) ws_.event_context.mode[c] = ws_.contact.mode[c];
    // the start is decided: what changes now has events
    if (ws_.event_context.cause == Cause::initial) ws_.event_context.cause = Cause::other_event;
    ws_.event_context.contact = -1;
    over_ = true;
  }
  /// The run ends with the present state of the phase, which nobody exports.
  void end(Status status) { status_ = status; }
  /// Nothing needs a decision, but for torques that have jumped beyond what locked contacts hold, and elements at rest
  /// that would start where one `passes` to its next piece.
  void go_on(bool jumped, bool passes = false) {
    if (jumped) ws_.guard.jumped_at = ws_.time;
    if constexpr (!Form::small) {
      if (jumped && balance_massless(form_, step_)) export_state(form_, step_.y0());
    }
    if (jumped || !has_tangents<T>) linearize_start();
    // derivatives are still those at the event, where the modes are decided
    auto& taken = taken_form().ws;
    if ((jumped && is_beyond(taken)) || (passes && stays_below_jump(taken))) return decide(Cause::other_event);
    if constexpr (has_tangents<T>) {
      linearize_behind_event();
      if (jumped) note_borders(form_, step_, Borders::held);
    }
    if (ws_.guard.n_chattering > 0 && chatters(ws_)) return leave(Status::chatter);
    show_behind(false);
    h_ = ws_.last_step;
  }
  /// The same where no restart follows that would shorten the step.
  void go_on_as_before() {
    linearize_behind_event();
    h_ = ws_.last_step = smaller(ws_.last_step, larger(h_, reach_));
  }
  /// The next step is not longer than `most` says, where the phase goes on.
  template <class Most>
  void limit_step(Most&& most) {
    if (!over_) h_ = ws_.last_step = smaller(ws_.last_step, most());
  }
  /// Whether torques balance at the present state.
  bool is_balanced() {
    evaluate(form_, ws_.time, step_.y0(), step_.slope());
    return clutchwork::is_balanced(ws_);
  }

 private:
  CLUTCHWORK_INLINE void linearize_start() {
    if constexpr (has_tangents<T>)
      varied_.reflect_here();
    else
      calls_.linearize_at(form_, step_, ws_.time, step_.y0(), step_.f0(), step_.dt0(), ws_.step_start);
  }
  CLUTCHWORK_INLINE void linearize_end() {
    if constexpr (has_tangents<T>)
      varied_.linearize_end(end_of_step());
    else
      calls_.linearize_at(form_, step_, end_of_step(), step_.y1(), step_.f1(), step_.dt1(), ws_.step_end);
  }

  /// The same where the phase goes on behind an event.
  CLUTCHWORK_INLINE void linearize_behind_event() {
    if constexpr (has_tangents<T>) {
      if (leave_event(form_, step_)) balance_massless(form_, step_);
    }
    linearize_start();
  }

  /// Speeds without inertia have jumped to their balance: the modes were decided with other torques. Once at an
  /// instant.
  bool may_decide_again() const { return ws_.sys.contacts > 0 && ws_.guard.balanced_at != ws_.time; }

  // -------------------------------------------------------------------------------------------------- room for a step

  /// Whether the phase goes on: no knot that changes the modes, not at the end, room and budget left.
  CLUTCHWORK_INLINE bool may_step() {
    if (ws_.time >= ws_.in.next_knot && !(ws_.time >= t_end_ && awaits_values(ws_, ws_.time))) meet_knot();
    if (!over_ && ws_.time >= t_end_) {
      const Status shown = emit_start(form_, step_, sink_, false);
      leave(shown == Status::running ? Status::done : shown);
    }
    if (over_) return false;
    const Status spent = what_is_spent();
    if (spent != Status::running) leave(spent);
    return !over_;
  }

  void meet_knot() {
    if constexpr (has_tangents<T>) move_with(form_, step_, knot_shift(ws_));
    const bool told = tells_all(form_) && ws_.sys.loads == 0;
    if (!told) rest_step(form_, step_);
    export_state(form_, step_.y0());
    told ? note_start(form_) : note_before(form_, step_, 0.0);
    if (knots_crowd(ws_)) return leave(Status::zeno);
    const bool jumps = any_jumps(ws_);
    if (jumps) ws_.guard.jumped_at = ws_.time;
    if (knot_decides(ws_)) return decide(Cause::input);
    if constexpr (!Form::small) {
      if (jumps && balance_massless(form_, step_)) export_state(form_, step_.y0());
    }
    if constexpr (Form::full && has_tangents<T>) tie_derivatives();
    linearize_start();
    if (knot_lets_go(taken_form().ws)) return decide(Cause::input);
    if constexpr (has_tangents<T>) {
      if (leave_event(form_, step_)) balance_massless(form_, step_), linearize_start();
      note_borders(form_, step_, Borders::carried);
    }
    show_behind(jumps);
  }

  /// Derivatives of the speeds onto the ties behind a knot, at which a ratio may jump by zero.
  void tie_derivatives()
    requires has_tangents<T>
  {
    if (ws_.ratios.n == 0) return;
    const int n = form_.n();
    for (int i = 0; i < n; ++i) step_.y1()[i] = step_.y0()[i];
    keep_ties(form_, step_, ws_.time, step_.y0());
    for (int i = 0; i < n; ++i) step_.y0()[i].v = step_.y1()[i].v;
    ws_.ratios.jammed = -1;
    export_state(form_, step_.y0());
  }

  /// In steps both sides of an instant have a row where a signal, a torque or an acceleration jumps.
  void show_behind(bool jumps) {
    if (sink_.steps == 0 || ws_.time >= t_end_) return;
    const Status shown = emit_start(form_, step_, sink_, true);
    if (shown != Status::running) return leave(shown);
    const bool kept = jumps || row_jumps(ws_, sink_);
    if (!kept) --sink_.at;
    sink_.behind = kept && sink_.spacing < infinity;
    linearize_start();
  }

  // ------------------------------------------------------------------------------------------------------------- step

  /// One step. False: rejected, or the run cannot go on.
  CLUTCHWORK_INLINE bool take_step() {
    plan_step();
    step_.t = ws_.time;
    const double error = advance();
    if (!judge(error, all_finite(form_.n(), taken_step().y1()))) return false;
    if constexpr (Form::full) {
      keep_ties(taken_form(), taken_step(), end_of_step(), taken_step().y1());
      passes_ = note_lost(taken_form().ws);
    }
    linearize_end();
    return true;
  }

  CLUTCHWORK_INLINE double advance() {
    if constexpr (has_tangents<T>)
      return varied_.advance(reach_);
    else
      return calls_.advance(form_, step_, reach_);
  }

  /// Whether a step counts.
  CLUTCHWORK_INLINE bool judge(double error, bool finite) {
    error_ = finite ? error : infinity;
    if (error_ <= 1 && ws_.options.work && drives_may_bend(ws_))
      error_ = larger(error_, work_error(taken_form(), taken_step()));
    if (!(error_ <= 1)) {
      reject();
      return false;
    }
    ++ws_.statistics.steps;
    return true;
  }

  /// What happens inside a step, and where the run goes on from. `written`: rows and work are there for the case that
  /// nothing happens; true: nothing did.
  [[gnu::noinline]] bool settle_step(bool written = false) {
    if (misses_start()) return reject_and_shrink(), false;
    const Hit hit = find_hit(taken_form(), taken_step());
    const bool is_written = written && hit.none();
    if (must_land(hit)) {
      land(hit.s);
    } else if (hit.rough) {
      error_ = much_missed, reject_and_shrink();
    } else if (misses_rest(hit)) {
      reject_and_shrink();
    } else if (Form::full && taken_form().ws.ratios.jammed >= 0) {
      // whatever comes first ends a step of its own: this one has lost a speed, perhaps far from its start
      const bool early = passes_ && reach_ > shortest * larger(1e-2, ws_.time);
      hit.none() && !early ? jam(*this, taken_form().ws.ratios.jammed) : (error_ = much_missed, reject_and_shrink());
    } else if (is_written || reach(hit)) {
      hit.none() ? accept() : meet(hit);
      return is_written;
    }
    return false;
  }

  void reject() {
    if (!shorten()) collapse();
  }

  /// Whether the step must be repeated to end where a guard was hit, because its own estimate does not speak for that
  /// point. docs/theory/events.md, rule 7
  CLUTCHWORK_INLINE bool must_land(const Hit& hit) {
    if (hit.none() || landings_ >= most_landings || hit.s <= 0 || hit.s >= 1) return false;
    bool sure = error_until(taken_form(), taken_step(), hit.s) <= most_cut_error;
    if constexpr (Form::full) {
      // a pole is where it is, and at it nothing tells what the contact has held
      if (taken_form().ws.ratios.n > 0 && !keeps_ties(taken_form().ws.ratios)) return false;
    }
    if constexpr (!Form::small) {
      if (sure && any_massless(taken_form())) {
        sure = massless_error(taken_form(), taken_step(), hit.s) <= most_light_error;
        if constexpr (has_tangents<T>) varied_.forget_factor();
      }
    }
    return !sure;
  }

  /// Repeat the step so that it ends there.
  void land(double s) {
    --ws_.statistics.steps;
    ++ws_.statistics.rejected;
    if (landings_++ == 0) before_ = larger(h_, reach_);
    h_ = s * reach_;
    linearize_again();
  }
  /// The derivatives are those of the other end.
  void linearize_again() {
    ws_.in.time = -infinity;
    if constexpr (has_tangents<T>)
      varied_.linearize_start();
    else
      linearize_start();
  }

  /// Whether a step towards rest has run over a change of the coefficient: the two solutions whose difference is its
  /// error may agree by chance. docs/theory/events.md, rule 7
  bool misses_rest(const Hit& hit) {
    if (!calls_.stiff || !hit.none() || !nears_rest(taken_form().ws)) return false;
    fit(taken_form(), taken_step());
    return misses(error_until(taken_form(), taken_step(), inner));
  }

  /// Whether the first step behind a jump has run over what settles within a part of it: its end is right, but not what
  /// is read inside. docs/theory/events.md, rule 7
  bool misses_start() {
    if (!calls_.stiff || !Base::follows_jump() || reach_ < shortest * larger(1e-2, ws_.time)) return false;
    if (!may_settle_within(taken_form().ws, reach_)) return false;
    fit(taken_form(), taken_step());
    if constexpr (has_tangents<T>) varied_.forget_factor();
    return misses(error_inside(taken_form(), taken_step()));
  }

  /// Whether the interpolant of the step misses more than it may.
  bool misses(double missed) {
    if (!(missed <= most_inner_error)) return error_ = missed, true;
    linearize_end();
    return false;
  }

  void reject_and_shrink() {
    --ws_.statistics.steps;
    linearize_again();
    reject();
  }

  /// To where the step ends, with rows and integrals, and with derivatives where there are some. False: the run cannot
  /// go on.
  CLUTCHWORK_INLINE bool reach(const Hit& hit) {
    if constexpr (has_tangents<T>) return follow(hit.s, hit.held);
    if (hit.held >= 0) ws_.out.jumps_at = hit.s, ws_.out.jumps_from = hit.held;
    return write(hit.s);
  }

  /// Derivatives along the step up to the share s, in as many parts as they need; `held` as that of a hit.
  bool follow(double s, double held)
    requires has_tangents<T>
  {
    if (s <= 0) varied_.rest();
    for (double at = 0; at < s;) {
      const double to = varied_.follow(at, s, end_of_step());
      if (to < 0) return leave(Status::step_collapse), false;
      if (ws_.moved.parts++ >= ws_.options.max_steps) return leave(Status::too_many_steps), false;
      const double end = to == s ? time_at(s) : step_.t + step_.h;
      // a share of the last part
      if (to == s && held >= 0) ws_.out.jumps_at = 1, ws_.out.jumps_from = 1 - (s - held) / (s - at);
      if constexpr (Form::full) keep_ties(form_, step_, end, step_.y1());
      if (!write_part(end)) return false;
      for (int i = 0; to < s && i < form_.n(); ++i) step_.y0()[i] = step_.y1()[i];
      at = to;
    }
    return true;
  }
  bool write_part(double end)
    requires has_tangents<T>
  {
    const bool rows = end > step_.t && sink_.at < sink_.count && sink_.times[sink_.at] <= end;
    if (!(rows || ws_.options.work || ws_.options.angles)) return true;
    varied_.fit_part();
    if (ws_.options.work) fit_power(form_, step_, 1.0);
    const Status shown = rows ? emit(form_, step_, 1.0, end, sink_) : Status::running;
    if (shown != Status::running) return leave(shown), false;
    accumulate(form_, step_, 1.0, false);
    return true;
  }

  /// Rows and integrals of the step up to the share s. False: a row is not finite, or the caller wants to stop.
  CLUTCHWORK_INLINE bool write(double s) {
    const bool rows = has_rows(s);
    if (!(rows || has_work(ws_) || has_angles(ws_)) || s <= 0) return true;
    fit(form_, step_);
    if (has_work(ws_)) fit_power(form_, step_, s);
    ws_.out.until = -1;
    const Status shown = rows ? emit(form_, step_, s, time_at(s), sink_) : Status::running;
    if (shown != Status::running) {
      leave(shown);
      return false;
    }
    accumulate(form_, step_, s, rows && ws_.out.until == s);
    return true;
  }

  /// Go on from the end of the step.
  CLUTCHWORK_INLINE void accept() {
    for (int i = 0; i < form_.n(); ++i) {
      step_.y0()[i] = step_.y1()[i];
      if constexpr (has_tangents<T>) continue;
      step_.f0()[i] = step_.f1()[i];
      step_.dt0()[i] = step_.dt1()[i];
    }
    const StepEnd<T> edge = ws_.step_start;
    ws_.step_start = ws_.step_end;
    ws_.step_end = edge;
    move_on();
    if constexpr (has_tangents<T>) varied_.accept();
    if (ws_.guard.n_undirected > 0) {
      const int before = ws_.guard.n_undirected;
      direct_open(form_, ws_.step_start);
      if constexpr (has_tangents<T>) {
        if (ws_.guard.n_undirected != before) linearize_start();
      }
    }
    if constexpr (Form::full) {
      // towards a pole of a transmission steps shrink without being rejected; cut and landed ones leave a longer one
      if (h_ < reach_ && is_too_short(h_)) return collapse();
    }
    if (ws_.guard.n_chattering > 0 && chatters(ws_)) leave(Status::chatter);
    if (!calls_.stiff && !over_ && ws_.options.method == Method::auto_) watch_strain();
  }

  /// A motion that has become stiff is left to an implicit method.
  void watch_strain() {
    ws_.guard.strained = reach_ * fastest_rate(ws_) > strain ? ws_.guard.strained + 1 : 0;
    if (ws_.guard.strained < most_strained) return;
    ws_.guard.strained = 0;
    export_state(form_, step_.y0());
    ws_.fresh_phase = ws_.stiffened = over_ = true;
  }

  // ------------------------------------------------------------------------------------------------------------ event

  /// Go to where the guard was hit: either the phase goes on from there, or the modes must be decided anew.
  CLUTCHWORK_INLINE void meet(const Hit& hit) {
    // after an event a quarter of the step before it; events at one instant do not shrink it further
    const double planned = larger(larger(h_, reach_), before_);
    ws_.last_step = hit.s * reach_ > 1e-9 * larger(1e-3, planned) ? planned : larger(4 * h_, planned);
    // the run keeps its last step alone, and may be left here to make room for rows
    before_ = 0, landings_ = 0, rejected_ = false;
    if (sink_.lean) fill_last_row();
    // a run with derivatives has a step that ends there
    const double at = has_tangents<T> ? 1.0 : hit.s;
    if constexpr (has_tangents<T>) varied_.fit_part();
    note_before(form_, step_, at);
    ws_.out.jumps_at = -1;
    interpolate(form_, step_, at, step_.u());
    ws_.time = smaller(ws_.time + hit.s * reach_, stop_);
    forget_forced(ws_);
    GuardList::visit(hit.what, [&](auto tag) {
      using G = typename decltype(tag)::type;
      if constexpr (requires { G::force(*this, hit); }) G::force(*this, hit);
    });
    if constexpr (has_tangents<T>) slope_at_end();
    for (int i = 0; i < form_.n(); ++i) step_.y0()[i] = step_.u()[i];
    if constexpr (has_tangents<T>) ws_.moved.span = planned, move_to_hit(form_, step_, hit);
    GuardList::visit(hit.what, [&](auto tag) {
      using G = typename decltype(tag)::type;
      if constexpr (requires { G::arrive(form_, step_, hit); }) G::arrive(form_, step_, hit);
    });
    ws_.in.time = -infinity;
    if constexpr (Form::full) keep_ties(form_, step_, ws_.time, step_.y0());
    export_state(form_, step_.y0());
    input_slopes_at(ws_, ws_.time);
    keep_prescribed(ws_);
    keep_ratios(ws_);
    GuardList::visit(hit.what, [&](auto tag) { decltype(tag)::type::settle(*this, hit); });
  }

  /// The row at the start of the step is compared with the one behind the event; what is read of it stays as it is.
  /// There is room for one more behind it.
  [[gnu::noinline]] void fill_last_row() {
    fit(form_, step_);
    fill_row(form_, step_, 0.0, 0.0, sink_);
    double *full = sink_.rows + ws_.row.size * sink_.at, *last = full - ws_.row.size;
    const ReadNumbers& inside = ws_.out.inside;
    for (std::int64_t i = 0; i < inside.n; ++i) full[inside.place[i]] = last[inside.place[i]];
    for (std::int64_t i = 0; i < ws_.row.size; ++i) last[i] = full[i];
  }

  /// Slopes of the speeds without inertia, which no equation of motion gives.
  void slope_at_end()
    requires has_tangents<T>
  {
    if (step_.h > 0) return interpolate_slope(form_, step_, 1.0, step_.k(2));
    for (int i = 0; i < form_.n(); ++i) step_.k(2)[i] = T(0);
  }
};

}  // namespace clutchwork

#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/input.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/motion/form.hpp>
#include <clutchwork/motion/reduce.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/motion/sparse.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/guards.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/workspace.hpp>

/// One smooth phase: from an event to the next one.
namespace clutchwork {

/// Whether some speed has no inertia and is algebraic.
template <class T>
bool has_massless(const Workspace<T>& ws) {
  for (int i = 0; i < ws.sys.speeds; ++i) {
    if (ws.sys.massless[i] != 0) return true;
  }
  return false;
}

/// Whether an explicit step is limited by accuracy and not by stability in the present phase.
template <class T>
bool explicit_suits(Workspace<T>& ws) {
  // speeds without inertia are algebraic: only the implicit method carries them
  if (has_massless(ws)) return false;
  // shared states may be stiff
  if (ws.sys.shared > 0 && ws.options.method == Method::automatic) return false;
  if (ws.options.method != Method::automatic) return ws.options.method == Method::dopri5;
  const int nv = int(ws.sys.speeds);
  double damping = 0, stiffness = 0;
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<T>& b = ws.branch[k];
    const StatePartials<T> out{ws.f_state + b.state, ws.g_rate + b.state, ws.g_time + b.state,
                               ws.g_state + ws.block[k]};
    const Partial<T> p = branch_partial(ws, b, rate_of(ws, b.direction), T(0), ws.state, ws.scratch, out);
    const T* row = ws.direction + b.direction * nv;
    const double mobility = value(dot(nv, row, row));
    damping += mobility * abs(value(p.by_rate));
    for (int s = 0; s < b.states; ++s) {
      stiffness += mobility * abs(value(out.f_state[s] * out.g_rate[s]));
      damping += abs(value(out.g_state[s * b.states + s]));
    }
  }
  const double fastest = damping + sqrt(stiffness), h = ws.last_step > 0 ? ws.last_step : 1e-3;
  return fastest * h < 1.0;
}

/// Contacts without load forget: the bristles of their laws are straight when they close again.
template <class T>
void relax_open(Workspace<T>& ws) {
  const System& sys = ws.sys;
  for (int c = 0; c < sys.contacts; ++c) {
    if (!ws.compliant[c] || ws.pressed[c]) continue;
    const int n = states_of(sys.contact_kind[c], sys.contact_law[c], ws.params + sys.contact_law_param[c]);
    for (int i = 0; i < n; ++i) ws.state[sys.contact_state[c] + i] = T(0);
    ws.piece[sys.elements + c] = 0;
  }
}

/// Laws whose slip has jumped to the other sign notice it.
template <class T>
void turn_jumped(Workspace<T>& ws) {
  for (int i = 0; i < ws.n_switching; ++i) {
    Branch<T>& b = ws.branch[ws.switching[i]];
    const T rate = rate_of(ws, b.direction);
    const int heading = value(rate) > 0 ? forward : backward;
    if (abs(value(rate)) <= slip_tolerance(ws) || heading == ws.heading[b.direction] || !law_turns(b)) continue;
    ws.piece[b.direction] = b.piece = law_cross(ws, b, rate, turned, ws.state);
    ws.heading[b.direction] = heading;
  }
}

/// Reduced motion of the present modes; the state goes to ws.y. False: the inertias differ too much to tell them apart.
template <class T>
bool enter_mode(Workspace<T>& ws) {
  const System& sys = ws.sys;
  T* basis = ws.envelope;
  relax_open(ws);
  list_locked(ws);
  pack_branches(ws);
  turn_jumped(ws);
  // many speeds: the rank from sparse elimination, the dense basis only where it is used
  const bool many = sys.speeds > 3 * small_speeds;
  ws.rank = many ? eliminate_locked(ws, ws.z_basis) : split_locked(ws, basis);
  ws.nz = int(sys.speeds) - ws.rank;
  ws.is_explicit = explicit_suits(ws);
  ws.sparse = ws.is_explicit || sys.shared > 0 || ws.nz > small_speeds || sys.states > small_states || has_massless(ws);
  if (many && (!ws.sparse || sys.prescribed > 0)) split_locked(ws, basis);
  if (!factor_mobility(ws)) return false;
  map_prescribed(ws, basis);
  if (!ws.sparse) map_multipliers(ws);
  if (ws.sparse) {
    if (!many) eliminate_locked(ws, ws.z_basis);
    reduce_rates(ws);
    reduce_sparse(ws);
  } else {
    reduce_dense(ws, basis);
    reduce_rates(ws);
  }
  for (int i = 0; i < sys.states; ++i) ws.y[ws.nz + i] = ws.state[i];
  list_lines(ws);
  ++ws.statistics.phases;
  return true;
}

/// Speeds without inertia: Newton on their balance of torques. docs/theory/reduction.md
template <class T>
void balance_massless(SparseForm<T>& form, Step<SparseForm<T>>& step) {
  Workspace<T>& ws = form.ws;
  const int nz = form.nz();
  bool any = false;
  for (int i = 0; i < nz; ++i) any = any || ws.m_first[i] == ws.m_first[i + 1];
  for (int round = 0; any && round < 8; ++round) {
    linearize(form, ws.time, step.y0(), step.f0(), step.dt0(), ws.here);
    T* stiff = ws.scratch;
    for (int k = 0; k < ws.n_branches; ++k) stiff[k] = ws.partial[k].by_rate;
    // a huge inertia holds all other speeds
    if (!form.factor(T(1e30), stiff)) return;
    T* b = step.slope();
    for (int i = 0; i < nz; ++i) b[i] = ws.m_first[i] == ws.m_first[i + 1] ? step.f0()[i] : T(0);
    form.solve(b);
    for (int i = 0; i < nz; ++i) step.y0()[i] += b[i];
  }
}

/// Derivatives, rates, slopes, multipliers at one end of the step.
template <class Form, class T = typename Form::Scalar>
CLUTCHWORK_INLINE void look(Form& form, Step<Form>& step, double t, const T* y, T* d, T* dt, Edge<T>& edge) {
  linearize(form, t, y, d, dt, edge);
  if constexpr (Form::small) {
    slopes(form, d, edge);
  } else {
    T* velocity = step.slope();
    for (int i = 0; i < form.nz(); ++i) velocity[i] = d[i];
    form.solve_mass(velocity);
    slopes(form, velocity, edge);
  }
  sense(form, d, edge);
}

/// A first step from the sizes of state and slope (E. Hairer, G. Wanner, Solving ODEs I, section II.4, shortened).
template <class Form>
double first_step(Form& form, Step<Form>& step, double span) {
  auto& ws = form.ws;
  if (ws.options.first_step > 0) return ws.options.first_step;
  auto* velocity = step.slope();
  for (int i = 0; i < form.n(); ++i) velocity[i] = step.f0()[i];
  form.solve_mass(velocity);
  const double size = error_norm(form, step.y0(), step.y0(), step.y0());
  const double speed = error_norm(form, velocity, step.y0(), step.y0());
  const double h = size < 1e-5 || speed < 1e-5 ? 1e-5 : 0.01 * size / speed;
  return smaller(larger(h, 1e-9), 0.1 * span);
}

/// Present state from reduced coordinates to the workspace.
template <class Form, class T = typename Form::Scalar>
void export_state(Form& form, const T* y) {
  Workspace<T>& ws = form.ws;
  for (int i = 0; i < form.n(); ++i) ws.y[i] = y[i];
  for (int i = 0; i < form.ns(); ++i) ws.state[i] = y[form.nz() + i];
  inputs_with(ws, ws.time, ws.state);
  expand(form, y, ws.v);
}

/// A step of no length at the present point, for reading rows and torques there.
template <class Form>
void rest_step(Form& form, Step<Form>& step) {
  step.t = form.ws.time;
  step.h = 0;
  for (int i = 0; i < form.n(); ++i) {
    step.y1()[i] = step.y0()[i];
    step.p(0)[i] = step.p(1)[i] = step.p(2)[i] = 0;
  }
}

/// Rows at the instant at which a phase starts. `running`: all is well.
template <class Form>
Status emit_start(Form& form, Step<Form>& step, Sink& sink, bool fresh) {
  if (!(sink.steps ? fresh : sink.at < sink.count && sink.times[sink.at] <= form.ws.time)) return Status::running;
  rest_step(form, step);
  if (!sink.steps) {
    // a grid row here is the right limit of an event; further equal times wait for the end of the step
    const std::int64_t size = form.ws.row.size;
    while (sink.at < sink.count && sink.times[sink.at] <= form.ws.time) {
      if (!fill_row(form, step, 0.0, 0.0, sink.rows + size * sink.at)) return Status::not_finite;
      ++sink.at;
    }
    return Status::running;
  }
  return emit(form, step, 0.0, sink);
}

/// Name the branch whose torque is not finite.
template <class Form>
void blame(Form& form, Step<Form>& step) {
  auto& ws = form.ws;
  ws.detail_component = -1;
  observe(form, ws.time, step.y0(), step.slope(), ws.scratch, ws.torque);
  for (int k = 0; k < ws.n_branches; ++k) {
    const double x = value(ws.torque[k]);
    if (x - x == 0) continue;
    ws.detail_component = ws.branch[k].direction;
    ws.detail_value = x;
    return;
  }
}

/// After a knot: right limits of the signals; true when the modes must be decided again.
template <class Form>
bool pass_knot(Form& form, Step<Form>& step) {
  auto& ws = form.ws;
  using T = typename Form::Scalar;
  for (int p = 0; p < ws.sys.prescribed; ++p) ws.prescribed_before[p] = ws.prescribed[p];
  load_inputs(ws, ws.time);
  bool decide = refresh_loads(ws);
  for (int p = 0; p < ws.sys.prescribed; ++p) decide = decide || value(ws.prescribed[p] - ws.prescribed_before[p]) != 0;
  if (decide) return true;
  look(form, step, ws.time, step.y0(), step.f0(), step.dt0(), ws.here);
  for (int a = 0; a < ws.n_locked; ++a) {
    if (is_rigid(ws, ws.locked[a])) return true;
    const T torque = ws.here.multiplier[a], capacity = ws.here.capacity[a];
    if (ws.in_set[a] == 0 && margin(ws, a, torque, capacity) < 0) return true;
  }
  for (int k = 0; k < ws.n_sets; ++k) {
    if (value(ws.here.room[k]) < 0) return true;
  }
  return ws.n_driven > 0;
}

/// The law of a contact goes to its next piece; it may move its states. False: it does so without end.
template <class Form>
bool pass_law(Form& form, Step<Form>& step, int k, int who) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  Branch<T>& b = ws.branch[k];
  T* state = step.y0() + form.nz();
  int& heading = ws.heading[b.direction];
  b.piece = law_cross(ws, b, rate_of(ws, b.direction), who, state);
  // a state that starts to slide does so the way the contact slips, however small the slip
  if (who == turned) {
    heading = -heading;
  } else if (b.law >= 0 && law_runs_on(b, who)) {
    heading = value(state[b.state + who]) < 0 ? backward : forward;
  }
  ws.piece[b.direction] = b.piece;
  for (int i = 0; i < b.states; ++i) ws.state[b.state + i] = state[b.state + i];
  list_lines(ws);
  return !events_crowd(ws, b.direction);
}

/// Longest first step after an element has met another piece: half a radian of the swing of what it joins on its own
/// stiffness. An implicit step much longer would damp a whole collision away unseen.
template <class T>
double collision_step(const Workspace<T>& ws, int k) {
  const Branch<T>& b = ws.branch[k];
  if (b.law >= 0) return infinity;
  const int nv = int(ws.sys.speeds);
  const T* row = ws.direction + b.direction * nv;
  double stiffness = 0;
  for (int s = 0; s < b.states; ++s) stiffness += abs(value(ws.f_state[b.state + s] * ws.g_rate[b.state + s]));
  const double square = stiffness * value(dot(nv, row, row));
  return square > 0 ? 0.5 / sqrt(square) : infinity;
}

/// Whether a contact whose torque jumps with the sign of its slip reverses again and again within a few steps: it
/// cannot come to rest.
template <class T>
bool chatters(Workspace<T>& ws) {
  constexpr int window = 800, most = 40;
  const std::int64_t steps = ws.statistics.steps + ws.statistics.rejected;
  if (steps - ws.reversals_since > window) ws.reversals_since = steps, ws.reversals = 0;
  for (int i = 0; i < ws.n_chattering; ++i) {
    const int k = ws.chattering[i];
    // a slip that was driven through zero goes on; one that chatters is pushed back
    const double rate = value(ws.here.rate[k]);
    if (rate * value(ws.there.rate[k]) >= 0 || rate * value(ws.here.slope[k]) >= 0) continue;
    ws.detail_component = ws.branch[k].direction;
    ws.detail_value = rate;
    if (++ws.reversals > most) return true;
  }
  return false;
}

/// Move the state to where a harmless guard was hit: next piece of a table, or an open contact passing zero.
template <class Form>
void pass_line(Form& form, const LineGuard& guard) {
  auto& ws = form.ws;
  auto& b = ws.branch[guard.branch];
  if (guard.kind == LineGuard::edge) {
    const int inner = b.law >= 0 ? b.sign : 1;
    ws.piece[b.direction] += guard.sign == -inner ? 1 : -1;
    b.piece = ws.piece[b.direction];
  } else {
    const int c = b.direction - int(ws.sys.elements), from = ws.mode[c];
    ws.mode[c] = b.sign = -from;
    const double e = kinetic_energy(ws);
    record(ws, c, from, ws.mode[c], Cause::passing, value(ws.here.slope[guard.branch]), 0.0, 0.0, e, e);
  }
  list_lines(ws);
}

/// Open contacts that were at rest and have started to move get their direction.
template <class Form>
void direct_open(Form& form, const Edge<typename Form::Scalar>& edge) {
  auto& ws = form.ws;
  bool changed = false;
  for (int k = ws.n_branches; k < ws.n_rates; ++k) {
    auto& b = ws.branch[k];
    const double rate = value(edge.rate[k]);
    if (b.sign != 0 || abs(rate) <= 1e-10) continue;
    b.sign = rate > 0 ? forward : backward;
    ws.mode[b.direction - int(ws.sys.elements)] = b.sign;
    --ws.n_undirected;
    changed = true;
  }
  if (changed) list_lines(ws);
}

/// Longest step that resolves the oscillating signals, which the error estimate may not see: with work half a radian
/// of a sine or half a time constant of a decay, for the quadrature; else what the samples of the guards need.
template <class T>
double signal_step(const Workspace<T>& ws) {
  double fastest = 0;
  for (int k = 0; k < ws.n_varying; ++k) {
    const Signal& signal = ws.signal[ws.ref_signal[ws.varying[k]]];
    if (!signal.linear) fastest = larger(fastest, segment_rate(signal.coef, ws.time - signal.start));
  }
  return fastest > 0 ? (ws.options.work ? 0.5 : 1.5) / fastest : infinity;
}

/// Error of the work over a step in units of the tolerance, by halving. Where speeds are prescribed no state may feel
/// the torque, so nothing else keeps the steps short enough for the quadrature.
template <class Form, class Integrator>
double work_error(Form& form, Step<Form>& step) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  Integrator::prepare_dense(form, step);
  T *whole = ws.power, *halves = ws.power + ws.n_directions;
  for (int k = 0; k < ws.n_branches; ++k) whole[k] = halves[k] = T(0);
  auto add = [&](double start, double width, T* sum) {
    for (int g = 0; g < 4; ++g) {
      const double s = start + width * gauss.node[g];
      interpolate(form, step, s, step.point());
      observe(form, step.t + s * step.h, step.point(), step.slope(), ws.scratch, ws.torque);
      for (int k = 0; k < ws.n_branches; ++k)
        sum[k] += T(width * step.h * gauss.weight[g]) * ws.torque[k] * ws.scratch[k];
    }
  };
  add(0, 1, whole), add(0, 0.5, halves), add(0.5, 0.5, halves);
  double error = 0;
  for (int k = 0; k < ws.n_branches; ++k) {
    const double done = value(ws.work[ws.branch[k].direction]);
    const double tolerance = ws.options.atol + ws.options.rtol * (abs(done) + abs(value(halves[k])));
    error = larger(error, abs(value(whole[k] - halves[k])) / tolerance);
  }
  return error;
}

/// Whether all of a state is finite.
template <class T>
CLUTCHWORK_INLINE bool all_finite(int n, const T* y) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += value(y[i]) * 0;
  return sum == 0;
}

/// Error that the motion up to the share s of a step may have, in units of the tolerance: what the interpolant misses
/// of the equations of motion there, over that time. Only the end of a step is checked by its own estimate.
template <class Form>
double error_until(Form& form, Step<Form>& step, double s) {
  using T = typename Form::Scalar;
  Workspace<T>& ws = form.ws;
  T *y = step.point(), *slope = step.slope(), *miss = step.u();
  interpolate(form, step, s, y);
  evaluate(form, step.t + s * step.h, y, miss);
  form.solve_mass(miss);
  interpolate_slope(form, step, s, slope);
  for (int i = 0; i < form.n(); ++i) miss[i] = T(s * step.h) * (miss[i] - slope[i]);
  if constexpr (!Form::small) {
    // speeds without inertia have no equation of motion
    for (int i = 0; i < form.nz(); ++i) {
      if (ws.m_first[i] == ws.m_first[i + 1]) miss[i] = T(0);
    }
  }
  return error_norm(form, miss, step.y0(), y);
}

/// Integration until an event, the end time, or a full buffer.
template <class Form, class Integrator>
class Phase {
  using T = typename Form::Scalar;
  // a step may be repeated so often to end on an event
  static constexpr int most_landings = 4;
  // of the tolerance: cuts come on top of steps, and there may be one every few steps
  static constexpr double most_cut_error = 0.3;

  Workspace<T>& ws_;
  Form form_;
  Step<Form> step_;
  Sink& sink_;
  const double t_end_;
  double h_ = 0;       ///< [s] next step
  double reach_ = 0;   ///< [s] present step
  double stop_ = 0;    ///< [s] time that it must not pass
  double error_ = 0;   ///< of the present step in units of the tolerance
  double before_ = 0;  ///< [s] length of the step that was cut to end on an event
  int landings_ = 0;
  bool rejected_ = false, cut_ = false;
  Status status_ = Status::running;

 public:
  Phase(Workspace<T>& ws, double t_end, Sink& sink) : ws_(ws), form_(ws), step_(form_), sink_(sink), t_end_(t_end) {}

  /// `running`: an event is waiting to be settled.
  Status run() {
    if (!begin()) return status_;
    while (true) {
      if (ends()) return status_;
      if (!try_step()) {
        if (status_ != Status::running) return status_;
        continue;
      }
      const Hit hit = find_hit<Form, Integrator>(form_, step_);
      if (hit.what != Hit::nothing && must_land(hit.s)) {
        land(hit.s);
        continue;
      }
      if (!write(hit.what == Hit::nothing ? 1.0 : hit.s)) return status_;
      if (hit.what == Hit::nothing ? accept() : meet(hit)) continue;
      return status_;
    }
  }

 private:
  /// False: the state is not finite, or there is no row of it.
  CLUTCHWORK_INLINE bool begin() {
    const bool fresh = ws_.fresh_phase;
    if constexpr (!Form::small) {
      if (fresh) form_.solve_mass(ws_.y);
    }
    for (int i = 0; i < form_.n(); ++i) step_.y0()[i] = ws_.y[i];
    if constexpr (!Form::small) balance_massless(form_, step_);
    ws_.fresh_phase = false;
    // at a knot the row is the right limit, which comes after it
    const Status shown = ws_.time < ws_.next_knot ? emit_start(form_, step_, sink_, fresh) : Status::running;
    if (shown != Status::running) return !leave(shown);
    look_here();
    // kept, so that a run takes the same steps whether or not it is asked for a row here
    if (fresh) ws_.last_step *= 0.25;
    h_ = ws_.last_step > 0 ? ws_.last_step : first_step(form_, step_, t_end_ - ws_.time);
    return true;
  }

  CLUTCHWORK_INLINE void look_here() { look(form_, step_, ws_.time, step_.y0(), step_.f0(), step_.dt0(), ws_.here); }

  bool leave(Status status) {
    export_state(form_, step_.y0());
    status_ = status;
    return true;
  }

  /// Whether the phase is over before the next step: a knot that changes the modes, the end, no room, no budget.
  CLUTCHWORK_INLINE bool ends() {
    if (ws_.time >= ws_.next_knot && !(ws_.time >= t_end_ && awaits_values(ws_, ws_.time))) {
      rest_step(form_, step_);
      export_state(form_, step_.y0());
      note_before(form_, step_, 0.0);
      if (knots_crowd(ws_)) return leave(Status::zeno);
      if (pass_knot(form_, step_)) {
        ws_.located = -1;
        ws_.cause = Cause::input;
        return true;
      }
    }
    if (ws_.time >= t_end_) {
      const Status shown = emit_start(form_, step_, sink_, false);
      return leave(shown == Status::running ? Status::done : shown);
    }
    if (sink_.steps && sink_.at + 3 > sink_.count) return leave(Status::rows_full);
    if (ws_.n_events >= Workspace<T>::event_room) return leave(Status::events_full);
    if (ws_.statistics.steps + ws_.statistics.rejected >= ws_.options.max_steps) return leave(Status::too_many_steps);
    if (stop_asked(ws_)) return leave(Status::interrupted);
    return false;
  }

  /// One step, onto knots and the end exactly. False: rejected, or the run cannot go on.
  CLUTCHWORK_INLINE bool try_step() {
    stop_ = smaller(t_end_, ws_.next_knot);
    reach_ = smaller(smaller(h_, signal_step(ws_)), ws_.options.max_step);
    cut_ = ws_.time + 1.0001 * reach_ >= stop_;
    if (cut_) reach_ = stop_ - ws_.time;
    step_.t = ws_.time;
    error_ = Integrator::advance(form_, step_, reach_);
    if (!all_finite(form_.n(), step_.y1())) error_ = infinity;
    if (error_ <= 1 && ws_.options.work && rates_bend(ws_))
      error_ = larger(error_, work_error<Form, Integrator>(form_, step_));
    if (!(error_ <= 1)) return reject();
    ++ws_.statistics.steps;
    look(form_, step_, cut_ ? stop_ : ws_.time + reach_, step_.y1(), step_.f1(), step_.dt1(), ws_.there);
    return true;
  }

  bool reject() {
    ++ws_.statistics.rejected;
    h_ = reach_ * (error_ < 1e300 ? larger(0.2, 0.9 * pow(error_, -0.2)) : 0.1);
    rejected_ = true;
    before_ = 0;
    if (h_ > 1e-14 * larger(1e-2, abs(ws_.time))) return false;
    blame(form_, step_);
    leave(ws_.detail_component >= 0 || !(error_ <= 1e300) ? Status::not_finite : Status::step_collapse);
    return false;
  }

  /// Whether the step must be repeated to end at the share s, because its own estimate does not speak for that point.
  CLUTCHWORK_INLINE bool must_land(double s) {
    if (landings_ >= most_landings || s <= 0 || s >= 1) return false;
    return !(error_until(form_, step_, s) <= most_cut_error);
  }

  /// Repeat the step so that it ends there.
  void land(double s) {
    --ws_.statistics.steps;
    ++ws_.statistics.rejected;
    if (landings_++ == 0) before_ = larger(h_, reach_);
    h_ = s * reach_;
    // the derivatives are those of the other end
    ws_.input_time = -infinity;
    look_here();
  }

  /// Rows and integrals of the step up to the share s. False: a row is not finite, or the caller wants to stop.
  CLUTCHWORK_INLINE bool write(double s) {
    const bool rows = sink_.steps || (sink_.at < sink_.count && sink_.times[sink_.at] <= ws_.time + s * reach_);
    if (!(rows || ws_.options.work || ws_.options.angles) || s <= 0) return true;
    if (!step_.dense) Integrator::prepare_dense(form_, step_);
    if (ws_.options.work) fit_power(form_, step_, s);
    const Status shown = rows ? emit(form_, step_, s, sink_) : Status::running;
    if (shown != Status::running) return !leave(shown);
    accumulate(form_, step_, s);
    return true;
  }

  /// Go on from the end of the step. False: a contact chatters.
  CLUTCHWORK_INLINE bool accept() {
    for (int i = 0; i < form_.n(); ++i) {
      step_.y0()[i] = step_.y1()[i];
      step_.f0()[i] = step_.f1()[i];
      step_.dt0()[i] = step_.dt1()[i];
    }
    const Edge<T> edge = ws_.here;
    ws_.here = ws_.there;
    ws_.there = edge;
    ws_.time = cut_ ? stop_ : ws_.time + reach_;
    const double growth = 0.9 * pow(larger(error_, 1e-10), -0.2);
    const double next = reach_ * smaller(rejected_ ? 1.0 : 6.0, larger(0.2, growth));
    h_ = cut_ ? larger(next, h_) : larger(next, before_);
    rejected_ = false;
    before_ = 0, landings_ = 0;
    ws_.last_step = h_;
    if (ws_.n_undirected > 0) direct_open(form_, ws_.here);
    if (ws_.n_chattering == 0 || !chatters(ws_)) return true;
    leave(Status::chatter);
    return false;
  }

  /// Go to where the guard was hit; true when the phase goes on from there.
  CLUTCHWORK_INLINE bool meet(const Hit& hit) {
    // after an event a quarter of the step before it; events at one instant do not shrink it further
    const double planned = larger(larger(h_, reach_), before_);
    ws_.last_step = hit.s * reach_ > 1e-9 * larger(1e-3, planned) ? planned : larger(4 * h_, planned);
    before_ = 0, landings_ = 0;
    note_before(form_, step_, hit.s);
    interpolate(form_, step_, hit.s, step_.u());
    ws_.time = smaller(ws_.time + hit.s * reach_, stop_);
    forget_forced(ws_);
    if (hit.what == Hit::set) force_set(hit);
    for (int i = 0; i < form_.n(); ++i) step_.y0()[i] = step_.u()[i];
    ws_.input_time = -infinity;
    export_state(form_, step_.y0());
    input_slopes_at(ws_, ws_.time);
    for (int p = 0; p < ws_.sys.prescribed; ++p) ws_.prescribed_before[p] = ws_.prescribed[p];
    if (passes(hit)) return true;
    if (status_ == Status::running) hand_over(hit);
    return false;
  }

  /// A set at its limit load: its contacts slip the way in which it gives way, seen just behind the limit.
  void force_set(const Hit& hit) {
    torques_at(form_, step_, larger(hit.s, 1e-6));
    break_set(ws_, hit.index, ws_.output_torque);
  }

  /// Guards that need no decision: the next piece of a law or a table, an open contact that passes zero.
  CLUTCHWORK_INLINE bool passes(const Hit& hit) {
    const LineGuard* guard = hit.what == Hit::line ? &ws_.line[hit.index] : nullptr;
    const bool law = hit.what == Hit::law || (guard != nullptr && guard->kind == LineGuard::turn);
    if (!law && (guard == nullptr || guard->kind == LineGuard::slip)) return false;
    if (law && !pass_law(form_, step_, hit.what == Hit::law ? hit.index : guard->branch, hit.who)) {
      leave(Status::zeno);
      return false;
    }
    if (!law) pass_line(form_, *guard);
    look_here();
    h_ = ws_.last_step;
    if (hit.what == Hit::law) h_ = smaller(h_, collision_step(ws_, hit.index));
    return true;
  }

  /// Leave what happened to the decision.
  void hand_over(const Hit& hit) {
    ws_.located = -1;
    switch (hit.what) {
      case Hit::line:
        ws_.located = ws_.branch[ws_.line[hit.index].branch].direction - int(ws_.sys.elements);
        ws_.cause = Cause::slip_zero;
        return;
      case Hit::multiplier:
        ws_.located = ws_.locked[hit.index];
        ws_.cause = Cause::torque_limit;
        return break_away(hit);
      case Hit::set:
        ws_.cause = Cause::torque_limit;
        if (events_crowd(ws_, int(ws_.sys.elements) + ws_.set_member[ws_.set_first[hit.index]])) status_ = Status::zeno;
        return roll_over(hit.index);
      case Hit::parting:
        ws_.located = ws_.spare[hit.index];
        ws_.cause = Cause::torque_limit;
        return;
      case Hit::exit:
        ws_.detail_component = int(ws_.sys.elements) + hit.index;
        status_ = Status::out_of_table;
        return;
      case Hit::fault:
        ws_.located = hit.index;
        ws_.cause = Cause::fault;
        return fail(ws_, hit.index);
      default:
        ws_.located = hit.index;
        ws_.cause = Cause::input;
        ws_.pressed[hit.index] = !ws_.pressed[hit.index];
        ws_.turned_at[hit.index] = ws_.time;
        ws_.loaded[hit.index] = is_closed(ws_, hit.index);
    }
  }

  /// A contact at its limit slips against its torque; a freewheel overruns, or gives way for good.
  void break_away(const Hit& hit) {
    const int c = ws_.located;
    if (rolls_over(ws_, c)) return fail(ws_, c);
    if (is_rigid(ws_, c)) return;
    const double pull = hit.s > 0 ? value(ws_.torque_before[c]) : value(ws_.there.multiplier[hit.index]);
    ws_.forced[c] = pull > 0 && !contact_one_way(ws_, c) ? backward : forward;
  }

  /// Freewheels of a set that gives way at their own limit do so for good.
  void roll_over(int k) {
    for (int i = ws_.set_first[k]; i < ws_.set_first[k + 1]; ++i) {
      const int c = ws_.set_member[i];
      if (ws_.forced[c] == backward && rolls_over(ws_, c)) fail(ws_, c);
    }
  }
};

}  // namespace clutchwork

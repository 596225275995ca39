#pragma once
#include <clutchwork/event.hpp>

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
    if (!ws.compliant[c] || ws.loaded[c]) continue;
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
    if (margin(ws, a, torque, capacity) < 0) return true;
  }
  return false;
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
  // a state reaches its limit the way the contact slips, however small the slip
  if (who == turned) {
    heading = -heading;
  } else if (b.law >= 0) {
    heading = value(state[b.state + who]) < 0 ? backward : forward;
  }
  ws.piece[b.direction] = b.piece;
  for (int i = 0; i < b.states; ++i) ws.state[b.state + i] = state[b.state + i];
  ws.detail_component = b.direction;
  list_lines(ws);
  return !stands_still(ws);
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
    const double* c = signal.coef;
    if (signal.linear || c[4] == 0) continue;
    // a decay of 25 time constants has died
    if (c[7] * (ws.time - signal.start) > 25) continue;
    fastest = larger(fastest, larger(abs(c[5]), abs(c[7])));
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

/// Integrate until an event, the end time, or a full buffer. `running`: an event is waiting to be settled.
template <class Form, class Integrator>
Status smooth_phase(Workspace<typename Form::Scalar>& ws, double t_end, Sink& sink) {
  Form form(ws);
  Step<Form> step(form);
  const int n = form.n();
  const bool fresh = ws.fresh_phase;
  if constexpr (!Form::small) {
    if (fresh) form.solve_mass(ws.y);
  }
  for (int i = 0; i < n; ++i) step.y0()[i] = ws.y[i];
  if constexpr (!Form::small) balance_massless(form, step);
  ws.fresh_phase = false;
  if (emit_start(form, step, sink, fresh) != Status::running) {
    export_state(form, step.y0());
    return Status::not_finite;
  }
  look(form, step, ws.time, step.y0(), step.f0(), step.dt0(), ws.here);
  double h = ws.last_step > 0 ? (fresh ? 0.25 * ws.last_step : ws.last_step) : first_step(form, step, t_end - ws.time);
  bool rejected = false;

  while (true) {
    if (ws.time >= ws.next_knot) {
      rest_step(form, step);
      export_state(form, step.y0());
      note_before(form, step, 0.0);
      if (pass_knot(form, step)) {
        ws.located = -1;
        ws.cause = Cause::input;
        return Status::running;
      }
    }
    if (ws.time >= t_end) {
      const Status end = emit_start(form, step, sink, false);
      export_state(form, step.y0());
      return end == Status::running ? Status::done : end;
    }
    if ((sink.steps && sink.at + 3 > sink.count) || ws.n_events >= Workspace<typename Form::Scalar>::event_room) {
      export_state(form, step.y0());
      return ws.n_events > 0 && !(sink.steps && sink.at + 3 > sink.count) ? Status::events_full : Status::rows_full;
    }
    if (ws.statistics.steps + ws.statistics.rejected >= ws.options.max_steps) {
      export_state(form, step.y0());
      return Status::too_many_steps;
    }
    if (stop_asked(ws)) {
      export_state(form, step.y0());
      return Status::interrupted;
    }

    // step, onto knots and the end exactly
    const double stop = smaller(t_end, ws.next_knot);
    double reach = smaller(smaller(h, signal_step(ws)), ws.options.max_step);
    const bool cut = ws.time + 1.0001 * reach >= stop;
    if (cut) reach = stop - ws.time;
    step.t = ws.time;
    double error = Integrator::advance(form, step, reach);
    if (!all_finite(n, step.y1())) error = infinity;
    if (error <= 1 && ws.options.work && rates_bend(ws))
      error = larger(error, work_error<Form, Integrator>(form, step));
    if (!(error <= 1)) {
      ++ws.statistics.rejected;
      h = reach * (error < 1e300 ? larger(0.2, 0.9 * pow(error, -0.2)) : 0.1);
      rejected = true;
      if (h > 1e-14 * larger(1e-2, abs(ws.time))) continue;
      blame(form, step);
      export_state(form, step.y0());
      return ws.detail_component >= 0 || !(error <= 1e300) ? Status::not_finite : Status::step_collapse;
    }
    ++ws.statistics.steps;
    const double t1 = cut ? stop : ws.time + reach;
    look(form, step, t1, step.y1(), step.f1(), step.dt1(), ws.there);

    // locate
    const Hit hit = find_hit<Form, Integrator>(form, step);
    const bool whole = hit.what == Hit::nothing;
    const double s = whole ? 1.0 : hit.s;
    const bool rows = sink.steps || (sink.at < sink.count && sink.times[sink.at] <= ws.time + s * reach);
    if ((rows || ws.options.work || ws.options.angles) && s > 0) {
      if (!step.dense) Integrator::prepare_dense(form, step);
      if (ws.options.work) fit_power(form, step, s);
      const Status emitted = rows ? emit(form, step, s, sink) : Status::running;
      if (emitted != Status::running) {
        export_state(form, step.y0());
        return emitted;
      }
      accumulate(form, step, s);
    }

    // accept
    if (whole) {
      for (int i = 0; i < n; ++i) {
        step.y0()[i] = step.y1()[i];
        step.f0()[i] = step.f1()[i];
        step.dt0()[i] = step.dt1()[i];
      }
      const Edge<typename Form::Scalar> edge = ws.here;
      ws.here = ws.there;
      ws.there = edge;
      ws.time = t1;
      const double growth = 0.9 * pow(larger(error, 1e-10), -0.2);
      const double next = reach * smaller(rejected ? 1.0 : 6.0, larger(0.2, growth));
      h = cut ? larger(next, h) : next;
      rejected = false;
      ws.last_step = h;
      if (ws.n_undirected > 0) direct_open(form, ws.here);
      if (ws.n_chattering > 0 && chatters(ws)) {
        export_state(form, step.y0());
        return Status::chatter;
      }
      continue;
    }

    // switch
    // after an event a quarter of the step before it; events at one instant do not shrink it further
    ws.last_step = s * reach > 1e-9 * larger(1e-3, h) ? larger(h, reach) : larger(4 * h, reach);
    if (s > 0)
      note_before(form, step, s);
    else
      note_before(form, step, 0.0);
    interpolate(form, step, s, step.u());
    ws.time = smaller(ws.time + s * reach, stop);
    for (int i = 0; i < n; ++i) step.y0()[i] = step.u()[i];
    ws.input_time = -infinity;
    export_state(form, step.y0());
    input_slopes_at(ws, ws.time);
    for (int p = 0; p < ws.sys.prescribed; ++p) ws.prescribed_before[p] = ws.prescribed[p];
    const LineGuard* guard = hit.what == Hit::line ? &ws.line[hit.index] : nullptr;
    const bool law = hit.what == Hit::law || (guard != nullptr && guard->kind == LineGuard::turn);
    if (law && !pass_law(form, step, hit.what == Hit::law ? hit.index : guard->branch, hit.who)) {
      export_state(form, step.y0());
      return Status::zeno;
    }
    if (law || (guard != nullptr && guard->kind != LineGuard::slip)) {
      if (!law) pass_line(form, *guard);
      look(form, step, ws.time, step.y0(), step.f0(), step.dt0(), ws.here);
      h = ws.last_step;
      if (hit.what == Hit::law) h = smaller(h, collision_step(ws, hit.index));
      continue;
    }
    if (hit.what == Hit::exit) {
      ws.detail_component = int(ws.sys.elements) + hit.index;
      return Status::out_of_table;
    }
    switch (hit.what) {
      case Hit::line:
        ws.located = ws.branch[guard->branch].direction - int(ws.sys.elements);
        break;
      case Hit::multiplier:
        ws.located = ws.locked[hit.index];
        ws.pull = s > 0 ? value(ws.torque_before[ws.located]) : value(ws.there.multiplier[hit.index]);
        break;
      default:
        ws.located = hit.index;
    }
    ws.cause = hit.what == Hit::line         ? Cause::slip_zero
               : hit.what == Hit::multiplier ? Cause::torque_limit
               : hit.what == Hit::fault      ? Cause::fault
                                             : Cause::input;
    if (hit.what == Hit::fault) fail(ws, hit.index);
    if (hit.what == Hit::multiplier && rolls_over(ws, hit.index)) fail(ws, ws.located);
    if (hit.what == Hit::load) ws.loaded[hit.index] = !ws.loaded[hit.index] || contact_one_way(ws, hit.index);
    return Status::running;
  }
}

}  // namespace clutchwork

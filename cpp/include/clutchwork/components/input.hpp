#pragma once
#include <clutchwork/workspace.hpp>

/// Signals over time: segments between knots, read through references so that a component finds its inputs in a row.
namespace clutchwork {

/// A wave of a segment, its numbers at w. G: a number of the model.
template <class G>
CLUTCHWORK_INLINE G wave_value(const G* w, G s) {
  return w[0] * (is_zero(w[3]) ? G(1) : exp(-w[3] * s)) * (is_zero(w[1]) ? sin(w[2]) : sin(w[1] * s + w[2]));
}
template <class G>
CLUTCHWORK_INLINE G wave_slope(const G* w, G s) {
  const G phase = w[1] * s + w[2];
  if (is_zero(w[3])) return w[0] * w[1] * cos(phase);
  return w[0] * exp(-w[3] * s) * (w[1] * cos(phase) - w[3] * sin(phase));
}
template <class G>
G wave_integral(const G* w, G s) {
  const G norm = w[1] * w[1] + w[3] * w[3];
  if (value(norm) == 0) return w[0] * sin(w[2]) * s;
  auto part = [&](G at) { return -exp(-w[3] * at) * (w[3] * sin(w[1] * at + w[2]) + w[1] * cos(w[1] * at + w[2])); };
  return w[0] * (part(s) - part(G(0))) / norm;
}
template <class G>
bool wave_varies(const G* w) {
  return !is_zero(w[0]) && !(is_zero(w[1]) && is_zero(w[3]));
}

/// The cubic of a segment s seconds after its start, and its time derivative.
template <class R>
CLUTCHWORK_INLINE R cubic_value(const R* c, R s) {
  return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}
template <class R>
CLUTCHWORK_INLINE R cubic_slope(const R* c, R s) {
  return c[1] + s * (R(2) * c[2] + s * R(3) * c[3]);
}

/// Value of a segment s seconds after its start.
template <class G>
CLUTCHWORK_INLINE G segment_value(const G* c, G s) {
  G x = cubic_value(c, s);
  if (!is_zero(c[4])) {
    x += wave_value(c + 4, s);
    if (!is_zero(c[8])) x += wave_value(c + 8, s);
  }
  return x;
}

/// Time derivative of a segment s seconds after its start.
template <class G>
CLUTCHWORK_INLINE G segment_slope(const G* c, G s) {
  G x = cubic_slope(c, s);
  if (!is_zero(c[4])) {
    x += wave_slope(c + 4, s);
    if (!is_zero(c[8])) x += wave_slope(c + 8, s);
  }
  return x;
}

/// Second time derivative of a segment s seconds after its start.
template <class G>
G segment_curvature(const G* c, G s) {
  auto wave = [&](const G* w) {
    if (is_zero(w[0])) return G(0);
    const G phase = w[1] * s + w[2], fast = w[1] * w[1], slow = w[3] * w[3];
    return w[0] * exp(-w[3] * s) * ((slow - fast) * sin(phase) - G(2) * w[1] * w[3] * cos(phase));
  };
  return G(2) * c[2] + G(6) * c[3] * s + (is_zero(c[4]) ? G(0) : wave(c + 4) + wave(c + 8));
}

/// Integral of a segment from its start to s seconds later.
template <class G>
G segment_integral(const G* c, G s) {
  G x = s * (c[0] + s * (c[1] / G(2) + s * (c[2] / G(3) + s * c[3] / G(4))));
  if (!is_zero(c[4])) {
    x += wave_integral(c + 4, s);
    if (!is_zero(c[8])) x += wave_integral(c + 8, s);
  }
  return x;
}

/// Fastest rate [1/s] of the waves of a segment s seconds after its start; a decay of 25 time constants has died.
template <class G>
double segment_rate(const G* c, double s) {
  auto rate = [&](const G* w) {
    return value(w[0]) == 0 || value(w[3]) * s > 25 ? 0.0 : larger(abs(value(w[1])), abs(value(w[3])));
  };
  return value(c[4]) == 0 ? 0.0 : larger(rate(c + 4), rate(c + 8));
}

/// Largest size of the second time derivative of a segment over h seconds from s on.
template <class G>
double segment_bend(const G* c, double s, double h) {
  auto wave = [&](const G* w) {
    const double decay = value(w[3]), rate = value(w[1]);
    if (value(w[0]) == 0) return 0.0;
    const double start = decay == 0 ? 1.0 : exp(-decay * (decay > 0 ? s : s + h));
    return abs(value(w[0])) * (rate * rate + decay * decay) * start;
  };
  const double waves = value(c[4]) == 0 ? 0.0 : wave(c + 4) + wave(c + 8);
  return 2 * abs(value(c[2])) + 6 * abs(value(c[3])) * larger(abs(s), abs(s + h)) + waves;
}

/// Starts of the n segments of a signal, the repeated ones included: k counts on through the cycles. Times: what gives
/// the start of one of the first n.
template <class G, class Times>
struct Starts {
  std::int64_t n;
  G period;
  Times times;

  G operator()(std::int64_t k) const {
    if (value(period) <= 0) return times[k];
    return times[k % n] + G(double(k / n)) * period;
  }
  bool exist(std::int64_t k) const { return k >= 0 && (value(period) > 0 || k < n); }
  /// A segment that does not start after the one that holds at time t, or is the first one.
  std::int64_t early(double t) const {
    const double cycles = value(period) > 0 ? (t - value(times[0])) / value(period) : 0;
    return cycles > 1 ? (std::int64_t(smaller(cycles, 1e12)) - 1) * n : 0;
  }
};

/// The segments of a signal: those of the system, or those that were set in their place.
template <class G>
struct Segments {
  Starts<Instant<G>, const Instant<G>*> start;
  const G* coef;
};
template <class T>
Segments<Given<T>> segments_of(const Workspace<T>& ws, int i) {
  const int set = ws.in.signal[i].set;
  const std::int64_t first = ws.sys.input_first[i], place = segment_size * first;
  const Instant<Given<T>> period = ws.sys.input_period[i];
  if (set > 0) return {{set, period, ws.in.set_time + first}, ws.in.set_coef + place};
  return {{ws.sys.input_count[i], period, ws.sys.segment_time + first}, ws.sys.segment_coef + place};
}

/// Whether signal i holds a value that comes from outside.
template <class T>
bool is_held(const Workspace<T>& ws, int i) {
  return ws.sys.input_count[i] == 0 || ws.in.signal[i].given;
}

/// Put the cursor of signal i on the segment that holds at time t (right limit).
template <class T>
void seek(Workspace<T>& ws, int i, double t) {
  using G = Given<T>;
  SignalOf<G>& signal = ws.in.signal[i];
  if (is_held(ws, i)) {
    signal.knot = Instant<G>(infinity), signal.coef = nullptr;
    signal.varying = signal.idle = false, signal.linear = true;
    return;
  }
  const auto [start, coef] = segments_of(ws, i);
  while (start.exist(signal.segment + 1) && value(start(signal.segment + 1)) <= t) ++signal.segment;
  const bool started = value(start(signal.segment)) <= t;
  signal.start = start(signal.segment);
  signal.coef = coef + segment_size * (signal.segment % start.n);
  signal.knot = start.exist(signal.segment + 1) ? start(signal.segment + 1) : Instant<G>(infinity);
  signal.idle = false;
  // before its start a periodic signal rests at the value of its last segment
  if (!started && value(start.period) > 0) {
    signal.coef = coef + segment_size * (start.n - 1);
    signal.knot = signal.start;
    signal.idle = true;
  }
  const G* c = signal.coef;
  const bool waves = wave_varies(c + 4) || wave_varies(c + 8);
  signal.varying = !signal.idle && (!is_zero(c[1]) || !is_zero(c[2]) || !is_zero(c[3]) || waves);
  signal.linear = is_zero(c[2]) && is_zero(c[3]) && !waves;
}

/// Time since the start of the present segment of a signal.
template <class T>
CLUTCHWORK_INLINE Given<T> since_start(const Workspace<T>& ws, const SignalOf<Given<T>>& signal, double t) {
  // at an event the present instant moves with what it depends on
  if constexpr (has_tangents<T>)
    return (T(t) - signal.start) + ws.moved.shift;
  else
    return Given<T>(t - signal.start);
}

/// Value of signal i at time t on its present segment.
template <class T>
CLUTCHWORK_INLINE Given<T> signal_value(const Workspace<T>& ws, int i, double t) {
  using G = Given<T>;
  const auto& signal = ws.in.signal[i];
  if (signal.coef == nullptr) return signal.held;
  const G s = signal.idle ? G(0) : since_start(ws, signal, t);
  if (signal.linear && is_zero(signal.coef[4])) return signal.coef[0] + signal.coef[1] * s;
  return segment_value(signal.coef, s);
}

/// Time derivative of signal i at time t on its present segment.
template <class T>
CLUTCHWORK_INLINE Given<T> signal_slope(const Workspace<T>& ws, int i, double t) {
  using G = Given<T>;
  const auto& signal = ws.in.signal[i];
  return signal.varying ? segment_slope(signal.coef, since_start(ws, signal, t)) : G(0);
}

/// Second time derivative of signal i at time t on its present segment.
template <class T>
Given<T> signal_curvature(const Workspace<T>& ws, int i, double t) {
  using G = Given<T>;
  const auto& signal = ws.in.signal[i];
  return signal.varying && !signal.linear ? segment_curvature(signal.coef, since_start(ws, signal, t)) : G(0);
}

/// Bounds of signal i from time t to its next knot; infinite where they are not plain.
template <class T>
void signal_range(const Workspace<T>& ws, int i, double t, double& low, double& high) {
  const auto& signal = ws.in.signal[i];
  // a shared state may go anywhere
  low = -infinity, high = infinity;
  if (i >= ws.sys.inputs) return;
  low = high = double(value(signal_value(ws, i, t)));
  if (!signal.varying) return;
  auto c = [&](int k) { return double(value(signal.coef[k])); };
  const double knot = value(signal.knot);
  if (signal.linear) {
    const double end = knot < infinity ? double(value(signal_value(ws, i, knot))) : c(1) > 0 ? infinity : -infinity;
    low = smaller(low, end), high = larger(high, end);
  } else if (c(1) == 0 && c(2) == 0 && c(3) == 0 && c(7) >= 0 && c(11) >= 0) {
    low = c(0) - abs(c(4)) - abs(c(8)), high = c(0) + abs(c(4)) + abs(c(8));
  } else {
    low = -infinity, high = infinity;
  }
}

/// Bounds of reference `ref` over the h seconds that end where the inputs and their slopes were taken last; false where
/// it is no signal.
template <class T>
bool reference_range(const Workspace<T>& ws, int ref, double h, double& low, double& high) {
  const int i = ws.in.ref_signal[ref];
  if (i >= ws.sys.inputs) return false;
  const auto& signal = ws.in.signal[i];
  low = high = value(ws.in.u[ref]);
  if (!signal.varying) return true;
  // back along the tangent, and what bends away from it
  const double start = low - h * value(ws.in.du[ref]);
  const double bend =
      signal.linear ? 0 : 0.5 * h * h * segment_bend(signal.coef, ws.in.time - h - value(signal.start), h);
  low = smaller(low, start) - bend, high = larger(high, start) + bend;
  return true;
}

/// Whether values of signals may come from outside at time t: what the signals do there waits for them.
/// docs/theory/events.md, rule 2
template <class T>
bool awaits_values(const Workspace<T>& ws, double t) {
  if (ws.in.next_knot < t) return false;
  for (int i = 0; i < ws.sys.inputs; ++i) {
    if (ws.sys.input_count[i] == 0) return true;
  }
  return ws.in.expected;
}

/// Values of all references at time t; only the varying ones are computed again.
template <class T>
CLUTCHWORK_INLINE void inputs_at(Workspace<T>& ws, double t) {
  if (t == ws.in.time) return;
  ws.in.time = t;
  for (int k = 0; k < ws.in.n_varying; ++k) {
    const int ref = ws.in.varying[k];
    ws.in.u[ref] = T(signal_value(ws, ws.in.ref_signal[ref], t));
  }
}

/// Time derivatives of all references at time t.
template <class T>
CLUTCHWORK_INLINE void input_slopes_at(Workspace<T>& ws, double t) {
  for (int k = 0; k < ws.in.n_varying; ++k) {
    const int ref = ws.in.varying[k];
    ws.in.du[ref] = T(signal_slope(ws, ws.in.ref_signal[ref], t));
  }
}

/// A signal on both sides of the knot that the run has reached.
struct Turn {
  double before, after;              ///< values
  double slope_before, slope_after;  ///< [1/s]

  bool jumps() const { return abs(after - before) > 1e-12 * (abs(after) + abs(before)); }
  bool bends() const { return abs(slope_after - slope_before) > 1e-12 * (abs(slope_after) + abs(slope_before)); }
};

/// Whether the run is at a knot of signal i that was not passed yet.
template <class T>
bool is_turning(const Workspace<T>& ws, int i) {
  return value(ws.in.signal[i].knot) <= ws.time && !is_held(ws, i);
}

/// What signal i does at its knot.
template <class T>
Turn turn_of(Workspace<T>& ws, int i) {
  auto& signal = ws.in.signal[i];
  Turn turn;
  turn.before = value(signal_value(ws, i, ws.time)), turn.slope_before = value(signal_slope(ws, i, ws.time));
  const auto present = signal;
  seek(ws, i, ws.time);
  turn.after = value(signal_value(ws, i, ws.time)), turn.slope_after = value(signal_slope(ws, i, ws.time));
  signal = present;
  return turn;
}

/// Whether any signal jumps at the knot that the run has reached.
template <class T>
bool any_jumps(Workspace<T>& ws) {
  for (int i = 0; i < ws.sys.inputs; ++i) {
    if (is_turning(ws, i) && turn_of(ws, i).jumps()) return true;
  }
  return false;
}

/// The prescribed speeds before they jump.
template <class T>
void keep_prescribed(Workspace<T>& ws) {
  for (int p = 0; p < ws.sys.prescribed; ++p) ws.in.prescribed_before[p] = ws.in.prescribed[p];
}

/// Signals with other segments from the present instant on vary no more before the run has passed it.
template <class T>
void rest_fresh(Workspace<T>& ws) {
  int n = 0;
  for (int k = 0; k < ws.in.n_varying; ++k) {
    const int ref = ws.in.varying[k];
    if (!ws.in.signal[ws.in.ref_signal[ref]].fresh) ws.in.varying[n++] = ref;
  }
  ws.in.n_varying = n;
}

/// Take the right limit of every signal at time t: cursors, constants, the list of varying ones, the next knot.
template <class T>
void load_inputs(Workspace<T>& ws, double t) {
  ws.in.n_varying = 0;
  ws.in.next_knot = infinity, ws.in.alone = -1;
  for (int i = 0; i < ws.sys.inputs; ++i) {
    seek(ws, i, t);
    ws.in.signal[i].fresh = false;
    ws.in.next_knot = smaller(ws.in.next_knot, value(ws.in.signal[i].knot));
  }
  ws.in.n_shared_refs = ws.in.n_direction_refs = ws.in.n_rate_refs = 0;
  for (int ref = 0; ref < ws.in.n_refs; ++ref) {
    const int i = ws.in.ref_signal[ref];
    if (i >= ws.sys.inputs) {
      if (i < ws.sys.inputs + ws.sys.shared) {
        ws.in.shared_ref[ws.in.n_shared_refs++] = ref;
      } else if (i >= ws.sys.inputs + ws.sys.shared + 3 * ws.n_directions) {
        // a sum of flows, which is made where those are known
        ws.in.u[ref] = ws.in.du[ref] = T(0);
      } else {
        ws.in.direction_ref[ws.in.n_direction_refs++] = ref;
        const bool rate = i < ws.sys.inputs + ws.sys.shared + ws.sys.elements;
        if (rate && ws.sys.full[0] != 0) ws.in.rate_ref[ws.in.n_rate_refs++] = ref;
      }
      continue;
    }
    ws.in.u[ref] = T(signal_value(ws, i, t));
    ws.in.du[ref] = T(signal_slope(ws, i, t));
    if (ws.in.signal[i].varying) ws.in.varying[ws.in.n_varying++] = ref;
  }
  ws.in.time = t;
}

}  // namespace clutchwork

#pragma once
#include "fingerprint.hpp"
#include "system_checks.hpp"

/// Saved states: what a run is, without pointers and without indices that could be followed. One description,
/// `describe`, serves to measure, write, check and read them; the segments that were set follow it.
/// docs/guide/export.md
namespace clutchwork::saved {

inline constexpr std::int64_t most = std::int64_t(1) << 60;

/// Everything that a saved state holds beside the arrays of the workspace, and those: scalars first, each within
/// bounds. What outlives a call and is neither here nor rebuilt by `resume` is lost.
template <class W, class A>
void describe(W& ws, A& a) {
  const System& s = ws.sys;
  const std::int64_t nc = s.contacts, nd = s.elements + nc;
  visit_options(ws.options, [&](auto& setting, const char*, const OptionRange& range) { a.setting(setting, range); });
  each_statistic(ws.statistics, [&](auto& count) { a.whole(count, 0, most); });

  a.time(ws.time), a.number(ws.last_step, 0, 1e300);
  a.whole(ws.started, 0, 1), a.whole(ws.fresh_phase, 0, 1), a.whole(ws.params_changed, 0, 1);
  a.whole(ws.stiffened, 0, 1), a.whole(ws.guard.strained, 0, 1 << 30);
  a.whole(ws.reduced.method, 1, last_method), a.number(ws.events.crowd_time), a.number(ws.contact.forced_time),
      a.number(ws.in.next_knot);
  a.whole(ws.guard.n_faulty, 0, nc), a.whole(ws.contact.failed, -1, nc - 1), a.whole(ws.guard.n_loads, 0, nc);
  a.whole(ws.guard.reversals, 0, 1 << 30), a.whole(ws.guard.reversals_since, 0, most);
  a.number(ws.guard.balanced_at), a.number(ws.guard.jumped_at), a.number(ws.guard.zero, 0, 1e300);
  a.number(ws.fixed.time), a.number(ws.fixed.before, 0, 1e300), a.number(ws.fixed.origin);
  a.whole(ws.fixed.count, 0, most), a.whole(ws.fixed.impacts, 0, most), a.whole(ws.fixed.fresh, 0, 1);
  a.number(ws.in.time), a.whole(ws.events.n, 0, EventBuffer::room + 3 * nc);
  a.whole(ws.detail.component, -1, nd - 1), a.number(ws.detail.value), a.whole(ws.detail.row, -1, ws.row.size - 1);

  for (std::int64_t i = 0; i < s.inputs; ++i) a.cursor(int(i), ws.in.signal[i]);
  lay_out(ws, a);
  for (std::int64_t i = 0; i < 3 * nd + nc; ++i) a.number(ws.guard.line[i].level);
}

/// Calls f(signal, n) for every signal that has n segments which were set.
template <class W, class F>
void each_set(const W& ws, F&& f) {
  for (int i = 0; i < int(ws.sys.inputs); ++i)
    if (ws.in.signal[i].set > 0) f(i, std::int64_t(ws.in.signal[i].set));
}

/// Numbers of a segment in a saved state: its start, then what it is.
inline constexpr std::int64_t set_size = 1 + segment_size;

/// Bytes of all segments that were set.
inline std::int64_t set_bytes(const Workspace<double>& ws) {
  std::int64_t all = 0;
  each_set(ws, [&](int, std::int64_t n) { all += n; });
  return 8 * set_size * all;
}

/// What the visitors share: arrays and cursors as single words, of which Self takes `number` and `whole`.
template <class Self>
struct Visitor {
  template <class P>
  void take(P* const& p, std::int64_t n) {
    if constexpr (std::is_same_v<P, double>) {
      for (std::int64_t i = 0; i < n; ++i) self().number(p[i]);
    }
  }
  template <class P>
  void scratch(P* const&, std::int64_t) {}
  void keep(int* const& p, std::int64_t n, std::int64_t low, std::int64_t high) {
    for (std::int64_t i = 0; i < n; ++i) self().whole(p[i], low, high);
  }
  template <class X>
  void setting(X& x, const OptionRange& range) {
    const double low = range.unset < range.least ? range.unset : range.least;
    const double high = range.unset > range.most ? range.unset : range.most;
    if constexpr (std::is_same_v<std::remove_const_t<X>, double>) return self().number(x, low, high);
    self().whole(x, std::int64_t(low), std::int64_t(high));
  }
  template <class X>
  void time(X& x) {
    self().number(x, 0, 1e300);
  }
  template <class S>
  void cursor(int, S& signal) {
    self().whole(signal.segment, 0, most), self().whole(signal.idle, 0, 1), self().number(signal.held);
    self().whole(signal.given, 0, 1), self().whole(signal.set, 0, (1ll << 31) - 1);
    self().whole(signal.fresh, 0, 1);
  }

 private:
  Self& self() { return static_cast<Self&>(*this); }
};

/// Bytes that a state needs, and a fingerprint of what stands where.
struct Measure : Visitor<Measure> {
  std::int64_t size = 0;
  std::uint64_t layout = 0;

  void number(const double&, double low = -infinity, double high = infinity) { add(low, high); }
  template <class I>
  void whole(const I&, std::int64_t low, std::int64_t high) {
    add(double(low), double(high));
  }

 private:
  void add(double low, double high) {
    std::uint64_t words[2];
    std::memcpy(words, &low, 8), std::memcpy(words + 1, &high, 8);
    layout = mix(mix(layout, words[0]), words[1]);
    size += 8;
  }
};

struct Writer : Visitor<Writer> {
  unsigned char* at;

  explicit Writer(unsigned char* to) : at(to) {}
  void number(const double& x, double = 0, double = 0) { put(x); }
  template <class I>
  void whole(const I& x, std::int64_t, std::int64_t) {
    put(std::int64_t(x));
  }

 private:
  template <class X>
  void put(X x) {
    std::memcpy(at, &x, 8);
    at += 8;
  }
};

/// The next words of a state.
class Words {
 public:
  explicit Words(const unsigned char* from) : at_(from) {}
  template <class X>
  X next() {
    X x;
    std::memcpy(&x, at_, 8);
    at_ += 8;
    return x;
  }
  const unsigned char* at() const { return at_; }

 private:
  const unsigned char* at_;
};

/// Reads a state that was checked.
struct Reader : Visitor<Reader> {
  Words words;

  explicit Reader(const unsigned char* from) : words(from) {}
  void number(double& x, double = 0, double = 0) { x = words.next<double>(); }
  template <class I>
  void whole(I& x, std::int64_t, std::int64_t) {
    x = I(words.next<std::int64_t>());
  }
};

/// Numbers of a state, wherever they stand.
struct Doubles {
  const unsigned char* from;
  double operator[](std::int64_t k) const { return Words(from + 8 * k).next<double>(); }
};

/// Whether every value of a state is one that a run of this system may have; changes nothing.
class Check : public Visitor<Check> {
 public:
  bool good = true;

  /// The segments that were set stand from `set` up to `end`.
  Check(const Workspace<double>& ws, const unsigned char* from, const unsigned char* set, const unsigned char* end)
      : ws_(ws), words_(from), set_(set), end_(end) {}
  /// Whether all of it was read.
  bool complete() const { return good && set_ == end_; }

  void number(const double& at, double low = -infinity, double high = infinity) {
    const double x = words_.next<double>();
    if (low > -infinity || high < infinity) good = good && x >= low && x <= high;
    if (&at == &ws_.time) time_ = x;
  }
  template <class I>
  void whole(const I& at, std::int64_t low, std::int64_t high) {
    const auto x = words_.next<std::int64_t>();
    good = good && x >= low && x <= high;
    const void* place = &at;
    if (place == &ws_.started) started_ = x != 0;
    if (place == &ws_.events.n) events_ = x;
  }
  template <class P>
  void take(P* const& p, std::int64_t n) {
    if constexpr (!std::is_same_v<P, double>) return;
    const void* place = &p;
    if (place == &ws_.params) return params(n);
    if (place == &ws_.events.at) return events(n);
    for (std::int64_t i = 0; i < n; ++i) words_.next<double>();
  }
  void keep(int* const& p, std::int64_t n, std::int64_t low, std::int64_t high) {
    const bool pieces = &p == &ws_.piece;
    for (std::int64_t i = 0; i < n; ++i) whole(p[i], pieces ? 0 : low, pieces ? last_piece(int(i)) : high);
  }

  /// A signal stands where its times and the time of the run say.
  void cursor(int i, const Signal&) {
    const System& sys = ws_.sys;
    const auto k = words_.next<std::int64_t>();
    const auto idle = words_.next<std::int64_t>();
    good = good && settable(words_.next<double>(), sys.input_value[i]) && k >= 0 && (idle == 0 || idle == 1);
    const auto given = words_.next<std::int64_t>();
    good = good && (given == 0 || (given == 1 && sys.input_count[i] > 0));
    const auto set = words_.next<std::int64_t>();
    const auto fresh = words_.next<std::int64_t>();
    good = good && (fresh == 0 || fresh == 1) && set >= 0 && set <= sys.input_count[i] &&
           set <= (end_ - set_) / (8 * set_size);
    if (!started_ || sys.input_count[i] == 0) good = good && k == 0 && idle == 0;
    if (!good) return;
    const double period = sys.input_period[i];
    if (set == 0) return stands(Starts<double, const double*>{sys.input_count[i], period, start_of(i)}, k, idle, given);
    const Doubles times{set_};
    set_ += 8 * set_size * set;
    for (std::int64_t j = 0; j < set_size * set; ++j) good = good && times[j] - times[j] == 0;
    good = good && in_order(set, period, times);
    stands(Starts<double, Doubles>{set, period, times}, k, idle, given);
  }

 private:
  const Workspace<double>& ws_;
  Words words_;
  const unsigned char *set_, *end_;
  double time_ = 0;

  const double* start_of(int i) const { return ws_.sys.segment_time + ws_.sys.input_first[i]; }

  /// Whether segment k is where a signal can be, resting before its start or held.
  template <class Times>
  void stands(const Starts<double, Times>& start, std::int64_t k, std::int64_t idle, std::int64_t given) {
    if (!good || !started_ || start.n == 0) return;
    const bool repeats = start.period > 0;
    const bool exists = repeats ? k < (std::int64_t(1) << 52) : k < start.n;
    // held it stands on a segment that it was on before
    if (given != 0) {
      good = exists && (k == 0 || start(k) <= time_);
    } else if (idle != 0) {
      good = repeats && k == 0 && time_ <= start(k);
    } else {
      const bool begun = k > 0 || repeats;
      good = exists && (!begun || start(k) <= time_) && (!start.exist(k + 1) || time_ <= start(k + 1));
    }
  }
  bool started_ = false;
  std::int64_t events_ = 0;

  static bool settable(double x, double loaded) { return x - x == 0 || std::memcmp(&x, &loaded, sizeof x) == 0; }

  /// Where curves stand and what is one of a few words never changes.
  void params(std::int64_t n) {
    for (std::int64_t i = 0; i < n; ++i) {
      const double x = words_.next<double>(), loaded = ws_.sys.params[i];
      good = good && settable(x, loaded) &&
             (x == loaded || std::memcmp(&x, &loaded, sizeof x) == 0 || !is_fixed(ws_.sys, i));
    }
  }

  /// Waiting events name contacts, modes and causes.
  void events(std::int64_t n) {
    for (std::int64_t i = 0; i < n; ++i) {
      const double x = words_.next<double>();
      const std::int64_t column = i % event_size;
      if (i / event_size >= events_ || column > 4) continue;
      const double low[] = {0, 0, backward, backward, 0};
      const double high[] = {1e300, double(ws_.sys.contacts - 1), open, open, double(last_cause)};
      good = good && x >= low[column] && x <= high[column] && (column == 0 || x == double(int(x)));
    }
  }

  /// Largest number of a piece of a direction: between kinks, or as the law that switches numbers them.
  std::int64_t last_piece(int d) const {
    auto last = [&](auto tag) -> std::int64_t {
      if constexpr (SwitchingLaw<typename decltype(tag)::type>) return (std::int64_t(1) << 31) - 1;
      return edge_count(ws_, d);
    };
    const System& sys = ws_.sys;
    if (d < sys.elements) return visit_torque(sys.element_kind[d], last);
    return visit_law(sys.contact_law[d - sys.elements], last);
  }
};

/// The signals on the segments that the cursors say, and what follows from them.
inline void place_cursors(Workspace<double>& ws) {
  // any instant at which all of them were there; one before its first segment is not passed
  double t = -infinity;
  for (int i = 0; i < ws.sys.inputs; ++i) {
    const Signal& signal = ws.in.signal[i];
    const bool begun = signal.segment > 0 || (ws.sys.input_period[i] > 0 && !signal.idle);
    if (!is_held(ws, i) && begun) t = larger(t, segments_of(ws, i).start(signal.segment));
  }
  load_inputs(ws, t);
}

/// The segments that were set, behind all else.
inline void put_set(const Workspace<double>& ws, unsigned char* to) {
  each_set(ws, [&](int i, std::int64_t n) {
    const auto [start, coef] = segments_of(ws, i);
    std::memcpy(to, start.times, std::size_t(8 * n)), std::memcpy(to + 8 * n, coef, std::size_t(8 * segment_size * n));
    to += 8 * set_size * n;
  });
}
inline void take_set(Workspace<double>& ws, const unsigned char* from) {
  each_set(ws, [&](int i, std::int64_t n) {
    const std::int64_t first = ws.sys.input_first[i];
    std::memcpy(ws.in.set_time + first, from, std::size_t(8 * n));
    std::memcpy(ws.in.set_coef + segment_size * first, from + 8 * n, std::size_t(8 * segment_size * n));
    from += 8 * set_size * n;
  });
}

/// Make the indices of a run anew from what is read: signals, modes, branches, guards. The numbers are read once more,
/// because some are those of the instant at which the phase began.
inline void resume(Workspace<double>& ws, const unsigned char* bytes) {
  auto read = [&] {
    Reader reader(bytes);
    describe(ws, reader);
    return reader.words.at();
  };
  const System& sys = ws.sys;
  take_set(ws, read());
  if (!ws.started) return;
  if (!prepare_geometry(ws)) {
    ws.started = false;
    return;
  }
  prepare_loads(ws);
  list_processes(ws);
  for (int c = 0; c < sys.contacts; ++c) ws.contact.compliant[c] = is_compliant_law(sys.contact_law[c]);
  for (int d = 0; d < ws.n_directions; ++d) ws.branch_of[d] = -1;
  place_cursors(ws);
  // fixed steps have no phase
  if (ws.options.method == Method::fixed && ws.fixed.time == ws.time) {
    read();
    rest_fresh(ws);
    ws.fresh_phase = true;
    return;
  }
  // so was the choice of the method
  ws.options.method = ws.reduced.method;
  const bool entered = enter_mode(ws, true);
  read();
  for (int i = 0; i < ws.guard.n_lines; ++i) {
    LineGuard& line = ws.guard.line[i];
    if (line.kind == LineGuard::turn) line.sign = ws.heading[ws.branch[line.branch].direction];
  }
  rest_fresh(ws);
  ws.fresh_phase = ws.fresh_phase || !entered;
}

/// The arrays of a run as they stand, fences included.
#ifdef __SANITIZE_ADDRESS__
__attribute__((no_sanitize("address"))) inline void copy_arrays(unsigned char* to, const unsigned char* from,
                                                                std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) to[i] = from[i];
}
#else
inline void copy_arrays(unsigned char* to, const unsigned char* from, std::int64_t n) {
  std::memcpy(to, from, std::size_t(n));
}
#endif

}  // namespace clutchwork::saved

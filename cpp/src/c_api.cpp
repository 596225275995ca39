#include <clutchwork/c_api.h>
#include <clutchwork/run/fixed/single.hpp>
#include <clutchwork/run/placed.hpp>

#include <algorithm>
#include <new>
#include "lanes.hpp"
#include "local.hpp"
#include "saved.hpp"

using namespace clutchwork;

/// A run and where it lives; its arrays follow it in the same memory.
struct cw_run {
  Workspace<double> ws;
  const unsigned char* system;
  std::int64_t system_bytes;
  std::uint64_t fingerprint;  ///< of the system
  unsigned char* arrays;
  std::int64_t bytes;
  mutable saved::Measure measure;  ///< of its states, taken once: it follows from the system
};

namespace {

constexpr std::int64_t head = (std::int64_t(sizeof(cw_run)) + 63) / 64 * 64;

/// Lay out the arrays of a run, and what is behind them; returns the size needed.
std::int64_t lay(Workspace<double>& ws, unsigned char* arrays) {
  const std::int64_t size = carve(ws, arrays);
#ifdef CLUTCHWORK_SINGLE
  const std::int64_t behind = (size + 63) / 64 * 64;
  ws.fixed.image = arrays == nullptr ? nullptr : arrays + behind;
  return behind + fixed::single_size(ws.sys);
#else
  return size;
#endif
}

/// A run at time zero in its own memory, whatever was there before.
void reset(cw_run* run) {
  Workspace<double>& ws = run->ws;
  drop_fences(run->arrays, run->bytes - head);
  std::memset(static_cast<void*>(run->arrays), 0, std::size_t(run->bytes - head));
  ws = Workspace<double>{};
  bind(ws.sys, run->system, run->system_bytes);
  ws.row = RowLayout(ws.sys);
  lay(ws, run->arrays);
  for (std::int64_t i = 0; i < ws.sys.n_input_refs; ++i) ws.in.ref_signal[i] = ws.sys.input_refs[i];
  for (std::int64_t p = 0; p < ws.sys.prescribed; ++p)
    ws.in.ref_signal[ws.sys.n_input_refs + p] = ws.sys.prescribed_input[p];
  for (std::int64_t i = 0; i < ws.sys.n_params; ++i) ws.params[i] = ws.sys.params[i];
  for (std::int64_t i = 0; i < ws.sys.inputs; ++i) {
    ws.in.signal[i] = Signal{};
    ws.in.signal[i].held = ws.sys.input_value[i];
  }
}

bool is_finite(double x) { return x - x == 0; }

/// Present time; before the start the one at which it will be.
double present(const Workspace<double>& ws) { return ws.started ? ws.time : ws.options.t_start; }

/// A signal steps at the present time; `alone`: its value is all that changes, -1: its segments do.
void make_knot(Workspace<double>& ws, int alone = -1) {
  const bool first = alone >= 0 && ws.in.next_knot > ws.time;
  if (first) ws.in.alone = alone, ws.in.knot_behind = ws.in.next_knot;
  if (!first && ws.in.alone != alone) ws.in.alone = -1;
  ws.in.next_knot = -infinity;
  // before the first step the value belongs to the start, which is decided anew
  if (ws.statistics.steps + ws.statistics.rejected > 0) return;
  ws.started = false;
  for (std::int64_t i = 0; i < ws.sys.inputs; ++i) ws.in.signal[i].segment = 0, ws.in.signal[i].idle = false;
}

/// Left limits of all signals at the present time, before one of them gets other segments.
void keep_left(Workspace<double>& ws) {
  if (ws.started) inputs_at(ws, ws.time), input_slopes_at(ws, ws.time);
}

/// A signal goes on with its segments from the present time on, which has its left limit still.
void follow(Workspace<double>& ws, int i) {
  Signal& signal = ws.in.signal[i];
  signal.given = signal.idle = false;
  make_knot(ws);
  signal.fresh = ws.started;
  if (!ws.started) return;
  rest_fresh(ws);
  // a saved state stands on the segment of its time
  const std::int64_t early = segments_of(ws, i).start.early(ws.time);
  if (signal.segment < early) signal.segment = early;
  seek(ws, i, ws.time);
}

/// Where rows go, for a call that advances a run; other than 0: what the call returns at once.
int take_sink(Sink& sink, cw_run* run, double t_end, double* times, double* rows, std::int64_t n, int steps) {
  if (run == nullptr || !is_finite(t_end) || t_end < present(run->ws) || n < 0 || steps < 0) return -1;
  if (n > 0 && (times == nullptr || rows == nullptr)) return -1;
  // a step fills its rows and up to two more, at an event
  if (steps > 0 && n < std::int64_t(steps) + 2) return int(Status::rows_full);
  sink.times = times, sink.rows = rows, sink.count = n, sink.steps = steps;
  run->ws.detail.row = -1;
  return 0;
}

/// What points into the memory or the system of another run points into those of this one.
void move_pointers(cw_run* run, const cw_run& other) {
  auto moved = [&](const double*& p) {
    const auto* at = reinterpret_cast<const unsigned char*>(p);
    if (at >= other.arrays && at < other.arrays + other.bytes - head)
      at = run->arrays + (at - other.arrays);
    else if (at >= other.system && at < other.system + other.system_bytes)
      at = run->system + (at - other.system);
    p = reinterpret_cast<const double*>(at);
  };
  Workspace<double>& ws = run->ws;
  for (int k = 0; k < ws.n_directions; ++k) {
    Branch<double>& b = ws.branch[k];
    for (auto* p : {&b.params, &b.law_params, &b.input, &b.input_slope, &b.law_input, &b.law_input_slope}) moved(*p);
  }
  for (std::int64_t i = 0; i < ws.sys.inputs; ++i) moved(ws.in.signal[i].coef);
}

const saved::Measure& measured(const cw_run* run) {
  if (run->measure.size == 0) saved::describe(run->ws, run->measure);
  return run->measure;
}

/// What stands before the states of a run, the checksum left out.
struct Head {
  std::uint64_t word[state_head::words];

  Head(const cw_run* run, const saved::Measure& m, std::int64_t size)
      : word{state_head::name, std::uint64_t(schema_hash), m.layout, run->fingerprint, std::uint64_t(size), 0} {}
};

}  // namespace

extern "C" {

std::int64_t cw_schema_hash(void) { return schema_hash; }

std::int64_t cw_size(const void* system, std::int64_t bytes) {
  Workspace<double> ws;
  if (system == nullptr || bind(ws.sys, static_cast<const unsigned char*>(system), bytes) < 0 || !in_range(ws.sys))
    return -1;
  return head + lay(ws, nullptr);
}

std::int64_t cw_single_size(const void* system, std::int64_t bytes) {
  const std::int64_t size = cw_size(system, bytes);
  if (size < 0) return -1;
  System sys;
  bind(sys, static_cast<const unsigned char*>(system), bytes);
  return size + fixed::extra_size(sys);
}

cw_run* cw_load(const void* system, std::int64_t bytes, void* memory, std::int64_t memory_bytes) {
  const std::int64_t size = cw_size(system, bytes);
  if (size < 0 || memory_bytes < size || memory == nullptr) return nullptr;
  cw_run* run = new (memory) cw_run;
  run->system = static_cast<const unsigned char*>(system);
  run->system_bytes = bind(run->ws.sys, run->system, bytes);
  run->fingerprint = fingerprint(run->system, run->system_bytes);
  run->arrays = static_cast<unsigned char*>(memory) + head;
  run->bytes = size;
  reset(run);
  return run;
}

int cw_set_option(cw_run* run, const char* name, double value) {
  if (run == nullptr || name == nullptr) return 0;
  int done = 0;
  visit_options(run->ws.options, [&](auto& setting, const char* known, const OptionRange& range) {
    if (std::strcmp(name, known) != 0 || !range.allows(value)) return;
    setting = static_cast<std::remove_reference_t<decltype(setting)>>(value);
    done = 1;
  });
  return done;
}

int cw_set_input(cw_run* run, std::int64_t input, double value) {
  if (run == nullptr || !is_finite(value) || input < 0 || input >= run->ws.sys.inputs) return 0;
  Signal& signal = run->ws.in.signal[input];
  // what the other signals do at this instant has waited for it
  if (is_held(run->ws, int(input)) && signal.held == value && run->ws.in.next_knot > run->ws.time) return 1;
  signal.held = value;
  signal.given = run->ws.sys.input_count[input] != 0;
  make_knot(run->ws, int(input));
  return 1;
}

int cw_release_input(cw_run* run, std::int64_t input) {
  if (run == nullptr || input < 0 || input >= run->ws.sys.inputs || run->ws.sys.input_count[input] == 0) return 0;
  Signal& signal = run->ws.in.signal[input];
  if (!signal.given && signal.set == 0) return 1;
  keep_left(run->ws);
  if (signal.set != 0) signal.segment = 0, signal.set = 0;
  begin_sums(run->ws);
  follow(run->ws, int(input));
  return 1;
}

int cw_set_segments(cw_run* run, std::int64_t input, const double* times, const double* coefficients, std::int64_t n) {
  if (run == nullptr || times == nullptr || coefficients == nullptr || input < 0 || input >= run->ws.sys.inputs)
    return 0;
  Workspace<double>& ws = run->ws;
  const auto [start, coef] = segments_of(ws, int(input));
  if (n < 1 || n > ws.sys.input_count[input] || !in_order(n, start.period, times)) return 0;
  for (std::int64_t k = 0; k < n; ++k) {
    if (!is_finite(times[k])) return 0;
  }
  for (std::int64_t k = 0; k < segment_size * n; ++k) {
    if (!is_finite(coefficients[k])) return 0;
#ifdef CLUTCHWORK_SINGLE
    // its steps refuse waves
    if (k % segment_size % 4 == 0 && k % segment_size > 0 && coefficients[k] != 0) return 0;
#endif
  }
  auto same = [](const double* a, const double* b, std::int64_t m) {
    return std::memcmp(a, b, std::size_t(8 * m)) == 0;
  };
  Signal& signal = ws.in.signal[input];
  if (!signal.given && n == start.n && same(times, start.times, n) && same(coefficients, coef, segment_size * n) &&
      ws.in.next_knot > ws.time)
    return 1;
  keep_left(ws);
  const std::int64_t first = ws.sys.input_first[input];
  std::memmove(ws.in.set_time + first, times, std::size_t(8 * n));
  std::memmove(ws.in.set_coef + segment_size * first, coefficients, std::size_t(8 * segment_size * n));
  signal.set = int(n), signal.segment = 0;
  follow(ws, int(input));
  return 1;
}

int cw_expect_inputs(cw_run* run, int expected) {
  if (run == nullptr) return 0;
  run->ws.in.expected = expected != 0;
  return 1;
}

int cw_read(cw_run* run, const std::int64_t* numbers, std::int64_t n, const std::int64_t* inside,
            std::int64_t n_inside) {
  if (run == nullptr || n < 0 || n_inside < 0 || (n > 0 && numbers == nullptr) || (n_inside > 0 && inside == nullptr))
    return 0;
  Workspace<double>& ws = run->ws;
  const RowLayout& row = ws.row;
  for (std::int64_t i = 0; i < n + n_inside; ++i) {
    const std::int64_t at = i < n ? numbers[i] : inside[i - n];
    if (at < 0 || at >= row.size) return 0;
  }
  auto lacked = [&](auto&& is_part) {
    if (std::any_of(inside, inside + n_inside, is_part)) return 0;
    return std::any_of(numbers, numbers + n, is_part) ? 1 : 2;
  };
  ws.out.read = {numbers, n}, ws.out.inside = {inside, n_inside};
  ws.out.lacks_angles = lacked([&](std::int64_t at) { return at >= row.angle && at < row.acceleration; });
  const int work = lacked([&](std::int64_t at) {
    return (at >= row.element_work && at < row.contact_mode) || (at >= row.prescribed_work && at < row.supply_power) ||
           (at >= row.supply_energy && at < row.input);
  });
  // the steps of such a motion follow its work
  ws.out.lacks_work = ws.sys.prescribed > 0 && work == 2 ? 1 : work;
  return 1;
}

int cw_set_param(cw_run* run, std::int64_t offset, double value) {
  if (run == nullptr || !is_finite(value)) return 0;
  Workspace<double>& ws = run->ws;
  if (offset < 0 || offset >= ws.sys.n_params || is_fixed(ws.sys, offset)) return 0;
  ws.params[offset] = value;
  ws.params_changed = true;
  return 1;
}

int cw_set_poll(cw_run* run, int (*poll)(void*), void* context) {
  if (run == nullptr) return 0;
  run->ws.poll = {poll, context};
  return 1;
}

int cw_advance(cw_run* run, double t_end, double* times, double* rows, std::int64_t n, int steps,
               std::int64_t* filled) {
  if (filled != nullptr) *filled = 0;
  Sink sink;
  const int refused = take_sink(sink, run, t_end, times, rows, n, steps);
  if (refused != 0) return refused;
  const Status status = advance(run->ws, t_end, sink);
  if (filled != nullptr) *filled = sink.at;
  return int(status);
}

int cw_advance_spaced(cw_run* run, double t_end, double spacing, double* times, double* rows, std::int64_t n,
                      std::int64_t* filled) {
  if (filled != nullptr) *filled = 0;
  Sink sink;
  if (!(spacing > 0)) return -1;
  const int refused = take_sink(sink, run, t_end, times, rows, n, 1);
  if (refused != 0) return refused;
  sink.spacing = spacing;
  const double most = (t_end - present(run->ws)) / spacing;
  if (!(most + 4 <= double(n))) return int(Status::rows_full);
  const Status status = advance(run->ws, t_end, sink);
  if (filled != nullptr) *filled = sink.at;
  return int(status);
}

int cw_advance_to_event(cw_run* run, double t_end) {
  Sink sink;
  const int refused = take_sink(sink, run, t_end, nullptr, nullptr, 0, 0);
  return refused != 0 ? refused : int(advance(run->ws, t_end, sink, true));
}

double cw_next_knot(const cw_run* run) {
  double next = infinity;
  for (std::int64_t i = 0; run != nullptr && i < run->ws.sys.inputs; ++i) {
    if (is_held(run->ws, int(i))) continue;
    const auto start = segments_of(run->ws, int(i)).start;
    // the present segment has begun, unless it waits for its first cycle
    const Signal& signal = run->ws.in.signal[i];
    std::int64_t k = run->ws.started ? signal.segment + (signal.idle ? 0 : 1) : 0;
    while (start.exist(k) && start(k) <= present(run->ws)) ++k;
    // the first segment holds before its start too, but for one that repeats
    if (start.exist(k) && (k > 0 || start.period > 0)) next = smaller(next, start(k));
  }
  return next;
}

std::int64_t cw_group_size(const cw_run* run) { return run == nullptr ? -1 : group_size(run->ws.sys); }

int cw_advance_group(cw_member* members, std::int64_t count, double t_end, void* memory, std::int64_t memory_bytes) {
  if (count < 0 || (count > 0 && members == nullptr) || memory_bytes < 0) return -1;
  for (std::int64_t i = 0; i < count; ++i) {
    if (members[i].run == nullptr) return -1;
    const std::int64_t size = cw_group_size(members[i].run);
    if (size > 0 && (memory == nullptr || memory_bytes < size)) return -1;
  }
  for (std::int64_t first = 0; first < count; first += most_together) {
    Sink sinks[most_together];
    Workspace<double>* runs[most_together];
    Status statuses[most_together];
    cw_member* taken[most_together];
    int n = 0;
    for (std::int64_t i = first; i < count && i < first + most_together; ++i) {
      cw_member& m = members[i];
      sinks[n] = Sink{};
      m.filled = 0;
      m.status = take_sink(sinks[n], m.run, t_end, m.times, m.rows, m.n, m.steps);
      if (m.status == 0) runs[n] = &m.run->ws, taken[n++] = &m;
    }
    if (n > 0) advance_group(runs, sinks, statuses, n, t_end, memory);
    for (int i = 0; i < n; ++i) taken[i]->status = int(statuses[i]), taken[i]->filled = sinks[i].at;
  }
  return 0;
}

double cw_time(const cw_run* run) { return run == nullptr ? __builtin_nan("") : present(run->ws); }

std::int64_t cw_row_size(const cw_run* run) { return run == nullptr ? -1 : run->ws.row.size; }

int cw_row(cw_run* run, double* row) {
  if (run == nullptr) return -1;
  double t = present(run->ws);
  return cw_advance(run, t, &t, row, 1, 0, nullptr);
}

void cw_local_size(const cw_run* run, std::int64_t* rows, std::int64_t* columns) {
  if (run == nullptr || rows == nullptr || columns == nullptr) return;
  const LocalSizes sizes(run->ws.sys);
  *rows = sizes.rows, *columns = sizes.columns;
}

int cw_local(cw_run* run, double* row, double* matrix) {
  if (run == nullptr || row == nullptr || matrix == nullptr) return -1;
  const int status = cw_row(run, row);
  if (status == int(Status::done)) fill_local(run->ws, matrix);
  run->ws.linearized = false;
  return status;
}

void cw_place_size(const cw_run* run, std::int64_t* states, std::int64_t* margins) {
  if (run == nullptr || states == nullptr || margins == nullptr) return;
  *states = count_placed(run->ws), *margins = count_margins(run->ws);
}

void cw_states(const cw_run* run, double* x) {
  if (run == nullptr || x == nullptr || !run->ws.started) return;
  each_placed(const_cast<cw_run*>(run)->ws, [&](std::int64_t i, double& place) { x[i] = place; });
}

int cw_place_input(cw_run* run, std::int64_t input, double value, double slope) {
  if (run == nullptr || !run->ws.started) return cw_set_input(run, input, value);
  if (!is_finite(value) || !is_finite(slope) || input < 0 || input >= run->ws.sys.inputs) return 0;
  place_input(run->ws, int(input), value, slope);
  return 1;
}

int cw_place(cw_run* run, double t, const double* x, double* row) {
  if (run == nullptr || x == nullptr || row == nullptr || !run->ws.started || !is_finite(t)) return -1;
  for (std::int64_t i = 0; i < count_placed(run->ws); ++i) {
    if (!is_finite(x[i])) return -1;
  }
  take_placed(run->ws, t, x);
  return int(look_placed(run->ws, row));
}

void cw_rates(const cw_run* run, double* dx) {
  if (run != nullptr && dx != nullptr && run->ws.started) placed_rates(run->ws, dx);
}

void cw_margins(cw_run* run, double* margins) {
  if (run != nullptr && margins != nullptr && run->ws.started) placed_margins(run->ws, margins);
}

int cw_decide(cw_run* run, int anew, double* row, double* margins) {
  if (run == nullptr || row == nullptr || !run->ws.started) return -1;
  if (margins == nullptr && count_margins(run->ws) > 0) return -1;
  return int(decide_placed(run->ws, anew != 0, row, margins));
}

std::int64_t cw_event_size(void) { return event_size; }

std::int64_t cw_pending_events(const cw_run* run) { return run == nullptr ? -1 : run->ws.events.n; }

std::int64_t cw_take_events(cw_run* run, double* events, std::int64_t room) {
  if (run == nullptr || room < 0 || (events == nullptr && room > 0)) return -1;
  Workspace<double>& ws = run->ws;
  const std::int64_t n = ws.events.n < room ? ws.events.n : room;
  if (n == 0) return 0;
  std::memcpy(events, ws.events.at, std::size_t(n * event_size) * sizeof(double));
  std::memmove(ws.events.at, ws.events.at + n * event_size,
               std::size_t((ws.events.n - n) * event_size) * sizeof(double));
  ws.events.n -= int(n);
  return n;
}

void cw_statistics(const cw_run* run, std::int64_t counts[7]) {
  if (run == nullptr || counts == nullptr) return;
  static_assert(n_statistics == 7, "c_api.h: cw_statistics says otherwise how many counters there are");
  each_statistic(run->ws.statistics, [&](std::int64_t count) { *counts++ = count; });
}

std::int64_t cw_detail(const cw_run* run, double* value) {
  if (run == nullptr) return -1;
  if (value != nullptr) *value = run->ws.detail.value;
  return run->ws.detail.component;
}

std::int64_t cw_detail_row(const cw_run* run) { return run == nullptr ? -1 : run->ws.detail.row; }

std::int64_t cw_state_size(const cw_run* run) {
  return run == nullptr ? -1 : state_head::bytes + measured(run).size + saved::set_bytes(run->ws);
}

std::int64_t cw_save(const cw_run* run, void* bytes, std::int64_t room) {
  if (run == nullptr || bytes == nullptr) return -1;
  const saved::Measure& m = measured(run);
  const std::int64_t size = state_head::bytes + m.size + saved::set_bytes(run->ws);
  const Head head(run, m, size);
  if (room < size) return -1;
  auto* to = static_cast<unsigned char*>(bytes);
  std::memcpy(to, head.word, sizeof head.word);
  saved::Writer writer(to + state_head::bytes);
  saved::describe(run->ws, writer);
  saved::put_set(run->ws, writer.at);
  const std::uint64_t sum = state_head::checksum_of(to, size);
  std::memcpy(to + 8 * state_head::checksum, &sum, 8);
  return size;
}

int cw_restore(cw_run* run, const void* bytes, std::int64_t n) {
  if (run == nullptr || bytes == nullptr) return 0;
  const auto* from = static_cast<const unsigned char*>(bytes);
  const saved::Measure& m = measured(run);
  const Head head(run, m, n);
  const std::int64_t set = state_head::bytes + m.size;
  if (n < set || std::memcmp(from, head.word, 8 * state_head::checksum) != 0) return 0;
  const std::uint64_t sum = state_head::checksum_of(from, n);
  if (std::memcmp(from + 8 * state_head::checksum, &sum, 8) != 0) return 0;
  saved::Check check(run->ws, from + state_head::bytes, from + set, from + n);
  saved::describe(run->ws, check);
  if (!check.complete()) return 0;
  const Poll poll = run->ws.poll;
  const bool expected = run->ws.in.expected;
  reset(run);
  run->ws.poll = poll;
  run->ws.in.expected = expected;
  saved::resume(run->ws, from + state_head::bytes);
  return 1;
}

std::int64_t cw_copy(const cw_run* run, void* copy, std::int64_t room) {
  if (run == nullptr || copy == nullptr || room < run->bytes) return -1;
  auto* to = static_cast<unsigned char*>(copy);
  std::memcpy(to, run, sizeof(cw_run));
  saved::copy_arrays(to + head, run->arrays, run->bytes - head);
  return run->bytes;
}

int cw_paste(cw_run* run, const void* copy, std::int64_t bytes) {
  if (run == nullptr || copy == nullptr || bytes != run->bytes) return 0;
  const auto* from = static_cast<const unsigned char*>(copy);
  alignas(cw_run) unsigned char own[sizeof(cw_run)];
  std::memcpy(own, from, sizeof own);
  const cw_run& other = *reinterpret_cast<const cw_run*>(own);
  if (other.bytes != bytes || other.fingerprint != run->fingerprint) return 0;
  const Poll poll = run->ws.poll;
  const bool expected = run->ws.in.expected;
  drop_fences(run->arrays, run->bytes - head);
  run->ws = other.ws;
  run->ws.poll = poll;
  run->ws.in.expected = expected;
  run->ws.linearized = false;
  // where everything is in the memory of this run
  bind(run->ws.sys, run->system, run->system_bytes);
  std::memcpy(run->arrays, from + head, std::size_t(bytes - head));
  lay(run->ws, run->arrays);
#ifdef CLUTCHWORK_SINGLE
  run->ws.fixed.ready = false;
#endif
  if (other.arrays != run->arrays || other.system != run->system) move_pointers(run, other);
  return 1;
}

int cw_law(int number, const double* params, const double* inputs, const double* points, std::int64_t n_points,
           double slip, double* kinetic, double* hold) {
  if (!has_law(number) || params == nullptr || kinetic == nullptr || hold == nullptr) return 0;
  bool has_curves = false;
  visit_law_curves(number, [&](int) { has_curves = true; });
  visit_law(number, [&](auto tag) {
    using L = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename L::template Params<double>*>(params);
    int piece = 0;
    if constexpr (Kinked<L>) {
      const int edges = n_points > 0 || !has_curves ? L::edges(p) : 0;
      while (piece < edges && L::edge(p, points, piece) <= slip) ++piece;
    }
    At<double> at{slip, nullptr, inputs, piece, points};
    if constexpr (Settling<L>) at.piece = L::settle(p, at);
    if constexpr (StickingLaw<L>) *kinetic = L::slide(p, at);
    if constexpr (CompliantLaw<L>) {
      // with states the coefficient depends on what went before
      *kinetic = __builtin_nan("");
      if constexpr (L::states == 0) *kinetic = L::coefficient(p, at);
    }
    *hold = L::hold(p, at);
  });
  return 1;
}

}  // extern "C"

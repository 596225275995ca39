#pragma once
#include <clutchwork/components/tangent.hpp>

#include <cstring>
#include <new>
// the image of a run is plain: what the core has of that is compiled here too
#define CLUTCHWORK_COMPONENTS
#include "../system_checks.hpp"
#include "lifted.hpp"
#include "tangents.hpp"

/// A run with derivatives in some directions, for registers of R numbers.
namespace clutchwork {

template <int N, int R>
struct TangentRun {
  using Number = Tangent<N, R>;
  Workspace<Number> ws;
  Workspace<double> image;
  System plain;
  const unsigned char* system;
};

/// What c_api.h says of these runs.
template <int N, int R>
struct TangentCalls {
  using Run = TangentRun<N, R>;
  static constexpr std::int64_t head = (std::int64_t(sizeof(Run)) + 63) / 64 * 64;

  static Run& run_at(void* run) { return *static_cast<Run*>(run); }

  /// Lay out the numbers of the model and the arrays of the run; the size of both.
  static std::int64_t lay_out(Run& run, unsigned char* memory) {
    Arena numbers(memory);
    lift(run.ws, run.plain, numbers);
    run.ws.row = RowLayout(run.plain);
    std::int64_t size = (numbers.size() + 63) / 64 * 64;
    size = (size + carve(run.ws, memory == nullptr ? nullptr : memory + size) + 63) / 64 * 64;
    return size + carve_image(run.ws, run.image, run.plain, memory == nullptr ? nullptr : memory + size);
  }

  static std::int64_t size(const void* system, std::int64_t bytes) {
    Run run{};
    if (system == nullptr || bind(run.plain, static_cast<const unsigned char*>(system), bytes) < 0) return -1;
    return in_range(run.plain) ? head + lay_out(run, nullptr) + 64 : -1;
  }

  static void* load(const void* system, std::int64_t bytes, void* memory, std::int64_t memory_bytes) {
    const std::int64_t needed = size(system, bytes);
    if (needed < 0 || memory_bytes < needed || memory == nullptr) return nullptr;
    auto* at = reinterpret_cast<unsigned char*>((reinterpret_cast<std::uintptr_t>(memory) + 63) / 64 * 64);
    std::memset(at, 0, std::size_t(needed - 64));
    auto* run = new (at) Run{};
    run->system = static_cast<const unsigned char*>(system);
    bind(run->plain, run->system, bytes);
    lay_out(*run, at + head);
    // until a number is seeded
    run->ws.moved.directions = 0, run->ws.moved.begin = infinity;
    return run;
  }

  static int set_option(void* run, const char* name, double value) {
    int done = 0;
    visit_options(run_at(run).ws.options, [&](auto& setting, const char* known, const OptionRange& range) {
      if (std::strcmp(name, known) != 0 || !range.allows(value)) return;
      setting = static_cast<std::remove_reference_t<decltype(setting)>>(value);
      done = 1;
    });
    return done;
  }

  static int leave_out_work(void* run) { return clutchwork::leave_out_work(run_at(run).ws); }

  static int seed(void* at, std::int64_t word, int direction, double slope) {
    Run& run = run_at(at);
    auto* number = number_at(run.ws, run.plain, run.system, word);
    if (number == nullptr || run.ws.started) return 0;
    number->slope(direction) += slope;
    auto& moved = run.ws.moved;
    moved.directions = larger(moved.directions, direction + 1);
    moved.begin = smaller(moved.begin, begin_of(run.plain, run.system, word));
    return 1;
  }

  static int advance(void* at, double t_end, const double* times, double* rows, double* tangents, std::int64_t n,
                     std::int64_t* filled) {
    Run& run = run_at(at);
    Sink sink;
    sink.times = const_cast<double*>(times), sink.rows = rows, sink.tangents = tangents, sink.count = n;
    if (!run.ws.started) begin_lifted(run.ws);
    const Status status = clutchwork::advance(run.ws, t_end, sink);
    if (filled != nullptr) *filled = sink.at;
    return int(status);
  }

  static std::int64_t events(void* at, double* events, double* tangents, std::int64_t most) {
    auto& ws = run_at(at).ws;
    const std::int64_t n = smaller<std::int64_t>(ws.events.n, most);
    for (std::int64_t i = 0; i < n * event_size; ++i) events[i] = ws.events.at[i];
    for (std::int64_t i = 0; i < n; ++i) keep(ws.moved.event[i], tangents + i * N);
    for (std::int64_t i = n * event_size; i < ws.events.n * event_size; ++i)
      ws.events.at[i - n * event_size] = ws.events.at[i];
    for (std::int64_t i = n; i < ws.events.n; ++i) ws.moved.event[i - n] = ws.moved.event[i];
    ws.events.n -= int(n);
    return n;
  }

  static std::int64_t grazes(void* at, double* grazes, double* tangents, std::int64_t most) {
    auto& moved = run_at(at).ws.moved;
    const std::int64_t n = smaller<std::int64_t>(moved.n, most);
    for (std::int64_t i = 0; i < n; ++i) {
      const Graze& g = moved.graze[i];
      const double numbers[graze_size] = {g.time, g.what, g.component, g.index, g.together};
      for (int j = 0; j < graze_size; ++j) grazes[i * graze_size + j] = numbers[j];
      keep(moved.instant[i], tangents + i * N);
    }
    moved.n = 0;
    return n;
  }

  static int fault(const void* at, double* value) {
    const auto& detail = static_cast<const Run*>(at)->ws.detail;
    if (value != nullptr) *value = detail.value;
    return detail.component;
  }

  static std::int64_t steps(const void* at) { return static_cast<const Run*>(at)->ws.statistics.steps; }

  static constexpr cw_tangent_calls table() {
    return {size, load, set_option, leave_out_work, seed, advance, events, grazes, fault, steps};
  }
};

}  // namespace clutchwork

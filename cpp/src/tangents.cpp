#include <clutchwork/c_api.h>

#include <clutchwork/components/tangent.hpp>

#include <new>
#include "lifted.hpp"
#include "system_checks.hpp"

using namespace clutchwork;

namespace {

constexpr int directions = CW_DIRECTIONS;
using Number = Tangent<directions>;
static_assert(graze_size == CW_GRAZE);

}  // namespace

/// A run with derivatives and where it lives; its arrays follow it in the same memory.
struct cw_tangents {
  Workspace<Number> ws;
  System plain;
  const unsigned char* system;
};

namespace {

constexpr std::int64_t head = (std::int64_t(sizeof(cw_tangents)) + 63) / 64 * 64;

/// Lay out the numbers of the model and the arrays of the run; the size of both.
std::int64_t lay_out_run(cw_tangents& run, unsigned char* memory) {
  Arena numbers(memory);
  lift(run.ws.sys, run.plain, numbers);
  run.ws.row = RowLayout(run.plain);
  const std::int64_t size = (numbers.size() + 63) / 64 * 64;
  return size + carve(run.ws, memory == nullptr ? nullptr : memory + size);
}

}  // namespace

extern "C" {

std::int64_t cw_tangents_size(const void* system, std::int64_t bytes) {
  cw_tangents run{};
  if (system == nullptr || bind(run.plain, static_cast<const unsigned char*>(system), bytes) < 0 ||
      !in_range(run.plain))
    return -1;
  return head + lay_out_run(run, nullptr) + 64;
}

cw_tangents* cw_tangents_load(const void* system, std::int64_t bytes, void* memory, std::int64_t memory_bytes) {
  const std::int64_t size = cw_tangents_size(system, bytes);
  if (size < 0 || memory_bytes < size || memory == nullptr) return nullptr;
  auto* at = reinterpret_cast<unsigned char*>((reinterpret_cast<std::uintptr_t>(memory) + 63) / 64 * 64);
  std::memset(at, 0, std::size_t(size - 64));
  auto* run = new (at) cw_tangents{};
  run->system = static_cast<const unsigned char*>(system);
  bind(run->plain, run->system, bytes);
  lay_out_run(*run, at + head);
  return run;
}

int cw_tangents_set_option(cw_tangents* run, const char* name, double value) {
  if (run == nullptr || name == nullptr) return 0;
  int done = 0;
  visit_options(run->ws.options, [&](auto& setting, const char* known, const OptionRange& range) {
    if (std::strcmp(name, known) != 0 || !range.allows(value)) return;
    setting = static_cast<std::remove_reference_t<decltype(setting)>>(value);
    done = 1;
  });
  return done;
}

int cw_tangents_seed(cw_tangents* run, std::int64_t word, int direction, double slope) {
  if (run == nullptr || run->ws.started || direction < 0 || direction >= directions) return 0;
  Number* number = number_at(run->ws.sys, run->plain, run->system, word);
  if (number == nullptr) return 0;
  number->d[direction] += slope;
  return 1;
}

int cw_tangents_advance(cw_tangents* run, double t_end, const double* times, double* rows, double* tangents,
                        std::int64_t n, std::int64_t* filled) {
  if (run == nullptr || n < 0 || (n > 0 && (times == nullptr || rows == nullptr || tangents == nullptr))) return -1;
  Sink sink;
  sink.times = const_cast<double*>(times), sink.rows = rows, sink.tangents = tangents, sink.count = n;
  if (!run->ws.started) begin_lifted(run->ws);
  const Status status = advance(run->ws, t_end, sink);
  if (filled != nullptr) *filled = sink.at;
  return int(status);
}

std::int64_t cw_tangents_events(cw_tangents* run, double* events, double* tangents, std::int64_t most) {
  if (run == nullptr || most < 0 || (most > 0 && (events == nullptr || tangents == nullptr))) return -1;
  Workspace<Number>& ws = run->ws;
  const std::int64_t n = smaller<std::int64_t>(ws.events.n, most);
  for (std::int64_t i = 0; i < n * event_size; ++i) events[i] = ws.events.at[i];
  for (std::int64_t i = 0; i < n; ++i) keep(ws.moved.event[i], tangents + i * directions);
  for (std::int64_t i = n * event_size; i < ws.events.n * event_size; ++i)
    ws.events.at[i - n * event_size] = ws.events.at[i];
  for (std::int64_t i = n; i < ws.events.n; ++i) ws.moved.event[i - n] = ws.moved.event[i];
  ws.events.n -= int(n);
  return n;
}

std::int64_t cw_tangents_grazes(cw_tangents* run, double* grazes, std::int64_t most) {
  if (run == nullptr || most < 0 || (most > 0 && grazes == nullptr)) return -1;
  const std::int64_t n = smaller<std::int64_t>(run->ws.moved.n, most);
  for (std::int64_t i = 0; i < n; ++i) {
    const Graze& g = run->ws.moved.graze[i];
    const double numbers[graze_size] = {g.time, g.what, g.component, g.index, g.together};
    for (int j = 0; j < graze_size; ++j) grazes[i * graze_size + j] = numbers[j];
  }
  run->ws.moved.n = 0;
  return n;
}

int cw_tangents_fault(const cw_tangents* run, double* value) {
  if (value != nullptr) *value = run->ws.detail.value;
  return run->ws.detail.component;
}

std::int64_t cw_tangents_steps(const cw_tangents* run) { return run->ws.statistics.steps; }

}  // extern "C"

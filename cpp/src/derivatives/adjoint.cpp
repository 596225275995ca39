#include <clutchwork/derivatives.h>

#include <clutchwork/components/taped.hpp>

#include <cstring>
#include <new>
// the image of a run is plain: what the core has of that is compiled here too
#define CLUTCHWORK_COMPONENTS
#include "../system_checks.hpp"
#include "lifted.hpp"

#include <clutchwork/run/linear_record.hpp>

using namespace clutchwork;

/// A run that notes on a tape how its numbers came about, and where it lives.
struct cw_adjoint {
  Workspace<Taped> ws;
  Workspace<double> image;
  System plain;
  const unsigned char* system;
  Tape tape;
};

namespace {

constexpr std::int64_t head = (std::int64_t(sizeof(cw_adjoint)) + 63) / 64 * 64;

/// Lay out the numbers of the model and the arrays of the run; the size of both.
std::int64_t lay_out_run(cw_adjoint& run, unsigned char* memory) {
  Arena numbers(memory);
  lift(run.ws, run.plain, numbers);
  run.ws.row = RowLayout(run.plain);
  std::int64_t size = (numbers.size() + 63) / 64 * 64;
  size = (size + carve(run.ws, memory == nullptr ? nullptr : memory + size) + 63) / 64 * 64;
  return size + carve_image(run.ws, run.image, run.plain, memory == nullptr ? nullptr : memory + size);
}

/// The tape of a run is that of this thread while it lives.
struct Writing {
  explicit Writing(Tape& tape) { Tape::current() = &tape; }
  ~Writing() { Tape::current() = nullptr; }
};

int is_full(void* tape) { return static_cast<const Tape*>(tape)->is_full(); }

}  // namespace

extern "C" {

std::int64_t cw_adjoint_size(const void* system, std::int64_t bytes) {
  cw_adjoint run{};
  if (system == nullptr || bind(run.plain, static_cast<const unsigned char*>(system), bytes) < 0) return -1;
  return in_range(run.plain) ? head + lay_out_run(run, nullptr) : -1;
}

cw_adjoint* cw_adjoint_load(const void* system, std::int64_t bytes, void* memory, std::int64_t memory_bytes, void* tape,
                            std::int64_t tape_bytes) {
  const std::int64_t size = cw_adjoint_size(system, bytes);
  if (size < 0 || memory_bytes < size || memory == nullptr || tape == nullptr || tape_bytes < 0) return nullptr;
  auto* at = static_cast<unsigned char*>(memory);
  std::memset(at, 0, std::size_t(size));
  auto* run = new (at) cw_adjoint{};
  run->system = static_cast<const unsigned char*>(system);
  bind(run->plain, run->system, bytes);
  run->tape = Tape(tape, tape_bytes);
  lay_out_run(*run, at + head);
  return run;
}

int cw_adjoint_set_option(cw_adjoint* run, const char* name, double value) {
  if (run == nullptr || name == nullptr) return 0;
  int done = 0;
  visit_options(run->ws.options, [&](auto& setting, const char* known, const OptionRange& range) {
    if (std::strcmp(name, known) != 0 || !range.allows(value)) return;
    setting = static_cast<std::remove_reference_t<decltype(setting)>>(value);
    done = 1;
  });
  return done;
}

int cw_adjoint_leave_out_work(cw_adjoint* run) { return run == nullptr ? 0 : leave_out_work(run->ws); }

std::int64_t cw_adjoint_seed(cw_adjoint* run, std::int64_t word, double probe) {
  if (run == nullptr || run->ws.started || !(probe - probe == 0)) return -1;
  Taped* number = number_at(run->ws, run->plain, run->system, word);
  if (number == nullptr) return -1;
  if (number->id == 0) number->id = run->tape.note(0, 0, 0, 0), number->probe = probe;
  return number->id;
}

int cw_adjoint_advance(cw_adjoint* run, double t_end, const double* times, double* rows, double* numbers,
                       std::int64_t n, std::int64_t* filled) {
  if (run == nullptr || !(t_end - t_end == 0) || n < 0) return -1;
  if (n > 0 && (times == nullptr || rows == nullptr || numbers == nullptr)) return -1;
  const Writing writing(run->tape);
  Sink sink;
  sink.times = const_cast<double*>(times), sink.rows = rows, sink.tangents = numbers, sink.count = n;
  run->ws.poll = {is_full, &run->tape};
  if (!run->ws.started) begin_lifted(run->ws);
  const Status status = advance(run->ws, t_end, sink);
  if (filled != nullptr) *filled = sink.at;
  return run->tape.is_full() ? int(Status::interrupted) : int(status);
}

std::int64_t cw_adjoint_events(cw_adjoint* run, double* events, double* numbers, std::int64_t most) {
  if (run == nullptr || most < 0 || (most > 0 && (events == nullptr || numbers == nullptr))) return -1;
  auto& ws = run->ws;
  const std::int64_t n = smaller<std::int64_t>(ws.events.n, most);
  for (std::int64_t i = 0; i < n * event_size; ++i) events[i] = ws.events.at[i];
  for (std::int64_t i = 0; i < n; ++i) keep(ws.moved.event[i], numbers + i);
  for (std::int64_t i = n * event_size; i < ws.events.n * event_size; ++i)
    ws.events.at[i - n * event_size] = ws.events.at[i];
  for (std::int64_t i = n; i < ws.events.n; ++i) ws.moved.event[i - n] = ws.moved.event[i];
  ws.events.n -= int(n);
  return n;
}

std::int64_t cw_adjoint_grazes(cw_adjoint* run, double* grazes, double* numbers, std::int64_t most) {
  if (run == nullptr || most < 0 || (most > 0 && (grazes == nullptr || numbers == nullptr))) return -1;
  auto& moved = run->ws.moved;
  const std::int64_t n = smaller<std::int64_t>(moved.n, most);
  for (std::int64_t i = 0; i < n; ++i) {
    const Graze& g = moved.graze[i];
    const double plain[graze_size] = {g.time, g.what, g.component, g.index, g.together};
    for (int j = 0; j < graze_size; ++j) grazes[i * graze_size + j] = plain[j];
    keep(moved.instant[i], numbers + i);
  }
  moved.n = 0;
  return n;
}

std::int64_t cw_adjoint_numbers(const cw_adjoint* run) { return run == nullptr ? -1 : run->tape.size(); }

int cw_adjoint_back(const cw_adjoint* run, double* adjoint) {
  if (run == nullptr || adjoint == nullptr || run->tape.is_full()) return 0;
  run->tape.back(adjoint, LinearRecord::back);
  return 1;
}

int cw_adjoint_fault(const cw_adjoint* run, double* value) {
  if (run == nullptr) return -1;
  if (value != nullptr) *value = run->ws.detail.value;
  return run->ws.detail.component;
}

}  // extern "C"

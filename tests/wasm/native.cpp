#include <clutchwork/c_api.h>

#include <stdio.h>
#include <stdlib.h>

/// Runs for tests: jobs on standard input, results on standard output, all of it words of eight bytes that are doubles.
/// tests/support/wasm.py says what they are; run.mjs does the same in JavaScript. Without the library of C++, which
/// would take longer to compile than all the rest.
namespace {

const char* const options[] = {"rtol", "atol", "method", "angles", "work"};
int events_full;  // a status
const double* input;

double next() { return *input++; }
const double* take(int64_t n) {
  input += n;
  return input - n;
}

double* room(int64_t n) { return static_cast<double*>(aligned_alloc(64, size_t((8 * n + 63) / 64 * 64 + 64))); }
void put(const double* from, int64_t n) { fwrite(from, 8, size_t(n), stdout); }

struct Events {
  double* at = nullptr;
  int64_t n = 0;

  void take_from(cw_run* run) {
    const int64_t pending = cw_pending_events(run), size = cw_event_size();
    at = static_cast<double*>(realloc(at, size_t(8 * (n + pending * size) + 8)));
    n += size * cw_take_events(run, at + n, pending);
  }
};

/// One stretch of a run: a signal that is set, rows at times.
void stretch(cw_run* run, Events& events) {
  const double signal = next();
  const auto pieces = int64_t(next());
  const double *starts = take(pieces), *coefficients = take(12 * pieces);
  const double set = signal < 0 ? -1 : cw_set_segments(run, int64_t(signal), starts, coefficients, pieces);
  const double end = next();
  const auto n = int64_t(next());
  double* times = const_cast<double*>(take(n));
  const int64_t row = cw_row_size(run);
  double* rows = room(n * row);
  int64_t done = 0;
  int status = events_full;
  while (status == events_full) {
    int64_t filled = 0;
    status = cw_advance(run, end, times + done, rows + done * row, n - done, 0, &filled);
    done += filled;
    events.take_from(run);
  }
  const double head[] = {set, double(status), double(done)};
  put(head, 3), put(rows, done * row);
  free(rows);
}

void job() {
  const auto words = int64_t(next());
  const double* system = take(words);
  const int64_t size = cw_size(system, 8 * words);
  double* memory = room(size / 8 + 1);
  cw_run* run = cw_load(system, 8 * words, memory, size);
  for (const char* name : options) cw_set_option(run, name, next());
  Events events;
  for (auto left = int(next()); left > 0; --left) stretch(run, events);
  const auto found = double(events.n);
  put(&found, 1), put(events.at, events.n);
  free(events.at), free(memory);
}

}  // namespace

int main(int, char** arguments) {
  events_full = atoi(arguments[1]);
  int64_t n = 0, most = 1 << 16;
  double* words = static_cast<double*>(malloc(size_t(8 * most)));
  for (size_t got; (got = fread(words + n, 8, size_t(most - n), stdin)) > 0;) {
    n += int64_t(got);
    if (n == most) words = static_cast<double*>(realloc(words, size_t(8 * (most *= 2))));
  }
  input = words;
  while (input < words + n) job();
}

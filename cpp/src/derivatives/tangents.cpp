#include "tangents.hpp"

#include <clutchwork/derivatives.h>

namespace {

#ifdef CLUTCHWORK_WIDE
bool has_wide() { return __builtin_cpu_supports("avx2"); }
#endif

/// Those for the widest registers that this processor has.
const cw_tangent_calls& calls() {
#ifdef CLUTCHWORK_WIDE_ALONE
  return clutchwork_tangents_wide;
#else
#ifdef CLUTCHWORK_WIDE
  if (has_wide()) return clutchwork_tangents_wide;
#endif
  return clutchwork_tangents_plain;
#endif
}

void* plain(cw_tangents* run) { return run; }

}  // namespace

extern "C" {

int cw_tangents_supported(void) {
#ifdef CLUTCHWORK_WIDE_ALONE
  return has_wide();
#else
  return 1;
#endif
}

std::int64_t cw_tangents_size(const void* system, std::int64_t bytes) { return calls().size(system, bytes); }

cw_tangents* cw_tangents_load(const void* system, std::int64_t bytes, void* memory, std::int64_t memory_bytes) {
  return static_cast<cw_tangents*>(calls().load(system, bytes, memory, memory_bytes));
}

int cw_tangents_set_option(cw_tangents* run, const char* name, double value) {
  return run != nullptr && name != nullptr ? calls().set_option(plain(run), name, value) : 0;
}

int cw_tangents_leave_out_work(cw_tangents* run) { return run == nullptr ? 0 : calls().leave_out_work(plain(run)); }

int cw_tangents_seed(cw_tangents* run, std::int64_t word, int direction, double slope) {
  if (run == nullptr || direction < 0 || direction >= CW_DIRECTIONS || !(slope - slope == 0)) return 0;
  return calls().seed(plain(run), word, direction, slope);
}

int cw_tangents_advance(cw_tangents* run, double t_end, const double* times, double* rows, double* tangents,
                        std::int64_t n, std::int64_t* filled) {
  if (run == nullptr || !(t_end - t_end == 0) || n < 0) return -1;
  if (n > 0 && (times == nullptr || rows == nullptr || tangents == nullptr)) return -1;
  return calls().advance(plain(run), t_end, times, rows, tangents, n, filled);
}

std::int64_t cw_tangents_events(cw_tangents* run, double* events, double* tangents, std::int64_t most) {
  if (run == nullptr || most < 0 || (most > 0 && (events == nullptr || tangents == nullptr))) return -1;
  return calls().events(plain(run), events, tangents, most);
}

std::int64_t cw_tangents_grazes(cw_tangents* run, double* grazes, double* tangents, std::int64_t most) {
  if (run == nullptr || most < 0 || (most > 0 && (grazes == nullptr || tangents == nullptr))) return -1;
  return calls().grazes(plain(run), grazes, tangents, most);
}

int cw_tangents_fault(const cw_tangents* run, double* value) { return run == nullptr ? -1 : calls().fault(run, value); }

std::int64_t cw_tangents_steps(const cw_tangents* run) { return run == nullptr ? -1 : calls().steps(run); }

}  // extern "C"

// Nothing is allocated after a run is loaded: every allocation is counted.

#include <cstdlib>
#include <new>

#include "check.hpp"
#include "models.hpp"

/// Every way to memory is counted: operator new here, malloc through the linker (-Wl,--wrap) where WRAP_MALLOC says so.
namespace {
volatile long taken = 0;
}

#ifdef WRAP_MALLOC
extern "C" {
void* __real_malloc(std::size_t);
void* __real_calloc(std::size_t, std::size_t);
void* __real_realloc(void*, std::size_t);
void* __wrap_malloc(std::size_t n) { return taken = taken + 1, __real_malloc(n); }
void* __wrap_calloc(std::size_t n, std::size_t size) { return taken = taken + 1, __real_calloc(n, size); }
void* __wrap_realloc(void* p, std::size_t n) { return taken = taken + 1, __real_realloc(p, n); }
}
#endif

void* operator new(std::size_t n) { return taken = taken + 1, std::malloc(n); }
void* operator new[](std::size_t n) { return taken = taken + 1, std::malloc(n); }
void operator delete(void* p) noexcept { taken = taken + 1, std::free(p); }
void operator delete[](void* p) noexcept { taken = taken + 1, std::free(p); }
void operator delete(void* p, std::size_t) noexcept { taken = taken + 1, std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { taken = taken + 1, std::free(p); }

using namespace fixture;

namespace {

/// Load, settings, a grid over all knots and events, steps, save and restore: nothing is taken.
void silent(const Model& model, double end, int method) {
  const Bytes system = model.bytes();
  const std::int64_t bytes = std::int64_t(system.size()), size = cw_size(system.data(), bytes);
  Bytes memory(static_cast<std::size_t>(size)), saved(memory.size());
  cw_run* run = cw_load(system.data(), bytes, memory.data(), size);
  if (!CHECK(run != nullptr)) return;
  constexpr int n = 400;
  Numbers times(n), rows(std::size_t(n * cw_row_size(run))), events(std::size_t(1000 * event_size));
  for (int i = 0; i < n; ++i) times[i] = end * (i + 1) / n;
  std::int64_t filled = 0, steps = 0, taken_events = 0, counts[7];
  const long before = taken;
  bool good = cw_set_option(run, "rtol", 1e-7) == 1 && cw_set_option(run, "method", method) == 1;
  for (int part = 1; part <= 2; ++part) {
    std::int64_t more = 0;
    good = good && cw_advance(run, 0.5 * end * part, &times[filled], &rows[filled * cw_row_size(run)], n - filled, 0,
                              &more) == 0;
    filled += more;
    const std::int64_t n = cw_save(run, saved.data(), size);
    good = good && cw_restore(run, saved.data(), n) == 1;
  }
  taken_events = cw_take_events(run, events.data(), 1000);
  const int status = cw_advance(run, 1.1 * end, times.data(), rows.data(), n, 1, &steps);
  good = good && (status == 0 || status == int(Status::rows_full)) && cw_row(run, rows.data()) == 0;
  cw_statistics(run, counts);
  const long after = taken;
  CHECK(after == before);
  CHECK(good);
  CHECK(filled == n && steps > 1 && taken_events >= 3);
  CHECK(counts[5] > 3 && counts[6] > 0);
}

}  // namespace

int main() {
  const long before = taken;
  delete new int(1);
  CHECK(taken > before);
#ifdef WRAP_MALLOC
  const long plain = taken;
  void* volatile p = std::malloc(3);
  std::free(p);
  CHECK(taken > plain);
#endif
  silent(three_shafts(), 2.5, 1);
  silent(three_shafts(), 2.5, 0);
  silent(chain(), 2.0, 1);
  silent(chain(), 2.0, 2);
  silent(bristles(), 3.0, 1);
  silent(hysteresis(), 3.0, 1);
  silent(hysteresis(), 3.0, 2);
  silent(warm(), 3.0, 1);
  silent(long_row(), 1.0, 1);
  return check::result();
}

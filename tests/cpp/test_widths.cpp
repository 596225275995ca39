// Runs with derivatives have the same bits whatever registers they are compiled for.

#include <clutchwork/derivatives.h>

#include <vector>

#include "check.hpp"
#include "derivatives/tangents.hpp"
#include "models.hpp"

using namespace fixture;

namespace {

struct Told {
  int status = 0;
  std::int64_t seeds = 0;
  std::vector<double> rows, slopes;
};

Told told(const cw_tangent_calls& calls, const Bytes& system, std::int64_t row) {
  const std::vector<double> times{0.1, 0.35, 0.8, 1.2};
  const std::int64_t n = std::int64_t(times.size()), bytes = std::int64_t(system.size());
  Bytes memory(std::size_t(calls.size(system.data(), bytes)));
  void* run = calls.load(system.data(), bytes, memory.data(), std::int64_t(memory.size()));
  Told found{0, 0, std::vector<double>(std::size_t(n * row)),
             std::vector<double>(std::size_t(n * row * CW_DIRECTIONS))};
  CHECK(run != nullptr);
  for (std::int64_t word = 0; run != nullptr && word < bytes / 8; ++word)
    found.seeds += calls.seed(run, word, int(word % CW_DIRECTIONS), 1.0);
  std::int64_t filled = 0;
  if (run != nullptr)
    found.status = calls.advance(run, 1.2, times.data(), found.rows.data(), found.slopes.data(), n, &filled);
  CHECK(filled == n);
  return found;
}

std::int64_t row_of(const Bytes& system) {
  const std::int64_t bytes = std::int64_t(system.size());
  Bytes memory(std::size_t(cw_size(system.data(), bytes)));
  return cw_row_size(cw_load(system.data(), bytes, memory.data(), std::int64_t(memory.size())));
}

void widths_agree(const Model& model) {
  const Bytes system = model.bytes();
  const std::int64_t row = row_of(system);
  const Told plain = told(clutchwork_tangents_plain, system, row), wide = told(clutchwork_tangents_wide, system, row);
  CHECK(plain.seeds > 0);
  CHECK(plain.status == wide.status);
  CHECK(plain.rows == wide.rows);
  CHECK(plain.slopes == wide.slopes);
}

}  // namespace

int test_widths() {
#ifdef CLUTCHWORK_WIDE
  if (__builtin_cpu_supports("avx2")) {
    widths_agree(three_shafts());
    widths_agree(bristles());
    widths_agree(parallel());
  }
#endif
  return check::result();
}

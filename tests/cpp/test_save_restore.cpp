#include "check.hpp"
#include "models.hpp"

using namespace fixture;

namespace {

/// Everything a run tells from now to the end: rows on a grid, events, counters.
Numbers story(Run& r, double end) {
  constexpr int n = 50;
  Numbers times(n), told(std::size_t(n * r.at.size));
  for (int i = 0; i < n; ++i) times[i] = cw_time(r.run) + (end - cw_time(r.run)) * (i + 1) / n;
  std::int64_t filled = 0, counts[7];
  CHECK(cw_advance(r.run, end, times.data(), told.data(), n, 0, &filled) == 0);
  CHECK(filled == n);
  for (double x : r.row()) told.push_back(x);
  for (double x : r.events()) told.push_back(x);
  cw_statistics(r.run, counts);
  for (std::int64_t x : counts) told.push_back(double(x));
  return told;
}

void same(const Numbers& a, const Numbers& b) {
  if (!CHECK(a.size() == b.size())) return;
  CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

/// Saved at `middle`, continued there and in other memory, after other things have happened there.
void continues(const Model& model, double middle, double end) {
  Run first(model);
  CHECK(first.advance(middle) == 0);
  first.events();
  Bytes saved(first.memory.size());
  cw_save(first.run, saved.data());
  const Numbers told = story(first, end);
  CHECK(cw_restore(first.run, saved.data(), std::int64_t(saved.size())) == 1);
  CHECK(cw_time(first.run) == middle);
  same(told, story(first, end));
  Run fresh(model), used(model);
  CHECK(used.advance(0.5 * (middle + end)) == 0);
  used.events();
  for (Run* other : {&fresh, &used}) {
    CHECK(cw_restore(other->run, saved.data(), std::int64_t(saved.size())) == 1);
    // the first one is gone: nothing may point there
    std::memset(first.memory.data(), 0xff, first.memory.size());
    std::memset(first.system.data(), 0xff, first.system.size());
    same(told, story(*other, end));
  }
  CHECK(cw_restore(fresh.run, saved.data(), std::int64_t(saved.size()) - 1) == 0);
}

}  // namespace

int main() {
  for (double middle : {0.0, 0.3, 0.7, 0.95, 1.4, 1.83, 2.2}) continues(three_shafts(), middle, 2.5);
  for (double middle : {0.0, 0.1, 0.35, 0.5, 0.77, 1.3}) continues(chain(), middle, 2.0);
  for (double middle : {0.0, 0.4, 0.8, 1.21, 1.6, 1.9, 2.5}) continues(bristles(), middle, 3.0);
  for (double middle : {0.0, 0.2, 0.7, 1.05, 1.3, 1.61, 2.1}) continues(hysteresis(), middle, 2.5);
  for (double middle : {0.0, 0.3, 0.67, 1.3, 2.3, 2.4, 2.7}) continues(warm(), middle, 3.0);
  return check::result();
}

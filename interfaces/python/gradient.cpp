#include <clutchwork/c_api.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>
#include <clutchwork/layout.gen.hpp>

#include <algorithm>
#include <memory>
#include <new>
#include <vector>

#include "door.hpp"

/// Runs with derivatives. docs/theory/gradients.md
namespace nb = nanobind;

namespace {

using Words = nb::ndarray<const std::int64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Seeds = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Times = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Options = std::vector<std::pair<std::string, double>>;

constexpr std::int64_t width = CW_DIRECTIONS, event_columns = clutchwork::event_size, events_at_once = 256;
constexpr std::int64_t most_grazes = 512;

/// What a run with derivatives gives.
struct Found {
  int status = 0;
  std::int64_t filled = 0;
  std::vector<double> rows, events, grazes;
  int component = -1;
  double value = 0;
};

/// Memory that is kept between calls of one thread.
struct Memory {
  std::unique_ptr<double[]> block;
  std::int64_t bytes = 0;

  void* at_least(std::int64_t size) {
    if (size > bytes) block.reset(new double[std::size_t(size / 8 + 1)]), bytes = size;
    return block.get();
  }
};

/// One run with up to `width` of n directions, from `first` on; derivatives go to where they stand among all.
bool run_chunk(const nb::bytes& system, const Words& words, const Seeds& seeds, std::int64_t first, const Times& times,
               double t_end, const Options& options, std::int64_t row, Found& found, std::vector<double>& slopes,
               std::vector<double>& moved) {
  static thread_local Memory memory;
  const std::int64_t n = std::int64_t(seeds.shape(1)), m = std::int64_t(words.shape(0));
  const std::int64_t k = std::int64_t(times.shape(0)), used = std::min(width, n - first);
  const std::int64_t bytes = std::int64_t(system.size()), size = cw_tangents_size(system.c_str(), bytes);
  cw_tangents* run = size < 0 ? nullptr : cw_tangents_load(system.c_str(), bytes, memory.at_least(size), size);
  if (run == nullptr) return false;
  for (const auto& [name, setting] : options) cw_tangents_set_option(run, name.c_str(), setting);
  for (std::int64_t i = 0; i < m; ++i) {
    for (std::int64_t j = 0; j < used; ++j) {
      const double slope = seeds.data()[i * n + first + j];
      if (slope != 0 && !cw_tangents_seed(run, words.data()[i], int(j), slope)) return false;
    }
  }
  std::vector<double> parts(std::size_t(k * row * width)), events(std::size_t(events_at_once * event_columns));
  std::vector<double> event_parts(std::size_t(events_at_once * width));
  found.rows.resize(std::size_t(k * row)), found.events.clear(), found.filled = 0;
  std::int64_t n_events = 0;
  do {
    std::int64_t filled = 0;
    const std::int64_t at = found.filled;
    found.status = cw_tangents_advance(run, t_end, times.data() + at, found.rows.data() + at * row,
                                       parts.data() + at * row * width, k - at, &filled);
    found.filled += filled;
    for (std::int64_t taken = events_at_once; taken == events_at_once;) {
      taken = cw_tangents_events(run, events.data(), event_parts.data(), events_at_once);
      found.events.insert(found.events.end(), events.begin(), events.begin() + taken * event_columns);
      moved.resize(std::max(moved.size(), std::size_t((n_events + taken) * n)));
      for (std::int64_t e = 0; e < taken; ++e)
        std::copy_n(event_parts.data() + e * width, used, moved.data() + (n_events + e) * n + first);
      n_events += taken;
    }
  } while (found.status == int(clutchwork::Status::events_full));
  for (std::int64_t i = 0; i < found.filled * row; ++i)
    std::copy_n(parts.data() + i * width, used, slopes.data() + i * n + first);
  std::vector<double> grazes(std::size_t(most_grazes * CW_GRAZE));
  const std::int64_t met = cw_tangents_grazes(run, grazes.data(), most_grazes);
  // two events at one instant may differ in some directions alone
  if (found.grazes.empty()) found.grazes.assign(grazes.begin(), grazes.begin() + met * CW_GRAZE);
  for (std::int64_t i = CW_GRAZE - 1; i < std::min(met * CW_GRAZE, std::int64_t(found.grazes.size())); i += CW_GRAZE)
    found.grazes[std::size_t(i)] = std::max(found.grazes[std::size_t(i)], grazes[std::size_t(i)]);
  found.component = cw_tangents_fault(run, &found.value);
  return true;
}

/// An array of numpy that owns the numbers.
nb::object array(std::vector<double>&& numbers, std::initializer_list<std::size_t> shape) {
  auto* kept = new std::vector<double>(std::move(numbers));
  nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, double>(kept->data(), shape, owner));
}

/// Rows, events and their derivatives.
nb::tuple tangents(const nb::bytes& system, const Words& words, const Seeds& seeds, const Times& times, double t_end,
                   const Options& options, std::int64_t row) {
  if (seeds.shape(0) != words.shape(0)) throw nb::value_error("one line of seeds for each word");
  const std::size_t k = times.shape(0), n = seeds.shape(1), r = std::size_t(row);
  Found found;
  std::vector<double> slopes(k * r * n), moved;
  bool good = true;
  {
    nb::gil_scoped_release release;
    for (std::int64_t first = 0; good && (first == 0 || first < std::int64_t(n)); first += width)
      good = run_chunk(system, words, seeds, first, times, t_end, options, row, found, slopes, moved);
  }
  if (!good) throw nb::value_error("the bytes are not a system of this core, or a word is not a number of its motion");
  const std::size_t e = found.events.size() / std::size_t(event_columns), g = found.grazes.size() / CW_GRAZE;
  return nb::make_tuple(
      found.status, found.filled, array(std::move(found.rows), {k, r}), array(std::move(slopes), {k, r, n}),
      array(std::move(found.events), {e, std::size_t(event_columns)}), array(std::move(moved), {e, n}),
      array(std::move(found.grazes), {g, std::size_t(CW_GRAZE)}), nb::make_tuple(found.component, found.value));
}

}  // namespace

void bind_gradient(nb::module_& m) {
  m.def("tangents", &tangents, nb::arg("system"), nb::arg("words"), nb::arg("seeds"), nb::arg("times"),
        nb::arg("t_end"), nb::arg("options"), nb::arg("row_size"),
        "Rows on a grid and events of one run, with derivatives in directions that change words of the system.");
}

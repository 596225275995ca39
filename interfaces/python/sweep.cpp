#include "sweep.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "door.hpp"

namespace nb = nanobind;

namespace {

using namespace clutchwork::sweep;
using clutchwork::door::owned;
using Numbers = nb::ndarray<double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Whole = nb::ndarray<std::int64_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Lines = nb::ndarray<std::int64_t, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;
using Words = nb::ndarray<std::uint64_t, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;
using Option = std::tuple<std::string, double>;

/// Everything is checked here, so that no thread meets what it cannot use.
void check(const Task& task) {
  for (const Bytes& system : task.systems) {
    if (cw_size(system.data, system.size) < 0) throw nb::value_error("system bytes do not fit this core");
    for (const Axis& axis : task.axes) {
      for (std::int64_t k = 0; k < axis.count; ++k)
        if (axis.place[k] < 0 || axis.place[k] >= system.size / 8) throw nb::index_error("a word is not in the system");
    }
  }
  const std::int64_t line = 1 + std::int64_t(task.axes.size());
  for (std::int64_t v = 0; v < task.variants; ++v) {
    const std::int64_t* choice = task.choice + v * line;
    bool fits = choice[0] >= 0 && choice[0] < std::int64_t(task.systems.size());
    for (std::int64_t a = 1; a < line; ++a)
      fits = fits && choice[a] >= 0 && choice[a] < task.axes[std::size_t(a - 1)].values;
    if (!fits) throw nb::index_error("a variant chooses what is not there");
  }
  for (std::int64_t i = 0; i < task.instants; ++i)
    if (!(task.times[i] >= (i > 0 ? task.times[i - 1] : 0.0))) throw nb::value_error("times must not decrease");
  if (!(task.t_end >= 0 && std::isfinite(task.t_end))) throw nb::value_error("the end time must be finite");
  if (task.parts < 0) throw nb::value_error("parts must be zero or positive");
}

/// Rows of the first system have as many numbers as those of all.
void check_columns(const Task& task, std::int64_t row_size) {
  const auto refuse = [&](std::int64_t column) {
    if (column < 0 || column >= row_size) throw nb::index_error("a column is not in the rows");
  };
  for (std::int64_t c = 0; c < task.width; ++c) refuse(task.columns[c]);
  for (const std::int64_t column : task.inside) refuse(column);
}

std::int64_t row_size_of(const Bytes& system) {
  struct alignas(64) Block {
    unsigned char byte[64];
  };
  const std::int64_t size = cw_size(system.data, system.size);
  const auto memory = std::make_unique<Block[]>(std::size_t(size + 63) / 64);
  return cw_row_size(cw_load(system.data, system.size, memory.get(), size));
}

/// Status, details and rows of a grid, what each thread found, and what a signal handler or `progress` raised, or None.
nb::tuple sweep(std::vector<nb::bytes> systems, std::vector<std::tuple<Whole, Words>> axes, Lines choice,
                std::vector<Option> options, double t_end, Numbers times, int parts, Whole columns, bool events,
                int threads, nb::object progress, std::optional<Whole> inside) {
  Task task{};
  for (const nb::bytes& system : systems) task.systems.push_back({system.c_str(), std::int64_t(system.size())});
  for (const auto& [place, words] : axes) {
    if (place.shape(0) != words.shape(1)) throw nb::value_error("an axis has other words than places");
    task.axes.push_back({place.data(), words.data(), std::int64_t(place.shape(0)), std::int64_t(words.shape(0))});
  }
  if (systems.empty() || choice.shape(1) != 1 + axes.size()) throw nb::value_error("variants must choose a system");
  task.options = {};
  for (const auto& [name, value] : options) task.options.emplace_back(name, value);
  task.choice = choice.data(), task.variants = std::int64_t(choice.shape(0));
  task.t_end = t_end, task.times = times.data(), task.instants = std::int64_t(times.shape(0)), task.parts = parts;
  task.columns = columns.data(), task.width = std::int64_t(columns.shape(0)), task.events = events;
  task.chosen = inside.has_value();
  const Whole& read = inside ? *inside : columns;
  task.inside.assign(read.data(), read.data() + read.shape(0));
  check(task);
  for (const Bytes& system : task.systems) check_columns(task, row_size_of(system));

  const auto variants = std::size_t(task.variants);
  std::vector<std::int32_t> status(variants, std::int32_t(clutchwork::Status::interrupted));
  std::vector<double> detail(variants * detail_size, __builtin_nan(""));
  std::vector<double> grid(parts > 0 ? 0 : variants * std::size_t(task.instants * task.width), __builtin_nan(""));
  const Results results{status.data(), detail.data(), grid.data()};
  clutchwork::Course course;
  nb::object raised = nb::none();
  std::vector<Found> found;
  {
    nb::gil_scoped_release release;
    found = run_all(task, results, threads > 1 ? threads : 1, course, [&] {
      nb::gil_scoped_acquire lock;
      return clutchwork::door::heard(raised, [&] {
        if (!progress.is_none()) progress(course.done.load());
      });
    });
  }
  // a signal that came after the last call of `progress` ends the sweep with what these runs gave
  if (raised.is_none()) clutchwork::door::heard(raised, [] {});
  nb::list parts_found;
  for (Found& one : found) {
    const std::size_t n = one.variant.size(), rows = one.times.size(), kept = one.events.size() / event_kept;
    parts_found.append(nb::make_tuple(
        owned(std::move(one.variant), {n}), owned(std::move(one.rows), {n}), owned(std::move(one.times), {rows}),
        owned(std::move(one.values), {rows, task.inside.size()}), owned(std::move(one.events), {kept, event_kept}),
        owned(std::move(one.ends), {n, std::size_t(2), std::size_t(task.width)})));
  }
  nb::object lines =
      parts > 0 ? nb::none() : owned(std::move(grid), {variants, std::size_t(task.instants), std::size_t(task.width)});
  return nb::make_tuple(owned(std::move(status), {variants}), owned(std::move(detail), {variants, detail_size}), lines,
                        parts_found, raised);
}

}  // namespace

void bind_sweep(nb::module_& m) {
  m.def("sweep", &sweep, nb::arg("systems"), nb::arg("axes"), nb::arg("choice"), nb::arg("options"), nb::arg("t_end"),
        nb::arg("times"), nb::arg("parts"), nb::arg("columns"), nb::arg("events"), nb::arg("threads"),
        nb::arg("progress").none(), nb::arg("inside") = nb::none(),
        "Runs of many variants of one system, on several threads.");
}

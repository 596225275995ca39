#include <clutchwork/derivatives.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>
#include <clutchwork/layout.gen.hpp>
#include <clutchwork/run/guards/list.hpp>
#include <clutchwork/schema.gen.hpp>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

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
               double t_end, const Options& options, std::int64_t row, bool work, Found& found,
               std::vector<double>& slopes, std::vector<double>& moved) {
  static thread_local Memory memory;
  const std::int64_t n = std::int64_t(seeds.shape(1)), m = std::int64_t(words.shape(0));
  const std::int64_t k = std::int64_t(times.shape(0)), used = std::min(width, n - first);
  const std::int64_t bytes = std::int64_t(system.size());
  cw_tangents* run = cw_tangents_load(system.c_str(), bytes, memory.block.get(), memory.bytes);
  if (run == nullptr) {
    const std::int64_t size = cw_tangents_size(system.c_str(), bytes);
    run = size < 0 ? nullptr : cw_tangents_load(system.c_str(), bytes, memory.at_least(size), size);
  }
  if (run == nullptr) return false;
  for (const auto& [name, setting] : options) cw_tangents_set_option(run, name.c_str(), setting);
  if (!work) cw_tangents_leave_out_work(run);
  for (std::int64_t i = 0; i < m; ++i) {
    for (std::int64_t j = 0; j < used; ++j) {
      const double slope = seeds.data()[i * n + first + j];
      if (slope != 0 && !cw_tangents_seed(run, words.data()[i], int(j), slope)) return false;
    }
  }
  // memory that has been touched is much faster than new one
  static thread_local std::vector<double> parts, events(std::size_t(events_at_once * event_columns)),
      event_parts(std::size_t(events_at_once * width)), grazes(std::size_t(most_grazes * CW_GRAZE)),
      graze_parts(std::size_t(most_grazes * width));
  parts.resize(std::max(parts.size(), std::size_t(k * row * width)));
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
  const std::int64_t met = cw_tangents_grazes(run, grazes.data(), graze_parts.data(), most_grazes);
  // their instants follow those of the events
  moved.resize(std::max(moved.size(), std::size_t((n_events + met) * n)));
  for (std::int64_t g = 0; g < met; ++g)
    std::copy_n(graze_parts.data() + g * width, used, moved.data() + (n_events + g) * n + first);
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
                   const Options& options, std::int64_t row, bool work) {
  if (seeds.shape(0) != words.shape(0)) throw nb::value_error("one line of seeds for each word");
  const std::size_t k = times.shape(0), n = seeds.shape(1), r = std::size_t(row);
  Found found;
  std::vector<double> slopes(k * r * n), moved;
  bool good = true;
  {
    nb::gil_scoped_release release;
    // a run that stops early by some numbers has no derivatives by the others
    auto goes_on = [&](std::int64_t first) {
      return first == 0 || (first < std::int64_t(n) && found.status == int(clutchwork::Status::done));
    };
    for (std::int64_t first = 0; good && goes_on(first); first += width)
      good = run_chunk(system, words, seeds, first, times, t_end, options, row, work, found, slopes, moved);
  }
  if (!good) throw nb::value_error("the bytes are not a system of this core, or a word is not a number of its motion");
  const std::size_t e = found.events.size() / std::size_t(event_columns), g = found.grazes.size() / CW_GRAZE;
  return nb::make_tuple(
      found.status, found.filled, array(std::move(found.rows), {k, r}), array(std::move(slopes), {k, r, n}),
      array(std::move(found.events), {e, std::size_t(event_columns)}), array(std::move(moved), {e + g, n}),
      array(std::move(found.grazes), {g, std::size_t(CW_GRAZE)}), nb::make_tuple(found.component, found.value));
}

/// Memory of runs that are followed back, and of their tapes. What is not written is never touched and costs nothing;
/// the last one of each kind is kept in each thread, as memory that has been touched is much faster than new one.
struct Blocks {
  enum Kind : int { run, tape, kinds };
  struct Free {
    void operator()(double* p) const { std::free(p); }
  };
  struct Kept {
    std::unique_ptr<double[], Free> memory;
    std::int64_t bytes = 0;
  };
  static Kept& last(Kind kind) {
    static thread_local Kept kept[kinds];
    return kept[kind];
  }
  static Kept take(Kind kind, std::int64_t bytes) {
    if (last(kind).bytes == bytes) {
      last(kind).bytes = 0;
      return {std::move(last(kind).memory), bytes};
    }
    Kept made{std::unique_ptr<double[], Free>(static_cast<double*>(std::malloc(std::size_t(bytes)))), bytes};
    if (made.memory == nullptr) throw std::bad_alloc();
    return made;
  }
  static void give(Kind kind, Kept&& block) { last(kind) = std::move(block); }
};

/// A run whose tape is kept, to be followed back for as many weights as are wanted.
class Adjoint {
 public:
  Adjoint(const nb::bytes& system, const Words& words, const Times& probes, const Times& times, double t_end,
          const Options& options, std::int64_t row, bool work, std::int64_t tape_bytes)
      : row_(row), k_(std::int64_t(times.shape(0))) {
    if (probes.shape(0) != words.shape(0)) throw nb::value_error("one probe for each word");
    const std::int64_t bytes = std::int64_t(system.size()), size = cw_adjoint_size(system.c_str(), bytes);
    if (size < 0) throw nb::value_error("the bytes are not a system of this core");
    memory_ = Blocks::take(Blocks::run, size + 16), tape_ = Blocks::take(Blocks::tape, tape_bytes);
    auto* at = reinterpret_cast<void*>((reinterpret_cast<std::uintptr_t>(memory_.memory.get()) + 15) / 16 * 16);
    run_ = cw_adjoint_load(system.c_str(), bytes, at, size, tape_.memory.get(), tape_bytes);
    if (run_ == nullptr) throw std::bad_alloc();
    for (const auto& [name, setting] : options) cw_adjoint_set_option(run_, name.c_str(), setting);
    if (!work) cw_adjoint_leave_out_work(run_);
    for (std::size_t i = 0; i < words.shape(0); ++i) {
      seeds_.push_back(cw_adjoint_seed(run_, words.data()[i], probes.data()[i]));
      if (seeds_.back() < 0) throw nb::value_error("a word is not a number of the motion");
    }
    nb::gil_scoped_release release;
    go(times, t_end);
  }
  ~Adjoint() { Blocks::give(Blocks::run, std::move(memory_)), Blocks::give(Blocks::tape, std::move(tape_)); }
  Adjoint(const Adjoint&) = delete;
  Adjoint& operator=(const Adjoint&) = delete;

  /// Derivatives of the weighted sum of rows and times, of events and of guards behind them, by the words.
  nb::object back(const Seeds& row_weights, const Times& event_weights) const {
    if (row_weights.shape(0) * row_weights.shape(1) != row_numbers_.size() ||
        event_weights.shape(0) != event_numbers_.size())
      throw nb::value_error("one weight for each number of the rows, each event and each guard that was hit");
    std::vector<double> found(seeds_.size());
    bool good = true;
    {
      nb::gil_scoped_release release;
      static thread_local std::vector<double> adjoint;
      adjoint.assign(std::size_t(cw_adjoint_numbers(run_)), 0);
      for (std::size_t i = 0; i < row_numbers_.size(); ++i)
        adjoint[std::size_t(row_numbers_[i])] += row_weights.data()[i];
      for (std::size_t i = 0; i < event_numbers_.size(); ++i)
        adjoint[std::size_t(event_numbers_[i])] += event_weights.data()[i];
      good = cw_adjoint_back(run_, adjoint.data()) != 0;
      for (std::size_t i = 0; i < seeds_.size(); ++i) found[i] = adjoint[std::size_t(seeds_[i])];
    }
    if (!good) throw nb::value_error("the tape is full");
    return array(std::move(found), {seeds_.size()});
  }

  nb::tuple found() const {
    const std::size_t e = found_.events.size() / std::size_t(event_columns), g = found_.grazes.size() / CW_GRAZE;
    auto copy = [](const std::vector<double>& x) { return std::vector<double>(x); };
    return nb::make_tuple(found_.status, found_.filled, array(copy(found_.rows), {std::size_t(k_), std::size_t(row_)}),
                          array(copy(found_.events), {e, std::size_t(event_columns)}),
                          array(copy(found_.grazes), {g, std::size_t(CW_GRAZE)}),
                          nb::make_tuple(found_.component, found_.value));
  }
  std::int64_t size() const { return cw_adjoint_numbers(run_); }

 private:
  void go(const Times& times, double t_end) {
    found_.rows.resize(std::size_t(k_ * row_)), row_numbers_.resize(std::size_t(k_ * row_));
    std::vector<double> events = std::vector<double>(std::size_t(events_at_once * event_columns));
    std::vector<double> numbers = std::vector<double>(std::size_t(events_at_once));
    do {
      std::int64_t filled = 0;
      const std::int64_t at = found_.filled;
      found_.status = cw_adjoint_advance(run_, t_end, times.data() + at, found_.rows.data() + at * row_,
                                         row_numbers_.data() + at * row_, k_ - at, &filled);
      found_.filled += filled;
      for (std::int64_t taken = events_at_once; taken == events_at_once;) {
        taken = cw_adjoint_events(run_, events.data(), numbers.data(), events_at_once);
        found_.events.insert(found_.events.end(), events.begin(), events.begin() + taken * event_columns);
        event_numbers_.insert(event_numbers_.end(), numbers.begin(), numbers.begin() + taken);
      }
    } while (found_.status == int(clutchwork::Status::events_full));
    found_.grazes.resize(std::size_t(most_grazes * CW_GRAZE)), numbers.resize(std::size_t(most_grazes));
    const std::int64_t met = cw_adjoint_grazes(run_, found_.grazes.data(), numbers.data(), most_grazes);
    found_.grazes.resize(std::size_t(met * CW_GRAZE));
    event_numbers_.insert(event_numbers_.end(), numbers.begin(), numbers.begin() + met);
    found_.component = cw_adjoint_fault(run_, &found_.value);
  }

  std::int64_t row_, k_;
  Blocks::Kept memory_, tape_;
  cw_adjoint* run_ = nullptr;
  std::vector<std::int64_t> seeds_;
  std::vector<double> row_numbers_, event_numbers_;
  Found found_;
};

}  // namespace

NB_MODULE(_derivatives, m) {
  m.doc() = "Runs of the core of clutchwork with derivatives.";
  m.attr("schema") = clutchwork::schema_text;
  m.attr("layout") = clutchwork::layout_text;
  nb::list guards;
  constexpr const char* effects[] = {"decides", "next piece", "other"};
  for (int i = 0; i < clutchwork::GuardList::count; ++i) {
    guards.append(nb::make_tuple(clutchwork::GuardList::name[i], effects[int(clutchwork::GuardList::effect[i])]));
  }
  m.attr("guards") = nb::tuple(guards);
  m.def("supported", &cw_tangents_supported, "Whether it was compiled for the processor of this machine.");
  nb::class_<Adjoint>(m, "Adjoint")
      .def(nb::init<const nb::bytes&, const Words&, const Times&, const Times&, double, const Options&, std::int64_t,
                    bool, std::int64_t>(),
           nb::arg("system"), nb::arg("words"), nb::arg("probes"), nb::arg("times"), nb::arg("t_end"),
           nb::arg("options"), nb::arg("row_size"), nb::arg("work"), nb::arg("tape_bytes"))
      .def("found", &Adjoint::found)
      .def("back", &Adjoint::back, nb::arg("row_weights"), nb::arg("event_weights"))
      .def_prop_ro("size", &Adjoint::size);
  m.def("tangents", &tangents, nb::arg("system"), nb::arg("words"), nb::arg("seeds"), nb::arg("times"),
        nb::arg("t_end"), nb::arg("options"), nb::arg("row_size"), nb::arg("work"),
        "Rows on a grid and events of one run, with derivatives in directions that change words of the system.");
}

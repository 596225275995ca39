#include <clutchwork/c_api.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>
#include <clutchwork/layout.gen.hpp>
#include <clutchwork/schema.gen.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "door.hpp"
#include "many.hpp"

namespace nb = nanobind;
namespace many = clutchwork::many;
using Vector = nb::ndarray<double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Matrix = nb::ndarray<double, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;
using Numbers = nb::ndarray<std::int64_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Statuses = nb::ndarray<std::int32_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

namespace {

const std::int64_t event_columns = cw_event_size();

/// Lets Python handle signals, such as Ctrl-C, some ten times a second while the core runs without its lock.
class Listener {
 public:
  /// Asked after every step; the clock and Python are asked rarely. Other than 0: a handler has raised.
  static int ask(void* self) { return static_cast<Listener*>(self)->heard(); }
  bool raised() const { return raised_; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr auto seldom = std::chrono::milliseconds(50), soon = std::chrono::milliseconds(5);
  static constexpr int most = 64;
  Clock::time_point looked_ = Clock::now(), listened_ = looked_;
  int every_ = 1, left_ = 1;
  bool raised_ = false;

  int heard() {
    if (raised_) return 1;
    if (--left_ > 0) return 0;
    // as many steps between two looks at the clock as take no longer than `soon`
    const auto now = Clock::now();
    every_ = now - looked_ > soon ? 1 : every_ < most ? 2 * every_ : most;
    looked_ = now;
    left_ = every_;
    if (now - listened_ < seldom) return 0;
    listened_ = now;
    nb::gil_scoped_acquire lock;
    raised_ = PyErr_CheckSignals() != 0;
    return raised_;
  }
};

/// Owns the memory of a run and the bytes of its system.
class Run {
 public:
  explicit Run(nb::bytes system) : system_(std::move(system)) {
    const std::int64_t size = cw_size(system_.c_str(), std::int64_t(system_.size()));
    if (size < 0)
      throw nb::value_error("the system bytes do not fit this core: assemble the driveline again with this version");
    // the core clears it
    memory_.reset(new Block[std::size_t(size + 63) / 64]);
    size_ = size;
    run_ = cw_load(system_.c_str(), std::int64_t(system_.size()), memory_.get(), size);
    if (run_ == nullptr) throw nb::value_error("the run could not be started from these system bytes");
  }

  cw_run* handle() const { return run_; }

  void set_option(const std::string& name, double value) {
    if (!cw_set_option(run_, name.c_str(), value)) {
      throw nb::value_error(("option " + name + " is unknown or cannot be " + std::to_string(value)).c_str());
    }
  }
  void set_input(std::int64_t input, double value) {
    if (!cw_set_input(run_, input, value)) throw nb::value_error("unknown input, or the value is not finite");
  }
  void release_input(std::int64_t input) {
    if (!cw_release_input(run_, input)) throw nb::value_error("unknown input, or one that is set from outside alone");
  }
  void set_segments(std::int64_t input, Vector times, Matrix coefficients) {
    const auto n = std::int64_t(times.shape(0));
    if (std::int64_t(coefficients.shape(0)) != n || coefficients.shape(1) != 12 ||
        !cw_set_segments(run_, input, times.data(), coefficients.data(), n))
      throw nb::value_error("unknown input, too many segments, starts that fall, or a number that is not finite");
  }
  void expect_inputs(bool expected) { cw_expect_inputs(run_, expected ? 1 : 0); }
  void set_param(std::int64_t offset, double value) {
    if (!cw_set_param(run_, offset, value))
      throw nb::value_error("unknown or fixed parameter, or the value is not finite");
  }

  /// Whether set_param would take this.
  bool is_settable(std::int64_t offset, double value) { return cw_set_param(run_, offset, value) != 0; }

  /// Status, rows filled, and what a signal handler raised meanwhile, or None.
  std::tuple<int, std::int64_t, nb::object> advance(double t_end, Vector times, Matrix rows, std::int64_t first,
                                                    int steps, double spacing) {
    if (rows.shape(1) != std::size_t(cw_row_size(run_)) || rows.shape(0) != times.shape(0)) {
      throw nb::value_error("rows must have one line per time and row_size columns");
    }
    const auto n = std::int64_t(times.shape(0));
    if (first < 0 || first > n) throw nb::index_error("first row out of range");
    std::int64_t filled = 0;
    double *t = times.data() + first, *r = rows.data() + first * cw_row_size(run_);
    int status;
    Listener listener;
    cw_set_poll(run_, &Listener::ask, &listener);
    {
      nb::gil_scoped_release release;
      status = spacing > 0 ? cw_advance_spaced(run_, t_end, spacing, t, r, n - first, &filled)
                           : cw_advance(run_, t_end, t, r, n - first, steps, &filled);
    }
    cw_set_poll(run_, nullptr, nullptr);
    if (status < 0) throw nb::value_error("the end time must be finite and not before the present time");
    if (!listener.raised() && PyErr_CheckSignals() == 0) return {status, filled, nb::none()};
    nb::python_error raised;
    return {status, filled, nb::borrow(raised.value())};
  }

  nb::object events() {
    const std::int64_t total = cw_pending_events(run_);
    double* data = new double[std::size_t(event_columns * (total > 0 ? total : 1))];
    cw_take_events(run_, data, total);
    nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<double*>(p); });
    return nb::cast(
        nb::ndarray<nb::numpy, double, nb::ndim<2>>(data, {std::size_t(total), std::size_t(event_columns)}, owner));
  }

  nb::object row() {
    const auto n = std::size_t(cw_row_size(run_));
    double* data = new double[n > 0 ? n : 1]();
    nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<double*>(p); });
    cw_row(run_, data);
    return nb::cast(nb::ndarray<nb::numpy, double, nb::ndim<1>>(data, {n}, owner));
  }

  /// Status, the row at this instant, and the derivatives of all components there.
  std::tuple<int, nb::object, nb::object> local() {
    std::int64_t lines = 0, columns = 0;
    cw_local_size(run_, &lines, &columns);
    const auto n = std::size_t(cw_row_size(run_)), m = std::size_t(lines), k = std::size_t(columns);
    std::unique_ptr<double[]> row(new double[n > 0 ? n : 1]()), matrix(new double[m * k > 0 ? m * k : 1]());
    const int status = cw_local(run_, row.get(), matrix.get());
    auto free = [](void* p) noexcept { delete[] static_cast<double*>(p); };
    double *r = row.release(), *x = matrix.release();
    nb::capsule row_owner(r, free), matrix_owner(x, free);
    return {status, nb::cast(nb::ndarray<nb::numpy, double, nb::ndim<1>>(r, {n}, row_owner)),
            nb::cast(nb::ndarray<nb::numpy, double, nb::ndim<2>>(x, {m, k}, matrix_owner))};
  }

  nb::dict statistics() const {
    constexpr int n = clutchwork::n_statistics;
    std::int64_t counts[n];
    cw_statistics(run_, counts);
    nb::dict d;
    for (int i = 0; i < n; ++i) d[clutchwork::statistic_names[i]] = counts[i];
    return d;
  }

  /// Component, time, value, and the number in a row that is not finite.
  std::tuple<std::int64_t, double, double, std::int64_t> detail() const {
    double value = 0;
    const std::int64_t component = cw_detail(run_, &value);
    return {component, cw_time(run_), value, cw_detail_row(run_)};
  }

  nb::bytes save() const {
    const std::int64_t size = cw_state_size(run_);
    std::unique_ptr<char[]> state(new char[std::size_t(size)]);
    cw_save(run_, state.get(), size);
    return nb::bytes(state.get(), std::size_t(size));
  }
  void restore(nb::bytes state) {
    if (!cw_restore(run_, state.c_str(), std::int64_t(state.size()))) {
      throw nb::value_error("the saved state is damaged or belongs to another system or version: save it again");
    }
  }

  std::int64_t pending() const { return cw_pending_events(run_); }
  double time() const { return cw_time(run_); }
  std::int64_t row_size() const { return cw_row_size(run_); }
  std::int64_t memory_size() const { return size_; }
  std::int64_t single_size() const { return cw_single_size(system_.c_str(), std::int64_t(system_.size())); }

 private:
  struct alignas(64) Block {
    unsigned char byte[64];
  };
  nb::bytes system_;
  std::unique_ptr<Block[]> memory_;
  std::int64_t size_ = 0;
  cw_run* run_ = nullptr;
};

std::tuple<double, double> law(int number, Vector params, Matrix points, double slip, std::vector<double> inputs) {
  double kinetic = 0, hold = 0;
  // a law reads as many as it declares
  inputs.resize(16);
  if (!cw_law(number, params.data(), inputs.data(), points.data(), std::int64_t(points.shape(0)), slip, &kinetic,
              &hold)) {
    throw nb::index_error("no such friction law");
  }
  return {kinetic, hold};
}

/// Statuses of runs advanced together, without rows. Each has the bits that it has alone.
std::vector<int> advance_group(const std::vector<Run*>& runs, double t_end) {
  std::vector<cw_member> members;
  std::int64_t size = 0;
  for (Run* run : runs) {
    if (run == nullptr) throw nb::value_error("a run of a group is None");
    if (std::count(runs.begin(), runs.end(), run) > 1) throw nb::value_error("a run is twice in a group");
    members.push_back({run->handle(), nullptr, nullptr, 0, 0, 0, 0});
    size = std::max(size, cw_group_size(run->handle()));
  }
  const std::unique_ptr<unsigned char[]> memory(new unsigned char[std::size_t(size)]);
  {
    nb::gil_scoped_release release;
    cw_advance_group(members.data(), std::int64_t(members.size()), t_end, memory.get(), size);
  }
  std::vector<int> statuses;
  for (const cw_member& member : members) statuses.push_back(member.status);
  return statuses;
}

/// Runs side by side, which it keeps alive.
class Side {
 public:
  explicit Side(const nb::list& runs) : owner_(runs.size()), runs_(runs.size()) {
    for (std::size_t i = 0; i < runs.size(); ++i) put(std::int64_t(i), runs[i]);
  }

  /// Another run takes the place of one.
  void put(std::int64_t number, nb::object owner) {
    refuse_while_going();
    const Run& run = nb::cast<const Run&>(owner);
    if (row_size_ >= 0 && run.row_size() != row_size_) throw nb::value_error("all runs have rows alike");
    row_size_ = run.row_size();
    at(number) = run.handle();
    owner_[std::size_t(number)] = std::move(owner);
  }

  /// Set a signal of some runs, each to a value of its own, which waits for the next step: it is given where the memory
  /// of the run is at hand.
  void set(Numbers which, std::int64_t input, Vector values) {
    refuse_while_going();
    if (values.shape(0) != which.shape(0)) throw nb::value_error("give a value for each run");
    std::vector<double>& kept = waiting_of(input);
    for (std::size_t i = 0; i < which.shape(0); ++i) {
      const std::int64_t number = which.data()[i];
      cw_run* run = at(number);
      double& value = kept[std::size_t(number)];
      // one value after another at the same instant, as a single run takes them
      if (!std::isnan(value) && !cw_set_input(run, input, value)) refuse();
      value = values.data()[i];
      if (!std::isfinite(value)) value = __builtin_nan(""), refuse();
    }
  }

  /// Give all values that wait.
  void give() {
    refuse_while_going();
    for (many::Waiting& one : waiting_) {
      for (std::size_t i = 0; i < runs_.size(); ++i)
        if (!one.give(runs_[i], std::int64_t(i))) refuse();
    }
  }

  /// Let some go on, each up to its end: events behind the numbers of their runs, and what a signal handler raised
  /// meanwhile, or None.
  std::tuple<nb::object, nb::object> advance(Numbers which, Vector ends, Matrix rows, Statuses status, int threads) {
    refuse_while_going();
    const std::size_t count = runs_.size();
    if (ends.shape(0) != count || rows.shape(0) != count || status.shape(0) != count)
      throw nb::value_error("give an end, a row and a status for each run");
    many::Task task{{}, ends.data(), rows.data(), std::int64_t(rows.shape(1)), status.data(), &waiting_, backward_};
    // those that were last are near still: they go first
    backward_ = !backward_;
    if (task.row_size != row_size_) throw nb::value_error("rows must have row_size columns");
    std::vector<bool> there(count, false);
    task.members.reserve(which.shape(0));
    for (std::size_t i = 0; i < which.shape(0); ++i) {
      const std::int64_t number = which.data()[i];
      cw_run* run = at(number);
      if (there[std::size_t(number)]) throw nb::value_error("a run appears twice");
      there[std::size_t(number)] = true;
      task.members.push_back({run, number});
    }
    clutchwork::Course course;
    nb::object raised = nb::none();
    std::vector<std::vector<double>> events;
    {
      const Going going(going_);
      nb::gil_scoped_release release;
      events = many::advance_all(task, threads > 1 ? threads : 1, course, [&] {
        nb::gil_scoped_acquire lock;
        return clutchwork::door::heard(raised, [] {});
      });
    }
    if (raised.is_none()) clutchwork::door::heard(raised, [] {});
    std::vector<double> all;
    for (const std::vector<double>& one : events) all.insert(all.end(), one.begin(), one.end());
    const auto columns = std::size_t(many::event_kept()), n = all.size() / columns;
    return {clutchwork::door::owned(std::move(all), {n, columns}), raised};
  }

 private:
  std::vector<nb::object> owner_;
  std::vector<cw_run*> runs_;
  std::vector<many::Waiting> waiting_;
  std::int64_t row_size_ = -1;
  bool going_ = false, backward_ = false;

  /// While they go on.
  struct Going {
    bool& now;
    explicit Going(bool& going) : now(going) { now = true; }
    ~Going() { now = false; }
    Going(const Going&) = delete;
    Going& operator=(const Going&) = delete;
  };

  void refuse_while_going() const {
    if (going_)
      throw std::runtime_error("these runs are going on: set, read and reset them between two calls of advance");
  }
  [[noreturn]] static void refuse() { throw nb::value_error("unknown input, or the value is not finite"); }

  std::vector<double>& waiting_of(std::int64_t input) {
    for (many::Waiting& one : waiting_)
      if (one.input == input) return one.values;
    waiting_.push_back({input, std::vector<double>(runs_.size(), __builtin_nan(""))});
    return waiting_.back().values;
  }

  cw_run*& at(std::int64_t number) {
    if (number < 0 || number >= std::int64_t(runs_.size())) throw nb::index_error("no such run");
    return runs_[std::size_t(number)];
  }
};

}  // namespace

NB_MODULE(_core, m) {
  m.doc() = "Compiled core of clutchwork.";
  m.attr("schema") = clutchwork::schema_text;
  m.attr("layout") = clutchwork::layout_text;
  m.def("schema_hash", &cw_schema_hash, "Fingerprint of the components and layouts this core was built from.");
  m.def("law", &law, nb::arg("number"), nb::arg("params"), nb::arg("points"), nb::arg("slip"),
        nb::arg("inputs") = std::vector<double>(),
        "Kinetic coefficient at a slip [rad/s] and static coefficient of a friction law at its inputs.");
  bind_sweep(m);
  m.def("advance_group", &advance_group, nb::arg("runs"), nb::arg("t_end"),
        "Advance runs to t_end [s] together, without output: a status for each.");
  nb::class_<Side>(m, "Side", "Runs side by side: each is set to values and goes on to ends of its own.")
      .def(nb::init<const nb::list&>(), nb::arg("runs"))
      .def("give", &Side::give)
      .def("put", &Side::put, nb::arg("number"), nb::arg("run"))
      .def("set", &Side::set, nb::arg("which"), nb::arg("input"), nb::arg("values"))
      .def("advance", &Side::advance, nb::arg("which"), nb::arg("ends"), nb::arg("rows"), nb::arg("status"),
           nb::arg("threads"));
  nb::class_<Run>(m, "Run", "One run of a frozen system: its memory, options, signals and results.")
      .def(nb::init<nb::bytes>(), nb::arg("system"))
      .def("set_option", &Run::set_option, nb::arg("name"), nb::arg("value"))
      .def("set_input", &Run::set_input, nb::arg("index"), nb::arg("value"))
      .def("release_input", &Run::release_input, nb::arg("index"))
      .def("set_segments", &Run::set_segments, nb::arg("index"), nb::arg("times"), nb::arg("coefficients"))
      .def("expect_inputs", &Run::expect_inputs, nb::arg("expected"))
      .def("set_param", &Run::set_param, nb::arg("offset"), nb::arg("value"))
      .def("is_settable", &Run::is_settable, nb::arg("offset"), nb::arg("value"))
      .def("advance", &Run::advance, nb::arg("t_end"), nb::arg("times"), nb::arg("rows"), nb::arg("first") = 0,
           nb::arg("steps") = 0, nb::arg("spacing") = 0.0)
      .def("events", &Run::events)
      .def("row", &Run::row)
      .def("local", &Run::local)
      .def("statistics", &Run::statistics)
      .def("detail", &Run::detail)
      .def("save", &Run::save)
      .def("restore", &Run::restore, nb::arg("state"))
      .def_prop_ro("pending", &Run::pending)
      .def_prop_ro("time", &Run::time)
      .def_prop_ro("row_size", &Run::row_size)
      .def_prop_ro("memory_size", &Run::memory_size)
      .def_prop_ro("single_size", &Run::single_size);
}

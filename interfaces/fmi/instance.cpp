#include "instance.hpp"

#include <clutchwork/layout.gen.hpp>

#include <cmath>
#include <cstdio>
#include <cstring>

namespace clutchwork::fmi {

namespace {

constexpr int orders = 3;
/// Instants that are closer are one, as a share of them.
constexpr double round_off = 1e-9, most_gap = 0.01;

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", x);
  return text;
}

bool is_parameter(const Variable& one) { return one.kind == Kind::tunable || one.kind == Kind::fixed; }

bool is_given(const Variable& one) { return one.kind == Kind::input || one.kind == Kind::slope || is_parameter(one); }

double along(const Place& place, const Variable& one, double base, double value) {
  return std::isnan(place.slope) ? value : base + place.slope * (value - one.start);
}

}  // namespace

Instance* Instance::make(const std::string& path, const char* token, Listener listener, Purpose purpose) {
  auto* made = new Instance(listener, purpose);
  std::string wrong = made->model_.load(path);
  if (wrong.empty() && (token == nullptr || made->model_.token != token))
    wrong = "the description of this FMU is that of another model: unpack the FMU again";
  if (wrong.empty() && purpose == Purpose::model_exchange && !made->model_.exchanges)
    wrong = "this FMU is for co-simulation, not for model exchange";
  if (!wrong.empty()) {
    made->refuse(wrong);
    delete made;
    return nullptr;
  }
  const Model& model = made->model_;
  made->memory_.resize(std::size_t(cw_size(model.system.data(), std::int64_t(model.system.size())) + 64));
  made->before_.resize(made->memory_.size());
  made->row_.resize(model.row.size());
  made->reset();
  std::int64_t states = 0, margins = 0;
  if (made->put(made->now_.value)) cw_place_size(made->run(), &states, &margins);
  made->rates_.resize(std::size_t(states)), made->margins_.resize(std::size_t(margins));
  made->now_.x.resize(std::size_t(states));
  return made;
}

// ----------------------------------------------------------------------------------------------------------- the log

Answer Instance::say(Answer answer, Category category, const std::string& text) const {
  if (is_logged_[int(category)] && listener_.say != nullptr)
    listener_.say(listener_.who, answer, category_names[int(category)], text.c_str());
  return answer;
}

/// Why the core stopped, as Python says it.
std::string Instance::told(int status) const {
  double value = 0;
  std::int64_t part = cw_detail(run(), &value);
  const std::int64_t column = cw_detail_row(run());
  const std::string at = "stopped at " + number(cw_time(run())) + " s: ";
  if (status < 0 || status >= int(model_.statuses.size())) return at + "the end of the step is not a time";
  const auto inputs = std::int64_t(model_.inputs.size());
  Sentence said = model_.statuses[std::size_t(status)];
  std::string where, seen;
  if (Status(status) == Status::zeno && part < 0 && value >= 0 && value < double(inputs)) {
    const std::string& signal = model_.inputs[std::size_t(value)];
    return at + "'" + signal + "' has more than 50 knots within a microsecond: thin out the signal";
  }
  const double crowd = value - double(inputs);
  if (Status(status) == Status::zeno && part < 0 && crowd >= 0 && crowd < double(model_.crowded.size()))
    where = " at '" + model_.crowded[std::size_t(crowd)] + "'";
  if (part >= 0 && part < std::int64_t(model_.parts.size())) {
    const Part& one = model_.parts[std::size_t(part)];
    where = " at '" + one.name + "'";
    if (Status(status) == Status::jammed && !one.jam.message.empty()) said = one.jam;
    const bool is_told = Status(status) == Status::not_finite || Status(status) == Status::chatter;
    if (is_told) seen = " (value " + number(value) + ")";
    if (Status(status) == Status::out_of_table) seen = " (value " + number(value) + one.covered + ")";
  } else if (Status(status) == Status::not_finite && column >= 0 && column < std::int64_t(model_.row.size())) {
    where = ": " + model_.row[std::size_t(column)] + " is " + number(value);
  }
  return at + said.message + where + seen + (said.remedy.empty() ? "" : ": " + said.remedy);
}

void Instance::take_events() {
  const std::int64_t n = cw_pending_events(run()), size = cw_event_size();
  if (n <= 0) return;
  events_.resize(std::size_t(n * size));
  cw_take_events(run(), events_.data(), n);
  for (std::int64_t i = 0; i < n && is_logged_[int(Category::events)]; ++i) {
    const double* event = events_.data() + i * size;
    auto word = [](const std::vector<std::string>& words, double k) {
      return k >= 0 && k < double(words.size()) ? words[std::size_t(k)] : std::string("?");
    };
    const double contact = event[1] + double(model_.elements);
    const bool is_named = event[1] >= 0 && contact < double(model_.parts.size());
    const std::string name = is_named ? model_.parts[std::size_t(contact)].name : "speeds";
    const std::string from = word(model_.modes, event[2] + 1), to = word(model_.modes, event[3] + 1);
    say(Answer::ok, Category::events,
        number(event[0]) + " s: " + name + " " + from + " to " + to + " (" + word(model_.causes, event[4]) + ")");
  }
}

// -------------------------------------------------------------------------------------------------------------- life

Answer Instance::experiment(double t_start, bool has_tolerance, double tolerance) {
  if (!std::isfinite(t_start)) return refuse("the start time is not a number");
  now_.t_start = t_start, now_.rtol = 0;
  if (!has_tolerance) return Answer::ok;
  now_.rtol = tolerance;
  now_.is_loaded = false;
  if (load() && run_ != nullptr) {
    const bool taken = cw_set_option(run(), "rtol", tolerance) != 0;
    now_.is_loaded = is_seen_ = false;
    if (taken) return Answer::ok;
  }
  now_.rtol = 0;
  now_.is_loaded = is_seen_ = false;
  return say(Answer::ok, Category::warning,
             "the tolerance " + number(tolerance) + " is out of range: that of the model is kept");
}

Answer Instance::initialize() {
  now_.stage = Stage::initialization;
  return Answer::ok;
}

Answer Instance::enter(Stage stage) {
  if (stage != Stage::terminated && !now_.is_loaded && !load()) return Answer::error;
  if (exchanges() && now_.stage == Stage::initialization && stage == Stage::event)
    return begin() ? Answer::ok : Answer::error;
  is_seen_ = is_seen_ && (exchanges() || (stage != Stage::event && now_.stage != Stage::event));
  now_.stage = stage;
  return Answer::ok;
}

void Instance::reset() {
  now_ = State{};
  now_.t_start = model_.t_start;
  for (const Variable& one : model_.variables) now_.value.push_back(one.start);
  now_.loaded = now_.value;
  now_.on_line.assign(now_.value.size(), 0.0);
  now_.slopes.assign(orders * now_.value.size(), 0.0);
  now_.x.assign(rates_.size(), 0.0);
  is_seen_ = false;
}

/// The bytes of the System with the values of all parameters.
bool Instance::put(const std::vector<double>& values) {
  system_ = model_.system;
  for (std::size_t k = 0; k < model_.variables.size(); ++k) {
    const Variable& one = model_.variables[k];
    if (!is_parameter(one) || values[k] == one.start) continue;
    for (const Place& place : one.words) {
      double word = 0;
      std::memcpy(&word, system_.data() + 8 * place.number, 8);
      word = along(place, one, word, values[k]);
      std::memcpy(system_.data() + 8 * place.number, &word, 8);
    }
  }
  auto* memory = memory_.data();
  while (reinterpret_cast<std::uintptr_t>(memory) % 64 != 0) ++memory;
  const auto room = std::int64_t(memory_.data() + memory_.size() - memory);
  run_ = cw_load(system_.data(), std::int64_t(system_.size()), memory, room);
  const bool fits = run_ != nullptr && cw_row_size(run_) == std::int64_t(row_.size());
  return fits || (refuse("these parameters do not fit the model: reset them"), false);
}

/// A run from its start, with everything that is set.
bool Instance::load() {
  if (now_.is_loaded) return true;
  if (!put(now_.value)) return false;
  for (const Option& option : model_.options) cw_set_option(run(), option.name.c_str(), option.value);
  cw_set_option(run(), "t_start", now_.t_start);
  if (now_.rtol > 0) cw_set_option(run(), "rtol", now_.rtol);
  for (std::size_t k = 0; k < model_.variables.size(); ++k) {
    const Variable& one = model_.variables[k];
    if (one.kind != Kind::input || now_.value[k] == one.start) continue;
    for (std::int64_t input : one.inputs) cw_set_input(run(), input, now_.value[k]);
  }
  // steps of one length are those of the importer, if any
  if (exchanges() && model_.is_fixed()) cw_set_option(run(), "method", 0);
  cw_expect_inputs(run(), 1);
  now_.loaded = now_.value;
  now_.is_loaded = true;
  is_seen_ = false;
  return true;
}

// --------------------------------------------------------------------------------------------------------- variables

const Variable* Instance::variable(std::uint32_t reference) const {
  return reference < model_.variables.size() ? &model_.variables[reference] : nullptr;
}

Answer Instance::check(std::uint32_t reference, double value) const {
  const Variable* one = variable(reference);
  if (one == nullptr) return refuse("there is no variable with the value reference " + std::to_string(reference));
  if (!is_given(*one)) return refuse("'" + one->name + "' is a result, which cannot be set");
  if (one->kind == Kind::fixed && is_begun())
    return refuse("'" + one->name + "' is fixed once the run has begun: set it before, or reset the instance");
  if (one->kind == Kind::tunable && is_placed() && now_.stage == Stage::step)
    return refuse("'" + one->name + "' may change in event mode alone");
  if (now_.stage == Stage::terminated) return refuse("the run is over: reset the instance");
  if (!std::isfinite(value))
    return say(Answer::discard, Category::error, "'" + one->name + "' must be a finite number");
  if (value < one->least || value > one->most)
    return say(Answer::discard, Category::error,
               "'" + one->name + "' must be " + one->bounds + ", not " + number(value));
  return Answer::ok;
}

Answer Instance::set(std::uint32_t reference, double value) {
  const Answer answer = check(reference, value);
  if (answer != Answer::ok) return answer;
  const Variable& one = *variable(reference);
  if (one.kind == Kind::slope) return set_slope(std::uint32_t(one.of), int(one.order), value);
  if (now_.value[reference] == value) return Answer::ok;
  now_.value[reference] = value;
  is_seen_ = false;
  if (!is_begun()) return now_.is_loaded = false, Answer::ok;
  bool done = true;
  now_.is_anew = now_.is_anew || (is_placed() && now_.stage == Stage::event);
  if (one.kind == Kind::tunable)
    for (const Place& place : one.params) done = cw_set_param(run(), place.number, along(place, one, 0, value)) && done;
  else if (!is_placed())
    for (std::int64_t input : one.inputs) done = cw_set_input(run(), input, value) && done;
  return done ? Answer::ok : refuse("'" + one.name + "' was not taken: export the model again");
}

Answer Instance::get(std::uint32_t reference, double* value) {
  const Variable* one = variable(reference);
  if (one == nullptr) return refuse("there is no variable with the value reference " + std::to_string(reference));
  if (one->kind == Kind::time) return *value = time(), Answer::ok;
  if (one->kind == Kind::slope) {
    *value = now_.slopes[std::size_t(orders * one->of + one->order - 1)];
    return Answer::ok;
  }
  if (is_given(*one)) return *value = now_.value[reference], Answer::ok;
  if (one->kind == Kind::rate || one->kind == Kind::margin) {
    if (!(is_seen_ && is_rated_) && !look()) return Answer::error;
    if (one->kind == Kind::margin) return *value = margins_[std::size_t(one->of)], Answer::ok;
    return *value = rates_[std::size_t(model_.states[std::size_t(one->of)].number)], Answer::ok;
  }
  if (!is_seen_ && !look()) return Answer::error;
  *value = model_.forms[std::size_t(one->of)](row_.data());
  return Answer::ok;
}

Answer Instance::set_slope(std::uint32_t input, int order, double value) {
  const Variable* one = variable(input);
  if (one == nullptr || one->kind != Kind::input)
    return refuse("only an input has derivatives, not the value reference " + std::to_string(input));
  if (order < 1 || order > orders)
    return refuse("derivatives of inputs are those of order 1 to 3, not " + std::to_string(order));
  if (!std::isfinite(value)) return say(Answer::discard, Category::error, "a derivative must be a finite number");
  now_.slopes[orders * input + std::size_t(order - 1)] = value;
  is_seen_ = false;
  return Answer::ok;
}

/// The row at the present time. Nothing of it stays: what was set is decided once, by what comes after.
bool Instance::look() {
  if (!load()) return false;
  if (now_.stage == Stage::failed) return refuse("the run has stopped: reset the instance"), false;
  if (is_placed()) return place();
  const std::int64_t n = cw_copy(run(), before_.data(), std::int64_t(before_.size()));
  const std::vector<double> lines = now_.on_line;
  give_inputs();
  // in event mode what inner signals do at this instant is seen, else it waits for the step
  cw_expect_inputs(run(), now_.stage != Stage::event);
  const int status = cw_row(run(), row_.data());
  cw_expect_inputs(run(), 1);
  if (status != int(Status::done)) refuse(told(status));
  cw_rates(run(), rates_.data());
  cw_margins(run(), margins_.data());
  if (exchanges()) cw_states(run(), now_.x.data());
  cw_paste(run(), before_.data(), n);
  now_.on_line = lines;
  return is_seen_ = is_rated_ = status == int(Status::done);
}

// -------------------------------------------------------------------------------------------------------------- steps

void Instance::forget_slopes() { now_.slopes.assign(now_.slopes.size(), 0.0); }

bool Instance::is_line(std::size_t input) const {
  const double* slope = now_.slopes.data() + orders * input;
  return slope[0] != 0 || slope[1] != 0 || slope[2] != 0;
}

/// Inputs over the coming step: lines where they have derivatives, else values.
void Instance::give_inputs() {
  const double start = cw_time(run());
  for (std::size_t k = 0; k < model_.variables.size(); ++k) {
    const Variable& one = model_.variables[k];
    const bool line = one.kind == Kind::input && is_line(k);
    if (!line && now_.on_line[k] == 0) continue;
    const double* slope = now_.slopes.data() + orders * k;
    const double polynomial[12] = {now_.value[k], slope[0], slope[1] / 2, slope[2] / 6};
    for (std::int64_t input : one.inputs) {
      if (line)
        cw_set_segments(run(), input, &start, polynomial, 1);
      else
        cw_set_input(run(), input, now_.value[k]);
    }
    now_.on_line[k] = line ? 1 : 0;
  }
}

/// Inputs with derivatives have moved on, and stay there until they are set again.
void Instance::follow_slopes(double s) {
  for (std::size_t k = 0; k < model_.variables.size(); ++k) {
    if (model_.variables[k].kind != Kind::input || !is_line(k)) continue;
    const double* slope = now_.slopes.data() + orders * k;
    now_.value[k] += s * (slope[0] + s * (slope[1] / 2 + s * slope[2] / 6));
  }
}

/// The budgets of the core count over the life of a run; here each step has its own.
void Instance::give_budget() {
  std::int64_t counts[n_statistics];
  cw_statistics(run(), counts);
  for (const Option& option : model_.options) {
    if (option.name == "max_steps") cw_set_option(run(), "max_steps", double(counts[0] + counts[1]) + option.value);
    if (option.name == "max_events") cw_set_option(run(), "max_events", double(counts[4]) + option.value);
  }
}

Stepped Instance::step(double from, double size, bool may_return_early) {
  if (now_.stage == Stage::failed) return {refuse("the run has stopped: reset the instance, or set it to a state")};
  if (!std::isfinite(from) || !std::isfinite(size) || size < 0)
    return {refuse("a step from " + number(from) + " s by " + number(size) + " s is no step")};
  const double begin = cw_time(run());
  // masters add up steps, whose round-off is no part of one
  const double gap = std::fabs(from - begin);
  if (gap > round_off * (1 + std::fabs(from)) || (size > 0 && gap > most_gap * size))
    return {refuse("the step begins at " + number(from) + " s, but the run is at " + number(begin) + " s")};
  double end = from + size > begin ? from + size : begin;
  give_inputs();
  give_budget();
  is_seen_ = false;
  int status = int(Status::done);
  bool is_early = false;
  if (may_return_early) {
    do {
      take_events();
      status = cw_advance_to_event(run(), end);
    } while (status == int(Status::events_full));
    is_early = status == int(Status::done) && cw_time(run()) < end;
    if (is_early) end = cw_time(run());
  }
  std::int64_t filled = 0;
  while (status == int(Status::done) && !is_early && filled == 0) {
    take_events();
    status = cw_advance(run(), end, &end, row_.data(), 1, 0, &filled);
    is_seen_ = filled > 0, is_rated_ = false;
    if (status == int(Status::events_full)) status = int(Status::done);
  }
  take_events();
  if (status != int(Status::done)) return {stop(status)};
  follow_slopes(end - begin);
  return {Answer::ok, is_early};
}

/// The run cannot go on.
Answer Instance::stop(int status) {
  now_.stage = Stage::failed;
  is_seen_ = false;
  return refuse(told(status));
}

// ----------------------------------------------------------------------------------------------------- model exchange

/// The motion at the time and the state of the importer; inputs go on smoothly.
bool Instance::place() {
  for (std::size_t k = 0; k < model_.variables.size(); ++k) {
    const Variable& one = model_.variables[k];
    if (one.kind != Kind::input) continue;
    for (std::int64_t input : one.inputs) cw_place_input(run(), input, now_.value[k], now_.slopes[orders * k]);
  }
  const int status = cw_place(run(), now_.time, now_.x.data(), row_.data());
  if (status != int(Status::done)) return refuse(status < 0 ? "the state is not a number" : told(status)), false;
  cw_rates(run(), rates_.data());
  cw_margins(run(), margins_.data());
  return is_seen_ = is_rated_ = true;
}

/// The run at its start, in event mode.
bool Instance::begin() {
  const int status = cw_row(run(), row_.data());
  if (status != int(Status::done)) return stop(status), false;
  cw_states(run(), now_.x.data());
  now_.time = cw_time(run()), now_.stage = Stage::event;
  return is_seen_ = false, true;
}

bool Instance::has_room(const double* numbers, std::size_t n, std::size_t wanted, const char* what) const {
  if (n == wanted && (n == 0 || numbers != nullptr)) return true;
  refuse("there are " + std::to_string(wanted) + " " + what + ", not " + std::to_string(n));
  return false;
}

std::size_t Instance::margin_count() const { return margins_.size(); }

Answer Instance::set_time(double t) {
  if (!std::isfinite(t)) return refuse("the time is not a number");
  is_seen_ = is_seen_ && t == now_.time;
  now_.time = t;
  return Answer::ok;
}

Answer Instance::set_states(const double* x, std::size_t n) {
  if (!has_room(x, n, state_count(), "continuous states")) return Answer::error;
  for (std::size_t i = 0; i < n; ++i) {
    double& place = now_.x[std::size_t(model_.states[i].number)];
    is_seen_ = is_seen_ && place == x[i];
    place = x[i];
  }
  return Answer::ok;
}

Answer Instance::get_states(double* x, std::size_t n) {
  if (!has_room(x, n, state_count(), "continuous states")) return Answer::error;
  if (!is_placed() && !is_seen_ && !look()) return Answer::error;
  for (std::size_t i = 0; i < n; ++i) x[i] = now_.x[std::size_t(model_.states[i].number)];
  return Answer::ok;
}

Answer Instance::rates(double* dx, std::size_t n) {
  if (!has_room(dx, n, state_count(), "continuous states")) return Answer::error;
  if (!(is_seen_ && is_rated_) && !look()) return is_begun() ? Answer::discard : Answer::error;
  for (std::size_t i = 0; i < n; ++i) dx[i] = rates_[std::size_t(model_.states[i].number)];
  return Answer::ok;
}

Answer Instance::margins(double* z, std::size_t n) {
  if (!has_room(z, n, margin_count(), "event indicators")) return Answer::error;
  if (!(is_seen_ && is_rated_) && !look()) return is_begun() ? Answer::discard : Answer::error;
  for (std::size_t i = 0; i < n; ++i) z[i] = margins_[i];
  return Answer::ok;
}

Answer Instance::nominals(double* sizes, std::size_t n) const {
  if (!has_room(sizes, n, state_count(), "continuous states")) return Answer::error;
  for (std::size_t i = 0; i < n; ++i) sizes[i] = model_.states[i].nominal;
  return Answer::ok;
}

/// What is due at this instant, decided by the core for all contacts together.
Answer Instance::decide(bool* changed) {
  *changed = false;
  if (!place()) return now_.stage = Stage::failed, Answer::error;
  std::int64_t before[n_statistics], after[n_statistics];
  give_budget();
  take_events();
  cw_statistics(run(), before);
  const int status = cw_decide(run(), now_.is_anew, row_.data(), margins_.data());
  cw_statistics(run(), after);
  take_events();
  if (status != int(Status::done)) return stop(status);
  now_.is_anew = false;
  is_seen_ = false;
  // without a step nothing was due
  *changed = after[0] + after[1] > before[0] + before[1];
  if (*changed) cw_states(run(), now_.x.data());
  return Answer::ok;
}

// ------------------------------------------------------------------------------------------------------------- states

State* Instance::state() {
  if (now_.is_loaded) {
    now_.run.resize(memory_.size());
    const std::int64_t n = cw_copy(run(), now_.run.data(), std::int64_t(now_.run.size()));
    now_.run.resize(std::size_t(n));
  }
  auto* made = new State(now_);
  now_.run.clear();
  return made;
}

Answer Instance::go_to(const State& state) {
  if (state.value.size() != now_.value.size()) return refuse("the state is that of another model");
  const bool is_other = state.is_loaded && (!now_.is_loaded || state.loaded != now_.loaded);
  const State before = now_;
  now_ = state;
  now_.run.clear();
  is_seen_ = false;
  if (is_other && !put(state.loaded)) return now_ = before, Answer::error;
  if (state.is_loaded) cw_expect_inputs(run(), 1);
  if (!state.is_loaded || cw_paste(run(), state.run.data(), std::int64_t(state.run.size())) != 0) return Answer::ok;
  now_ = before;
  now_.is_loaded = false;
  now_.stage = Stage::failed;
  return refuse("the state is that of another model: reset the instance");
}

namespace {

constexpr std::uint64_t state_magic = 0x3245544154534d46u;  // FMSTATE2
constexpr std::int64_t state_words = 10;

std::uint64_t checksum(const unsigned char* bytes, std::int64_t n) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (std::int64_t i = 0; i < n; ++i) h = (h ^ bytes[i]) * 0x100000001b3u;
  return h;
}

void append(std::vector<unsigned char>& to, const void* from, std::size_t n) {
  const auto* bytes = static_cast<const unsigned char*>(from);
  to.insert(to.end(), bytes, bytes + n);
}

}  // namespace

/// magic, checksum of all after it, fingerprint of the token, stage, whether a run follows, t_start, rtol, number of
/// values, time of the importer, whether something was set in event mode; values, loaded values, lines, derivatives,
/// the state of the importer, then the saved state of the core.
std::vector<unsigned char> Instance::serialized(const State& state) {
  std::vector<unsigned char> saved;
  if (state.is_loaded) {
    // a run of its own, so that this one stays
    const State here = *std::unique_ptr<State>(this->state());
    if (go_to(state) == Answer::ok) {
      saved.resize(std::size_t(cw_state_size(run())));
      cw_save(run(), saved.data(), std::int64_t(saved.size()));
    }
    if (go_to(here) != Answer::ok || saved.empty()) return {};
  }
  const auto& token = model_.token;
  const std::uint64_t words[state_words] = {
      state_magic,
      0,
      checksum(reinterpret_cast<const unsigned char*>(token.data()), std::int64_t(token.size())),
      std::uint64_t(state.stage),
      std::uint64_t(state.is_loaded),
      0,
      0,
      std::uint64_t(state.value.size()),
      0,
      std::uint64_t(state.is_anew)};
  std::vector<unsigned char> made;
  append(made, words, sizeof words);
  std::memcpy(made.data() + 40, &state.t_start, 8), std::memcpy(made.data() + 48, &state.rtol, 8);
  std::memcpy(made.data() + 64, &state.time, 8);
  for (const auto* part : {&state.value, &state.loaded, &state.on_line, &state.slopes, &state.x})
    append(made, part->data(), 8 * part->size());
  append(made, saved.data(), saved.size());
  const std::uint64_t sum = checksum(made.data() + 16, std::int64_t(made.size()) - 16);
  std::memcpy(made.data() + 8, &sum, 8);
  return made;
}

/// Whether every number of a state, but for those of its run, is one that an instance may have.
bool Instance::is_possible(const State& state) const {
  bool fits = std::isfinite(state.t_start) && std::isfinite(state.time) && state.rtol >= 0 && state.rtol < 1;
  fits = fits && (state.is_loaded || int(state.stage) < int(Stage::step));
  for (double slope : state.slopes) fits = fits && std::isfinite(slope);
  for (double x : state.x) fits = fits && std::isfinite(x);
  for (std::size_t k = 0; k < model_.variables.size(); ++k) {
    const Variable& one = model_.variables[k];
    fits = fits && (state.on_line[k] == 0 || (state.on_line[k] == 1 && one.kind == Kind::input));
    for (double x : {state.loaded[k], state.value[k]})
      fits = fits && (!is_given(one) || one.kind == Kind::slope || (x >= one.least && x <= one.most));
  }
  return fits;
}

State* Instance::deserialized(const unsigned char* bytes, std::int64_t n) {
  const char* damaged = "the serialised state is damaged, or that of another model";
  std::uint64_t words[state_words];
  if (bytes == nullptr || n < std::int64_t(sizeof words)) return refuse(damaged), nullptr;
  std::memcpy(words, bytes, sizeof words);
  const auto& token = model_.token;
  const bool is_own =
      words[0] == state_magic && words[1] == checksum(bytes + 16, n - 16) &&
      words[2] == checksum(reinterpret_cast<const unsigned char*>(token.data()), std::int64_t(token.size())) &&
      words[3] <= std::uint64_t(Stage::failed) && words[4] <= 1 && words[7] == now_.value.size();
  const auto count = std::int64_t(now_.value.size()),
             at = std::int64_t(sizeof words) + 8 * (count * (3 + orders) + std::int64_t(now_.x.size()));
  if (!is_own || n < at) return refuse(damaged), nullptr;
  auto made = std::make_unique<State>();
  made->stage = Stage(words[3]), made->is_loaded = words[4] == 1, made->is_anew = words[9] != 0;
  std::memcpy(&made->t_start, bytes + 40, 8), std::memcpy(&made->rtol, bytes + 48, 8);
  std::memcpy(&made->time, bytes + 64, 8);
  const unsigned char* from = bytes + sizeof words;
  for (auto* part : {&made->value, &made->loaded, &made->on_line, &made->slopes, &made->x}) {
    part->resize(part == &made->x ? now_.x.size() : std::size_t(part == &made->slopes ? orders * count : count));
    std::memcpy(part->data(), from, 8 * part->size());
    from += 8 * part->size();
  }
  if (!is_possible(*made)) return refuse(damaged), nullptr;
  if (!made->is_loaded) return made.release();
  // read by a run of its own, of which it becomes a copy
  const State here = *std::unique_ptr<State>(state());
  const bool is_read = put(made->loaded) && cw_restore(run(), bytes + at, n - at) != 0;
  if (is_read) {
    made->run.resize(memory_.size());
    made->run.resize(std::size_t(cw_copy(run(), made->run.data(), std::int64_t(made->run.size()))));
  }
  now_.is_loaded = false;
  go_to(here);
  return is_read ? made.release() : (refuse(damaged), nullptr);
}

}  // namespace clutchwork::fmi

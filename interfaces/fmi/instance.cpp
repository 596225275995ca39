#include "instance.hpp"

#include <clutchwork/layout.gen.hpp>

#include <cmath>
#include <cstdio>
#include <cstring>

namespace clutchwork::fmi {

namespace {

double along(const Place& place, const Variable& one, double base, double value) {
  return std::isnan(place.slope) ? value : base + place.slope * (value - one.start);
}

}  // namespace

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", x);
  return text;
}

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
  const bool is_put = made->put(made->now_.value);
  if (is_put) cw_place_size(made->run(), &states, &margins);
  made->rates_.resize(std::size_t(states)), made->margins_.resize(std::size_t(margins));
  made->now_.x.resize(std::size_t(states));
  if (is_put && !model.has_places(states, margins)) {
    made->refuse(damaged_resource);
    delete made;
    return nullptr;
  }
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
  now_.past = now_.slopes;
  now_.x.assign(rates_.size(), 0.0);
  is_seen_ = false;
}

/// Outputs that are computed from parameters with the values of these.
void Instance::follow(const std::vector<double>& values) {
  forms_.clear();
  for (std::size_t k = 0; k < model_.variables.size(); ++k) {
    const Variable& one = model_.variables[k];
    if (one.forms.empty() || values[k] == one.start) continue;
    if (forms_.empty()) forms_ = model_.forms;
    for (const Follows& number : one.forms) {
      Term& term = forms_[std::size_t(number.form)].terms[std::size_t(number.term)];
      Combination& sum = number.side == 0 ? term.one : term.other;
      double& place = number.share < 0 ? sum.offset : sum.parts[std::size_t(number.share)].slope;
      place += number.change(one.start, values[k]);
    }
  }
}

/// The bytes of the System with the values of all parameters.
bool Instance::put(const std::vector<double>& values) {
  system_ = model_.system;
  for (std::size_t k = 0; k < model_.variables.size(); ++k) {
    const Variable& one = model_.variables[k];
    if (!one.is_parameter() || values[k] == one.start) continue;
    for (const Place& place : one.words) {
      double word = 0;
      std::memcpy(&word, system_.data() + 8 * place.number, 8);
      word = along(place, one, word, values[k]);
      std::memcpy(system_.data() + 8 * place.number, &word, 8);
    }
  }
  follow(values);
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

/// The run cannot go on.
Answer Instance::stop(int status) {
  now_.stage = Stage::failed;
  is_seen_ = false;
  return refuse(told(status));
}

// --------------------------------------------------------------------------------------------------------- variables

const Variable* Instance::variable(std::uint32_t reference) const {
  return reference < model_.variables.size() ? &model_.variables[reference] : nullptr;
}

Answer Instance::check(std::uint32_t reference, double value) const {
  const Variable* one = variable(reference);
  if (one == nullptr) return refuse("there is no variable with the value reference " + std::to_string(reference));
  if (!one->is_given()) return refuse("'" + one->name + "' is a result, which cannot be set");
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
  if (one->is_given()) return *value = now_.value[reference], Answer::ok;
  const bool needs_rates = one->kind == Kind::rate || one->kind == Kind::margin;
  if (!(is_seen_ && (is_rated_ || !needs_rates)) && !look()) return Answer::error;
  return *value = computed(*one), Answer::ok;
}

/// A result where the motion was looked at.
double Instance::computed(const Variable& one) const {
  if (one.kind == Kind::margin) return margins_[std::size_t(one.of)];
  if (one.kind == Kind::rate) return rates_[std::size_t(model_.states[std::size_t(one.of)].number)];
  return (forms_.empty() ? model_.forms : forms_)[std::size_t(one.of)](row_.data());
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

}  // namespace clutchwork::fmi

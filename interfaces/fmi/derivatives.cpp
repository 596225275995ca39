#include <clutchwork/layout.gen.hpp>

#include <cmath>
#include "instance.hpp"

/// Derivatives inside the present modes, by differences of fourth order. docs/theory/model-exchange.md (4)
namespace clutchwork::fmi {

namespace {

/// Length of a difference as a share of the sizes, and the least share of a nominal value that counts as a size.
constexpr double share = 1e-6, least_size = 1e-2;
/// Length of a difference along the motion [s].
constexpr double instant = 1e-7;
constexpr int points = 5;
/// Points of a difference and their weights: around a point, and on from it.
struct Stencil {
  double places[points], weights[points];
};
constexpr Stencil around = {{-2, -1, 0, 1, 2}, {1.0 / 12, -2.0 / 3, 0, 2.0 / 3, -1.0 / 12}};
constexpr Stencil onwards = {{0, 1, 2, 3, 4}, {-25.0 / 12, 4, -3, 4.0 / 3, -1.0 / 4}};

double size_of(double value, double nominal) { return std::fmax(std::fabs(value), least_size * nominal); }

/// From a point along a direction.
std::vector<double> moved(const std::vector<double>& from, const std::vector<double>& along, double by) {
  std::vector<double> made = from;
  for (std::size_t i = 0; i < made.size(); ++i) made[i] += by * along[i];
  return made;
}

}  // namespace

Direction Instance::no_direction() const {
  Direction made;
  made.x.assign(now_.x.size(), 0.0);
  made.value.assign(now_.value.size(), 0.0);
  made.slopes.assign(now_.slopes.size(), 0.0);
  return made;
}

/// Turn a direction into that of an input, the derivative of one, or a continuous state, by a seed.
Answer Instance::turn(std::uint32_t known, double seed, Direction& into) const {
  const Variable* one = variable(known);
  if (one == nullptr) return refuse("there is no variable with the value reference " + std::to_string(known));
  if (!std::isfinite(seed)) return say(Answer::discard, Category::error, "a seed must be a finite number");
  if (one->kind == Kind::input) return into.value[known] += seed, Answer::ok;
  if (one->kind == Kind::slope) return into.slopes[std::size_t(orders * one->of + one->order - 1)] += seed, Answer::ok;
  for (const ContinuousState& state : model_.states)
    if (exchanges() && state.variable == std::int64_t(known))
      return into.x[std::size_t(state.number)] += seed, Answer::ok;
  return refuse("'" + one->name + "' is " + (exchanges() ? "neither an input nor a continuous state" : "not an input") +
                ", so that nothing is derived by it");
}

/// How far along a direction everything stays about where it is; 0: nothing changes.
double Instance::length(const Direction& along, const Point& here) const {
  if (along.time != 0) return instant;
  double most = 0;
  for (const ContinuousState& state : model_.states) {
    const auto i = std::size_t(state.number);
    most = std::fmax(most, std::fabs(along.x[i]) / size_of(here.x[i], state.nominal));
  }
  for (std::size_t k = 0; k < along.value.size(); ++k) {
    const double nominal = model_.variables[k].nominal;
    if (model_.variables[k].kind != Kind::input) continue;
    most = std::fmax(most, std::fabs(along.value[k]) / size_of(here.value[k], nominal));
    most = std::fmax(most, std::fabs(along.slopes[orders * k]) / size_of(here.slopes[orders * k], nominal));
  }
  return most > 0 ? share / most : 0.0;
}

/// An input at zero, such as a pressure, has a kink there: 1 or -1, the way to its values; 0: none is at zero; 2: two
/// are, of which one would go below.
int Instance::way_from_zero(const Direction& along, const Point& here, double by) const {
  int way = 0;
  for (std::size_t k = 0; k < along.value.size(); ++k) {
    const double gain = along.value[k];
    if (model_.variables[k].kind != Kind::input || gain == 0 || std::fabs(here.value[k]) > 2 * by * std::fabs(gain))
      continue;
    const int own = gain > 0 ? 1 : -1;
    way = way == 0 || way == own ? own : 2;
  }
  return way;
}

/// Whether results have derivatives that can be asked for.
Answer Instance::check_results(const References& of) {
  for (std::size_t i = 0; i < of.n; ++i) {
    const Variable* one = variable(of.at[i]);
    if (one == nullptr) return refuse("there is no variable with the value reference " + std::to_string(of.at[i]));
    if (one->kind == Kind::mode || one->kind == Kind::time || one->is_given())
      return refuse("'" + one->name + "' is no result that has derivatives");
  }
  if (now_.stage == Stage::failed) return refuse("the run has stopped: reset the instance");
  if (!exchanges() && model_.is_fixed()) return refuse("a run of steps of one length has no derivatives");
  return load() ? Answer::ok : Answer::error;
}

/// Where derivatives are asked for: as the master sees it.
bool Instance::find(Point& here) {
  here.x = now_.x, here.time = now_.time, here.value = now_.value, here.slopes = now_.slopes;
  if (is_placed()) return true;
  give_inputs();
  cw_expect_inputs(run(), now_.stage != Stage::event);
  const int status = cw_row(run(), row_.data());
  cw_expect_inputs(run(), 1);
  if (status != int(Status::done)) return refuse(told(status)), false;
  cw_states(run(), here.x.data());
  here.time = cw_time(run());
  return true;
}

/// The motion goes on as it came, and so do the inputs.
bool Instance::follow_motion(Point& here, Direction& along) {
  if (here.time > now_.t_start) here.slopes = now_.past;
  if (!stand(here.time, here.x, here.value, here.slopes)) return false;
  along.time = 1;
  along.x = rates_;
  for (std::size_t k = 0; k < along.value.size(); ++k)
    along.value[k] = here.slopes[orders * k], along.slopes[orders * k] = here.slopes[orders * k + 1];
  return true;
}

/// Rates of results along a direction, or along the motion. Nothing of it stays.
Answer Instance::change(Direction along, bool is_motion, const References& of, double* rates) {
  const std::int64_t kept = cw_copy(run(), before_.data(), std::int64_t(before_.size()));
  const std::vector<double> lines = now_.on_line;
  for (std::size_t i = 0; i < of.n; ++i) rates[i] = 0;
  Point here;
  if (kept < 0) return Answer::discard;
  bool done = find(here) && (!is_motion || follow_motion(here, along));
  double by = done ? length(along, here) : 0.0;
  const int way = is_motion ? 0 : way_from_zero(along, here, by);
  // no direction leaves two kinks both ways
  done = done && way < 2;
  const Stencil& stencil = way == 0 ? around : onwards;
  if (way < 0) by = -by;
  for (int k = 0; k < points && done && by != 0; ++k) {
    const double s = stencil.places[k] * by;
    if (stencil.weights[k] == 0) continue;
    done = stand(here.time + s * along.time, moved(here.x, along.x, s), moved(here.value, along.value, s),
                 moved(here.slopes, along.slopes, s));
    for (std::size_t i = 0; i < of.n && done; ++i)
      rates[i] += stencil.weights[k] / by * computed(model_.variables[of.at[i]]);
  }
  done = cw_paste(run(), before_.data(), kept) == 1 && done;
  now_.on_line = lines;
  is_seen_ = false;
  return done ? Answer::ok : Answer::discard;
}

Answer Instance::derivatives(const References& of, const References& by, const double* seed, double* found) {
  Direction along = no_direction();
  Answer answer = check_results(of);
  for (std::size_t i = 0; i < by.n && answer == Answer::ok; ++i) answer = turn(by.at[i], seed[i], along);
  return answer != Answer::ok ? answer : change(along, false, of, found);
}

Answer Instance::adjoint(const References& of, const References& by, const double* seed, double* found) {
  std::vector<double> rates(of.n);
  const double one = 1;
  for (std::size_t i = 0; i < by.n; ++i) {
    const Answer answer = derivatives(of, {by.at + i, 1}, &one, rates.data());
    if (answer != Answer::ok) return answer;
    found[i] = 0;
    for (std::size_t k = 0; k < of.n; ++k) found[i] += seed[k] * rates[k];
  }
  return Answer::ok;
}

Answer Instance::output_rates(const References& of, double* rates) {
  const Answer answer = check_results(of);
  return answer != Answer::ok ? answer : change(no_direction(), true, of, rates);
}

}  // namespace clutchwork::fmi

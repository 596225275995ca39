#include <clutchwork/layout.gen.hpp>

#include <cmath>
#include "instance.hpp"

/// Co-simulation: the instance takes the steps. docs/guide/fmu.md
namespace clutchwork::fmi {

namespace {

/// Instants that are closer are one, as a share of them.
constexpr double round_off = 1e-9, most_gap = 0.01;

}  // namespace

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
  now_.past = now_.slopes;
  for (std::size_t k = 0; k < model_.variables.size(); ++k) {
    if (model_.variables[k].kind != Kind::input || !is_line(k)) continue;
    const double* slope = now_.slopes.data() + orders * k;
    now_.value[k] += s * (slope[0] + s * (slope[1] / 2 + s * slope[2] / 6));
    now_.past[orders * k] = slope[0] + s * (slope[1] + s * slope[2] / 2);
    now_.past[orders * k + 1] = slope[1] + s * slope[2];
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

}  // namespace clutchwork::fmi

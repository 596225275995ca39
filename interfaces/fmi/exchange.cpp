#include <clutchwork/layout.gen.hpp>

#include <cmath>
#include "instance.hpp"

/// Model exchange: the importer takes the steps. docs/theory/model-exchange.md
namespace clutchwork::fmi {

/// The motion at the time and the state of the importer.
bool Instance::place() { return stand(now_.time, now_.x, now_.value, now_.slopes); }

/// The motion at a point, the modes of all contacts held; inputs go on smoothly.
bool Instance::stand(double time, const std::vector<double>& x, const std::vector<double>& value,
                     const std::vector<double>& slopes) {
  for (std::size_t k = 0; k < model_.variables.size(); ++k) {
    const Variable& one = model_.variables[k];
    if (one.kind != Kind::input) continue;
    for (std::int64_t input : one.inputs) cw_place_input(run(), input, value[k], slopes[orders * k]);
  }
  const int status = cw_place(run(), time, x.data(), row_.data());
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

}  // namespace clutchwork::fmi

// Signals that are set and released while a run goes on, and runs that begin later than at zero.

#include "check.hpp"
#include "models.hpp"

using namespace fixture;

namespace {

bool near(double a, double b, double tolerance = 1e-9) { return std::abs(a - b) <= tolerance * (1 + std::abs(b)); }

void same(const Numbers& a, const Numbers& b) {
  if (!CHECK(a.size() == b.size())) return;
  CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

/// One shaft of inertia 1 under a torque that rises from 0 by 2 per second, repeated every second or not.
Model pushed(double period = 0) {
  Model m;
  const int push = m.signal({{0, {0, 2}}, {0.5, {1, -2}}, {1, {0}}}, 0, period);
  m.element<elements::Torque>(housing, m.shaft(1), {}, {push});
  return m;
}

double speed(Run& r) { return r.row()[std::size_t(r.at.speed)]; }
double input(Run& r) { return r.row()[std::size_t(r.at.input)]; }

/// It holds what it is told and follows its segments before and after.
void holds_and_follows() {
  for (double period : {0.0, 1.0}) {
    Run r(pushed(period));
    CHECK(cw_expect_inputs(r.run, 1) == 1);
    CHECK(r.advance(0.25) == 0 && near(speed(r), 0.0625) && near(input(r), 0.5));
    CHECK(cw_set_input(r.run, 0, 4) == 1 && near(input(r), 4));
    CHECK(r.advance(0.6) == 0 && near(speed(r), 0.0625 + 4 * 0.35) && input(r) == 4);
    CHECK(cw_release_input(r.run, 0) == 1 && near(input(r), 0.8));
    // what is left of the fall: half of the slope times the square of the time
    CHECK(r.advance(1) == 0 && near(speed(r), 0.0625 + 4 * 0.35 + 0.16));
    // nothing has changed when it is told again
    CHECK(cw_release_input(r.run, 0) == 1);
  }
}

/// Beyond the knots that it passed meanwhile, one that repeats is in step.
void is_in_step_again() {
  Run held(pushed(1)), plain(pushed(1));
  CHECK(cw_set_input(held.run, 0, 0.3) == 1 && held.advance(7.3) == 0 && plain.advance(7.3) == 0);
  CHECK(cw_release_input(held.run, 0) == 1);
  CHECK(held.advance(7.4) == 0 && plain.advance(7.4) == 0);
  CHECK(near(input(held), input(plain)));
  CHECK(held.advance(9.7) == 0 && plain.advance(9.7) == 0 && near(input(held), input(plain)));
}

/// What is set before the first step belongs to the start, of a system with knots before it too.
void belongs_to_the_start() {
  Run r(three_shafts()), other(three_shafts());
  r.row();
  CHECK(cw_set_input(r.run, 0, 3) == 1 && cw_set_input(other.run, 0, 3) == 1);
  const Bytes saved = r.save();
  CHECK(cw_restore(r.run, saved.data(), std::int64_t(saved.size())) == 1);
  CHECK(r.advance(1) == 0 && other.advance(1) == 0);
  same(r.row(), other.row());
}

/// Held signals, whatever they did before, are part of a state.
void are_saved(const Model& model) {
  Run r(model), other(model);
  check::Random g{11};
  const int inputs = int(r.sys.inputs);
  for (int round = 0; round < 12; ++round) {
    const int i = g.below(inputs);
    if (g.below(3) == 0) {
      cw_release_input(r.run, i);
    } else {
      CHECK(cw_set_input(r.run, i, g.between(0, 30)) == 1);
    }
    const Bytes saved = r.save();
    CHECK(cw_restore(other.run, saved.data(), std::int64_t(saved.size())) == 1);
    CHECK(other.save() == saved);
    const double t = 0.17 * (round + 1);
    CHECK(r.advance(t) == 0 && other.advance(t) == 0);
    same(r.row(), other.row());
    same(r.events(), other.events());
  }
}

/// Signals and rows are those of that time; speeds are those of the start.
void begins_later() {
  Run r(pushed());
  CHECK(cw_set_option(r.run, "t_start", 0.75) == 1 && cw_time(r.run) == 0.75);
  CHECK(r.advance(0.5) == -1 && near(input(r), 0.5) && speed(r) == 0);
  CHECK(r.advance(1) == 0 && near(speed(r), 0.0625) && cw_time(r.run) == 1);
  for (double bad : {-1.0, double(NAN), double(INFINITY)}) CHECK(cw_set_option(r.run, "t_start", bad) == 0);
  // the start is over
  CHECK(cw_set_option(r.run, "t_start", 3) == 1 && cw_time(r.run) == 1);
  Run late(pushed(1)), whole(pushed(1));
  cw_set_option(late.run, "t_start", 5.25);
  CHECK(late.advance(5.25) == 0 && whole.advance(5.25) == 0 && near(input(late), input(whole)));
  const Bytes saved = late.save();
  CHECK(cw_restore(whole.run, saved.data(), std::int64_t(saved.size())) == 1 && cw_time(whole.run) == 5.25);
}

/// A knot at the end of a call waits for what may be set there.
void knots_wait() {
  for (int expected : {0, 1}) {
    Run r(pushed());
    cw_expect_inputs(r.run, expected);
    CHECK(r.advance(1) == 0);
    CHECK(cw_set_input(r.run, 0, 5) == 1 && near(input(r), 5));
  }
}

void wrong_calls() {
  Run r(driven());
  const Bytes before = r.save();
  CHECK(cw_release_input(nullptr, 0) == 0 && cw_release_input(r.run, -1) == 0 && cw_release_input(r.run, 99) == 0);
  // the system says nothing about it
  CHECK(cw_release_input(r.run, 1) == 0 && cw_set_input(r.run, 0, NAN) == 0);
  CHECK(cw_expect_inputs(nullptr, 1) == 0 && cw_pending_events(nullptr) == -1 && cw_pending_events(r.run) == 0);
  CHECK(r.save() == before);
  CHECK(r.advance(1.5) == 0);
  const std::int64_t pending = cw_pending_events(r.run);
  CHECK(pending * event_size == std::int64_t(r.events().size()) && cw_pending_events(r.run) == 0);
}

/// Runs of a group may hold signals that others follow.
void in_groups() {
  constexpr int n = 8;
  std::vector<Run> together, alone;
  std::vector<cw_member> members;
  for (int i = 0; i < n; ++i) together.emplace_back(three_shafts()), alone.emplace_back(three_shafts());
  for (int i = 0; i < n; ++i) {
    for (Run* r : {&together[std::size_t(i)], &alone[std::size_t(i)]}) {
      if (i % 3 != 0) CHECK(cw_set_input(r->run, i % 2, 20.0 + i) == 1);
    }
    members.push_back({together[std::size_t(i)].run, nullptr, nullptr, 0, 0, 0, 0});
  }
  const std::int64_t size = cw_group_size(together[0].run);
  Bytes memory(std::size_t(size > 0 ? size : 1));
  for (double t : {0.3, 0.9, 1.6}) {
    CHECK(cw_advance_group(members.data(), n, t, memory.data(), size) == 0);
    for (int i = 0; i < n; ++i) {
      CHECK(members[std::size_t(i)].status == 0 && alone[std::size_t(i)].advance(t) == 0);
      same(together[std::size_t(i)].row(), alone[std::size_t(i)].row());
      if (t < 0.5) cw_release_input(together[std::size_t(i)].run, 0), cw_release_input(alone[std::size_t(i)].run, 0);
    }
  }
}

}  // namespace

int test_outside() {
  holds_and_follows();
  is_in_step_again();
  belongs_to_the_start();
  for (const Model& model : {three_shafts(), chain(), bristles(), hysteresis(), warm(), driven(), parallel()})
    are_saved(model);
  begins_later();
  knots_wait();
  wrong_calls();
  in_groups();
  return check::result();
}

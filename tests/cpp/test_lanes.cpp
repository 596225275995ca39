// Runs advanced in groups have the bits of runs alone, whatever the group.

#include <functional>
#include <memory>

#include "check.hpp"
#include "models.hpp"

using namespace fixture;

namespace {

using Random = check::Random;
using Make = std::function<Model(Random&)>;

/// Engine with a kink, spring, load, a clutch that engages and one that lets go: everything steps in lanes.
Model shift(Random& r) {
  Model m;
  const double x = r.between(0.8, 1.2), y = r.between(0.9, 1.1);
  const int a = m.shaft(0.3 * y, 60 * x), b = m.shaft(0.4, 30), c = m.shaft(2 * x, 5);
  const int on = m.signal({{0, {0}}, {0.1 * y, {0, 400 * x}}, {0.6 * y, {200 * x}}});
  const int off = m.signal({{0, {80 * y}}, {0.3, {80 * y, -200}}, {0.3 + 0.4 * y, {0}}});
  const int load = m.constant(20 * x);
  // passed at other instants, on the way up and down
  const Numbers table = m.curve({0, 68 * x, 110}, {150 * y, 90, -60});
  m.element<elements::SpeedTorque>(housing, a, {table[0], table[1], x});
  m.element<elements::SpringDamper>(b, c, {4000 * x, 6, 0});
  m.element<elements::ResistingTorque>(housing, c, {0.5 * y}, {load});
  m.contact<elements::Clutch, laws::Exponential>(a, b, {0.9}, {on}, {0.6, 0.5 * y, 0.3, 8 * x});
  m.contact<elements::Brake, laws::Stribeck>(housing, b, {1.1 * y}, {off}, {0.5, 0.4, 4, 2, 1, 0.001});
  return m;
}

/// A wave of torque that makes a clutch stick and slip at other instants in each variant; a freewheel, and prescribed
/// speed where it is wanted.
template <bool prescribed>
Model stick_slip(Random& r) {
  Model m;
  const double x = r.between(0.7, 1.3);
  const int a =
      prescribed ? m.prescribed(0.1, m.signal({{0, {8 * x, 5}}, {0.5, {10, -8 * x, 3}}})) : m.shaft(0.5 * x, 3);
  const int b = m.shaft(0.7, 2), c = m.shaft(0.4 * x);
  const int push = m.signal({{0, {2, 0, 0, 0, 14 * x, 11, 0.3}}, {0.9, {3, x, 0, 0, 9, 7, 0, 0.4, 2, 3, 1, 0.1}}});
  m.element<elements::Torque>(housing, b, {}, {push});
  m.element<elements::Damper>(housing, c, {1.5 * x});
  m.element<elements::LinearTorque>(housing, b, {-1.5, 20 * x, r.unit() < 0.5 ? 1.0 : 0.0});
  m.element<elements::WetDrag>(a, c, {3, 5 * x}, {m.constant(1)});
  m.contact<elements::Clutch, laws::Coulomb>(a, b, {x}, {m.constant(6)}, {1.2, 1});
  m.contact<elements::TorqueLimiter, laws::Stribeck>(b, c, {4 * x}, {}, {1.5, 1, 0.8, 1, 1.5, 0});
  m.contact<elements::OneWayClutch, laws::Coulomb>(housing, c, {1}, {m.constant(0.5)}, {0.3, 0.2});
  return m;
}

/// Everything a run tells: what is written on the way, the last row, events, counters, where it stands.
struct Story {
  Numbers times, rows;
  std::int64_t filled = 0, counts[7];
  int status = 0;
  Numbers last, events;

  void end(Run& r) {
    cw_statistics(r.run, counts);
    events = r.events();
    last = r.row();
    double value = 0;
    last.push_back(cw_time(r.run)), last.push_back(double(cw_detail(r.run, &value))), last.push_back(value);
    last.push_back(double(cw_detail_row(r.run)));
  }
};

void same(const Numbers& a, const Numbers& b) {
  if (CHECK(a.size() == b.size())) CHECK(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

void same(const Story& a, const Story& b) {
  CHECK(a.status == b.status && a.filled == b.filled);
  CHECK(std::memcmp(a.counts, b.counts, sizeof a.counts) == 0);
  same(a.times, b.times), same(a.rows, b.rows), same(a.last, b.last), same(a.events, b.events);
}

/// What differs between the runs of a group, beside their numbers.
struct Plan {
  int instants = 0, steps = 0;
  bool integrals = false;
  std::function<void(cw_run*, int)> disturb = [](cw_run*, int) {};
};

/// Both stories of each run, in groups and alone, in two parts of the time.
void advances(const std::vector<Bytes>& systems, double end, const Plan& plan) {
  std::vector<std::unique_ptr<Run>> alone, together;
  auto load = [&](auto& runs) {
    for (std::size_t i = 0; i < systems.size(); ++i) {
      runs.push_back(std::make_unique<Run>(systems[i]));
      cw_set_option(runs[i]->run, "work", plan.integrals), cw_set_option(runs[i]->run, "angles", plan.integrals);
      cw_set_option(runs[i]->run, "method", 1);
      plan.disturb(runs[i]->run, int(i));
    }
  };
  load(alone), load(together);
  std::int64_t need = 0;
  for (auto& r : together) need = std::max(need, cw_group_size(r->run));
  Bytes memory(std::size_t(need) + 1);
  for (double t : {0.6 * end, end}) {
    const int room = plan.steps > 0 ? 4000 : plan.instants;
    std::vector<Story> one(systems.size()), other(systems.size());
    std::vector<cw_member> members(systems.size());
    for (std::size_t i = 0; i < systems.size(); ++i) {
      for (Story* s : {&one[i], &other[i]}) {
        s->times.assign(std::size_t(room), 0.0), s->rows.assign(std::size_t(room) * alone[i]->at.size, 0.0);
        for (int k = 0; k < plan.instants; ++k) s->times[k] = t * (k + 1) / plan.instants;
      }
      one[i].status =
          cw_advance(alone[i]->run, t, one[i].times.data(), one[i].rows.data(), room, plan.steps, &one[i].filled);
      one[i].end(*alone[i]);
      members[i] = {together[i]->run, other[i].times.data(), other[i].rows.data(), room, plan.steps, -5, -5};
    }
    CHECK(cw_advance_group(members.data(), std::int64_t(members.size()), t, memory.data() + 1, need) == 0);
    for (std::size_t i = 0; i < systems.size(); ++i) {
      other[i].status = members[i].status, other[i].filled = members[i].filled;
      other[i].end(*together[i]);
      same(one[i], other[i]);
    }
  }
}

std::vector<Bytes> variants(const Make& make, int n, std::uint64_t seed) {
  Random random{seed};
  std::vector<Bytes> systems;
  for (int i = 0; i < n; ++i) systems.push_back(make(random).bytes());
  return systems;
}

const std::vector<Make> models = {shift, stick_slip<false>, stick_slip<true>};

void any_number_of_them() {
  for (const Make& make : models) {
    for (int n : {1, 2, 3, 8, 9, 19}) advances(variants(make, n, 7 + n), 1.5, {});
  }
}

void with_rows_and_integrals() {
  for (const Make& make : models) {
    advances(variants(make, 8, 3), 1.5, {.instants = 37});
    advances(variants(make, 5, 4), 1.5, {.instants = 11, .integrals = true});
    advances(variants(make, 8, 5), 1.5, {.steps = 1});
    advances(variants(make, 8, 5), 1.5, {.steps = 4});
    advances(variants(make, 8, 6), 1.5, {.integrals = true});
  }
}

/// Lanes with other tolerances, those that stop early, and one that overflows.
void lanes_that_stop() {
  Plan plan;
  plan.disturb = [](cw_run* run, int i) {
    if (i % 3 == 1) cw_set_option(run, "max_steps", 20 + 7 * i);
    if (i % 3 == 2) cw_set_option(run, "rtol", 1e-5 / (i + 1));
    if (i == 6) cw_set_param(run, 2, 1e308);
    if (i == 4) cw_set_option(run, "max_step", 0.01);
    if (i == 0) cw_set_option(run, "max_events", 1);
  };
  for (const Make& make : models) advances(variants(make, 16, 12), 1.5, plan);
}

int asked(void* left) { return --*static_cast<int*>(left) < 0; }

/// A run that its caller stops hurts no other.
void stopped_by_the_caller() {
  std::vector<Bytes> systems = variants(shift, 8, 21);
  std::vector<int> left(16, 1 << 20);
  Plan plan;
  int calls = 0;
  plan.disturb = [&](cw_run* run, int i) {
    int& mine = left[std::size_t(calls++)];
    if (i == 3) mine = 40;
    cw_set_poll(run, asked, &mine);
  };
  advances(systems, 1.5, plan);
}

/// Neighbours with another structure, or with what does not step in lanes.
void mixed_groups() {
  Random random{5};
  for (int round = 0; round < 6; ++round) {
    std::vector<Bytes> systems;
    for (int i = 0; i < 11; ++i) {
      const int kind = random.below(5);
      systems.push_back(kind < 3    ? models[std::size_t(kind)](random).bytes()
                        : kind == 3 ? three_shafts().bytes()
                                    : bristles().bytes());
    }
    advances(systems, 1.2, {.instants = 5});
  }
}

void refusals() {
  Random random{1};
  Run run(shift(random));
  cw_member member{run.run, nullptr, nullptr, 0, 0, 0, 0};
  const std::int64_t need = cw_group_size(run.run);
  Bytes memory(std::size_t(need) + 64);
  CHECK(need > 0 && cw_group_size(nullptr) == -1);
  CHECK(cw_advance_group(nullptr, 1, 1.0, memory.data(), need) == -1);
  CHECK(cw_advance_group(&member, -1, 1.0, memory.data(), need) == -1);
  CHECK(cw_advance_group(&member, 1, 1.0, memory.data(), need - 1) == -1);
  CHECK(cw_advance_group(&member, 1, 1.0, nullptr, need) == -1);
  CHECK(cw_time(run.run) == 0);
  CHECK(cw_advance_group(&member, 0, 1.0, nullptr, 0) == 0);
  CHECK(cw_advance_group(&member, 1, -1.0, memory.data(), need) == 0 && member.status == -1);
  member.run = nullptr;
  CHECK(cw_advance_group(&member, 1, 1.0, memory.data(), need) == -1);
}

}  // namespace

int test_lanes() {
  any_number_of_them();
  with_rows_and_integrals();
  lanes_that_stop();
  stopped_by_the_caller();
  mixed_groups();
  refusals();
  return check::result();
}

// Contacts whose laws never stick: vanishing loads, freewheels, and contacts beside them that do stick.

#include "friction.hpp"

/// Contacts whose laws never stick, among loads that vanish, freewheels, and contacts that do stick.
using namespace fixture;

namespace {

const Numbers curve = stribeck_curve(0.15, 0.1, 2, 1, 0.001);
const Numbers deflections{0.01, 0.02, 0.05, 0.1}, shares{0.1, 0.2, 0.3, 0.4};

/// A freewheel that overruns, blocks, and gives way again, with a law beside it: the block is exact, the torques add.
/// `law(model)`: its numbers; `coefficient(speed, states)`: what it says.
template <class L, class Law, class F>
void freewheel(Law&& law, F&& coefficient) {
  Model m;
  const double load = 20, inertia = 0.5;
  const int shaft = m.shaft(inertia, 10);
  m.element<elements::Torque>(housing, shaft, {}, {m.signal({{0, {-6}}, {2, {-6, 8}}})});
  m.contact<elements::OneWayClutch, L>(housing, shaft, {1}, {m.constant(load)}, law(m));
  TightRun r(m);
  int blocked = 0, overrunning = 0;
  double held = 0;
  r.grid(4, 400, [&](double t, const double* row) {
    const double push = t <= 2 ? -6 : -6 + 8 * (t - 2), speed = row[r.at.speed], torque = row[r.at.contact_torque];
    const double own = load * coefficient(speed, row + r.at.state);
    CHECK(speed >= 0);
    CHECK_NEAR(inertia * row[r.at.acceleration], push + torque, 1e-9);
    CHECK_NEAR(row[r.at.contact_capacity], load * 0.15, 1e-12);
    if (row[r.at.contact_mode] == 0) {
      ++blocked;
      held = own;
      CHECK(speed == 0);
      CHECK_NEAR(torque, -push, 1e-12);
      CHECK(torque >= -own - 1e-9);
    } else {
      ++overrunning;
      CHECK(row[r.at.contact_mode] == 1);
      CHECK_NEAR(torque, -own, 1e-9);
    }
  });
  CHECK(blocked > 50 && overrunning > 50);
  const Numbers events = r.events();
  if (!CHECK(int(events.size()) == 2 * event_size)) return;
  CHECK(events[2] == 1 && events[3] == 0 && events[4] == 1);
  CHECK(events[event_size + 2] == 0 && events[event_size + 3] == 1 && events[event_size + 4] == 2);
  // it gives way where the push meets the torque of the law alone
  CHECK_NEAR(events[event_size], 2 + (6 + held) / 8, 1e-9);
}

void freewheels() {
  auto of = [](const Numbers& numbers) { return [numbers](Model&) { return numbers; }; };
  auto elements = [](const Numbers& more) {
    return [more](Model& m) { return joined({curve, m.curve(deflections, shares), more}); };
  };
  auto sum = [](double v, const double* f) { return f[0] + f[1] + f[2] + f[3] + 0.001 * v; };
  freewheel<laws::Tanh>(of({0.15, 5}), [](double v, const double*) { return 0.15 * std::tanh(2 * v / 5); });
  freewheel<laws::Dahl>(of({0.15, 10, 1}), [](double, const double* f) { return f[0]; });
  freewheel<laws::LuGre>(of(joined({curve, {10, 0}})), [](double v, const double* f) { return f[0] + 0.001 * v; });
  freewheel<laws::GMS>(elements({5, 0}), sum);
  freewheel<laws::Leuven>(elements({1, 0}), sum);
  freewheel<laws::Mykhalevych>(of({0.15, 0.1, 0.1, 2, 0.5, 0, 3, 1}), [](double v, const double* w) {
    return (0.1 + 0.05 * std::exp(-v * v / 4)) * std::tanh(w[0] + 0.25 * v);
  });
}

/// The freewheel stops a slip that runs backward by an impulse, whatever the law beside it.
void freewheel_stops() {
  Model m;
  const int a = m.shaft(1, 5), b = m.shaft(2, -1);
  m.element<elements::Torque>(a, b, {}, {m.constant(-0.1)});
  m.contact<elements::OneWayClutch, laws::LuGre>(a, b, {1}, {m.constant(3)}, joined({curve, {10, 0}}));
  TightRun r(m);
  r.grid(1, 10, [&](double, const double* row) {
    CHECK_NEAR(row[r.at.speed + a], 1, 1e-12);
    CHECK(row[r.at.speed + a] == row[r.at.speed + b]);
    CHECK(row[r.at.contact_mode] == 0);
  });
}

/// Without load a contact forgets: no torque, states at zero, and from there when it closes again.
template <class L>
void relaxes(bool elements, const Numbers& more) {
  const int states = elements ? 4 : 1;
  // off by a jump and by a ramp, on by a ramp and by a jump
  Model m;
  const int pressure =
      m.signal({{0, {20}}, {0.5, {0}}, {1.0, {0, 40}}, {1.5, {20, -50}}, {2.2, {-15, 10}}, {2.5, {20}}});
  const int a = m.shaft(1e9, 0.4), b = m.shaft(3, -0.2);
  const Numbers points = elements ? m.curve(deflections, shares) : Numbers{};
  m.contact<elements::Clutch, L>(a, b, {1}, {pressure}, joined({curve, points, more}));
  TightRun r(m);
  int off = 0, on = 0;
  r.grid(3, 600, [&](double t, const double* row) {
    // a row at an event is the left limit
    const bool unloaded = (t > 0.5 && t <= 1) || (t > 1.9 + 1e-9 && t <= 2.5);
    double size = 0;
    for (int i = 0; i < states; ++i) size += std::fabs(row[r.at.state + i]);
    CHECK((row[r.at.contact_mode] == 2) == unloaded);
    CHECK((row[r.at.contact_torque] == 0) == unloaded);
    CHECK((size == 0) == unloaded);
    (unloaded ? off : on) += 1;
    // rows after the closing: all that was bent was bent since
    for (double closed : {1.0, 2.5}) {
      if (t > closed && t < closed + 0.02) CHECK(size < 30 * 0.6 * (t - closed));
    }
  });
  CHECK(off > 200 && on > 300);
  for (std::size_t e = 0, n = r.events().size(); e < n; ++e) CHECK(n == 0);
}

/// A law that jumps with the sign of its slip cannot come to rest: the run ends where it should, and says so.
void chatter() {
  for (double push : {0.0, 3.0}) {
    Model m;
    m.shaft(1, 1);
    const int shaft = m.shaft(2, 5);
    m.element<elements::Torque>(housing, shaft, {}, {m.constant(push)});
    m.contact<elements::Clutch, laws::Coulomb>(housing, 0, {1}, {m.constant(1)}, {1, 1});
    m.contact<elements::BearingFriction, laws::NaiveSign>(housing, shaft, {50}, {}, stribeck_curve(0.15, 0.1, 1e-9));
    Run r(m);
    CHECK(r.advance(10) == int(Status::chatter));
    // 5 = (50 * 0.1 - push) / 2 t
    const double rest = 5 * 2 / (5 - push);
    CHECK(cw_time(r.run) >= rest - 1e-9 && cw_time(r.run) < rest + 0.05);
    double rate = 0;
    CHECK(cw_detail(r.run, &rate) == 2);
    CHECK(std::fabs(rate) < 0.1);
    std::int64_t counts[7];
    cw_statistics(r.run, counts);
    CHECK(counts[0] + counts[1] < 1000);
    // once is no chatter
    Run once(m);
    CHECK(once.advance(0.99 * rest) == 0);
  }
}

/// A slip that passes zero again and again, as it is driven to, is no chatter.
void swings() {
  Model m;
  driven<laws::NaiveSign>(m, {{0, {0, 0, 0, 0, 3, 40, 0, 0}}}, 50, stribeck_curve(0.15, 0.1, 1));
  Run r(m);
  CHECK(r.advance(20) == 0);
}

/// Clutches that stick and laws that do not on one driveline: what goes in by work is what the inertias hold.
void energy() {
  Model m;
  const double inertia[] = {0.4, 0.2, 0.3, 1.5}, start[] = {30, 0, 0, 0};
  for (int i = 0; i < 4; ++i) m.shaft(inertia[i], start[i]);
  const int push = m.signal({{0, {12}}, {1, {-20, 30}}, {2, {6, 0, 0, 0, 15, 12, 0, 0}}});
  const int pressure = m.signal({{0, {0, 60}}, {1, {60}}, {1.6, {0}}, {2.1, {60}}});
  m.element<elements::Torque>(housing, 0, {}, {push});
  m.element<elements::SpringDamper>(0, 1, {300, 0.2, 0});
  m.contact<elements::Clutch, laws::Stribeck>(1, 2, {1}, {pressure}, stribeck_curve(0.3, 0.25, 3));
  m.contact<elements::Clutch, laws::LuGre>(2, 3, {1}, {pressure}, joined({curve, {30, 0.01}}));
  m.contact<elements::OneWayClutch, laws::Tanh>(housing, 2, {1}, {m.constant(1)}, {0.15, 1});
  m.contact<elements::BearingFriction, laws::GMS>(housing, 3, {8}, {},
                                                  joined({curve, m.curve(deflections, shares), {50, 0}}));
  TightRun r(m);
  CHECK(r.advance(3) == 0);
  CHECK(!r.events().empty());
  const Numbers row = r.row();
  double kinetic = -0.5 * 0.4 * 900, work = 0, turned = 0;
  for (int i = 0; i < 4; ++i) kinetic += 0.5 * inertia[i] * row[r.at.speed + i] * row[r.at.speed + i];
  for (int e = 0; e < 2; ++e) work += row[r.at.element_work + e], turned += std::fabs(row[r.at.element_work + e]);
  for (int c = 0; c < 4; ++c) work += row[r.at.contact_work + c], turned += std::fabs(row[r.at.contact_work + c]);
  CHECK_NEAR(kinetic, work, 1e-8 * turned);
  for (int c = 0; c < 4; ++c) CHECK(row[r.at.contact_work + c] < 0);
}

}  // namespace

int test_compliant() {
  freewheels();
  freewheel_stops();
  relaxes<laws::LuGre>(false, {10, 0});
  relaxes<laws::GMS>(true, {5, 0});
  relaxes<laws::Leuven>(true, {1, 0});
  chatter();
  swings();
  energy();
  return check::result();
}

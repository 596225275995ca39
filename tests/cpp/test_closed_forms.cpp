// Locks, break-aways, work and contacts between prescribed speeds against closed forms.

#include "check.hpp"
#include "models.hpp"

using namespace fixture;

namespace {

/// Slip 100 rad/s over 1.2 kg m2 falls under 75 N m within 1.6 s.
void engagement() {
  Model m;
  const int a = m.shaft(2, 100), b = m.shaft(3, 0);
  m.contact<elements::Clutch, laws::Coulomb>(a, b, {0.5}, {m.constant(150)}, {1.2, 1.0});
  Run r(m);
  if (!CHECK(r.run != nullptr)) return;
  CHECK(r.advance(1.0) == 0);
  Numbers row = r.row();
  CHECK_NEAR(row[r.at.speed + a], 100 - 37.5, 1e-10);
  CHECK_NEAR(row[r.at.contact_torque], 75, 1e-12);
  CHECK(row[r.at.contact_mode] == -1);
  CHECK(r.advance(3.0) == 0);
  const Numbers events = r.events();
  if (!CHECK(int(events.size()) == event_size)) return;
  CHECK_NEAR(events[0], 1.6, 1e-12);
  CHECK(events[2] == -1 && events[3] == 0 && events[4] == 1);
  CHECK_NEAR(events[5], 62.5, 1e-9);
  row = r.row();
  CHECK_NEAR(row[r.at.speed + a], 40, 1e-10);
  // locked speeds are products of one number, each rounded
  CHECK_NEAR(row[r.at.speed + a], row[r.at.speed + b], 1e-13);
  CHECK_NEAR(row[r.at.contact_work], -6000, 1e-8);
  CHECK_NEAR(row[r.at.angle + a], 1.6 * 70 + 1.4 * 40, 1e-9);
  CHECK_NEAR(row[r.at.contact_capacity], 90, 1e-12);
}

/// A locked clutch under a ramp of torque slips when its share of it passes the static torque.
void break_away() {
  Model m;
  const int a = m.shaft(2), b = m.shaft(3);
  m.element<elements::Torque>(housing, a, {}, {m.signal({{0, {0, 50}}})});
  m.contact<elements::Clutch, laws::Coulomb>(a, b, {1}, {m.constant(60)}, {1.0, 0.8});
  Run r(m);
  CHECK(r.advance(4.0) == 0);
  const Numbers events = r.events();
  if (!CHECK(int(events.size()) == event_size)) return;
  // 50 t * 3 / 5 = 60
  CHECK_NEAR(events[0], 2.0, 1e-12);
  CHECK(events[2] == 0 && events[3] == -1 && events[4] == 2);
  CHECK_NEAR(events[6], 60, 1e-9);
  CHECK_NEAR(events[7], 48, 1e-9);
  // speed 20 at 2 s; then (50 t - 48) / 2 and 48 / 3
  const Numbers row = r.row();
  CHECK_NEAR(row[r.at.speed + a], 20 + (25 * 12 - 48 * 2) / 2.0, 1e-9);
  CHECK_NEAR(row[r.at.speed + b], 20 + 32, 1e-9);
}

/// What goes in by work is what the inertias hold, over springs, dampers, curves, knots and events.
void energy() {
  const int a = 0, b = 1, c = 2;
  Run r(three_shafts());
  CHECK(cw_set_option(r.run, "rtol", 1e-10) == 1 && cw_set_option(r.run, "atol", 1e-11) == 1);
  CHECK(r.advance(2.5) == 0);
  CHECK(!r.events().empty());
  const Numbers row = r.row();
  const double w[3] = {row[a], row[b], row[c]};
  const double kinetic = 0.1 * w[0] * w[0] + 0.25 * w[1] * w[1] + 0.75 * w[2] * w[2] - 2.5;
  double work = row[r.at.contact_work], turned = 0;
  for (int e = 0; e < 3; ++e) work += row[r.at.element_work + e], turned += std::fabs(row[r.at.element_work + e]);
  CHECK_NEAR(kinetic, work, 1e-8 * turned);
  CHECK(row[r.at.contact_work] < 0);
  // the torque of the spring from the angles
  CHECK_NEAR(row[r.at.state], 900 * (row[r.at.angle + b] - row[r.at.angle + a]), 1e-6);
}

/// Between prescribed speeds a contact follows the prescription: torque kinetic, source work to match.
void prescribed() {
  Model m;
  const int a = m.prescribed(1, m.signal({{0, {10}}, {1, {10, -10}}, {2, {0}}})), b = m.shaft(2);
  m.contact<elements::Brake, laws::Coulomb>(a, b, {1}, {m.constant(8)}, {1, 1});
  Run r(m);
  CHECK(r.advance(2.5) == 0);
  // 4 t meets 10 - 10 (t - 1) at 10/7 s; the brake cannot follow 10 rad/s2 and passes through
  const Numbers events = r.events();
  if (!CHECK(int(events.size()) >= event_size)) return;
  CHECK_NEAR(events[0], 10.0 / 7, 1e-12);
  CHECK(events[2] == -1 && events[3] == 1);
  CHECK_NEAR(r.row()[r.at.speed + b], 40.0 / 7 - 4 * (2.5 - 10.0 / 7), 1e-9);
}

}  // namespace

int test_closed_forms() {
  engagement();
  break_away();
  energy();
  prescribed();
  return check::result();
}

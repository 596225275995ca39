// Derivatives of all components at an instant: values are those of the row, sizes and refusals as documented.

#include "friction.hpp"

using namespace fixture;

namespace {

/// A clutch that warms a mass whose temperature its coefficient follows, a spring, and a freewheel that is locked.
void warm_clutch() {
  Model m;
  const int x = m.shaft(2, 100), y = m.shaft(3), z = m.shaft(1);
  const int node = m.shared(0, 1.0 / 300, 300);
  const Numbers kinetic = m.curve({300, 400}, {0.2, 0.6});
  const Indices temperature{source(of_shared, node)};
  m.element<elements::SpringDamper>(y, z, {500, 2, 0}, {});
  m.contact<elements::Clutch, laws::TemperatureTable>(x, y, {1}, {m.constant(50)}, joined({{0, 0}, kinetic, kinetic}),
                                                      false, {}, 0, temperature);
  m.heat(of_contact_heat, 0, node, 1);
  TightRun r(m);
  CHECK(r.advance(0.25) == 0);
  std::int64_t lines = 0, columns = 0;
  cw_local_size(r.run, &lines, &columns);
  // 1 spring + 1 contact, 2 states, 3 numbers of the contact; rates, states, 1 signal, value
  CHECK(lines == 2 + 2 + 3);
  CHECK(columns == 2 + 2 + 1 + 1);
  Numbers row(std::size_t(cw_row_size(r.run))), local(std::size_t(lines * columns));
  CHECK(cw_local(r.run, row.data(), local.data()) == 0);
  auto at = [&](std::int64_t i, std::int64_t j) { return local[std::size_t(i * columns + j)]; };
  const auto value = columns - 1;
  CHECK_NEAR(at(0, value), row[r.at.element_torque], 1e-9);
  CHECK_NEAR(at(1, value), row[r.at.contact_torque], 1e-9);
  CHECK_NEAR(at(0, 0), -2, 1e-12);
  CHECK_NEAR(at(0, 2), -1, 1e-12);
  // rate of the spring torque
  CHECK_NEAR(at(2, 0), 500, 1e-9);
  // 50 N times 0.004 per K times K per J, against a slip that is backward
  CHECK_NEAR(at(1, 3), 50 * 0.004 / 300, 1e-12);
  const double slip = row[r.at.speed + y] - row[r.at.speed + x];
  CHECK_NEAR(at(3, value), -slip * row[r.at.contact_torque], 1e-6);
  CHECK_NEAR(at(3, 3), -slip * at(1, 3), 1e-9);
  CHECK_NEAR(at(3, 1), -row[r.at.contact_torque], 1e-9);
  CHECK_NEAR(at(4, value), row[r.at.contact_capacity], 1e-9);
  CHECK_NEAR(at(5, value), -at(6, value), 1e-9);
}

void refusals() {
  Model m;
  m.shaft(1);
  TightRun r(m);
  std::int64_t lines = -7, columns = -7;
  cw_local_size(nullptr, &lines, &columns);
  CHECK(lines == -7 && columns == -7);
  cw_local_size(r.run, nullptr, &columns);
  double row[64], local[64];
  CHECK(cw_local(nullptr, row, local) == -1);
  CHECK(cw_local(r.run, nullptr, local) == -1);
  CHECK(cw_local(r.run, row, nullptr) == -1);
  CHECK(cw_local(r.run, row, local) == 0);
}

}  // namespace

int test_local() {
  warm_clutch();
  refusals();
  return check::result();
}

// The full form: its Jacobian against differences, its torques against those of the sparse form.

#include <instances.hpp>
#include "friction.hpp"

#include "typed_run.hpp"

using namespace fixture;

namespace {

/// A converter, a spring, a clutch that warms what its coefficient follows, a drum of given speed, a signal that rises.
Model everything() {
  Model m;
  const int engine = m.shaft(0.4, 210), turbine = m.shaft(0.1, 130), wheels = m.shaft(3, 90), extra = m.shaft(0.7, 20);
  const int drum = m.prescribed(1, m.signal({{0, {50, 12}}}));
  const int node = m.shared(0, 1.0 / 300, 330);
  auto list = [&](const Numbers& x) { return m.curve(x, Numbers(x.size())); };
  const Numbers tables =
      joined({list({0, 0.5, 1}), list({2, 1.4, 1}), list({2e-3, 1.6e-3, 0}), list({0}), list({0}), {0.05}});
  m.coupled<elements::TorqueConverter>({{housing, engine}, {housing, turbine}, {engine, turbine}}, tables, {}, {40});
  const Numbers table = joined({list({0, 1}), list({1e-3, 0}), list({0}), {860, 0}});
  m.coupled<elements::FluidCoupling>({{wheels, extra}, {housing, wheels}, {housing, extra}}, table);
  m.element<elements::SpringDamper>(turbine, wheels, {500, 2, 0}, {}, {30});
  m.element<elements::SpringDamper>(wheels, drum, {200, 1, 0}, {}, {5});
  const Numbers kinetic = m.curve({300, 400}, {0.2, 0.6});
  const int press = m.signal({{0, {50, 7}}});
  m.contact<elements::Clutch, laws::TemperatureTable>(engine, extra, {1}, {press}, joined({{0, 0}, kinetic, kinetic}),
                                                      false, {}, 0, {source(of_shared, node)});
  m.heat(of_contact_heat, 0, node, 1), m.heat(of_heat, 0, node, 0.5), m.heat(of_heat, 3, node, 1);
  m.flow<elements::Conduction>(node, -1, {3}, {source(of_shared, node), m.constant(300)});
  return m;
}

void jacobian() {
  TypedRun<double> run(everything());
  Workspace<double>& ws = run.ws;
  if (!CHECK(reach_phase(ws) == Status::running)) return;
  FullForm<double> form(ws);
  const int n = form.n();
  Numbers y(ws.reduced.y, ws.reduced.y + n), d(y), dt(y), up(y), down(y), at(y);
  form.solve_mass(y.data());
  at = y;
  linearize(form, 0.0, y.data(), d.data(), dt.data(), ws.step_start);
  const Numbers jacobian(ws.full.jacobian, ws.full.jacobian + n * n);
  auto compare = [&](int i, double found, double h) {
    const double slope = (up[std::size_t(i)] - down[std::size_t(i)]) / (2 * h);
    CHECK_NEAR(found, slope, 1e-6 * (1 + std::abs(slope)) + 1e-11 * std::abs(d[std::size_t(i)]) / h);
  };
  for (int j = 0; j < n; ++j) {
    const double h = 1e-5 * (1 + std::abs(y[std::size_t(j)]));
    at[std::size_t(j)] = y[std::size_t(j)] + h, evaluate(form, 0.0, at.data(), up.data());
    at[std::size_t(j)] = y[std::size_t(j)] - h, evaluate(form, 0.0, at.data(), down.data());
    at[std::size_t(j)] = y[std::size_t(j)];
    for (int i = 0; i < n; ++i) compare(i, jacobian[std::size_t(i * n + j)], h);
  }
  evaluate(form, 1e-5, y.data(), up.data()), evaluate(form, -1e-5, y.data(), down.data());
  for (int i = 0; i < n; ++i) compare(i, dt[std::size_t(i)], 1e-5);
  // the matrix of a step times its solution
  const double scale = 300;
  Numbers b(y.size(), 1), x(b);
  CHECK(form.factor_whole(scale));
  form.solve_whole(x.data(), n);
  Numbers back(y.size(), 0);
  form.add_mass_times(scale, x.data(), back.data());
  for (int i = 0; i < n; ++i) {
    if (i >= form.nz()) back[std::size_t(i)] += scale * x[std::size_t(i)];
    for (int j = 0; j < n; ++j) back[std::size_t(i)] -= jacobian[std::size_t(i * n + j)] * x[std::size_t(j)];
    CHECK_NEAR(back[std::size_t(i)], b[std::size_t(i)], 1e-10);
  }
}

/// Drift of the torques along the motion against differences.
void drift() {
  TypedRun<double> run(everything());
  Workspace<double>& ws = run.ws;
  if (!CHECK(reach_phase(ws) == Status::running)) return;
  FullForm<double> form(ws);
  const int n = form.n(), nz = form.nz();
  Numbers y(ws.reduced.y, ws.reduced.y + n), d(y), dt(y);
  form.solve_mass(y.data());
  linearize(form, 0.0, y.data(), d.data(), dt.data(), ws.step_start);
  Numbers slope = d, at(y), torque(ws.observed.torque, ws.observed.torque + ws.n_branches), found(torque), up(torque),
          down(torque);
  form.solve_mass(slope.data());
  drift_whole(form, y.data(), slope.data(), slope.data() + nz, torque.data(), found.data());
  const double h = 1e-7;
  auto along = [&](double t, Numbers& out) {
    for (int i = 0; i < n; ++i) at[std::size_t(i)] = y[std::size_t(i)] + t * slope[std::size_t(i)];
    observe(form, t, at.data(), d.data());
    for (int k = 0; k < ws.n_branches; ++k) out[std::size_t(k)] = ws.observed.torque[k];
  };
  along(h, up), along(-h, down);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const double expected = (up[k] - down[k]) / (2 * h);
    CHECK_NEAR(found[k], expected, 1e-5 * (1 + std::abs(expected)) + 1e-8 * std::abs(torque[k]) / h * 1e-6);
  }
}

/// No heap, no errors of memory, the energy closes.
void whole_run() {
  TightRun r(everything());
  CHECK(r.advance(2) == 0);
}

}  // namespace

int test_full() {
  jacobian();
  drift();
  whole_run();
  return check::result();
}

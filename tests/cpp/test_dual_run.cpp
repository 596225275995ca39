// Whole runs with dual numbers: derivatives by parameters against differences of plain runs.

#include "check.hpp"
#include "typed_run.hpp"

using D = clutchwork::Dual<double, 2>;
SMALL_AND_SPARSE(clutchwork::Dual<double, 2>)

using namespace fixture;

namespace {

/// Two shafts, a clutch that slips with an exponential law, a quadratic load, an oscillating torque.
Model slipping() {
  Model m;
  const int a = m.shaft(0.4, 80), b = m.shaft(1.1, 2);
  m.element<elements::QuadraticTorque>(housing, b, {-6, 20, 0});
  m.element<elements::Damper>(housing, a, {0.05});
  m.element<elements::Torque>(housing, a, {}, {m.signal({{0, {10, 0, 0, 0, 5, 7, 0, 0}}})});
  m.contact<elements::Clutch, laws::Exponential>(a, b, {1}, {m.constant(20)}, {1.2, 1.0, 0.6, 15});
  return m;
}

/// The same shafts with bristles in the clutch, from rest at the start.
Model bending() {
  Model m;
  const int a = m.shaft(0.4, 8), b = m.shaft(1.1, 2);
  m.element<elements::QuadraticTorque>(housing, b, {-6, 20, 0});
  m.element<elements::Damper>(housing, a, {0.05});
  m.element<elements::Torque>(housing, a, {}, {m.signal({{0, {10, 0, 0, 0, 5, 7, 0, 0}}})});
  m.contact<elements::Clutch, laws::LuGre>(a, b, {1}, {m.constant(20)}, {1.2, 1.0, 5, 0, 2, 0.01, 4, 0.05});
  return m;
}

void settings(Options& o, int method) {
  // steps of one length: the same ones whatever the parameter
  o.rtol = 1e-2, o.atol = 1e-2, o.first_step = o.max_step = 0.0125;
  o.method = Method(method);
}

/// Speeds at t in plain numbers with parameter k moved by h.
void plain(const Model& model, double t, int k, double h, int method, Numbers& out) {
  Run r(model);
  cw_set_option(r.run, "rtol", 1e-2), cw_set_option(r.run, "atol", 1e-2);
  cw_set_option(r.run, "first_step", 0.0125), cw_set_option(r.run, "max_step", 0.0125);
  cw_set_option(r.run, "method", method);
  CHECK(cw_set_param(r.run, k, r.sys.params[k] + h) == 1);
  CHECK(r.advance(t) == 0);
  CHECK(r.events().empty());
  const Numbers row = r.row();
  out = {row[0], row[1]};
  for (int i = 0; i < r.sys.states; ++i) out.push_back(row[r.at.state + i]);
}

/// d(speeds and states)/d(parameter), two parameters at a time, and the values of the plain run.
void carries(const Model& model, int k, int l, int method) {
  TypedRun<D> r(model);
  settings(r.ws.options, method);
  r.ws.params[k].d[0] = 1, r.ws.params[l].d[1] = 1;
  CHECK(r.advance(0.6) == Status::done);
  CHECK(r.ws.events.n == 0);
  for (int j = 0; j < 2; ++j) {
    const int number = j == 0 ? k : l;
    const double h = 1e-5 * (1 + std::fabs(r.ws.sys.params[number]));
    Numbers up, down, here;
    for (auto [out, dx] : {std::pair{&up, h}, {&down, -h}, {&here, 0.0}}) plain(model, 0.6, number, dx, method, *out);
    for (std::size_t i = 0; i < here.size(); ++i) {
      const double slope = (up[i] - down[i]) / (2 * h);
      const D& x = i < 2 ? r.ws.v[i] : r.ws.state[i - 2];
      CHECK_NEAR(x.d[j], slope, 1e-6 * (1e-3 + std::fabs(slope)));
      CHECK_NEAR(x.v, here[i], 1e-12 * std::fabs(here[i]));
    }
  }
}

}  // namespace

int test_dual_run() {
  for (int method : {1, 2}) {
    // load and damping, gain and law
    carries(slipping(), 0, 3, method);
    carries(slipping(), 4, 6, method);
    carries(slipping(), 7, 8, method);
    // static and kinetic, speed and viscous, stiffness and damping
    carries(bending(), 5, 6, method);
    carries(bending(), 7, 10, method);
    carries(bending(), 11, 12, method);
  }
  return check::result();
}

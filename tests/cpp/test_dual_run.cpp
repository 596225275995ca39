#include "check.hpp"
#include "typed_run.hpp"

using D = clutchwork::Dual<double, 2>;
ONLY_TWO_SPEEDS(clutchwork::Dual<double, 2>)

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

void settings(Options& o, int method) {
  // steps of one length: the same ones whatever the parameter
  o.rtol = 1e-2, o.atol = 1e-2, o.first_step = o.max_step = 0.0125;
  o.method = Method(method);
}

/// Speeds at t in plain numbers with parameter k moved by h.
void plain(double t, int k, double h, int method, double* v) {
  Run r(slipping());
  cw_set_option(r.run, "rtol", 1e-2), cw_set_option(r.run, "atol", 1e-2);
  cw_set_option(r.run, "first_step", 0.0125), cw_set_option(r.run, "max_step", 0.0125);
  cw_set_option(r.run, "method", method);
  CHECK(cw_set_param(r.run, k, r.sys.params[k] + h) == 1);
  CHECK(r.advance(t) == 0);
  CHECK(r.events().empty());
  const Numbers row = r.row();
  v[0] = row[0], v[1] = row[1];
}

/// d(speed)/d(parameter), two parameters at a time, and the values of the plain run to the last bit.
void carries(int k, int l, int method) {
  TypedRun<D> r(slipping());
  settings(r.ws.options, method);
  r.ws.params[k].d[0] = 1, r.ws.params[l].d[1] = 1;
  CHECK(r.advance(0.6) == Status::done);
  CHECK(r.ws.n_events == 0);
  for (int j = 0; j < 2; ++j) {
    const int number = j == 0 ? k : l;
    const double h = 1e-4 * (1 + std::fabs(r.ws.sys.params[number]));
    double up[2], down[2], here[2];
    plain(0.6, number, h, method, up), plain(0.6, number, -h, method, down), plain(0.6, number, 0, method, here);
    for (int i = 0; i < 2; ++i) {
      const double slope = (up[i] - down[i]) / (2 * h);
      CHECK_NEAR(r.ws.v[i].d[j], slope, 1e-6 * (1e-3 + std::fabs(slope)));
      CHECK_NEAR(r.ws.v[i].v, here[i], 1e-12 * std::fabs(here[i]));
    }
  }
}

}  // namespace

int main() {
  for (int method : {1, 2}) {
    // load and damping, gain and law
    carries(0, 3, method);
    carries(4, 6, method);
    carries(7, 8, method);
  }
  return check::result();
}

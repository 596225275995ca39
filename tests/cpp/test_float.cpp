// Whole runs in single precision against closed forms and double precision.

#include "check.hpp"
#include "typed_run.hpp"

SMALL_AND_SPARSE(float)

using namespace fixture;

namespace {

/// Two discs lock at 1.6 s and break away under a ramp, in single precision.
void lock_and_break(int method) {
  Model m;
  const int a = m.shaft(2, 100), b = m.shaft(3, 0);
  m.element<elements::Torque>(housing, a, {}, {m.signal({{0, {0}}, {2, {0, 50}}})});
  m.contact<elements::Clutch, laws::Coulomb>(a, b, {0.5}, {m.constant(150)}, {1.2, 1.0});
  TypedRun<float> r(m);
  r.ws.options.rtol = 1e-4, r.ws.options.atol = 1e-4;
  r.ws.options.method = Method(method);
  CHECK(r.advance(6.0) == Status::done);
  if (!CHECK(r.ws.events.n >= 2)) return;
  CHECK_NEAR(r.ws.events.at[0], 1.6, 1.6e-5);
  // 50 (t - 2) * 3 / 5 = 90
  CHECK_NEAR(r.ws.events.at[event_size], 5.0, 5e-5);
  CHECK(r.ws.contact.mode[0] == backward);
  CHECK_NEAR(r.ws.v[1], 40 + 50 * 4.5 / 5 + 25, 1e-2);
}

/// A disc that LuGre friction slows, then holds elastically, in single precision against double.
void bristles_hold(int method) {
  Model m;
  const int a = m.shaft(0.5, 10);
  m.shaft(2, 30);
  m.element<elements::Torque>(housing, a, {}, {m.signal({{0, {0}}, {2, {1.5}}})});
  m.contact<elements::BearingFriction, laws::LuGre>(housing, a, {20}, {}, {0.2, 0.15, 2, 0, 2, 0.001, 40, 0.3});
  TypedRun<float> r(m);
  r.ws.options.rtol = 1e-4, r.ws.options.atol = 1e-5;
  r.ws.options.method = Method(method);
  Run exact(m);
  cw_set_option(exact.run, "rtol", 1e-10), cw_set_option(exact.run, "atol", 1e-12);
  for (double t : {0.5, 1.5, 2.05, 4.0}) {
    CHECK(r.advance(t) == Status::done);
    CHECK(exact.advance(t) == 0);
    const Numbers row = exact.row();
    CHECK_NEAR(r.ws.v[0], row[exact.at.speed], 1e-3);
    CHECK_NEAR(r.ws.state[0], row[exact.at.state], 2e-4);
  }
  // 20 * 0.075 = 1.5
  CHECK_NEAR(r.ws.state[0], 0.075, 2e-4);
}

}  // namespace

int test_float() {
  lock_and_break(1);
  lock_and_break(2);
  bristles_hold(1);
  bristles_hold(2);
  return check::result();
}

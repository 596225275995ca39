#include "check.hpp"
#include "typed_run.hpp"

ONLY_TWO_SPEEDS(float)

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
  if (!CHECK(r.ws.n_events >= 2)) return;
  CHECK_NEAR(r.ws.events[0], 1.6, 1.6e-5);
  // 50 (t - 2) * 3 / 5 = 90
  CHECK_NEAR(r.ws.events[event_size], 5.0, 5e-5);
  CHECK(r.ws.mode[0] == backward);
  CHECK_NEAR(r.ws.v[1], 40 + 50 * 4.5 / 5 + 25, 1e-2);
}

}  // namespace

int main() {
  lock_and_break(1);
  lock_and_break(2);
  return check::result();
}

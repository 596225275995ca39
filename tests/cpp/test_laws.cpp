// Friction laws in motions with a closed form.

#include "friction.hpp"

/// Friction laws in motions whose outcome is known in closed form: docs/theory/friction-laws.md.
using namespace fixture;

namespace {

constexpr double pi = 3.14159265358979323846;
const Numbers deflections{2e-5, 5e-5, 1e-4, 2e-4}, shares{0.1, 0.2, 0.3, 0.4};

/// At a constant slip every law ends on the Stribeck curve; `more`: its numbers behind the curve.
template <class L>
void slides(const Numbers& more, bool elements = false) {
  for (int shape = 0; shape < 4; ++shape) {
    const Numbers curve = stribeck_curve(0.15, 0.1, 2, shape, 0.01);
    for (double slip : {-5.0, -0.7, 0.4, 3.0}) {
      Model m;
      const Numbers points = elements ? m.curve(deflections, shares) : Numbers{};
      // nothing slows this disc
      disc<L>(m, 1e15, slip, 40, joined({curve, points, more}));
      TightRun r(m);
      CHECK(r.advance(1.0) == 0);
      const Numbers row = r.row();
      CHECK_NEAR(row[r.at.contact_torque], -40 * (sign(slip) * curve_at(curve, slip) + 0.01 * slip), 1e-8);
      CHECK(row[r.at.contact_mode] == sign(slip));
      CHECK_NEAR(row[r.at.contact_capacity], 40 * 0.15, 1e-14);
    }
  }
}

/// Laws that end elsewhere.
void slides_otherwise() {
  for (double slip : {-5.0, -0.02, 0.4}) {
    Model m;
    disc<laws::Tanh>(m, 1e15, slip, 40, {0.1, 0.5});
    disc<laws::Dahl>(m, 1e15, slip, 40, {0.1, 1e4, 1});
    for (int passive = 0; passive < 2; ++passive) {
      disc<laws::Mykhalevych>(m, 1e15, slip, 40, {0.15, 0.1, 1e-4, 2, 0.5, 0, 3, double(passive)});
    }
    TightRun r(m);
    CHECK(r.advance(1.0) == 0);
    const Numbers row = r.row();
    const double left = std::exp(-slip * slip / 4), wound = std::tanh(3 * sign(slip) + 0.5 * slip / 2);
    CHECK_NEAR(row[r.at.contact_torque], -40 * 0.1 * std::tanh(2 * slip / 0.5), 1e-9);
    CHECK_NEAR(row[r.at.contact_torque + 1], -40 * 0.1 * sign(slip), 1e-9);
    CHECK_NEAR(row[r.at.contact_torque + 2], -40 * (0.15 * wound - sign(slip) * 0.05 * (1 - left)), 1e-9);
    CHECK_NEAR(row[r.at.contact_torque + 3], -40 * (0.1 + 0.05 * left) * wound, 1e-9);
  }
}

/// From rest at a constant slip v the elastic part is s (1 - exp(-k |v| t / s)): LuGre, and Leuven with one element.
void builds_up() {
  const double v = -0.3, stiffness[] = {400, 250};
  const Numbers curve = stribeck_curve(0.15, 0.1, 0.5, 0, 0.02);
  Model m;
  disc<laws::Leuven>(m, 1e15, v, 10, joined({curve, m.curve({2 * 0.15 / stiffness[0]}, {2}), {1, 0.4}}));
  disc<laws::LuGre>(m, 1e15, v, 10, joined({curve, {stiffness[1], 0.4}}));
  const double s = curve_at(curve, v);
  TightRun r(m);
  r.grid(0.01, 50, [&](double t, const double* row) {
    for (int c = 0; c < 2; ++c) {
      const double left = std::exp(stiffness[c] * v * t / s), f = -s * (1 - left);
      CHECK_NEAR(row[r.at.state + c], f, 1e-10);
      CHECK_NEAR(row[r.at.contact_torque + c], -10 * (f + 0.4 * v * left + 0.02 * v), 1e-9);
    }
  });
}

/// A sliding element of GMS follows a new slip with the time constant s / attraction.
void lags() {
  const Numbers curve = stribeck_curve(0.15, 0.1, 2);
  Model m;
  driven<laws::GMS>(m, {{0, {0.5}}, {0.1, {3}}}, 10, joined({curve, m.curve(deflections, shares), {20, 0}}));
  TightRun r(m);
  CHECK(r.advance(0.1) == 0);
  const double before = curve_at(curve, 0.5), after = curve_at(curve, 3);
  r.grid(0.13, 40, [&](double t, const double* row) {
    const double level = after + (before - after) * std::exp(-20 * (t - 0.1) / after);
    for (int i = 0; i < 4; ++i) CHECK_NEAR(row[r.at.state + i], shares[i] * level, 1e-10);
  });
}

/// Before it slides a contact is a spring: free oscillation of a disc with stiffness and damping, as coefficients.
template <class L>
void oscillates(Model& m, const Numbers& law, double stiffness, double damping, double amplitude, double tolerance) {
  const double inertia = 0.3, load = 20, decay = 0.5 * load * damping / inertia;
  const double w = std::sqrt(load * stiffness / inertia - decay * decay), v0 = amplitude * w;
  const int shaft = disc<L>(m, inertia, v0, load, law);
  TightRun r(m, 1e-11);
  cw_set_option(r.run, "atol", 1e-12 * v0);
  r.grid(20.3 * 3.1416 / w, 200, [&](double t, const double* row) {
    const double e = std::exp(-decay * t), x = amplitude * e * std::sin(w * t);
    const double v = v0 * e * std::cos(w * t) - decay * x;
    CHECK_NEAR(row[r.at.angle + shaft], x, tolerance * amplitude);
    CHECK_NEAR(row[r.at.speed + shaft], v, tolerance * v0);
    CHECK_NEAR(row[r.at.contact_torque], inertia * row[r.at.acceleration + shaft], 1e-12 * v0 * w);
    const double won = 0.5 * inertia * (row[r.at.speed + shaft] * row[r.at.speed + shaft] - v0 * v0);
    CHECK_NEAR(row[r.at.contact_work], won, 1e-8 * inertia * v0 * v0);
  });
}

void springs() {
  const Numbers curve = stribeck_curve(0.15, 0.1, 2, 0, 2e-4);
  double stiffness = 0;
  for (int i = 0; i < 4; ++i) stiffness += 0.15 * shares[i] / deflections[i];
  {
    // exactly, up to the elastic limit
    Model m;
    oscillates<laws::ElastoPlastic>(m, joined({curve, {500, 1e-3, 1e-4, 2e-4}}), 500, 1.2e-3, 0.99e-4, 1e-7);
  }
  {
    // exactly, up to the first element that breaks away
    Model m;
    const Numbers points = m.curve(deflections, shares);
    oscillates<laws::GMS>(m, joined({curve, points, {100, 0}}), stiffness, 2e-4, 1.9e-5, 1e-7);
  }
  {
    // up to (h/s)^6, here 1e-13
    Model m;
    const Numbers points = m.curve(deflections, shares);
    oscillates<laws::Leuven>(m, joined({curve, points, {6, 1e-3}}), stiffness, 1.2e-3, 3e-7, 1e-7);
  }
  {
    // up to f/s, here 1e-5, in each of ten periods
    Model m;
    oscillates<laws::LuGre>(m, joined({curve, {500, 1e-3}}), 500, 1.2e-3, 3e-9, 3e-4);
  }
  {
    Model m;
    oscillates<laws::Dahl>(m, {0.15, 500, 1}, 500, 0, 3e-9, 3e-4);
  }
  {
    // up to the cube of the wind-up, here 1e-10
    Model m;
    oscillates<laws::Mykhalevych>(m, {0.15, 0.1, 3e-4, 2, 1, 0, 3, 0}, 500, 0.075, 3e-9, 1e-6);
  }
}

/// Dahl over the displacement there and back, whatever the speed: closed forms for exponents 1 and 2, and 1/2 until it
/// slides.
void dahl() {
  const double limit = 0.15, k = 40, speed = 0.05, w = 7;
  auto law = [&](double exponent) { return Numbers{limit, k, exponent}; };
  Model m;
  // x = speed / w (1 - cos(w t))
  const std::vector<Segment> swing{{0, {0, 0, 0, 0, speed, w, 0, 0}}};
  const int shaft = driven<laws::Dahl>(m, swing, 10, law(1));
  m.contact<elements::BearingFriction, laws::Dahl>(housing, shaft, {10}, {}, law(2));
  m.contact<elements::BearingFriction, laws::Dahl>(housing, shaft, {10}, {}, law(0.5));
  TightRun r(m);
  // the coefficient after the displacement dx from f, in the direction of `side`
  auto after = [&](int exponent, double f, double dx, double side) {
    const double left = 1 - side * f / limit, x = k * std::fabs(dx) / limit;
    return side * limit * (1 - (exponent == 1 ? left * std::exp(-x) : left / (1 + left * x)));
  };
  double turn = 0, start[2] = {};
  for (int half = 0; half < 5; ++half) {
    const double side = half % 2 == 0 ? 1 : -1, end = (half + 1) * pi / w;
    double last[2] = {}, x = 0;
    r.grid(end, 40, [&](double, const double* row) {
      x = row[r.at.angle + shaft];
      for (int e = 0; e < 2; ++e) {
        last[e] = row[r.at.state + e];
        CHECK_NEAR(last[e], after(e + 1, start[e], x - turn, side), 1e-8);
      }
      const double root = 1 - 0.5 * k * x / limit;
      if (half == 0) CHECK_NEAR(row[r.at.state + 2], root > 0 ? limit * (1 - root * root) : limit, 1e-6);
    });
    turn = x, start[0] = last[0], start[1] = last[1];
  }
}

/// Under a load that swings below stiffness * elastic, elasto-plastic friction is a spring to the last digit and comes
/// back; above it slides. LuGre drifts under any.
void drift() {
  const double k = 2000, load = 10, limit = k * 3e-5;
  const Numbers curve = stribeck_curve(0.15, 0.1, 0.1);
  for (double part : {0.45, 1.5}) {
    Model m;
    const double push = part * limit * load;
    const int torque = m.signal({{0, {0.4 * push, 0, 0, 0, 0.6 * push, 40, 0, 0}}, {3, {0}}});
    const int plastic = disc<laws::ElastoPlastic>(m, 0.02, 0, load, joined({curve, {k, 2, 3e-5, 0}}));
    const int lugre = disc<laws::LuGre>(m, 0.02, 0, load, joined({curve, {k, 2}}));
    for (int shaft : {plastic, lugre}) m.element<elements::Torque>(housing, shaft, {}, {torque});
    TightRun r(m);
    double most = 0, slid = 0;
    r.grid(3, 500, [&](double, const double* row) {
      const double elastic = row[r.at.state] - k * row[r.at.angle + plastic];
      most = std::fmax(most, std::fabs(row[r.at.state]));
      slid = std::fmax(slid, std::fabs(elastic));
    });
    CHECK(r.advance(5) == 0);
    const Numbers row = r.row();
    const double rest = std::fabs(row[r.at.angle + plastic]), drifted = std::fabs(row[r.at.angle + lugre]);
    if (part < 1) {
      CHECK(most > 0.7 * part * limit && most < limit);
      CHECK(slid < 1e-9 * limit);
      CHECK(rest < 1e-9 * limit / k);
      CHECK(drifted > 1e-3 * limit / k);
    } else {
      CHECK(most > limit && slid > 1e-3 * limit);
      CHECK(rest > 1e-3 * limit / k && rest < drifted);
    }
  }
}

/// What the displacement x does to a spring that slides at a limit.
double stop(double f, double stiffness, double dx, double limit) {
  return std::fmax(-limit, std::fmin(limit, f + stiffness * dx));
}

/// Loops within loops: elements are springs that slide, and a closed inner loop leaves nothing behind. `jumps`: the
/// slip jumps from one direction to the other, else it swings.
template <class L>
void remembers(const Numbers& more, bool jumps) {
  constexpr int legs = 12;
  const double turns[legs] = {1, 0.2, 0.6, 0.2, 1, -1, -0.1, -0.7, -0.1, -0.4, -0.1, -1};
  const Numbers curve = stribeck_curve(0.15, 0.15, 2);
  const double largest = 1.6e-4;
  std::vector<Segment> path;
  double x = 0;
  for (int leg = 0; leg < legs; ++leg) {
    const double way = turns[leg] * largest - x;
    if (jumps)
      path.push_back({double(leg), {way}});
    else
      path.push_back({double(leg), {0, 0, 0, 0, 0.5 * pi * way, pi, 0, 0}});
    x += way;
  }
  Model m;
  const Numbers points = m.curve(deflections, shares);
  const int shaft = driven<L>(m, path, 10, joined({curve, points, more}));
  TightRun r(m);
  double f[4] = {}, closed[2][4], from = 0;
  for (int leg = 0; leg < legs; ++leg) {
    Numbers last(4);
    r.grid(leg + 1, 17, [&](double, const double* row) {
      for (int i = 0; i < 4; ++i) {
        const double limit = 0.15 * shares[i];
        last[i] = stop(f[i], limit / deflections[i], row[r.at.angle + shaft] - from, limit);
        CHECK_NEAR(row[r.at.state + i], last[i], 1e-9);
        if (leg == 1 || leg == 3) closed[leg / 2][i] = row[r.at.state + i];
      }
    });
    for (int i = 0; i < 4; ++i) f[i] = last[i];
    from = turns[leg] * largest;
  }
  for (int i = 0; i < 4; ++i) CHECK_NEAR(closed[0][i], closed[1][i], 1e-10);
}

/// The wind-up of Mykhalevych under a swinging slip, in its three ways of being limited.
void winds_up() {
  // x = 4 sin(5 t) in units of the elastic angle
  const double elastic = 1e-3;
  const std::vector<Segment> swing{{0, {0, 0, 0, 0, 4 * elastic * 5, 5, pi / 2, 0}}};
  Model m;
  const int shaft = driven<laws::Mykhalevych>(m, swing, 10, {0.15, 0.1, elastic, 2, 1, 0, 2.5, 0});
  for (int reset : {1, 2}) {
    const Numbers law{0.15, 0.1, elastic, 2, 1, double(reset), 3, 0};
    m.contact<elements::BearingFriction, laws::Mykhalevych>(housing, shaft, {10}, {}, law);
  }
  TightRun r(m);
  double start[3] = {}, turn = 0;
  for (int half = 0; half < 5; ++half) {
    double x = 0;
    r.grid((half + 0.5) * pi / 5 - 1e-9, 30, [&](double, const double* row) {
      x = row[r.at.angle + shaft] / elastic;
      CHECK_NEAR(row[r.at.state], stop(start[0], 1, x - turn, 2.5), 1e-8);
      for (int i = 1; i < 3; ++i) CHECK_NEAR(row[r.at.state + i], start[i] + x - turn, 1e-8);
    });
    start[0] = stop(start[0], 1, x - turn, 2.5);
    start[1] = stop(start[1], 1, x - turn, 1), start[2] = sign(start[2] + x - turn);
    turn = x;
  }
  // a swing that is small: clipped it does nothing, literally it ratchets
  Model small;
  const std::vector<Segment> little{{0, {0, 0, 0, 0, 0.2 * elastic * 5, 5, pi / 2, 0}}};
  driven<laws::Mykhalevych>(small, little, 10, {0.15, 0.1, elastic, 2, 1, 1, 3, 0});
  TightRun s(small);
  s.grid(4, 300, [&](double t, const double* row) { CHECK_NEAR(row[s.at.state], 0.2 * std::sin(5 * t), 1e-8); });
}

/// Karnopp: locks at the edge of the band by an impulse, breaks away at the static coefficient, which acts inside it.
void karnopp() {
  const double band = 0.5;
  Model m;
  const int shaft = m.shaft(2, 3);
  m.element<elements::Torque>(housing, shaft, {}, {m.signal({{0, {0}}, {2, {0, 4}}})});
  m.contact<elements::BearingFriction, laws::Karnopp>(housing, shaft, {40}, {}, {0.15, 0.1, 1e-9, 2, 2, 0, band}, false,
                                                      {}, band);
  TightRun r(m);
  CHECK(r.advance(5) == 0);
  const Numbers events = r.events();
  if (!CHECK(int(events.size()) == 2 * event_size)) return;
  // 3 - 2 t = 0.5
  CHECK_NEAR(events[0], 1.25, 1e-9);
  CHECK(events[2] == 1 && events[3] == 0 && events[4] == 1);
  CHECK_NEAR(events[8] - events[9], 0.5 * 2 * band * band, 1e-9);
  // 4 (t - 2) = 40 * 0.15
  CHECK_NEAR(events[event_size], 3.5, 1e-9);
  CHECK_NEAR(events[event_size + 7], -6, 1e-9);
  // (t - 3.5)^2 inside the band, then (40 * 0.05) / 2 is added to the acceleration
  const double edge = 3.5 + std::sqrt(0.5), t = 5 - edge;
  CHECK_NEAR(r.row()[r.at.speed], 1.5 * 1.5 + t, 1e-8);
}

}  // namespace

int test_laws() {
  slides<laws::Stribeck>({});
  slides<laws::Karnopp>({0.1});
  slides<laws::NaiveSign>({});
  slides<laws::RegularisedStribeck>({0.01});
  slides<laws::LuGre>({1e4, 10});
  slides<laws::ElastoPlastic>({1e4, 10, 1e-6, 0});
  slides<laws::Leuven>({1, 10}, true);
  slides<laws::GMS>({100, 0}, true);
  slides_otherwise();
  builds_up();
  lags();
  springs();
  dahl();
  drift();
  for (bool jumps : {false, true}) {
    remembers<laws::GMS>({100, 0}, jumps);
    // so sharp that it yields only where it slides
    remembers<laws::Leuven>({300, 0}, jumps);
  }
  winds_up();
  karnopp();
  return check::result();
}

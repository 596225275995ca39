// Shared states: heat that flows, friction over the temperature, processes.

#include "friction.hpp"

/// Shared states: heat that flows, friction over temperature, components that have nothing else.
using namespace fixture;

namespace {

/// A thermal mass that starts at a temperature; the shared state is the heat above that.
int mass(Model& m, double capacity, double temperature) { return m.shared(0, 1 / capacity, temperature); }

/// Two masses exchange heat; a third one is cooled by oil whose flow rises, a fourth one by air that a shaft moves.
void exchange() {
  Model m;
  const int shaft = m.shaft(2);
  m.element<elements::Torque>(housing, shaft, {}, {m.constant(20)});
  const int warm = mass(m, 2000, 400), cold = mass(m, 500, 300), oiled = mass(m, 800, 420), fanned = mass(m, 600, 350);
  const int inlet = m.constant(310), flow = m.signal({{0, {0.01, 0.02}}}), air = m.constant(290);
  m.flow<elements::Conduction>(warm, cold, {25}, {source(of_shared, warm), source(of_shared, cold)});
  m.flow<elements::OilFlow>(oiled, -1, {2000}, {source(of_shared, oiled), inlet, flow});
  m.flow<elements::Convection>(fanned, -1, m.curve({0, 40, 80}, {2, 10, 10}),
                               {source(of_shared, fanned), air, source(of_rate, 0)});
  TightRun r(m);
  r.grid(8, 80, [&](double t, const double* row) {
    const double* heat = row + r.at.state;
    const double left = 100 * std::exp(-25 * t * (1 / 2000.0 + 1 / 500.0));
    CHECK_NEAR((400 + heat[0] / 2000) - (300 + heat[1] / 500), left, 1e-7);
    CHECK_NEAR(heat[0] + heat[1], 0, 1e-7);
    CHECK_NEAR(310 + 110 * std::exp(-2000 / 800.0 * (0.01 * t + 0.01 * t * t)), 420 + heat[2] / 800, 1e-7);
    // the speed is 10 t
    const double over = t < 4 ? 2 * t + t * t : 8 + 16 + 10 * (t - 4);
    CHECK_NEAR(290 + 60 * std::exp(-over / 600), 350 + heat[3] / 600, 1e-7);
  });
}

/// A clutch whose coefficients rise with the temperature that its own heat makes: with c = b load / (2 capacity) and
/// k = a load / inertia + c w0^2 the slip is sqrt(k/c) tanh(artanh(w0 sqrt(c/k)) - sqrt(k c) t).
void heats_itself() {
  const double load = 50, inertia = 1.2, capacity = 300, start = 100, a = 0.2, b = 0.004;
  for (double share : {1.0, 0.5}) {
    Model m;
    const int x = m.shaft(2, start), y = m.shaft(3), node = mass(m, capacity, 300);
    const Numbers kinetic = m.curve({300, 400}, {a, a + 100 * b});
    const Indices temperature{source(of_shared, node)};
    m.contact<elements::Clutch, laws::TemperatureTable>(x, y, {1}, {m.constant(load)},
                                                        joined({{0, 0}, kinetic, kinetic}), false, {}, 0, temperature);
    m.heat(of_contact_heat, 0, node, share);
    const double c = share * b * load / (2 * capacity), k = a * load / inertia + c * start * start;
    const double top = std::sqrt(k / c), phase = std::atanh(start / top), rate = std::sqrt(k * c);
    TightRun r(m);
    r.grid(0.9 * phase / rate, 50, [&](double t, const double* row) {
      CHECK_NEAR(row[r.at.speed + x] - row[r.at.speed + y], top * std::tanh(phase - rate * t), 1e-7);
      CHECK_NEAR(row[r.at.state], -share * row[r.at.contact_work], 1e-5);
    });
    CHECK(r.advance(1.5 * phase / rate) == 0);
    const Numbers events = r.events(), row = r.row();
    if (!CHECK(int(events.size()) == event_size)) continue;
    CHECK_NEAR(events[0], phase / rate, 1e-9);
    CHECK_NEAR(row[r.at.state], share * 0.5 * inertia * start * start, 1e-5);
    CHECK_NEAR(row[r.at.contact_capacity], load * (a + b * row[r.at.state] / capacity), 1e-9);
  }
}

/// A locked clutch whose static coefficient falls while it is warmed from outside gives way at a known temperature.
void gives_way() {
  Model m;
  const int shaft = m.shaft(2), node = mass(m, 100, 300), hot = m.constant(500);
  m.element<elements::Torque>(housing, shaft, {}, {m.constant(9)});
  m.flow<elements::Conduction>(node, -1, {20}, {source(of_shared, node), hot});
  m.contact<elements::Clutch, laws::TemperatureTable>(
      housing, shaft, {1}, {m.constant(50)},
      joined({{0, 0}, m.curve({300, 500}, {0.3, 0.1}), m.curve({300, 500}, {0.2, 0.05})}), false, {}, 0,
      {source(of_shared, node)});
  TightRun r(m);
  CHECK(r.advance(2) == 0);
  CHECK(r.row()[r.at.contact_mode] == 0);
  CHECK(r.advance(10) == 0);
  const Numbers events = r.events();
  if (!CHECK(int(events.size()) == event_size)) return;
  // 50 (0.3 - 0.001 (T - 300)) = 9 at 420 K; 500 - 200 exp(-0.2 t)
  CHECK_NEAR(events[0], 5 * std::log(200 / 80.0), 1e-9);
  CHECK(events[2] == 0 && events[3] == 1 && events[4] == 2);
  CHECK_NEAR(events[7], -50 * (0.2 - 0.15 / 200 * 120), 1e-7);
}

/// Processes: a pressure that follows its command by a lag and closes a clutch, wear by the heat of that.
void processes() {
  const double lag = 0.1, wanted = 40, area = 0.02, rate = 1e-9;
  Model m;
  const int a = m.shaft(2, 30);
  const int piston = m.process<elements::PressureActuator>({lag, 0, 0, 0, 1e9, 1e9}, {m.constant(wanted)}, {0});
  const int depth = m.process<elements::Wear>({rate, area, 0}, {source(of_contact_heat, 0)}, {0}, rate / area);
  m.contact<elements::Clutch, laws::Coulomb>(housing, a, {1}, {source(of_shared, piston)}, {0.5, 0.4});
  TightRun r(m);
  r.grid(2, 100, [&](double t, const double* row) {
    CHECK_NEAR(row[r.at.state + piston], wanted * (1 - std::exp(-t / lag)), 1e-7);
    // the impulse of the brake
    const double impulse = 0.4 * wanted * (t - lag * (1 - std::exp(-t / lag)));
    CHECK_NEAR(row[r.at.speed], 30 - 0.5 * impulse, 1e-7);
    CHECK_NEAR(row[r.at.state + depth], -row[r.at.contact_work], 1e-6);
  });
}

}  // namespace

int test_shared() {
  exchange();
  heats_itself();
  gives_way();
  processes();
  return check::result();
}

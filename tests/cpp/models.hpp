#pragma once
#include "fixture.hpp"

/// Drivelines that several tests run.
namespace fixture {

/// Three shafts with spring, load, table of friction, knots, an oscillating torque: locks and slips. Small form.
inline Model three_shafts() {
  Model m;
  const int a = m.shaft(0.2, 5), b = m.shaft(0.5), c = m.shaft(1.5);
  const int push = m.signal({{0, {20}}, {0.7, {-30, 10}}, {1.4, {5, 0, 0, 0, 40, 9, 0.2, 0.1}}});
  const int pressure = m.signal({{0, {0, 60}}, {1.0, {60}}, {1.5, {3}}});
  m.element<elements::Torque>(housing, a, {}, {push});
  m.element<elements::SpringDamper>(a, b, {900, 0.8, 0});
  m.element<elements::QuadraticTorque>(housing, c, {-4, 20, 0});
  Numbers law{0.5};
  for (double x : m.curve({0, 5, 40}, {0.4, 0.3, 0.2})) law.push_back(x);
  law.push_back(double(choice::Extrapolation::nearest));
  m.contact<elements::Clutch, laws::CoefficientTable>(b, c, {1}, {pressure}, law);
  return m;
}

/// Twelve shafts in a row with springs, clutches, a freewheel, a bearing and a periodic pressure. Sparse form.
inline Model chain() {
  Model m;
  const int pulse = m.signal({{0, {30}}, {0.15, {30, -150}}, {0.35, {0, 200}}}, 0, 0.5);
  const int push = m.signal({{0, {60}}, {1.2, {-40}}}), load = m.constant(15), still = m.constant(25);
  for (int i = 0; i < 12; ++i) m.shaft(0.1 + 0.02 * i, i < 6 ? 20 : 0);
  m.element<elements::Torque>(housing, 0, {}, {push});
  m.element<elements::ResistingTorque>(housing, 11, {1}, {load});
  for (int i = 0; i + 1 < 12; ++i) {
    if (i == 3)
      m.contact<elements::OneWayClutch, laws::Coulomb>(i, i + 1, {1}, {still}, {0.4, 0.3});
    else if (i == 5)
      m.contact<elements::Clutch, laws::Coulomb>(i, i + 1, {1}, {pulse}, {1.1, 1});
    else if (i == 8)
      m.contact<elements::Clutch, laws::Exponential>(i, i + 1, {1}, {still}, {0.8, 0.7, 0.5, 3});
    else
      m.element<elements::SpringDamper>(i, i + 1, {2000, 1.5, 0});
  }
  m.contact<elements::BearingFriction, laws::Coulomb>(housing, 7, {2}, {}, {1, 0.9});
  return m;
}

/// Two shafts whose clutch has bristles, under a pressure with knots and a gap; a freewheel blocks one. Small form.
inline Model bristles() {
  Model m;
  const int a = m.shaft(0.4, 30), b = m.shaft(0.8);
  const int push = m.signal({{0, {4, 0, 0, 0, 9, 8, 0, 0}}, {1.5, {-20, 0, 0, 0, 3, 15, 0, 0}}});
  const int pressure = m.signal({{0, {0, 60}}, {0.8, {48, -60}}, {1.8, {40}}});
  m.element<elements::Torque>(housing, a, {}, {push});
  m.element<elements::Torque>(housing, b, {}, {m.signal({{0, {-2}}, {2.6, {30}}})});
  m.contact<elements::Clutch, laws::LuGre>(a, b, {1}, {pressure}, {0.3, 0.2, 3, 0, 2, 0.001, 40, 0.05});
  m.contact<elements::OneWayClutch, laws::Tanh>(housing, b, {1}, {m.constant(5)}, {0.1, 2});
  return m;
}

/// Five shafts whose contacts have elements, wind-up and bristles that switch, beside a clutch that sticks. Sparse
/// form.
inline Model hysteresis() {
  Model m;
  const double start[] = {12, 0, 0, 0, -4};
  for (int i = 0; i < 5; ++i) m.shaft(0.2 + 0.1 * i, start[i]);
  const int push = m.signal({{0, {3, 0, 0, 0, 12, 9, 0, 0}}, {1.5, {-8, 0, 0, 0, 12, 20, 1, 0.5}}});
  const int pressure = m.signal({{0, {0, 40}}, {0.7, {28, -80}}, {1.3, {30}}}), still = m.constant(25);
  const Numbers curve{0.3, 0.2, 3, 1, 2, 0.001}, points = m.curve({0.01, 0.03, 0.08, 0.2}, {0.1, 0.2, 0.3, 0.4});
  m.element<elements::Torque>(housing, 0, {}, {push});
  for (int i = 0; i < 4; ++i) m.element<elements::SpringDamper>(i, i + 1, {60, 0.3, 0});
  m.contact<elements::BearingFriction, laws::GMS>(housing, 0, {9}, {}, joined({curve, points, {30, 0}}));
  m.contact<elements::BearingFriction, laws::Leuven>(housing, 1, {7}, {}, joined({curve, points, {1.5, 0.01}}));
  m.contact<elements::Clutch, laws::Mykhalevych>(0, 2, {1}, {pressure}, {0.2, 0.15, 0.05, 3, 0.5, 0, 2, 1});
  m.contact<elements::Clutch, laws::ElastoPlastic>(3, 4, {1}, {pressure}, joined({curve, {20, 0.05, 0.003, 0}}));
  m.contact<elements::Clutch, laws::Coulomb>(1, 4, {0.3}, {pressure}, {0.5, 0.4});
  m.contact<elements::Brake, laws::Mykhalevych>(housing, 4, {0.4}, {still}, {0.2, 0.15, 0.05, 3, 0.5, 1, 3, 0});
  return m;
}

/// Shafts whose plates warm up and wear, pressed by a piston; they fail late. Oil, air, a map of friction, a freewheel
/// that rolls over, teeth that mesh. Sparse form.
inline Model warm() {
  Model m;
  const int in = m.shaft(0.4, 60), out = m.shaft(1.1), side = m.shaft(0.3, 4), last = m.shaft(0.6);
  const int plates = m.shared(0, 1 / 300.0, 300), hub = m.shared(0, 1 / 900.0, 310);
  const int command = m.signal({{0, {50}}, {1.2, {10, -20}}, {1.6, {60}}}), none = m.constant(0);
  const int push = m.signal({{0, {12}}, {1.0, {15, 0, 0, 0, 20, 9, 0, 0}}, {1.7, {-60}}}),
            fails = m.signal({{0, {0, 0.21}}});
  const int piston = m.process<elements::PressureActuator>({0.05, 0.02, 5, 2, 900, 900}, {command}, {-2});
  const int wear = m.process<elements::Wear>({1e-9, 0.02, 0}, {source(of_contact_heat, 0)}, {0}, 5e-8);
  m.element<elements::Torque>(housing, in, {}, {push});
  m.element<elements::SpringDamper>(out, side, {80, 0.4, 0});
  m.element<elements::DogClutch>(side, last, {8, 0.1, 600, 0.01, 15, 0.5, 0.05, 0, 0},
                                 {m.signal({{0, {0}}, {0.6, {1}}})}, {0.02, 0});
  const Numbers map = joined({{0, 0},
                              m.curve({300, 350, 400}, {0, 0, 0}),
                              m.curve({0, 10, 60}, {0, 0, 0}),
                              m.curve({0.34, 0.33, 0.31}, {0, 0, 0}),
                              m.curve({0.33, 0.31, 0.29, 0.32, 0.29, 0.26, 0.3, 0.26, 0.22}, Numbers(9))});
  m.contact<elements::PlateContact, laws::FrictionMap>(
      in, out, {3, 1, 0.8, 1e-4, 1e4, 0, 1, 1}, {source(of_shared, piston), source(of_shared, wear), none, fails}, map,
      false, {}, 0, {source(of_shared, plates)});
  m.contact<elements::SpragClutch, laws::Coulomb>(housing, out, {6, 0.5}, {}, {1, 1});
  m.contact<elements::BearingFriction, laws::LuGre>(housing, last, {4}, {}, {0.2, 0.15, 3, 0, 2, 0.001, 40, 0.05});
  m.flow<elements::Conduction>(plates, hub, {15}, {source(of_shared, plates), source(of_shared, hub)});
  m.flow<elements::OilFlow>(plates, -1, {2000}, {source(of_shared, plates), m.constant(300), m.constant(0.01)});
  m.flow<elements::Convection>(hub, -1, m.curve({0, 20, 90}, {2, 8, 20}),
                               {source(of_shared, hub), m.constant(295), source(of_contact_rate, 1)});
  m.heat(of_contact_heat, 0, plates, 0.9), m.heat(of_contact_heat, 2, hub), m.heat(of_heat, 1, hub);
  return m;
}

/// A prescribed speed, signals that repeat and wait, an input from outside (number 1), a freewheel. Small form.
inline Model driven() {
  Model m;
  const int speed = m.signal({{0.1, {2, 0, 0, 0, 3, 7, 0, 0}}}), outside = m.signal({}, 4);
  const int wave = m.signal({{0.2, {1}}, {0.25, {5, -20}}, {0.45, {1}}}, 0, 0.3);
  const int in = m.prescribed(0.3, speed), out = m.shaft(0.5, 3), free = m.shaft(0.2);
  m.element<elements::Torque>(housing, free, {}, {outside});
  m.contact<elements::Clutch, laws::Stribeck>(in, out, {1}, {wave}, {0.4, 0.3, 3, 0, 2, 0});
  m.contact<elements::OneWayClutch, laws::Coulomb>(out, free, {1}, {m.constant(1)}, {0.4, 0.3});
  return m;
}

/// Clutches side by side that lock together, under pressures that differ and vary: their shares are a choice. Small
/// form.
inline Model parallel() {
  Model m;
  const int a = m.shaft(0.4, 12), b = m.shaft(0.9), c = m.shaft(0.5, -3);
  const int push = m.signal({{0, {9, 0, 0, 0, 12, 6, 0, 0}}, {1.5, {-8}}});
  const int up = m.signal({{0, {0, 40}}, {1.0, {40, -15}}}), even = m.constant(14);
  m.element<elements::Torque>(housing, a, {}, {push});
  m.element<elements::SpringDamper>(b, c, {200, 0.5, 0});
  m.contact<elements::Clutch, laws::Coulomb>(a, b, {1}, {up}, {0.6, 0.5});
  m.contact<elements::Clutch, laws::Coulomb>(a, b, {1}, {even}, {0.5, 0.4});
  m.contact<elements::Clutch, laws::Stribeck>(a, b, {0.5}, {up}, {0.4, 0.3, 3, 0, 2, 0});
  m.contact<elements::Brake, laws::Coulomb>(housing, c, {1}, {m.signal({{0, {0}}, {9, {0, 1}}})}, {0.3, 0.2});
  return m;
}

/// More speeds than are treated as few: clutches in a row, one beside another, a ring, a freewheel, a prescribed shaft.
inline Model long_row() {
  Model m;
  const int pulse = m.signal({{0, {30}}, {0.2, {30, -150}}, {0.5, {0, 200}}}, 0, 0.8), still = m.constant(25);
  const int push = m.signal({{0, {40, 0, 0, 0, 30, 9, 0, 0}}, {1.2, {-40}}}), load = m.constant(5);
  const int n = few_speeds + 4;
  for (int i = 0; i < n; ++i) m.shaft(0.1 + 0.02 * i, 20.0 - i);
  const int given = m.prescribed(0, m.signal({{0, {12, 0, 0, 0, 5, 3, 0, 0}}}));
  m.element<elements::Torque>(housing, 0, {}, {push});
  m.element<elements::ResistingTorque>(housing, n - 1, {1}, {load});
  m.element<elements::SpringDamper>(2, 3, {800, 1.5, 0});
  for (int i = 0; i + 1 < n; ++i) {
    if (i == 2) continue;
    if (i == 5)
      m.contact<elements::OneWayClutch, laws::Coulomb>(i, i + 1, {1}, {still}, {0.4, 0.3});
    else if (i % 4 == 1)
      m.contact<elements::Clutch, laws::Coulomb>(i, i + 1, {1}, {pulse}, {0.6, 0.5});
    else
      m.contact<elements::Clutch, laws::Exponential>(i, i + 1, {0.4}, {still}, {0.8, 0.7, 0.5, 3});
  }
  m.contact<elements::Clutch, laws::Coulomb>(8, 9, {1}, {pulse}, {0.3, 0.2});
  m.contact<elements::Clutch, laws::Coulomb>(10, 12, {1}, {still}, {0.2, 0.1});
  m.contact<elements::Clutch, laws::Coulomb>(given, 4, {1}, {pulse}, {0.3, 0.2});
  return m;
}

}  // namespace fixture

"""Laws that stick against closed forms: rest, break-away, and the time in which sliding ends."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from reference.friction.closed_forms import BAND, CURVE, FALL, KINETIC, LAWS, SPEED, STATIC, TO_REST, VISCOUS
from support.runs import EXACT, TIGHT

MASS, LOAD, START = 2.0, 5.0, 3.0  # kg, N, m/s


def body(law: cw.Law, speed: float = 0.0, force: Any = 0.0) -> cw.Driveline:
    """A mass on the ground."""
    d = cw.Driveline("body")
    m = d.mass("m", mass=MASS, speed=speed)
    d.add(cw.BearingFriction("c", shaft=m, friction=law, torque=LOAD))
    d.add(cw.Torque("f", shaft=m, torque=force))
    return d


def changes(run: Any, after: str) -> list[float]:
    """Times [s] at which the contact changed to a mode."""
    return [e.time for e in run.events.changes() if e.after == after]


def test_every_law_here_has_its_time_to_stop() -> None:
    assert TO_REST.keys() == LAWS.keys()


@pytest.mark.parametrize("speed", [START, -START])
@pytest.mark.parametrize("name", LAWS)
def test_sliding_ends_when_it_should_and_then_sticks(name: str, speed: float) -> None:
    run = body(LAWS[name], speed).simulate(12.0, **TIGHT)
    stop = MASS / LOAD * TO_REST[name](START)
    assert changes(run, "locked") == [pytest.approx(stop, abs=EXACT)]
    assert np.all(run["m.speed"][run.time > stop + EXACT] == 0.0)
    # all kinetic energy is heat, that of the impulse in Karnopp's band too
    assert run["c.heat"][-1] == pytest.approx(0.5 * MASS * START**2, rel=1e-9)


@pytest.mark.parametrize("way", ["forward", "backward"])
@pytest.mark.parametrize("name", LAWS)
def test_breaks_away_at_the_static_coefficient(name: str, way: str) -> None:
    """A force that rises by 2 N/s: rest up to it with the multiplier equal to the load, sliding from there."""
    law: Any = LAWS[name]
    rate = 2.0 if way == "forward" else -2.0
    run = body(law, force=cw.Table([(0.0, 0.0), (10.0, 10 * rate)])).simulate(4.0, dt=0.01, **TIGHT)
    start = LOAD * law.static / 2.0
    assert changes(run, way) == [pytest.approx(start, abs=EXACT)]
    held = run.time < start - 1e-6
    assert np.all(run["m.speed"][held] == 0.0)
    assert np.all(run["m.position"][held] == 0.0)
    assert run["c.torque"][held] == pytest.approx(-rate * run.time[held], abs=1e-12)


@pytest.mark.parametrize("name", LAWS)
def test_holds_just_below_the_static_coefficient_and_not_above(name: str) -> None:
    law: Any = LAWS[name]
    limit = LOAD * law.static
    below, above = (body(law, force=limit * (1 + e)).simulate(2.0, **TIGHT) for e in (-1e-9, 1e-9))
    assert np.all(below["m.speed"] == 0.0)
    assert changes(below, "locked") == []
    assert above["m.speed"][-1] > 0.0


def test_slides_on_at_the_kinetic_coefficient_after_break_away() -> None:
    """Coulomb under a force that rises by r: m v = (static - kinetic) (t - t0) + r (t - t0)^2/2, capacities in N."""
    law, r = LAWS["coulomb"], 2.0
    t0 = LOAD * STATIC / r
    run = body(law, force=cw.Table([(0.0, 0.0), (10.0, 10 * r)])).simulate(5.0, dt=0.01, **TIGHT)
    s = np.maximum(run.time - t0, 0.0)
    assert run["m.speed"] == pytest.approx((LOAD * FALL * s + r * s**2 / 2) / MASS, abs=1e-9)


def test_the_static_coefficient_of_a_continuous_law_rises_into_sliding() -> None:
    """Exponential with a static coefficient above the kinetic one at vanishing slip: the drop is that difference."""
    law: Any = LAWS["exponential"]
    r = 2.0
    t0 = LOAD * law.static / r
    run = body(law, force=cw.Table([(0.0, 0.0), (10.0, 10 * r)])).simulate(t0 + 1e-3, **TIGHT)
    # first-order in a millisecond; the next term is a thousandth
    assert run["m.speed"][-1] == pytest.approx(LOAD * (law.static - law.slow) * 1e-3 / MASS, rel=5e-3)


def test_karnopp_in_its_band() -> None:
    """Locks at the edge of the band; breaking away it carries the static force up to there, then the curve."""
    law, r = LAWS["karnopp"], 2.0
    run = body(law, START).simulate(3.0, dt=1e-3, **TIGHT)
    sliding = run["m.speed"] != 0.0
    assert np.min(run["m.speed"][sliding]) >= BAND - 1e-9
    t0 = LOAD * STATIC / r
    push = body(law, force=cw.Table([(0.0, 0.0), (10.0, 10 * r)]))
    edge = t0 + sqrt(2 * MASS * BAND / r)
    run = push.simulate(edge + 0.2, times=np.linspace(t0, edge + 0.2, 2001), **TIGHT)
    inside = run.time < edge - EXACT
    assert run["m.speed"][inside] == pytest.approx(r * (run.time[inside] - t0) ** 2 / (2 * MASS), abs=1e-9)
    assert run["c.torque"][inside][1:] == pytest.approx(-LOAD * STATIC, rel=1e-9)
    # outside: the Stribeck curve
    v = run["m.speed"][~inside][1:]
    assert run["c.torque"][~inside][1:] == pytest.approx(-LOAD * (KINETIC + FALL * np.exp(-v / SPEED)), rel=1e-9)


@pytest.mark.parametrize("shape", ["gaussian", "tustin", "lorentz", "power"])
def test_shapes_of_the_stribeck_curve(shape: str) -> None:
    """At a given slip the torque is the curve."""
    law = cw.Stribeck(**CURVE, shape=shape, viscous=VISCOUS, **({"exponent": 0.6} if shape == "power" else {}))
    d = cw.Driveline("curve")
    m = d.mass("m", mass=1.0)
    d.add(cw.PrescribedSpeed("p", shaft=m, speed=cw.Table([(0.0, 0.0), (1.0, 2.0)])))
    d.add(cw.Brake("c", shaft=m, friction=law, gain=1.0, normal_force=LOAD))
    run = d.simulate(1.0, times=np.linspace(0.01, 1.0, 100))
    x = 2.0 * run.time / SPEED
    falls = {"gaussian": np.exp(-(x**2)), "tustin": np.exp(-x), "lorentz": 1 / (1 + x**2), "power": np.exp(-(x**0.6))}
    expected = KINETIC + FALL * falls[shape] + VISCOUS * SPEED * x
    assert -run["c.torque"] == pytest.approx(LOAD * expected, rel=1e-12)


def test_stribeck_without_fall_is_coulomb() -> None:
    even = replace(LAWS["stribeck"], kinetic=STATIC)  # type: ignore[type-var]
    one = body(even, START).simulate(2.0, dt=0.01, **TIGHT)
    other = body(cw.Coulomb(static=STATIC, kinetic=STATIC), START).simulate(2.0, dt=0.01, **TIGHT)
    assert one["m.speed"] == pytest.approx(other["m.speed"], abs=1e-12)


@pytest.mark.parametrize(("beyond", "held"), [("linear", 0.26), ("nearest", 0.3)])
@pytest.mark.filterwarnings("ignore:.*kinetic falls to zero")
def test_a_body_beyond_a_table_over_the_temperature_lets_go(beyond: Any, held: float) -> None:
    """At 450 K the lines have crossed, 0.25 at rest and 0.26 sliding: the larger holds, or the last point."""
    static, kinetic = [(300.0, 0.4), (400.0, 0.3)], [(300.0, 0.35), (400.0, 0.29)]
    law = cw.TemperatureTable(static=static, kinetic=kinetic, temperature=450.0, extrapolation=beyond)
    run = body(law, force=cw.Ramp(height=2.0, duration=2.0)).simulate(2.0, **TIGHT)
    assert changes(run, "forward") == [pytest.approx(held * LOAD, abs=EXACT)]
    assert changes(run, "locked") == []

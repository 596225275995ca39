"""A locked contact whose static coefficient is a table lets go wherever that dips, between long steps too.

docs/theory/events.md, rule 12.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import clutchwork as cw
from support.amount import amount

FORCE = 100.0  # N
END = 10.0  # s
KINDS = ("table", "map")
Points = list[tuple[float, float]]


def law(kind: str, points: Points, interpolation: str, temperature: cw.Table | None) -> cw.Law:
    """The static coefficient of these points, above a kinetic one that is the same everywhere."""
    places = [x for x, _ in points]
    if kind == "table":
        kinetic = [(x, 0.01) for x in places]
        return cw.TemperatureTable(static=points, kinetic=kinetic, temperature=temperature, interpolation=interpolation)
    return cw.FrictionMap(
        temperatures=places,
        speeds=[0.0, 50.0, 100.0],
        static=[y for _, y in points],
        kinetic=[[0.01] * 3] * len(points),
        temperature=temperature,
        interpolation=interpolation,
    )


def held(friction: cw.Law, torque: float, heat: float = 0.0) -> cw.Driveline:
    """A shaft that a brake holds against a torque, whose plates are heated from elsewhere."""
    d = cw.Driveline("held")
    shaft = d.shaft("a", inertia=1.0)
    plates = d.thermal("plates", capacity=1.0, temperature=300.0)
    # a fan that turns at 1 rad/s heats them with its drag
    fan = d.shaft("fan", inertia=1.0, speed=1.0)
    d.add(cw.PrescribedSpeed("drive", shaft=fan, speed=1.0))
    d.add(cw.Damper("drag", base=d.housing, follower=fan, damping=heat, heat=plates))
    d.add(cw.Brake("c", shaft=shaft, friction=friction, gain=1.0, normal_force=FORCE, heat=plates))
    d.add(cw.Torque("t", shaft=shaft, torque=torque))
    return d


def dips(rng: np.random.Generator) -> Points:
    """A coefficient that falls sharply between two of its points, and not at both ends."""
    places = 300.0 + 200.0 * np.concatenate([[0.0], np.cumsum(rng.dirichlet(np.ones(7)))])
    values = np.full(8, 0.3)
    values[rng.integers(2, 7)] = rng.uniform(0.02, 0.2)
    return [(float(x), float(y)) for x, y in zip(places, values, strict=True)]


def path(rng: np.random.Generator) -> cw.Table:
    """A temperature that rises or falls through all points."""
    low, high = rng.uniform(300.0, 302.0), rng.uniform(498.0, 500.0)
    first, last = (low, high) if rng.random() < 0.5 else (high, low)
    return cw.Table([(0.0, first), (END, last)])


def lets_go(points: Points, temperature: cw.Table, torque: float) -> float | None:
    """When the line through the points falls below the torque, exact; None: never."""
    (_, first), (_, last) = temperature.points
    along = points if last > first else points[::-1]
    for (x, y), (next_x, next_y) in pairwise(along):
        if FORCE * next_y < torque <= FORCE * y:
            place = x + (next_x - x) * (torque / FORCE - y) / (next_y - y)
            return END * (place - first) / (last - first)
    return None


@pytest.mark.random
@pytest.mark.parametrize("kind", KINDS)
def test_lets_go_where_the_table_dips(kind: str) -> None:
    gone = 0
    for seed in range(amount(60)):
        rng = np.random.default_rng(seed)
        points, temperature, torque = dips(rng), path(rng), rng.uniform(3.0, 29.0)
        run = held(law(kind, points, "linear", temperature), torque).simulate(END)
        expected = lets_go(points, temperature, torque)
        if expected is None:
            assert not run.events, seed
            continue
        gone += 1
        # the instant is located to round-off of the capacity, over which temperatures are 1e-12 of themselves
        assert run.events[0].time == pytest.approx(expected, abs=1e-9), seed
        assert run.events[0].cause == "torque limit"
    assert gone > 0


@pytest.mark.random
@pytest.mark.parametrize("kind", KINDS)
def test_a_smooth_table_as_with_short_steps(kind: str) -> None:
    for seed in range(amount(20)):
        rng = np.random.default_rng(seed)
        friction = law(kind, dips(rng), "smooth", path(rng))
        d = held(friction, rng.uniform(3.0, 29.0))
        run, short = d.simulate(END), d.simulate(END, max_step=1e-3)
        assert [e.cause for e in run.events[:1]] == [e.cause for e in short.events[:1]], seed
        if run.events:
            assert run.events[0].time == pytest.approx(short.events[0].time, abs=1e-9), seed


@pytest.mark.random
@pytest.mark.parametrize("parallel", [1, 2])
def test_something_else_happens_between_the_release_and_the_point(parallel: int) -> None:
    """Another shaft stops there: the step ends at it, and its own end says nothing of the dip."""
    for seed in range(amount(40)):
        rng = np.random.default_rng(seed)
        width, torque = rng.uniform(0.5, 4.0), rng.uniform(4.0, 29.0)
        points = [(300.0, 0.3), (400.0 - 20.0 * width, 0.3), (400.0, 0.02), (400.0 + 20.0 * width, 0.3), (500.0, 0.3)]
        expected = 5.0 - width + width * (0.3 - torque / FORCE) / 0.28
        d = cw.Driveline("two shafts")
        shaft, other = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0, speed=10.0 * rng.uniform(expected, 5.0))
        friction = law("table", points, "linear", cw.Table([(0.0, 300.0), (END, 500.0)]))
        for name in ("c1", "c2")[:parallel]:
            d.add(cw.Brake(name, shaft=shaft, friction=friction, gain=1.0 / parallel, normal_force=FORCE))
        d.add(cw.Torque("t", shaft=shaft, torque=torque))
        stops = cw.Coulomb(static=0.1, kinetic=0.1)
        d.add(cw.Brake("stops", shaft=other, friction=stops, gain=1.0, normal_force=FORCE))
        gone = [e.time for e in d.simulate(END).events if e.before == "locked" and e.element.startswith("c")]
        assert gone[0] == pytest.approx(expected, abs=1e-6), seed


def test_plates_that_are_heated() -> None:
    points = [(300.0, 0.3), (400.0, 0.3), (425.0, 0.05), (450.0, 0.3), (500.0, 0.3)]
    # 1 J/K heated by 19 W: 115 K after 6.0526 s, where 100 N at a coefficient of 0.15 hold 15 N m
    run = held(law("table", points, "linear", None), 15.0, heat=19.0).simulate(END)
    assert run.events[0].time == pytest.approx(115.0 / 19.0, abs=1e-6)


def test_a_step_of_the_temperature() -> None:
    points = [(300.0, 0.3), (400.0, 0.3), (425.0, 0.05), (450.0, 0.3), (500.0, 0.3)]
    # it jumps over a dip, then comes back into it
    temperature = cw.Table([(0.0, 350.0), (2.0, 350.0), (2.0, 480.0), (3.0, 480.0), (8.0, 430.0)])
    run = held(law("table", points, "linear", temperature), 15.0).simulate(END)
    # 0.15 is reached at 435 K
    assert run.events[0].time == pytest.approx(3.0 + 5.0 * 45.0 / 50.0, abs=1e-9)


def test_derivative_of_what_follows() -> None:
    points = [(300.0, 0.3), (400.0, 0.3), (425.0, 0.05), (450.0, 0.3), (500.0, 0.3)]
    temperature = cw.Table([(0.0, 301.0), (END, 491.0)])
    d = held(law("table", points, "linear", temperature), 15.0)
    by = ["c.friction.static.values[3]", "t.torque"]
    run = d.simulate(END)
    found = run.gradient(of="a.speed", by=by)
    # a torque of 15 N m against 1 N m of friction from when it lets go: at 400 K + 25 K * (0.3 - 0.15) / (0.3 - b)
    after = END - run.events[0].time
    rate = 19.0  # K/s
    by_value = -14.0 * 25.0 * 0.15 / 0.25**2 / rate
    by_torque = after + 14.0 * 25.0 / (100.0 * 0.25) / rate
    assert float(found.matrix[0, 0]) == pytest.approx(by_value, rel=1e-6)
    assert float(found.matrix[0, 1]) == pytest.approx(by_torque, rel=1e-6)


@pytest.mark.parametrize("kind", KINDS)
def test_in_a_sweep(kind: str) -> None:
    points = [(300.0, 0.3), (400.0, 0.3), (425.0, 0.05), (450.0, 0.3), (500.0, 0.3)]
    temperature = cw.Table([(0.0, 301.0), (END, 491.0)])
    d = held(law(kind, points, "linear", temperature), 15.0)
    torques = np.linspace(2.0, 29.0, 8)
    swept = cw.sweep(d.assemble(), END, vary={"t.torque": torques}, outputs=["a.speed"])
    alone = [held(law(kind, points, "linear", temperature), t).simulate(END)["a.speed"][-1] for t in torques]
    np.testing.assert_allclose(swept["a.speed"], alone, rtol=1e-12)

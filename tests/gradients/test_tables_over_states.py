"""Tables over what changes slowly: a step may run over a whole cell, so that each border ends it.

docs/theory/events.md, rule 12. An ordinate between two steps has no other part in them: without borders its derivative
is zero.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support import by_differences
from support.amount import amount

Rng = np.random.Generator
Model = tuple[cw.Driveline, float, list[str]]
# of runs that let steps be long, and what values and derivatives may then miss of their scale
LOOSE: dict[str, Any] = {"rtol": 1e-6, "atol": 1e-8}
ALLOWED = 1e-4
# differences that are further apart say nothing
DOUBTFUL = 1e-6
MANNERS = [(between, beyond) for between in ("linear", "smooth") for beyond in ("linear", "nearest")]


def points_of(rng: Rng, low: float, high: float, count: int) -> list[tuple[float, float]]:
    """Points of a table about 1: straight, of which no error estimate sees a point, hardly bent, or up and down."""
    gaps = rng.uniform(0.3, 1.0, count - 1)
    places = low + (high - low) * np.concatenate([[0.0], np.cumsum(gaps) / gaps.sum()])
    bent = rng.choice([0.0, 1e-6, 0.2])
    values = rng.uniform(0.9, 1.1) + 1e-3 * (places - low) / (high - low) + bent * rng.uniform(-1.0, 1.0, count)
    return [(float(x), float(y)) for x, y in zip(places, values, strict=True)]


def braked(d: cw.Driveline, law: cw.Law, capacity: float) -> None:
    """A heavy shaft whose brake heats its plates by a few degrees."""
    plates = d.thermal("plates", capacity=capacity, temperature=300.0)
    shaft = d.shaft("a", inertia=20.0, speed=100.0)
    d.add(cw.Brake("c", shaft=shaft, friction=law, gain=1.0, normal_force=100.0, heat=plates))


def manner(rng: Rng) -> dict[str, str]:
    """What a table does between and beyond its points."""
    between, beyond = MANNERS[rng.integers(len(MANNERS))]
    return {"interpolation": between, "extrapolation": beyond}


def temperature(rng: Rng) -> Model:
    """Coefficients over the temperature."""
    d = cw.Driveline("temperature")
    points = points_of(rng, rng.uniform(296.0, 303.0), rng.uniform(306.0, 315.0), int(rng.integers(3, 30)))
    kinetic = [(x, 0.1 * y) for x, y in points]
    law = cw.TemperatureTable(static=[(x, 2.0 * y) for x, y in kinetic], kinetic=kinetic, **manner(rng))
    braked(d, law, rng.uniform(150.0, 400.0))
    numbers = rng.permutation([f"c.friction.kinetic.values[{i + 1}]" for i in range(len(points))])[:4]
    return d, 3.0, [*map(str, numbers), "a.speed", "plates.capacity"]


def mapped(rng: Rng) -> Model:
    """A map over temperature and slip."""
    d = cw.Driveline("mapped")
    warm = [x for x, _ in points_of(rng, 297.0, 312.0, int(rng.integers(3, 20)))]
    speeds = [0.0, *sorted(map(float, rng.uniform(20.0, 120.0, 3)))]
    rows = 0.1 + rng.choice([0.0, 1e-7, 2e-2]) * rng.uniform(-1.0, 1.0, (len(warm), len(speeds)))
    law = cw.FrictionMap(
        temperatures=warm, speeds=speeds, static=[0.2] * len(warm), kinetic=rows.tolist(), **manner(rng)
    )
    braked(d, law, rng.uniform(150.0, 400.0))
    return d, 3.0, ["a.speed", "plates.capacity", "c.normal_force"]


def cooled(rng: Rng) -> Model:
    """A conductance over the speed of a shaft that turns round, or runs up."""
    d = cw.Driveline("cooled")
    shaft = d.shaft("a", inertia=20.0, speed=float(rng.choice([0.0, rng.uniform(-80.0, 80.0)])))
    d.add(cw.Torque("t", shaft=shaft, torque=rng.choice([-1.0, 1.0]) * rng.uniform(200.0, 900.0)))
    first = float(rng.choice([0.0, 5.0, 20.0]))
    points = [(x, 20.0 * y) for x, y in points_of(rng, first, rng.uniform(60.0, 120.0), int(rng.integers(2, 30)))]
    drum, air = d.thermal("drum", capacity=100.0, temperature=400.0), d.ambient("air", temperature=300.0)
    d.add(cw.Convection("w", hot=drum, cold=air, conductance=points, speed=shaft))
    numbers = rng.permutation([f"w.conductance.values[{i + 1}]" for i in range(len(points))])[:4]
    return d, 3.0, [*map(str, numbers), "a.speed", "a.inertia"]


def pedal(rng: Rng) -> Model:
    """A clamp force over a pedal that is let go slowly."""
    d = cw.Driveline("pedal")
    a = d.shaft("a", inertia=20.0, speed=100.0)
    points = [(x, 1e3 * y) for x, y in points_of(rng, 0.0, 8e-3, int(rng.integers(3, 30)))]
    between, _ = MANNERS[rng.integers(len(MANNERS))]
    travel = cw.Table([(0.0, rng.uniform(6e-3, 1e-2)), (2.5, rng.uniform(-1e-3, 2e-3)), (3.0, 1e-3)])
    lag = float(rng.choice([2e-3, 0.2]))
    spring = cw.DiaphragmSpring(
        "f", force=points, travel=travel, free_travel=float(rng.choice([0.0, 1e-3])), lag=lag, interpolation=between
    )
    d.add(spring)
    law = cw.Coulomb(static=0.2, kinetic=0.1)
    d.add(cw.Brake("c", shaft=a, friction=law, gain=1.0, normal_force=spring))
    numbers = rng.permutation([f"f.force.values[{i + 1}]" for i in range(len(points))])[:4]
    return d, 3.0, [*map(str, numbers), "f.ratio", "f.travel.values[2]"]


KINDS: dict[str, Callable[[Rng], Model]] = {made.__name__: made for made in (temperature, mapped, cooled, pedal)}
OUTPUTS = {
    "temperature": ["a.speed", "plates.temperature"],
    "mapped": ["a.speed", "plates.temperature"],
    "cooled": ["drum.temperature"],
    "pedal": ["a.speed", "f.clamp_force"],
}


def missed(model: cw.Driveline, t_end: float, of: list[str], by: list[str]) -> tuple[int, list[str]]:
    """How many derivatives of loose runs were compared, and what they and their values miss.

    Each is asked for alone: parts of steps that another number needs would help it.
    """
    function, tight = (cw.differentiable(model, t_end, of=of, by=by, **how) for how in (LOOSE, by_differences.TIGHT))
    scales = by_differences.scales(model.simulate(t_end, rtol=1e-8), function.task.outputs)
    off = np.abs(np.array(function(function.x0)) - np.array(tight(tight.x0))) / scales
    found = [f"{name}: {miss:.1e}" for name, miss in zip(of, off, strict=True) if not miss < ALLOWED]
    exact = np.hstack([cw.differentiable(model, t_end, of=of, by=one, **LOOSE).gradient().matrix for one in by])
    compared = 0
    for one in by_differences.compared(function, exact, scales):
        for name, miss, doubt in zip(of, one.missed, one.doubt, strict=True):
            compared += doubt < DOUBTFUL
            if doubt < DOUBTFUL and not miss < ALLOWED:
                found.append(f"d {name} / d {one.name}: {miss:.1e} of scale")
    return compared, found


def test_an_ordinate_that_a_step_could_run_over_counts() -> None:
    d = cw.Driveline("brake")
    # straight, so that the error of a step says nothing of its points
    kinetic = [(300.0 + 0.5 * i, 0.1) for i in range(32)]
    braked(d, cw.TemperatureTable(static=[(x, 0.2) for x, _ in kinetic], kinetic=kinetic), 250.0)
    run = d.simulate(3.0, **LOOSE)
    assert run["plates.temperature"][-1] == pytest.approx(312.0, abs=1.0)
    by = [f"c.friction.kinetic.values[{i}]" for i in range(2, 22)]
    compared, wrong = missed(d, 3.0, ["a.speed"], by)
    assert (compared, wrong) == (len(by), [])
    slope = [cw.differentiable(d, 3.0, of="a.speed", by=one, **LOOSE).gradient().matrix[0, 0] for one in by]
    # a cell of 0.5 of 12 K takes 1/24 of 3 s, in which 100 N m for a coefficient of 1 slow 20 kg m2
    np.testing.assert_allclose(slope, -3.0 / 24.0 * 100.0 / 20.0, rtol=0.1)


# tables whose continuation falls to zero far away
@pytest.mark.filterwarnings("ignore::clutchwork.ModelWarning")
@pytest.mark.random
@pytest.mark.parametrize("kind", KINDS)
def test_random_tables(kind: str) -> None:
    compared = 0
    for seed in range(amount(40)):
        model, t_end, by = KINDS[kind](np.random.default_rng([seed, 7]))
        count, wrong = missed(model, t_end, OUTPUTS[kind], by)
        compared += count
        assert not wrong, f"seed {seed}: {wrong}"
    assert compared > 4 * amount(40)

"""A mass that a crank moves starts where the crank holds it; stops on it; engines begin at the angle of their shaft."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support.amount import seeds


def press(seed: int, **mass: float) -> tuple[cw.Driveline, cw.CrankSlider]:
    rng = np.random.default_rng([seed, 18])
    radius = float(rng.uniform(0.02, 0.1))
    d = cw.Driveline(f"press {seed}")
    crank = d.shaft("crank", inertia=0.05, speed=float(rng.uniform(-90.0, 90.0)), angle=float(rng.uniform(-7.0, 7.0)))
    slider = d.mass("slider", mass=float(rng.uniform(0.1, 2.0)), **mass)
    rod, phase = radius * float(rng.uniform(1.5, 5.0)), float(rng.uniform(-4.0, 4.0))
    return d, d.add(cw.CrankSlider("c", shaft=crank, mass=slider, radius=radius, rod=rod, phase=phase))


def place(c: cw.CrankSlider, angle: np.ndarray | float) -> np.ndarray:
    """docs/theory/varying-ratios.md"""
    x = np.asarray(angle) + c.phase
    return c.radius * np.cos(x) + np.sqrt(c.rod**2 - (c.radius * np.sin(x)) ** 2)


@pytest.mark.random
@pytest.mark.parametrize("seed", seeds(30))
def test_the_position_follows_from_the_crank_at_all_times(seed: int) -> None:
    d, c = press(seed)
    run = d.simulate(0.3, angles=True, rtol=1e-8)
    np.testing.assert_allclose(run["slider.position"], place(c, run["crank.angle"]), atol=1e-7)


@pytest.mark.random
@pytest.mark.parametrize("seed", seeds(30))
def test_a_position_that_does_not_fit_is_refused_with_the_one_that_does(seed: int) -> None:
    d, c = press(seed)
    fits = float(place(c, d.shafts[0].angle or 0.0))
    other, _ = press(seed, position=1.1 * fits)
    with pytest.raises(cw.ModelError, match=f'mass "slider": position = .* give {fits:.9g} m, or leave it out'):
        other.simulate(0.1)
    given, _ = press(seed, position=fits)
    assert given.simulate(0.1)["slider.speed"][-1] == d.simulate(0.1)["slider.speed"][-1]


@pytest.mark.random
@pytest.mark.parametrize("seed", seeds(30))
def test_a_stop_on_a_slider(seed: int) -> None:
    """It is where the slider is; one within its way is met, one beyond its start is refused."""
    d, c = press(seed)
    start, low, high = float(place(c, d.shafts[0].angle or 0.0)), c.rod - c.radius, c.rod + c.radius
    slider = d.masses[0]
    d.add(cw.EndStop("e", follower=slider, lower=0.9 * low, upper=1.1 * high))
    run = d.simulate(0.3, angles=True, rtol=1e-8)
    assert len(run.events) == 0
    np.testing.assert_allclose(run["e.position"], run["slider.position"], atol=1e-7)
    met, c = press(seed)
    middle = 0.5 * (low + start)
    met.add(cw.EndStop("e", follower=met.masses[0], lower=middle, lower_restitution=0.5))
    run = met.simulate(0.3, angles=True)
    assert run["slider.position"].min() > middle - 1e-6
    beyond, _ = press(seed)
    beyond.add(cw.EndStop("e", follower=beyond.masses[0], lower=start + 0.01))
    with pytest.raises(cw.ModelError, match=r"initial_position is .* at the start, (below|above) the"):
        beyond.simulate(0.1)


@pytest.mark.parametrize("name", ["c.radius", "c.rod", "c.phase", "crank.angle"])
def test_changed_numbers_move_the_slider(name: str) -> None:
    d, c = press(3)
    d.add(cw.EndStop("e", follower=d.masses[0], lower=0.0))
    value = 1.2 * (d.shafts[0].angle or 0.0) if name == "crank.angle" else 1.2 * getattr(c, name[2:])
    system = d.assemble().changed({name: value})
    made, _ = press(3)
    run = cw.simulate(system, 0.01, angles=True)
    assert run["slider.position"][0] == run["e.position"][0] != made.simulate(0.01, angles=True)["slider.position"][0]


def test_the_ripple_of_an_engine_begins_at_the_angle_of_its_shaft() -> None:
    def run(angle: float, base: float, **given: float) -> float:
        d = cw.Driveline("engine")
        shaft, frame = d.shaft("s", inertia=1.0, speed=50.0, angle=angle), d.shaft("f", inertia=9.0, angle=base)
        curves = {"full_load": [[0.0, 100.0], [300.0, 150.0]], "orders": [2.0], "amplitudes": [0.7]}
        d.add(cw.Engine("e", shaft=shaft, base=frame, throttle=1.0, **curves, **given))
        return float(d.simulate(0.05)["s.speed"][-1])

    assert run(0.9, 0.2) == run(0.0, 0.0, initial_crank=0.7) != run(0.0, 0.0)
    assert run(0.9, 0.2, initial_crank=0.0) == run(0.0, 0.0)

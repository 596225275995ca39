"""Elastic backlash and gaps: closed forms, SciPy on equations of their own, energy."""

from __future__ import annotations

from math import atan, cos, exp, pi, sin, sqrt
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from support.amount import seeds
from support.runs import TIGHT, at_end

INERTIA, STIFFNESS, GAP, SPEED = 0.2, 500.0, 0.1, 3.0  # kg m2, N m/rad, rad, rad/s
TURNING = sqrt(STIFFNESS / INERTIA)  # rad/s
# of the signal's own size; the runs keep 1e-12 in every step
CLOSED = 1e-9


def body(element: str, **fields: Any) -> cw.Driveline:
    """A shaft at the housing, in the middle of the gap or just before contact."""
    d = cw.Driveline("body")
    shaft = d.shaft("j", inertia=INERTIA, speed=fields.pop("speed", SPEED))
    cls = getattr(cw, element)
    d.add(cls("x", base=d.housing, follower=shaft, stiffness=STIFFNESS, **fields))
    return d


def test_a_shaft_swings_between_flanks_without_damping() -> None:
    """Half a swing of the spring at each flank, and two flights over the gap."""
    period = 2 * pi / TURNING + 2 * GAP / SPEED
    run = body("ElasticBacklash", gap=GAP).simulate(7 * period, times=[7 * period], **TIGHT)
    assert at_end(run, "j.speed") == pytest.approx(SPEED, rel=CLOSED)
    assert at_end(run, "x.twist") == pytest.approx(0.0, abs=CLOSED * GAP)
    peak = GAP / 2 / SPEED + pi / 2 / TURNING
    run = body("ElasticBacklash", gap=GAP).simulate(peak, times=[peak], **TIGHT)
    assert at_end(run, "x.torque") == pytest.approx(-STIFFNESS * SPEED / TURNING, rel=CLOSED)


@pytest.mark.parametrize("damping", [0.5, 4.0])
def test_a_damped_flank_gives_back_a_share_of_the_speed(damping: float) -> None:
    """Without the limit the damper acts until it would pull: that part of a damped swing, then a free flight."""
    fading = damping / 2 / INERTIA
    turning = sqrt(STIFFNESS / INERTIA - fading**2)
    phase = pi - atan(damping * turning / (STIFFNESS - damping * fading))
    share = exp(-fading * phase / turning) * (cos(phase) - fading / turning * sin(phase))
    end = GAP / 2 / SPEED + phase / turning
    d = body("ElasticBacklash", gap=GAP, damping=damping, limited=False)
    run = d.simulate(end + 0.1 * GAP / SPEED, times=[end - 1e-6, end, end + 0.05 * GAP / SPEED], **TIGHT)
    assert at_end(run, "j.speed") == pytest.approx(SPEED * share, rel=1e-8)
    # 1e-6 s before it nearly lets go
    assert -1e-3 * STIFFNESS * SPEED / turning < run["x.torque"][0] < 0.0
    assert run["x.torque"][2] == 0.0


def flank(depth: float, closing: float, damping: float, limited: bool) -> float:
    """Torque of a flank by the conventions of the cases."""
    if depth <= 0:
        return 0.0
    spring, damper = STIFFNESS * depth, damping * closing
    if spring + damper <= 0:
        return 0.0
    return spring + (min(spring, damper) if limited else damper)


@pytest.mark.parametrize("damping", [1.0, 8.0, 30.0])
@pytest.mark.parametrize("limited", [True, False])
def test_backlash_against_scipy(limited: bool, damping: float) -> None:
    """Driven across the gap by a sine, in small steps of an explicit method."""

    def slope(t: float, y: np.ndarray) -> list[float]:
        push = flank(y[0] - GAP / 2, y[1], damping, limited) - flank(-y[0] - GAP / 2, -y[1], damping, limited)
        return [y[1], (20.0 * np.sin(5.0 * t) - push) / INERTIA]

    times = np.linspace(0.0, 2.0, 41)
    known = solve_ivp(slope, (0, 2), [0.0, 1.0], "DOP853", times, rtol=1e-11, atol=1e-13, max_step=1e-3)
    d = body("ElasticBacklash", gap=GAP, damping=damping, limited=limited, speed=1.0)
    d.add(cw.Torque("drive", shaft=d.shafts[0], torque=cw.Sine(amplitude=20.0, frequency=5.0 / 2 / pi)))
    run = d.simulate(2.0, times=times, **TIGHT)
    # SciPy steps over kinks and jumps of the torque, which costs it some digits
    assert run["j.speed"] == pytest.approx(known.y[1], abs=1e-6 * np.abs(known.y[1]).max())
    assert run["x.twist"] == pytest.approx(known.y[0], abs=1e-6 * np.abs(known.y[0]).max())


# of the random flights below, some with long steps over a flank and back to the other one
OVER_BOTH = (72, 92, 93, 100, 111, 136, 203, 247)


@pytest.mark.parametrize("seed", [*OVER_BOTH, *seeds(20)])
def test_a_flank_is_met_however_long_the_step(seed: int) -> None:
    """A constant torque turns a shaft round in the gap: a step may be longer than the flight to both flanks."""
    rng = np.random.default_rng([seed, 5])
    inertia, gap = 10 ** rng.uniform(-2, 0), 10 ** rng.uniform(-2, -0.5)
    torque = 10 ** rng.uniform(0, 1.5) * rng.choice([-1, 1])
    # a second number was drawn when the seeds above were found
    stiffness, _ = 10 ** rng.uniform(3.5, 5), rng.uniform(0.02, 0.3)
    twist, flight = rng.uniform(-0.5, 0.5) * gap, sqrt(2 * gap * inertia / abs(torque))
    speed = rng.uniform(-1, 1) * sqrt(2 * abs(torque) / inertia * gap) * 2
    d = cw.Driveline("flight")
    shaft = d.shaft("j", inertia=inertia, speed=speed)
    d.add(cw.Torque("t", shaft=shaft, torque=torque))
    flanks = {"stiffness": stiffness, "gap": gap, "initial_twist": twist}
    d.add(cw.ElasticBacklash("x", base=d.housing, follower=shaft, **flanks))
    for rtol in (1e-6, 1e-8, 1e-10):
        run = d.simulate(6 * flight, rtol=rtol, atol=1e-2 * rtol)
        beyond = np.sign(run["x.twist"]) * np.maximum(np.abs(run["x.twist"]) - gap / 2, 0.0)
        # rows have both; a flank is found to 1e-12
        assert np.abs(run["x.torque"] + stiffness * beyond).max() < 1e-9 * stiffness * gap, rtol


def test_a_body_bounces_on_an_undamped_gap() -> None:
    """Under a weight: parabolas between contacts that last pi + 2 atan(sqrt(2 h k/(m g^2) m)) of the swing."""
    mass, weight, height = 2.0, 20.0, 0.3
    d = cw.Driveline("drop")
    ball = d.mass("ball", mass=mass, position=height)
    d.add(cw.ElasticGap("floor", base=d.housing, follower=ball, stiffness=STIFFNESS, initial_gap=height))
    d.add(cw.Torque("weight", shaft=ball, torque=-weight))
    fall, turning = sqrt(2 * height * mass / weight), sqrt(STIFFNESS / mass)
    sink = weight / STIFFNESS
    contact = 2 * (pi - np.arctan2(weight / mass * fall / turning, sink)) / turning
    period = 2 * fall + contact
    run = d.simulate(3 * period, times=[period, 3 * period], **TIGHT)
    assert run["ball.position"] == pytest.approx(height, rel=CLOSED)
    depth = sink + sqrt(sink**2 + (weight / mass * fall / turning) ** 2)
    run = d.simulate(fall + contact / 2, times=[fall + contact / 2], **TIGHT)
    assert at_end(run, "floor.gap") == pytest.approx(-depth, rel=CLOSED)
    assert at_end(run, "floor.torque") == pytest.approx(STIFFNESS * depth, rel=CLOSED)


def test_a_damped_gap_never_pulls_and_comes_to_rest() -> None:
    d = cw.Driveline("drop")
    ball = d.mass("ball", mass=2.0, position=0.3)
    d.add(cw.ElasticGap("floor", base=d.housing, follower=ball, stiffness=STIFFNESS, damping=10.0, initial_gap=0.3))
    d.add(cw.Torque("weight", shaft=ball, torque=-20.0))
    run = d.simulate(10.0, rtol=1e-9, atol=1e-11)
    # round-off of the instant at which it opens: 1e-12 m/s times the damping
    assert np.min(run["floor.torque"]) >= -1e-10
    pressed = run["floor.gap"] < 0
    # nor does its damping exceed the spring
    spring = -STIFFNESS * run["floor.gap"]
    assert np.all(run["floor.torque"][pressed] <= 2 * spring[pressed] * (1 + 1e-9))
    assert at_end(run, "ball.position") == pytest.approx(-20.0 / STIFFNESS, rel=1e-6)


@pytest.mark.parametrize("seed", range(40))
def test_energy_of_random_lines_with_play(seed: int) -> None:
    """Three shafts, of which one joint has play, one may, and one may be a gap to the housing."""
    draw = np.random.default_rng(seed)
    d = cw.Driveline("line")
    shafts = [d.shaft(f"s{i}", inertia=draw.uniform(0.05, 1.0), speed=draw.normal(0, 5)) for i in range(3)]
    for i in range(2):
        d.add(
            cw.ElasticBacklash(
                f"b{i}",
                base=shafts[i],
                follower=shafts[i + 1],
                stiffness=10 ** draw.uniform(2, 4),
                damping=draw.choice([0.0, 0.5, 5.0]),
                gap=10 ** draw.uniform(-3, -1),
                limited=bool(draw.integers(2)),
                initial_twist=draw.normal(0, 0.02),
            )
        )
    gap = {"stiffness": 10 ** draw.uniform(2, 4), "damping": draw.uniform(0, 3), "initial_gap": draw.normal(0.05, 0.1)}
    d.add(cw.ElasticGap("gap", base=d.housing, follower=shafts[int(draw.integers(3))], **gap))
    d.add(
        cw.Torque(
            "drive", shaft=shafts[0], torque=cw.Sine(amplitude=draw.uniform(5, 60), frequency=draw.uniform(0.5, 4))
        )
    )
    run = d.simulate(2.0, rtol=1e-9, atol=1e-11)
    assert run.status == "done"
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover
    # a flank without damping has no heat but the residual of the run, which is asked to be within that
    for name in ("b0", "b1", "gap"):
        assert run.energy.heat[name] >= -1e-8 * run.energy.turnover


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_what_is_pressed_at_the_start_pushes_from_the_first_row_on(side: float) -> None:
    """Torque and linear system of the start itself, not of the instant after it."""
    d = body("ElasticBacklash", gap=GAP, damping=0.5, limited=False, initial_twist=side * GAP, speed=0.0)
    assert d.simulate(1e-3)["x.torque"][0] == pytest.approx(-side * STIFFNESS * GAP / 2, rel=CLOSED)
    assert cw.linearise(d).A[0] == pytest.approx([-0.5 / INERTIA, -STIFFNESS / INERTIA], rel=CLOSED)
    d = body("ElasticGap", damping=0.5, initial_gap=-side * GAP, speed=0.0)
    pressed = STIFFNESS * GAP if side > 0 else 0.0
    assert d.simulate(1e-3)["x.torque"][0] == pytest.approx(pressed, rel=CLOSED)
    assert cw.linearise(d).A[0, 1] == pytest.approx(-STIFFNESS / INERTIA if side > 0 else 0.0, rel=CLOSED)


def test_a_flank_that_springs_apart_at_the_start_is_slack() -> None:
    """Where the damper would pull from the start on, nothing acts: it opens faster than the spring can push."""
    d = body("ElasticBacklash", gap=GAP, damping=50.0, initial_twist=0.55 * GAP, speed=-SPEED)
    run = d.simulate(1e-4)
    assert run["x.torque"][0] == 0.0
    assert cw.linearise(d).A[0] == pytest.approx([0.0, 0.0])

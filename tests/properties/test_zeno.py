"""The guard against events without end: it stops what would never end, and nothing else."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.amount import amount
from support.sweep import log_uniform, simulate, stopped, sweep

# what the guard promises: so many events within a microsecond are one too many
PROMISED = 50
WINDOW = 1e-6
ONE = cw.Coulomb(static=1.0, kinetic=1.0)


def after_a_spring(seed: int) -> str:
    """A freewheel and equal clutches behind a spring move as the freewheel and one clutch."""
    rng = np.random.default_rng([seed, 50])
    inertia = [log_uniform(rng, 0.05, 2.0) for _ in range(3)]
    speeds = [float(x) for x in rng.uniform(-100.0, 100.0, 3)]
    stiffness, capacity = log_uniform(rng, 1e2, 1e5), log_uniform(rng, 10.0, 1000.0)
    law = cw.Coulomb(static=float(rng.uniform(1.0, 1.3)), kinetic=1.0)
    ahead = bool(rng.random() < 0.5)

    def run(count: int) -> Any:
        d = cw.Driveline("after a spring")
        a, b, q = (d.shaft(n, inertia=j, speed=w) for n, j, w in zip("abq", inertia, speeds, strict=True))
        d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=stiffness, damping=stiffness * 1e-4))
        d.add(cw.OneWayClutch("f", base=b if ahead else q, follower=q if ahead else b))
        for i in range(count):
            d.add(cw.Clutch(f"c{i}", base=b, follower=q, friction=law, gain=1.0, normal_force=capacity / count))
        return simulate(d, 0.5, rtol=1e-9, atol=1e-10, dt=0.01)

    count = int(rng.integers(2, 8))
    one, several = run(1), run(count)
    if text := stopped(one) or stopped(several):
        return f"{count} clutches: {text}"
    full = max(float(np.max(np.abs(one[f"{n}.speed"]))) for n in "abq")
    error = max(float(np.max(np.abs(one[f"{n}.speed"] - several[f"{n}.speed"]))) for n in "abq") / full
    return "" if error <= 1e-6 else f"{count} clutches: speeds differ by {error:.1e} of full scale"


@pytest.mark.random
def test_freewheel_and_equal_clutches_after_a_spring() -> None:
    sweep(after_a_spring, amount())


@pytest.mark.random
def test_many_contacts_switch_at_once() -> None:
    """More contacts than the guard counts close, lock and let go in the same instants: on shafts of their own, on one
    shaft, and in a chain; with freewheels among them.
    """

    def check(seed: int) -> str:
        rng = np.random.default_rng([seed, 51])
        d = cw.Driveline("many")
        count, layout = int(rng.integers(55, 100)), int(rng.integers(3))
        nodes = [d.shaft(f"s{i}", inertia=1.0, speed=10.0) for i in range(1 if layout == 1 else count)]
        force = cw.Table([(0.2, 0.0), (0.2, 30.0), (0.9, 30.0), (0.9, 0.0)])
        for i in range(count):
            shaft = nodes[0 if layout == 1 else i]
            base = nodes[i - 1] if layout == 2 and i else d.housing
            if rng.random() < 0.2:
                d.add(cw.OneWayClutch(f"c{i}", base=shaft, follower=base))
            else:
                d.add(cw.Clutch(f"c{i}", base=base, follower=shaft, friction=ONE, gain=1.0, normal_force=force))
        return stopped(simulate(d, 1.0, points=10))

    sweep(check, max(6, amount() // 30))


def knots(count: int, within: float) -> cw.Table:
    """A table with so many knots in a stretch of time that starts at half a second."""
    step = within / count
    return cw.Table([(0.5 + i * step, 20.0 + i % 2) for i in range(count)])


def braked(force: Any) -> cw.Driveline:
    d = cw.Driveline("knots")
    a = d.shaft("a", inertia=1.0, speed=100.0)
    d.add(cw.Brake("c", shaft=a, friction=ONE, gain=1.0, normal_force=force))
    return d


@pytest.mark.parametrize("count", [2, 20, 40])
def test_fewer_knots_within_a_microsecond_are_no_zeno_sequence(count: int) -> None:
    run = simulate(braked(knots(count, 0.9 * WINDOW)), 1.0)
    assert run.status == "done", run.message


@pytest.mark.parametrize("period", [1e-9, 2e-9, 1e-8])
def test_signal_with_knots_without_end_stops_and_says_so(period: float) -> None:
    """Some 100 to 1000 knots within a microsecond: neither inertia nor damping would help."""
    pulse = cw.Pulse(height=1.0, period=period, width=period / 2, offset=20.0)
    run = simulate(braked(pulse), 1e-5)
    assert run.status == "zeno", run.message
    assert run.time[-1] <= 2 * WINDOW
    assert "inertia" not in run.message
    assert "signal" in run.message or "knot" in run.message


def stick_slip(rng: np.random.Generator, rate: float) -> cw.Driveline:
    """A mass so small that it sticks and slips `rate` times in a second; static 2 N m, kinetic 1 N m.

    The spring falls back by twice the difference of the two, so that it sticks for 2 N m / (stiffness speed), and slips
    for half a period of its own, pi sqrt(J/k): a quarter and half of the time.
    """
    speed = log_uniform(rng, 10.0, 1000.0)
    stiffness = 2.0 * 2.0 * rate / speed
    inertia = stiffness * (1.0 / (2.0 * rate * np.pi)) ** 2
    d = cw.Driveline("stick-slip")
    a, p = d.shaft("a", inertia=float(inertia)), d.shaft("p", inertia=1.0)
    d.add(cw.PrescribedSpeed("m", shaft=p, speed=speed))
    d.add(cw.Spring("k", base=p, follower=a, stiffness=stiffness))
    d.add(cw.Brake("c", shaft=a, friction=cw.Coulomb(static=2.0, kinetic=1.0), gain=1.0, normal_force=1.0))
    return d


@pytest.mark.random
def test_events_without_end_stop_after_as_many_as_promised() -> None:
    """Stick-slip with 100 to 10 000 events within a microsecond."""

    def check(seed: int) -> str:
        rng = np.random.default_rng([seed, 52])
        d = stick_slip(rng, log_uniform(rng, 50.0, 5000.0) / WINDOW)
        run = simulate(d, 1e-3, max_steps=100_000)
        count = sum(event.time >= run.time[-1] - WINDOW for event in run.events)
        if run.status == "zeno" and "'c'" in run.message and PROMISED <= count <= PROMISED + 10:
            return ""
        return f"{run.status}, {count} events: {run.message}"

    sweep(check, amount() // 3)


@pytest.mark.random
def test_fewer_events_within_a_microsecond_go_on() -> None:
    """Stick-slip with 2 to 30 events within a microsecond, for ten of them."""

    def check(seed: int) -> str:
        rng = np.random.default_rng([seed, 53])
        rate = log_uniform(rng, 1.0, 15.0) / WINDOW
        d = stick_slip(rng, rate)
        run = simulate(d, 10 * WINDOW)
        return stopped(run) or ("" if len(run.events) >= 8 * rate * WINDOW else f"only {len(run.events)} events")

    sweep(check, amount() // 3)

"""A shaft without inertia between an eddy-current brake and a damper: the torque of both has a peak and a valley, and a
balance that ends there jumps to the other side. docs/theory/reduction.md (9)"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

import clutchwork as cw

PEAK, PEAK_SPEED, DAMPING, RISE = 100.0, 10.0, 1.0, 40.0


def resisting(speed: float) -> float:
    """[N m] of brake and damper."""
    ratio = speed / PEAK_SPEED
    return 2 * PEAK * ratio / (1 + ratio**2) + DAMPING * speed


def add(model: cw.Driveline, name: str, torque: cw.SignalLike, *, damping: float = DAMPING, **of_shaft: float) -> None:
    """A shaft with a brake, a damper and a torque."""
    shaft = model.shaft(name, **of_shaft)
    model.add(cw.EddyCurrentBrake(f"{name} brake", shaft=shaft, nominal_torque=PEAK, nominal_speed=PEAK_SPEED))
    model.add(cw.Damper(f"{name} damper", base=model.housing, follower=shaft, damping=damping))
    model.add(cw.Torque(f"{name} drive", shaft=shaft, torque=torque))


def driven(torque: cw.SignalLike, speed: float = 0.0, inertia: float = 0.0) -> cw.Driveline:
    """One of them."""
    model = cw.Driveline()
    model.shaft("other", inertia=1.0)
    add(model, "shaft", torque, speed=speed, inertia=inertia)
    return model


@pytest.mark.parametrize("way", [1, -1])
def test_a_balance_jumps_where_it_ends(way: int) -> None:
    """Up at the peak, and down again at the valley, each to the speed at which the same torque balances."""
    peak = minimize_scalar(lambda w: -resisting(w), bounds=(5, 15), method="bounded", options={"xatol": 1e-12}).x
    valley = minimize_scalar(resisting, bounds=(15, 60), method="bounded", options={"xatol": 1e-12}).x
    up, top = resisting(peak) / RISE, 4.0
    down = top + (RISE * top - resisting(valley)) / RISE
    after = brentq(lambda w: resisting(w) - RISE * up, 2 * peak, 1e4)
    back = brentq(lambda w: resisting(w) - resisting(valley), 0, peak)
    drive = cw.Table(((0.0, 0.0), (top, way * RISE * top), (2 * top, 0.0)))
    result = driven(drive).simulate(2 * top)
    speed, rows = way * result["shaft.speed"], result.time
    # of the speed, beside a fold, the root of what a time of the tolerance makes
    assert result.status == "done"
    for at, left, right in ((up, peak, after), (down, valley, back)):
        inside = int(np.searchsorted(rows, at + 1e-9))
        assert np.isclose(rows[inside - 1], at, rtol=1e-8)
        jump = int(np.argmax(np.abs(np.diff(speed[inside - 3 : inside + 3])))) + inside - 3
        assert np.isclose(speed[jump], left, rtol=1e-3)
        assert np.isclose(speed[jump + 1], right, rtol=1e-3)
    torque = np.array([resisting(w) for w in speed])
    given = np.interp(rows, (0.0, top, 2 * top), (0.0, RISE * top, 0.0))
    assert np.abs(torque - given).max() < 1e-6 * RISE * top


@pytest.mark.parametrize("speed", [-500.0, -57.1, -30.0, 12.0, 25.0, 57.1, 500.0])
@pytest.mark.parametrize("torque", [0.0, 100.0, -100.0])
def test_a_shaft_begins_at_the_balance_that_its_torques_drive_it_to(torque: float, speed: float) -> None:
    """Of three balances at 100 N m the one in the middle does not hold, and the others are where a shaft of next to no
    inertia goes from either side."""
    result, light = (driven(torque, speed, inertia).simulate(1.0) for inertia in (0.0, 1e-6))
    assert result.status == "done"
    # the light one comes to its balance within 1e-5 s
    assert result["shaft.speed"][0] == pytest.approx(light["shaft.speed"][-1], rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("speeds", [(12.0, 12.0), (12.0, 25.0), (25.0, 500.0), (-30.0, 12.0)])
def test_two_shafts_begin_where_each_of_them_would(speeds: tuple[float, float]) -> None:
    """At 100 N m a shaft below 20 rad/s goes down to 6.8 rad/s, one above it up to 73 rad/s."""
    model = cw.Driveline()
    for name, speed in zip("ab", speeds, strict=True):
        add(model, name, 100.0, speed=speed)
    run = model.simulate(0.1)
    alone = [driven(100.0, speed).simulate(0.1)["shaft.speed"][0] for speed in speeds]
    assert [run[f"{name}.speed"][0] for name in "ab"] == pytest.approx(alone, rel=1e-9)


@pytest.mark.parametrize("share", [1.0, 1.0 + 1e-10, 1.01])
def test_shafts_alike_jump_together(share: float) -> None:
    """Both wheels of an axle, which nothing but the same torque joins."""
    model, drive = cw.Driveline(), cw.Table(((0.0, 0.0), (4.0, RISE * 4.0), (8.0, 0.0)))
    add(model, "left", drive)
    add(model, "right", drive, damping=share * DAMPING)
    result = model.simulate(8.0)
    assert result.status == "done"
    apart = np.abs(result["left.speed"] - result["right.speed"]) > 0.1 * np.abs(result["left.speed"]).max()
    # but for the times between their jumps: dampers differ by 1 % at 11 rad/s of the peak and 31 rad/s of the valley
    assert np.sum(np.diff(result.time)[apart[1:]]) <= 1.5 * (11.0 + 31.0) * DAMPING * (share - 1.0) / RISE + 1e-6


def test_derivatives_end_at_a_fold() -> None:
    """When it jumps depends on the torque; nothing carries that, and no gradient is made up behind it."""
    system = driven(cw.Table(((0.0, 0.0), (4.0, 160.0))))
    f = cw.differentiable(system, 4.0, of={"speed": "shaft.speed"}, by=["shaft damper.damping"])
    with pytest.raises(cw.ClutchworkError, match="collapsed"):
        f.gradient([DAMPING])

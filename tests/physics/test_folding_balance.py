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


def driven(torque: cw.SignalLike, speed: float = 0.0) -> cw.System:
    """The shaft with a brake, a damper and a torque."""
    model = cw.Driveline()
    shaft = model.shaft("shaft", speed=speed)
    model.shaft("other", inertia=1.0)
    model.add(cw.EddyCurrentBrake("brake", shaft=shaft, nominal_torque=PEAK, nominal_speed=PEAK_SPEED))
    model.add(cw.Damper("damper", base=model.housing, follower=shaft, damping=DAMPING))
    model.add(cw.Torque("drive", shaft=shaft, torque=torque))
    return model.assemble()


@pytest.mark.parametrize("way", (1, -1))
def test_a_balance_jumps_where_it_ends(way: int) -> None:
    """Up at the peak, and down again at the valley, each to the speed at which the same torque balances."""
    peak = minimize_scalar(lambda w: -resisting(w), bounds=(5, 15), method="bounded", options={"xatol": 1e-12}).x
    valley = minimize_scalar(resisting, bounds=(15, 60), method="bounded", options={"xatol": 1e-12}).x
    up, top = resisting(peak) / RISE, 4.0
    down = top + (RISE * top - resisting(valley)) / RISE
    after = brentq(lambda w: resisting(w) - RISE * up, 2 * peak, 1e4)
    back = brentq(lambda w: resisting(w) - resisting(valley), 0, peak)
    drive = cw.Table(((0.0, 0.0), (top, way * RISE * top), (2 * top, 0.0)))
    result = cw.simulate(driven(drive), 2 * top)
    speed, rows = way * result["shaft.speed"], result.time
    # of the speed, beside a fold, the root of what a time of the tolerance makes
    assert result.status == "done"
    for at, left, right in ((up, peak, after), (down, valley, back)):
        inside = int(np.searchsorted(rows, at + 1e-9))
        assert np.isclose(rows[inside - 1], at, rtol=1e-8)
        jump = int(np.argmax(np.abs(np.diff(speed[inside - 3 : inside + 3])))) + inside - 3
        assert np.isclose(speed[jump], left, rtol=1e-3) and np.isclose(speed[jump + 1], right, rtol=1e-3)
    torque = np.array([resisting(w) for w in speed])
    given = np.interp(rows, (0.0, top, 2 * top), (0.0, RISE * top, 0.0))
    assert np.abs(torque - given).max() < 1e-6 * RISE * top


@pytest.mark.parametrize("speed", (-500.0, -57.1, 57.1, 500.0))
def test_a_shaft_beyond_a_peak_runs_to_its_balance(speed: float) -> None:
    """Its only balance is rest, and no step of Newton's method from beyond the valley leads there."""
    result = cw.simulate(driven(0.0, speed), 0.1)
    assert result.status == "done" and np.abs(result["shaft.speed"]).max() < 1e-9


def test_derivatives_end_at_a_fold() -> None:
    """When it jumps depends on the torque; nothing carries that, and no gradient is made up behind it."""
    system = driven(cw.Table(((0.0, 0.0), (4.0, 160.0))))
    f = cw.differentiable(system, 4.0, of={"speed": "shaft.speed"}, by=["damper.damping"])
    with pytest.raises(cw.ClutchworkError, match="collapsed"):
        f.gradient([DAMPING])

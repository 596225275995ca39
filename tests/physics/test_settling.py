"""Rows within the first step behind a jump show how a stiff motion settles there: docs/theory/integrators.md (18)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.run.simulation import begun

# [kg m2], [N m s/rad], [N m], [s]: the shaft settles within a microsecond, and steps reach milliseconds
INERTIA, DAMPING, BEFORE, JUMP, AT = 1e-3, 1e3, 1.0, 1e-3, 0.01
AFTER = AT + np.array([1e-7, 1e-6, 3e-6, 1e-5, 1e-4, 1e-3, 5e-3])
ATOL = 1e-8
# tables of the drive that jump, and that bend: what the speed is short of the balance by, from then on
Shape = tuple[list[tuple[float, float]], Callable[[np.ndarray], np.ndarray]]
SHAPES: dict[str, Shape] = {
    "jump": ([(0.0, BEFORE), (AT, BEFORE), (AT, BEFORE + JUMP)], lambda t: JUMP * np.exp(-t * DAMPING / INERTIA)),
    "bend": (
        [(0.0, BEFORE), (AT, BEFORE), (AT + 1.0, BEFORE + 1e2)],
        lambda t: 1e2 * INERTIA / DAMPING * (1.0 - np.exp(-t * DAMPING / INERTIA)),
    ),
}


def driveline(points: list[tuple[float, float]], beside: int = 0) -> cw.Driveline:
    """A damped shaft under a torque, and others at rest, for a motion in other forms."""
    d = cw.Driveline("settles")
    a = d.shaft("a", inertia=INERTIA, speed=BEFORE / DAMPING)
    d.add(cw.Damper("damper", base=d.housing, follower=a, damping=DAMPING))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Table(points)))
    for k in range(beside):
        d.add(cw.Damper(f"d{k}", base=d.housing, follower=d.shaft(f"s{k}", inertia=1.0), damping=1.0))
    return d


@pytest.mark.parametrize("beside", [0, 8])
@pytest.mark.parametrize("shape", SHAPES)
def test_rows_behind_a_jump_are_those_of_the_motion(shape: str, beside: int) -> None:
    points, short = SHAPES[shape]
    run = driveline(points, beside).simulate(0.02, times=AFTER, atol=ATOL)
    torque = np.interp(AFTER, *np.array(points[-2:] if shape == "bend" else points).T)
    torque = torque if shape == "bend" else np.full_like(AFTER, BEFORE + JUMP)
    # the estimate is a mean over all speeds
    most = np.sqrt(1 + beside) * (ATOL + 1e-6 * BEFORE / DAMPING)
    assert run["a.speed"] == pytest.approx((torque - short(AFTER - AT)) / DAMPING, abs=most, rel=0)


def test_a_motion_that_is_not_stiff_takes_no_step_more() -> None:
    """Of a spring of 1 Hz: knots of its drive that change nothing cost it none but those that end on them."""
    counts = []
    for knots in (False, True):
        d = cw.Driveline("slow")
        a = d.shaft("a", inertia=1.0, speed=1.0)
        d.add(cw.SpringDamper("spring", base=d.housing, follower=a, stiffness=40.0, damping=0.1))
        points = [(0.5 * k, 1.0) for k in range(9 if knots else 1)]
        d.add(cw.Torque("drive", shaft=a, torque=cw.Table(points) if knots else 1.0))
        counts.append(d.simulate(4.0, method="rodas5p").statistics["rejected"])
    assert counts[1] <= counts[0]


@pytest.mark.parametrize("eps", [1e-9, 1e-7, 1e-6])
def test_rows_do_not_depend_on_where_a_call_ends(eps: float) -> None:
    """A first step that a call cuts short says nothing of the one behind it."""
    points, short = SHAPES["jump"]
    system = driveline(points).assemble()
    whole = cw.simulate(system, 0.02, times=AFTER, atol=ATOL)
    column = int(np.argmin(np.abs(whole.rows[-1] - whole["a.speed"][-1])))
    run, late, none = begun(system, whole.options, None), AFTER[AT + eps < AFTER], np.empty((0, whole.rows.shape[1]))
    rows = np.empty((late.size, whole.rows.shape[1]))
    run.advance(AT + eps, none[:, 0], none, 0, 0)
    run.advance(0.02, late, rows, 0, 0)
    want = (BEFORE + JUMP - short(late - AT)) / DAMPING
    assert rows[:, column] == pytest.approx(want, abs=ATOL + 1e-6 * BEFORE / DAMPING, rel=0)

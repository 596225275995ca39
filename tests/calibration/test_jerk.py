"""The size of the jerk: what a jump of the acceleration counts, wherever it falls between the instants."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.calibration.terms import PER_WINDOW
from support.engagement import BOTH, GAIN, LINING, LOAD, PRESSURE, SPEED, discs

WINDOW = 0.1
LOCKED = SPEED * BOTH / (GAIN * LINING * PRESSURE)
# a jump of the acceleration of the load as it locks
JUMP = GAIN * LINING * PRESSURE / LOAD / WINDOW


@pytest.mark.parametrize("shift", np.linspace(0.0, 1.0, 9, endpoint=False) / PER_WINDOW)
def test_the_jump_of_a_lock_counts_wherever_it_falls(shift):
    first = LOCKED - 5.0 * WINDOW - shift * WINDOW
    found = cw.calibrate(
        discs(),
        5.0,
        free={"c1.gain": (3e-4, 9e-4)},
        minimise="c1.heat",
        subject_to=cw.limit(cw.jerk("load", WINDOW, (first, 3.0)), upper=1e5),
        iterations=1,
    )
    size = found.limits[0].before[1]
    assert size <= JUMP * (1.0 + 1e-6)
    # half a step over the window, docs/theory/calibration.md (3)
    assert size >= JUMP * (1.0 - 0.5 / PER_WINDOW - 1e-6)


def test_a_step_as_the_run_begins_does_not_count():
    found = cw.calibrate(
        discs(),
        5.0,
        free={"c1.gain": (3e-4, 9e-4)},
        minimise="c1.heat",
        subject_to=cw.limit(cw.jerk("load", WINDOW, (0.0, 1.0)), upper=1e5),
        iterations=1,
    )
    assert abs(found.limits[0].before[1]) < 1e-6 * JUMP

"""The size of the jerk: what a jump of the acceleration counts, wherever it falls between the instants."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.calibration.terms import OutputUnits
from clutchwork.sweeps.outputs import PER_WINDOW
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


def test_one_definition_in_sweeps_calibrations_and_shifts():
    """The lock-up makes the acceleration jump: everywhere that counts as its height over the window."""
    found = cw.sweep(discs(), 5.0, vary=[{}], outputs={"j": cw.jerk("load", WINDOW, (0.5, 4.0))})["j"].ravel()[0]
    limited = cw.calibrate(
        discs(),
        5.0,
        free={"c1.gain": (3e-4, 9e-4)},
        minimise="c1.heat",
        subject_to=cw.limit(cw.jerk("load", WINDOW, (0.5, 4.0)), upper=1e5),
        iterations=1,
    )
    assert float(found) == pytest.approx(limited.limits[0].before[1], rel=1e-6)
    step = 1e-3
    speed = discs().simulate(5.0, times=np.arange(0.0, 5.0, step))["load.speed"]
    felt = cw.shifts.jerk(speed, step, window=WINDOW)[round(0.6 / step) : round(3.9 / step)]
    assert np.max(np.abs(felt)) == pytest.approx(JUMP, rel=step / WINDOW)
    assert JUMP * (1.0 - 0.5 / PER_WINDOW) <= float(found) <= JUMP * (1.0 + 1e-6)
    # in a calibration and in a sweep at instants a sixteenth of a window apart, in shifts a millisecond
    assert float(found) <= np.max(np.abs(felt)) * (1.0 + step / WINDOW)


def test_a_run_that_is_too_short_has_none_in_a_sweep():
    with pytest.raises(cw.UseError, match=r"two windows of 0.1 s take 0.2 s, there are 0.1 s of the run"):
        cw.sweep(discs(), 0.1, vary=[{}], outputs={"j": cw.jerk("load", WINDOW)})


def test_units_of_jerks_are_those_of_sweeps():
    units = OutputUnits(discs().assemble())
    swept = cw.sweep(discs(), 0.1, vary=[{}], outputs=[cw.squared_jerk("load")])
    assert units.output(cw.squared_jerk("load")) == swept.units["squared_jerk(load)"] == "rad2/s5"
    assert units.output(cw.jerk("load")) == "rad/s3"
    assert units.output(cw.squared_jerk("lead")) == ""

"""Rows of a motion that follows a steep law closely: the slip that makes the torque is less than the tolerance of the
speeds, and still the torque is that of the equations of motion. docs/theory/events.md, rule 7"""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw

DRIVE, SWING, FREQUENCY, END = 1.0, 0.4, 0.8, 1.0


def held(**options: float) -> cw.Trajectory:
    """Two discs of 1 kg m2, whose speeds differ as prescribed, and a freewheel of a steep law that holds one of them
    through a planetary gear whose carrier turns half as fast as its ring."""
    d = cw.Driveline("held")
    ring, carrier, disc = d.shaft("ring"), d.shaft("carrier", inertia=1.0), d.shaft("disc", inertia=1.0)
    d.add(cw.Torque("drive", shaft=disc, torque=DRIVE))
    pull = cw.Sine(amplitude=SWING, frequency=FREQUENCY)
    d.add(cw.PrescribedAcceleration("pull", shaft=disc, base=carrier, acceleration=pull))
    law = cw.Tanh(kinetic=0.08, speed=0.05)
    d.add(cw.OneWayClutch("freewheel", base=d.housing, follower=ring, friction=law, pressure=2e5))
    d.add(cw.CompoundPlanetary("gear", sun=d.housing, ring=ring, carrier=carrier, ratio=1.0))
    return d.simulate(END, **options)


@pytest.mark.parametrize(("options", "allowed"), [({}, 5e-3), ({"rtol": 1e-9, "atol": 1e-11}, 1e-4)])
def test_torques_of_a_steep_law_balance_in_every_row(options: dict[str, float], allowed: float) -> None:
    """The freewheel lets the ring turn by a millionth of what the disc does: its torque is that of a held ring."""
    run = held(**options)
    pulled = SWING * np.sin(2 * np.pi * FREQUENCY * run.time)
    torque = np.abs(run["freewheel.torque"])
    # what settles behind the start is no part of it
    rows = run.time > 0.02
    # the slip changes by 1e-6 rad/s in 1 s; an order less than the acceleration of a disc that misses the torque
    assert np.abs(torque - 0.5 * (DRIVE - pulled))[rows].max() < allowed * DRIVE
    assert np.abs(run["carrier.acceleration"])[rows].max() < allowed


def test_the_source_of_a_prescribed_motion_beside_a_steep_law_does_the_work_of_the_motion() -> None:
    """What it pushes is what accelerates the disc, less what drives that, and its work that times the speed."""
    run = held()
    pulled = SWING * np.sin(2 * np.pi * FREQUENCY * run.time)
    rows = run.time > 0.02
    assert np.abs(np.abs(run["pull.torque"]) - np.abs(pulled - DRIVE))[rows].max() < 5e-3

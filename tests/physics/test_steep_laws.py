"""Rows of a motion that follows a steep law closely: the slip that makes the torque is less than the tolerance of the
speeds, and still the torque is that of the equations of motion. docs/theory/events.md, rule 7"""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw

DRIVE, SWING, FREQUENCY, END = 1.0, 0.4, 0.8, 1.0


def held_driveline() -> cw.Driveline:
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
    return d


def held(**options: float) -> cw.Trajectory:
    """A run of them."""
    return held_driveline().simulate(END, **options)


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
    """It pushes with what accelerates the disc, less what drives that, and its work is that times the difference."""
    run = held()
    pulled = SWING * np.sin(2 * np.pi * FREQUENCY * run.time)
    rows = run.time > 0.02
    assert np.abs(run["pull.torque"] - (pulled - DRIVE))[rows].max() < 5e-3
    difference = run["disc.speed"] - run["carrier.speed"]
    power = (pulled - DRIVE) * difference
    work = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(run.time) * (power[1:] + power[:-1]))])
    # what the sum of the rows misses
    assert np.abs(run["pull.work"] - work).max() < 1e-3 * np.abs(work).max()


def test_values_beside_derivatives_are_those_of_the_run() -> None:
    system, t = held_driveline(), 0.55
    wanted = {"torque": cw.at("freewheel.torque", t), "peak": cw.peak("freewheel.torque")}
    f = cw.differentiable(system, END, of=wanted, by="drive.torque")
    gradient = f.gradient()
    right = 0.5 * (DRIVE - SWING * np.sin(2 * np.pi * FREQUENCY * t))
    assert np.abs(gradient.values) == pytest.approx([right, 0.5 * (DRIVE + SWING)], rel=2e-3)
    assert np.abs(gradient.matrix[:, 0]) == pytest.approx(0.5, rel=1e-6)


def test_rows_of_laws_that_break_away_stay_where_the_motion_is() -> None:
    """Three discs through two clutches of steep laws and a brake: at one end of a step a law slips, at the other it
    holds, and what brings the rows of one onto the equations of motion throws the others off."""
    times = np.linspace(0.0, 0.6, 1801)

    def run(rtol: float) -> cw.Trajectory:
        d = cw.Driveline("stick-slip")
        a, b, c = (d.shaft(n, inertia=j) for n, j in (("a", 0.12869), ("b", 0.11658), ("c", 0.0023269)))
        drive = cw.Sine(amplitude=4.2539, frequency=2.046, offset=-10.664)
        d.add(cw.Torque("drive", shaft=a, torque=drive))
        for name, base, follower, speed, pressure in (
            ("c1", a, b, 1.5883e-4, 103537.15),
            ("c2", b, c, 4.6466e-3, 193590.895),
            ("brake", d.housing, c, 6.6478e-4, 73727.37),
        ):
            law = cw.Tanh(kinetic=0.1, speed=speed)
            d.add(cw.Clutch(name, base=base, follower=follower, friction=law, gain=1e-3, pressure=pressure))
        return d.simulate(0.6, times=times, rtol=rtol, atol=1e-2 * rtol)

    right = run(1e-10)
    # what the interpolant misses of 12 rad/s, and room
    for rtol, allowed in ((1e-4, 1e-2), (1e-6, 1e-4)):
        loose = run(rtol)
        for name in ("a.speed", "b.speed", "c.speed"):
            assert np.abs(loose[name] - right[name]).max() < allowed * np.abs(right[name]).max(), (rtol, name)


def test_rows_that_a_correction_would_throw_off_stay_as_they_are() -> None:
    """A chain of two clutches and a brake beside a varying ratio, whose laws turn within a step: what one step of
    Newton's method leaves of the equations of motion says so."""
    times = np.linspace(0.0, 0.6, 1801)

    def run(rtol: float) -> cw.Trajectory:
        d = cw.Driveline("chain")
        a, b = d.shaft("a", inertia=0.1572, speed=-8.328), d.shaft("b", inertia=0.002696, speed=0.0)
        c, turned = d.shaft("c", inertia=0.001179, speed=0.0), d.shaft("turned", inertia=0.02)
        d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=1.08, frequency=4.699, offset=-13.99)))
        rough = cw.RegularisedStribeck(static=0.13, kinetic=0.1, speed=1.0, width=6.474e-6)
        steep, brake = (cw.Tanh(kinetic=0.1, speed=speed) for speed in (1.537e-5, 1.214e-3))
        d.add(cw.Clutch("c1", base=a, follower=b, friction=rough, gain=1e-3, pressure=209600.0))
        d.add(cw.Clutch("c2", base=b, follower=c, friction=steep, gain=1e-3, pressure=82650.0))
        d.add(cw.Brake("brake", shaft=c, friction=brake, gain=1e-3, pressure=4907.0))
        ratio = cw.Sine(amplitude=0.3, frequency=2.0, offset=1.5)
        d.add(cw.VariableRatio("ratio", input=a, output=turned, ratio=ratio))
        d.add(cw.Damper("damper", base=d.housing, follower=turned, damping=0.1))
        return d.simulate(0.6, times=times, rtol=rtol, atol=1e-2 * rtol)

    right, loose = run(1e-10), run(1e-6)
    for name in ("a.speed", "b.speed", "c.speed"):
        # ten tolerances; the interpolant misses three
        assert np.abs(loose[name] - right[name]).max() < 1e-5 * np.abs(right[name]).max()


def test_accelerations_beside_a_gear_with_losses_are_those_of_the_motion() -> None:
    """A steep torque holds the pinion of a gear whose friction follows its load, which never passes zero."""
    size, frequency, steepness, inertia, pull = 4.0, 3.0, 120.0, 1e-5, 30.0
    d = cw.Driveline("creeps")
    pinion, wheel = d.shaft("pinion", inertia=inertia, speed=0.05), d.shaft("wheel", inertia=3e-3)
    d.add(cw.Torque("drive", shaft=pinion, torque=cw.Sine(amplitude=size, frequency=frequency, offset=9.0)))
    d.add(cw.Torque("load", shaft=wheel, torque=-pull))
    d.add(cw.SpeedTorque("steep", shaft=pinion, torque=[(-1.0, steepness), (1.0, -steepness)]))
    d.add(cw.LossyGear("gear", input=pinion, output=wheel, ratio=30.0, efficiency=0.9))
    run = d.simulate(0.8)
    omega = 2 * np.pi * frequency
    wanted = size * omega * np.cos(omega * run.time) / steepness
    # what settles behind the start is no part of it
    rows = run.time > 0.02
    missed = np.abs(run["pinion.acceleration"] - wanted)[rows]
    assert np.median(missed) < 1e-3 * np.abs(wanted).max()
    # rows of which a millionth of the torques is missed, 20 N m on 2e-5 kg m2, stay as they are
    assert missed.max() < 1.0

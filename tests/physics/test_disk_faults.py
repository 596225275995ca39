"""Faults and wear of a disc clutch against closed forms."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.run.failure import FaultWarning
from support.disk_clutches import GAIN, J1, J2, LINING, REDUCED, W0, clutch, discs
from support.runs import EXACT, TIGHT, assert_switches, at_end

feature = pytest.mark.feature


def faulty(**given: Any) -> Any:
    """A locked pair that is driven through the clutch, with a fault."""
    return discs(clutch(**{"pressure": 1e5, "report": "none", **given}))


@feature("faults: triggered at a time")
@feature("faults: cannot transmit power")
@feature("faults: stays for the rest of the run")
def test_a_clutch_that_fails_at_a_time_transmits_nothing_from_then_on() -> None:
    run = faulty(fault="cannot_transmit", fault_time=0.2).simulate(1.0, **TIGHT)
    rate = 0.3 * GAIN * 1e5 / REDUCED
    failed = next(e for e in run.events if e.cause == "fault")
    assert failed.time == 0.2
    assert at_end(run, "c1.slip") == pytest.approx(W0 - rate * 0.2, rel=1e-12)
    assert np.all(run["c1.torque"][run.time > 0.2] == 0.0)
    assert run["c1.state"][-1] == "open"


@feature("faults: triggered by a signal")
@feature("faults: stays for the rest of the run")
def test_a_clutch_that_fails_by_a_signal_stays_so_when_the_signal_is_gone() -> None:
    """The signal passes 0.5 at 0.25 s and is back below at 0.35 s."""
    signal = cw.Table([(0.0, 0.0), (0.2, 0.0), (0.3, 1.0), (0.4, 0.0), (2.0, 0.0)])
    run = faulty(fault="cannot_transmit", fault_signal=signal).simulate(1.0, **TIGHT)
    failed = next(e for e in run.events if e.cause == "fault")
    assert failed.time == pytest.approx(0.25, abs=EXACT)
    assert at_end(run, "c1.torque") == 0.0


@feature("faults: triggered at a time")
@feature("faults: triggered by a signal")
def test_time_and_signal_together_trigger_at_the_earlier_instant() -> None:
    for time, expected in ((0.1, 0.1), (0.4, 0.3)):
        signal = cw.Step(height=1.0, start=0.3)
        run = faulty(fault="cannot_transmit", fault_time=time, fault_signal=signal).simulate(0.5)
        assert [e.time for e in run.events if e.cause == "fault"] == [expected]


@feature("faults: cannot unlock")
@pytest.mark.parametrize("trigger", [{"fault_time": 0.2}, {"fault_signal": cw.Table([(0.0, 0.0), (0.4, 1.0)])}])
def test_a_clutch_that_cannot_unlock_slips_until_it_locks_for_good(trigger: dict[str, Any]) -> None:
    """It fails while it slips, locks as it would, and then holds with its pressure gone."""
    pressure = cw.Table([(0.0, 2e5), (1.0, 2e5), (1.0, 0.0), (2.0, 0.0)])
    d = faulty(fault="cannot_unlock", pressure=pressure, **trigger)
    d.add(cw.Torque("pull", shaft=d.nodes[1], torque=cw.Table([(0.0, 0.0), (1.2, 0.0), (1.3, 90.0), (2.0, 90.0)])))
    run = d.simulate(1.6, **TIGHT)
    assert_switches(run, [(REDUCED * W0 / (0.3 * GAIN * 2e5), "c1", "forward", "locked")])
    assert at_end(run, "c1.torque") == pytest.approx(-90.0 * J2 / (J1 + J2), rel=1e-9)


@feature("faults: cannot unlock")
def test_a_clutch_that_cannot_unlock_holds_any_torque_without_pressure() -> None:
    """Locked at the start; the pressure is gone at 0.5 s, and it still holds what would tear it apart."""
    d = discs(
        clutch(
            locked=True,
            pressure=cw.Table([(0.0, 1e5), (0.5, 1e5), (0.5, 0.0), (2.0, 0.0)]),
            fault="cannot_unlock",
            fault_time=0.1,
            report="none",
        ),
        speed=0.0,
    )
    d.add(cw.Torque("drive", shaft=d.nodes[0], torque=cw.Table([(0.0, 0.0), (1.0, 500.0), (2.0, 500.0)])))
    run = d.simulate(1.5, **TIGHT)
    assert set(run["c1.state"]) == {"locked"}
    assert at_end(run, "c1.torque") == pytest.approx(500.0 * J1 / (J1 + J2), rel=1e-9)


@feature("faults: off by default")
@feature("faults: reported as nothing, a warning or an error")
def test_faults_are_reported_as_asked() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not [e for e in discs(clutch()).simulate(0.5).events if e.cause == "fault"]
        quiet = faulty(fault="cannot_transmit", fault_time=0.2).simulate(0.5)
    assert quiet.status == "done"
    with pytest.warns(FaultWarning, match="c1.*0.2 s"):
        told = faulty(fault="cannot_transmit", fault_time=0.2, report="warning").simulate(0.5)
    assert told.status == "done"
    with pytest.warns(cw.StoppedEarly, match="'c1'") as caught:
        stopped = faulty(fault="cannot_transmit", fault_time=0.2, report="error").simulate(0.5)
    assert stopped.status == "fault"
    assert stopped.time[-1] == pytest.approx(0.2, abs=EXACT)
    assert "fault" in str(caught[0].message)


@feature("wear: a state that grows with the energy of sliding")
def test_wear_follows_the_energy_of_sliding() -> None:
    """depth = rate E/(area surfaces); off unless it is given."""
    rate = 1e-11
    ring = {"radius": None, "outer_diameter": 0.3, "inner_diameter": 0.2}
    run = discs(clutch(wear_rate=rate, **ring)).simulate(2.0, **TIGHT)
    expected = rate * 0.5 * REDUCED * W0**2 / (4 * 1e-3)
    assert at_end(run, "c1.wear.depth") == pytest.approx(expected, rel=1e-9)
    assert "c1.wear.depth" not in discs(clutch()).simulate(0.01).names


@feature("wear: changes the de-rating and the touch point")
def test_wear_lowers_the_derating_and_raises_the_touch_point() -> None:
    """A ring worn by many times its running-in depth has the capacity of uniform wear, less the shifted threshold."""
    from clutchwork.elements.bases.geometry import derating_when_worn, mean_radius

    d = cw.Driveline("worn")
    base, follower = d.shaft("base", inertia=J2), d.shaft("follower", inertia=J1, speed=W0)
    d.add(
        cw.DiskClutch(
            "c1",
            base=base,
            follower=follower,
            friction=LINING,
            outer_diameter=0.3,
            inner_diameter=0.2,
            area=1e-3,
            pressure=2e5,
            wear_rate=1e-9,
            running_in=1e-7,
            touch_shift=1e7,
        )
    )
    run = d.simulate(3.0, **TIGHT)
    depth = at_end(run, "c1.wear.depth")
    radius = mean_radius(0.3, 0.2) * derating_when_worn(0.3, 0.2)
    assert at_end(run, "c1.capacity") == pytest.approx(0.35 * 4 * radius * 1e-3 * (2e5 - 1e7 * depth), rel=1e-9)

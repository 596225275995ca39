"""Shifts of gearboxes with freewheels: they overrun and catch by themselves, and nobody sets them a pressure."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support.shift_car import survey
from support.transmissions import AODE

BOX = cw.Gearbox.from_dict(
    {
        **AODE,
        "name": "four speeds with a freewheel",
        "elements": {**AODE["elements"], "free": {"type": "freewheel", "members": ["housing", "C"]}},
        "gears": {**AODE["gears"], "1": ["forward", "free"], "1m": ["forward", "low"]},
    }
)
PAIRS = [("1", "2"), ("2", "1"), ("1", "1m"), ("1m", "1"), ("1m", "2"), ("2", "1m"), ("1", "3"), ("3", "1")]


@pytest.fixture(scope="module")
def found() -> cw.shifts.Survey:
    return survey(BOX, PAIRS)


def of(found: cw.shifts.Survey, before: str, after: str, power_on: bool) -> cw.shifts.Surveyed:
    (one,) = (
        one
        for one in found.results
        if (one.record.before, one.record.after, one.record.power_on) == (before, after, power_on)
    )
    return one


def test_every_shift_is_made(found: cw.shifts.Survey) -> None:
    for one in found.results:
        assert one.record.reached, one.record
        assert one.record.end is not None
        assert one.record.end - one.record.begin < 1.5
        # it never falls behind
        assert np.min(one.run["gearbox.free.slip"]) > -1e-9
        assert abs(one.run.energy.residual) < 1e-6 * one.run.energy.turnover


@pytest.mark.parametrize(("before", "after"), [("2", "1"), ("3", "1"), ("1m", "1")])
def test_it_catches_under_power(found: cw.shifts.Survey, before: str, after: str) -> None:
    run = of(found, before, after, power_on=True).run
    assert run["gearbox.free.state"][-1] == "locked"
    assert run["gearbox.in.speed"][-1] == pytest.approx(BOX.ratios["1"] * run["gearbox.ring.speed"][-1], rel=1e-9)
    assert cw.shifts.gears_of(run, BOX)[-1].gear == "1"


@pytest.mark.parametrize(("before", "after"), [("2", "1"), ("3", "1"), ("1m", "1")])
def test_it_overruns_without_power(found: cw.shifts.Survey, before: str, after: str) -> None:
    """The input falls to idle; no gear is in, though the elements of first gear are commanded."""
    run = of(found, before, after, power_on=False).run
    assert run["gearbox.free.slip"][-1] > 10.0
    assert run["gearbox.in.speed"][-1] < BOX.ratios["1"] * run["gearbox.ring.speed"][-1]
    assert cw.shifts.gears_of(run, BOX)[-1].gear != "1"


def test_an_upshift_takes_the_torque_from_it(found: cw.shifts.Survey) -> None:
    """No overlap can tie it up: it lets go by itself when the torque is gone."""
    one = of(found, "1", "2", power_on=True)
    assert one.quality is not None
    assert one.quality.tie_up == 0.0
    assert one.quality.flare == 0.0
    assert one.quality.shift.opens == ("free",)
    assert one.quality.shift.torque_time == pytest.approx(0.14, abs=0.03)
    torque = one.run["gearbox.free.torque"]
    assert np.min(torque) > -1e-6

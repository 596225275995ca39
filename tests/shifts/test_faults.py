"""Single faults of shift elements: classified by kinematics, simulated in a car, judged by rules."""

from __future__ import annotations

import sys
from copy import deepcopy
from math import isnan
from pathlib import Path

import pytest

import clutchwork as cw
from clutchwork.shifts import faults
from support.shift_car import car
from support.transmissions import AODE

EXAMPLE = Path(__file__).parents[2] / "examples" / "eight_speed"
EIGHT = cw.Gearbox.load("zf-8hp70")
NINE = cw.Gearbox.load("zf-9hp48")


def with_freewheel() -> cw.Gearbox:
    """First gear by a freewheel, beside a brake that holds it both ways."""
    data = deepcopy(AODE)
    data["elements"]["free"] = {"type": "freewheel", "members": ["housing", "C"]}
    data["gears"]["1"] = ["forward", "free"]
    return cw.Gearbox.from_dict(data)


def table(box: cw.Gearbox, *gears: str, throttle: float = 0.2) -> cw.shifts.FaultTable:
    """Faults of the car in some gears, with its turbine at 180 rad/s."""
    return cw.shifts.fault_table(
        lambda gear: car(box, gear, 180.0, throttle), box, vehicle="car", gears=gears, until=1.8, rtol=1e-6
    )


@pytest.mark.parametrize("name", ["zf-8hp70", "ford-10r80", "six-speed", "zf-9hp48", "toyota-a760e"])
def test_each_element_fails_once_in_each_gear(name: str) -> None:
    """Missing where it is closed, stuck where it is open; what that makes is what the box says of the combination."""
    box = cw.Gearbox.load(name)
    found = list(cw.shifts.single_faults(box))
    assert len(found) == len(box.ratios) * len(box.elements)
    for one in found:
        closed = set(box.closed_in(one.gear))
        assert (one.fault == "missing") == (one.element in closed)
        made = box.combination(sorted(closed ^ {one.element}))
        assert one.makes == made.kind
        assert one.ratio == (None if made.ratio is None else pytest.approx(float(made.ratio)))
        # one element less frees a motion, unless it transmits nothing
        if one.fault == "missing" and abs(box.state(one.gear).torques[one.element]) > 1e-9:
            assert one.ratio is None


def test_all_faults_of_some_gears() -> None:
    """Sixth gear is direct: everything turns as one, and a brake that is stuck works against it."""
    found = table(EIGHT, "6")
    assert {(one.fault.element, one.fault.fault, one.fault.makes) for one in found} == {
        ("A", "stuck closed", "tie-up"),
        ("B", "stuck closed", "tie-up"),
        ("C", "missing", "neutral"),
        ("D", "missing", "neutral"),
        ("E", "missing", "neutral"),
    }
    by = {(one.fault.element): one for one in found}
    assert {name: by[name].verdict for name in "CDE"} == dict.fromkeys("CDE", "drive lost")
    for name in "AB":
        # four elements hold it in no gear; it goes over to one that has the brake, if it can
        assert by[name].verdict in ("decelerates", "other gear")
        assert not by[name].ends_in or name in EIGHT.closed_in(by[name].ends_in)
        # what gives way burns, and the car is braked by it
        assert by[name].burns
        assert by[name].power > 1e4
        assert by[name].energy > 1e3
    assert len(found.of("drive lost")) == 3


def test_elements_without_pressure() -> None:
    """A dog clutch opens by its command; what no signal can do is listed and not run."""
    found = {(one.fault.element, one.fault.fault): one for one in table(NINE, "7")}
    assert found["A", "stuck closed"].verdict == "not simulated"
    assert isnan(found["A", "stuck closed"].deceleration)
    assert found["F", "missing"].verdict == "drive lost"
    assert found["F", "missing"].ends_in == ""
    free = {(one.fault.element, one.fault.fault): one for one in table(with_freewheel(), "1", "2")}
    assert free["free", "missing"].verdict == "not simulated"
    # in second gear the freewheel would have to overrun
    assert free["free", "stuck closed"].verdict == "decelerates"
    assert free["forward", "missing"].verdict == "drive lost"


def test_an_output_that_stands_is_locked_and_an_idle_element_is_not_missed() -> None:
    """The wheels slide while the car goes on; two elements alone hold fourth gear of the nine-speed."""
    sys.path.insert(0, str(EXAMPLE))
    import eight_speed_model as model

    def verdict(box: cw.Gearbox, gear: str, element: str) -> cw.shifts.FaultResult:
        speed = 150.0 / box.ratios[gear] / model.FINAL_DRIVE * model.RADIUS
        found = cw.shifts.fault_table(
            lambda gear: model.car(box, gear, speed, throttle=0.3), box, vehicle="car", gears=(gear,), rtol=1e-6
        )
        return next(one for one in found if one.fault.element == element)

    locked = verdict(EIGHT, "8", "B")
    assert (locked.verdict, locked.fault.fault) == ("locks the output", "stuck closed")
    # it slides to rest over a long way
    assert locked.speed > 15.0
    idle = verdict(cw.Gearbox.load("mb-9g-v1"), "4", "F")
    assert (idle.verdict, idle.fault.makes, idle.ends_in, idle.burns) == ("none", "gear", "4", "")


def test_tables_are_written(tmp_path: Path) -> None:
    found = table(NINE, "8")
    found.to_csv(tmp_path / "faults.csv")
    lines = (tmp_path / "faults.csv").read_text().splitlines()
    assert len(lines) == 1 + len(NINE.elements)
    assert lines[0].startswith("gear,element,fault,makes,verdict,deceleration m/s2")
    assert any("not simulated,-,-,-" in line for line in lines)
    assert "not simulated" in str(found)


@pytest.mark.parametrize(
    ("makes", "ends_in", "deceleration", "stops", "verdict"),
    [
        ("tie-up", "", 3.0, True, "locks the output"),
        ("tie-up", "", 3.0, False, "decelerates"),
        # it is braked, whatever gear is in at the end
        ("tie-up", "4", 3.0, False, "decelerates"),
        ("tie-up", "5", 0.5, False, "none"),
        ("gear", "5", 0.5, False, "none"),
        ("tie-up", "4", 0.5, False, "other gear"),
        ("neutral", "", 0.5, False, "drive lost"),
        ("input held", "", 0.5, False, "drive lost"),
        ("tie-up", "", 0.5, False, "slips"),
        ("gear", "", 0.5, False, "slips"),
    ],
)
def test_rules_of_the_verdict(makes: str, ends_in: str, deceleration: float, stops: bool, verdict: str) -> None:
    fault = cw.shifts.Fault("5", "A", "stuck closed", makes, None)
    assert faults._verdict(fault, ends_in, deceleration, 1.5, stops=stops) == verdict


def test_a_gear_that_the_box_does_not_have() -> None:
    with pytest.raises(cw.UseError, match="'11' is not a gear of zf-8hp70; choose from 1, 2"):
        list(cw.shifts.single_faults(cw.Gearbox.load("zf-8hp70"), ("11",)))


def test_one_signal_of_torque_needs_no_list() -> None:
    assert cw.shifts.Sensed(torque="turbine.torque").torque == ("turbine.torque",)

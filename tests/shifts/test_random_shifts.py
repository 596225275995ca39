"""Random gearboxes of the catalogue, inertias, capacities, pedals and calibrations: no gear is silently wrong."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import clutchwork as cw
from support.amount import amount
from support.shift_car import SENSED, car

# dual clutches have a controller of their own
BOXES = {
    name: box
    for name, box in cw.catalogue().items()
    if any(gear[0] == "R" for gear in box.gears) and "synchroniser" not in {one.kind for one in box.elements}
}
# s; every shift is over by then, whatever its calibration
UNTIL = 8.0


@st.composite
def drives(draw: st.DrawFn) -> tuple[cw.Gearbox, str, str, dict[str, float], cw.shifts.ShiftSettings, float, float]:
    """A box, two of its gears, its sizes, a calibration, the pedal, and the speed of the input."""
    box = BOXES[draw(st.sampled_from(sorted(BOXES)))]
    gears = [gear for gear, ratio in box.ratios.items() if ratio > 0.0]
    before = draw(st.sampled_from(gears))
    after = draw(st.sampled_from([gear for gear in gears if gear != before]))
    number = lambda low, high: st.floats(low, high, allow_nan=False)  # noqa: E731
    # elements may be too weak for what they carry
    sizes = {"inertia": draw(number(0.001, 0.06)), "torque": draw(number(60.0, 1000.0))}
    chosen = cw.shifts.ShiftSettings(
        fill_time=draw(number(0.0, 0.3)),
        torque_time=draw(number(0.0, 0.5)),
        inertia_time=draw(number(0.05, 1.0)),
        end_time=draw(number(0.0, 0.3)),
        margin=draw(number(0.7, 2.0)),
        reduction=draw(number(0.0, 1.0)),
        closed_loop=draw(st.booleans()),
        proportional=draw(number(0.0, 40.0)),
        integral=draw(number(0.0, 200.0)),
        longest=draw(number(0.3, 2.0)),
    )
    return box, before, after, sizes, chosen, draw(st.sampled_from([0.0, 0.1, 0.4, 1.0])), draw(number(90.0, 350.0))


@settings(max_examples=amount(25), deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)
@given(drives())
def test_the_gear_is_in_or_the_record_says_that_it_is_not(drive: tuple[object, ...]) -> None:
    box, before, after, sizes, chosen, pedal, speed = drive
    system = car(box, before, speed, **sizes).assemble()
    control = cw.shifts.ShiftController(box, cw.shifts.plant_of(system, box), settings=chosen, gear=before)
    sim = cw.Simulator(system, rtol=1e-6)
    cw.shifts.drive(sim, control, 0.3, sensed=SENSED, throttle=lambda _: pedal)
    control.request(after)
    run = cw.shifts.drive(sim, control, UNTIL, sensed=SENSED, throttle=lambda _: pedal)
    record, *back = control.records
    assert record.end is not None
    # one that did not get there goes back, and that is a shift of its own
    assert not back or (record.problem.startswith("the input did not come") and back[0].after == before)
    assert np.all(np.isfinite(run.rows))
    assert abs(run.energy.residual) < 1e-5 * run.energy.turnover
    # what is in at the end of the shift
    at = np.array([record.end])
    part = run.at(at)
    friction = [name for name in box.closed_in(after) if box.element(name).kind in ("clutch", "brake")]
    slips = {name: abs(float(part[f"gearbox.{name}.slip"][0])) for name in friction}
    dogs = [name for name in box.closed_in(after) if box.element(name).kind == "dog"]
    slips |= {name: 1e9 for name in dogs if part[f"gearbox.{name}.sleeve"][0] < 0.5}
    assert record.reached or record.problem
    if record.reached:
        assert max(slips.values()) <= chosen.sync_slip, (record, slips)
        turning = part[f"gearbox.{box.input}.speed"][0]
        wanted = box.ratios[after] * part[f"gearbox.{box.output}.speed"][0]
        assert turning == pytest.approx(wanted, abs=40.0 * chosen.sync_slip)

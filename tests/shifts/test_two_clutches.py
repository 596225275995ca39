"""Phases and measures of shifts whose motion is known: two inertias, two gear pairs, two clutches, closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support.amount import amount
from support.two_clutches import BEGIN, BOX, FULL, I1, I2, J1, J2, LOAD, PER_PASCAL, RAMP, W0, C, T, quality, ramp, run


@pytest.fixture(scope="module")
def upshift() -> cw.Trajectory:
    """Power-on upshift of which everything is known."""
    opened = BEGIN + RAMP
    return run(*ramp("C2", BEGIN, opened, C / PER_PASCAL), (opened, {"C1": 0.0}), (1.6, {"C2": FULL}), heated=True)


def drop() -> float:
    """How much slower the output is after the torque phase: its impulse over the inertia in first gear."""
    return (I1 / I2 - 1.0) * C * RAMP / 2.0 / (J2 + I1**2 * J1)


def synchronous() -> tuple[float, float]:
    """Duration of the inertia phase [s], and the slip of the second clutch at its beginning [rad/s]."""
    slip = (I1 / I2 - 1.0) * (W0 - drop())
    rate = (T - C / I2) / J1 / I2 - (C - LOAD) / J2
    return slip / -rate, slip


def test_phases(upshift: cw.Trajectory) -> None:
    (shift,) = cw.shifts.shifts_of(upshift, BOX)
    assert (shift.before, shift.after, shift.opens, shift.closes) == ("1", "2", ("C1",), ("C2",))
    # a torque below 2 % of its largest counts as none: the ramp is there after 2 % of its time
    assert shift.begin == pytest.approx(BEGIN, abs=0.03 * RAMP)
    assert shift.torque_phase == (shift.begin, pytest.approx(BEGIN + RAMP, abs=1e-9))
    assert shift.inertia_phase[0] == pytest.approx(BEGIN + RAMP, abs=1e-9)
    assert shift.inertia_time == pytest.approx(synchronous()[0], rel=1e-5)
    assert shift.end == shift.inertia_phase[1]
    assert shift.time == pytest.approx(shift.torque_time + shift.inertia_time)


def test_torque_hole(upshift: cw.Trajectory) -> None:
    """What is left of the torque at the output at the end of the torque phase, below first and second gear."""
    one = quality(upshift)
    slower = (I1 / I2 - 1.0) * C / (J2 + I1**2 * J1)
    least = LOAD - J2 * slower
    second = (I2 * T * J2 + LOAD * I2**2 * J1) / (J2 + I2**2 * J1)
    # while the speeds change the second clutch alone drives
    assert least < min(C, second) < LOAD
    # it is looked at every millisecond, in which it falls by this much
    step = (LOAD - least) * 1e-3 / RAMP
    assert one.torque_hole == pytest.approx(second - least, abs=step)
    assert one.hole_share == pytest.approx((second - least) / LOAD, abs=step / LOAD)


def test_slip_energy_and_temperature(upshift: cw.Trajectory) -> None:
    """Work of the slip: that of the ramp, with speeds that change a little, and that of the inertia phase."""
    one = quality(upshift)
    time, slip = synchronous()
    x = np.linspace(0.0, 1.0, 20001)
    speed = W0 - drop() * x**2
    ramped = float(np.trapezoid(C * x * (I1 / I2 - 1.0) * speed, x)) * RAMP
    # in the first 2 % of the ramp there is next to nothing
    assert one.slip_energy["C2"] == pytest.approx(ramped + C * slip * time / 2.0, rel=1e-3)
    assert one.slip_energy["C1"] == 0.0
    assert one.slip_power["C2"] == pytest.approx(C * slip, rel=2e-3)
    heat = upshift["gearbox.C2.heat"]
    assert one.slip_energy["C2"] == pytest.approx(heat[-1] - heat[0], rel=2e-3)
    assert one.temperature["C2"] == pytest.approx(350.0 + (heat[-1] - heat[0]) / 50.0, abs=1e-6)
    assert "C1" not in one.temperature


def test_no_flare_no_sag_no_tie_up(upshift: cw.Trajectory) -> None:
    one = quality(upshift)
    assert (one.flare, one.sag) == (0.0, 0.0)
    # the clutch that opens was unloaded beyond zero by what the input gives up as it slows down
    left = I1 * (T + J1 * I1 * (I1 / I2 - 1.0) * C / (J2 + I1**2 * J1) - C / I2)
    assert one.tie_up == pytest.approx(max(0.0, -left), abs=2.0)


@pytest.mark.parametrize("gap", [0.02, 0.05, 0.1])
def test_flare_where_the_first_clutch_opens_too_early(gap: float) -> None:
    """Free for a time, the input runs above first gear; the output slows down under its load."""
    found = run((0.6, {"C1": 0.0}), (0.6 + gap, {"C2": C / PER_PASCAL}), (1.8, {"C2": FULL}))
    one = quality(found)
    assert one.flare == pytest.approx((T / J1 + I1 * LOAD / J2) * gap, rel=1e-3 / gap)
    assert one.tie_up == 0.0
    assert one.shift.torque_time == 0.0


@pytest.mark.parametrize("gap", [0.02, 0.05, 0.1])
def test_sag_where_the_input_drags(gap: float) -> None:
    """Without power the input falls below second gear on its way to first gear."""
    points = [(0.6, {"C2": 0.0}), (0.6 + gap, {"C1": 2.0 * C / PER_PASCAL}), (2.0, {"C1": FULL})]
    one = quality(run(*points, gear="2", torque=-T, load=-I2 * T))
    assert (one.shift.before, one.shift.after) == ("2", "1")
    # the output speeds up without the drag
    assert one.sag == pytest.approx((T / J1 + I2 * I2 * T / J2) * gap, rel=1e-3 / gap)
    assert one.flare == 0.0


@pytest.mark.parametrize("overlap", [1.5, 2.0])
def test_tie_up_where_the_second_clutch_carries_too_much(overlap: float) -> None:
    """The first clutch, still closed, works against the second one."""
    capacity = overlap * C
    points = [*ramp("C2", 0.6, 0.8, capacity / PER_PASCAL), (0.8, {"C1": 0.0}), (1.4, {"C2": FULL})]
    one = quality(run(*points))
    slower = (I1 / I2 - 1.0) * capacity / (J2 + I1**2 * J1)
    against = -I1 * (T + J1 * I1 * slower - capacity / I2)
    assert against > 100.0
    assert one.tie_up == pytest.approx(against, rel=0.02)


@pytest.mark.random
def test_tie_up_on_both_sides_of_a_short_inertia_phase() -> None:
    """The first clutch is held on after the second one has locked: it slips backward with all that it can."""
    for seed in range(amount(12)):
        rng = np.random.default_rng([3131, seed])
        before, behind = rng.uniform(0.03, 0.3, 2)
        first, second = float(rng.uniform(20.0, 150.0)), float(rng.uniform(400.0, 800.0))
        points = [
            (0.6, {"C2": first / PER_PASCAL}),
            (0.6 + before, {"C1": second / PER_PASCAL, "C2": 4.0 * second / PER_PASCAL}),
            (0.6 + before + behind, {"C1": 0.0}),
        ]
        one = quality(run(*points))
        assert one.tie_up == pytest.approx(second, rel=1e-6), seed
        # docs/theory/shifts.md (8): below 2 % of its largest torque an element carries none
        begin = 0.6 if first > 0.02 * 4.0 * second else 0.6 + before
        assert one.shift.begin == pytest.approx(begin, abs=1e-9), seed
        assert one.shift.end == pytest.approx(0.6 + before + behind, abs=1e-9), seed


def test_neutral_and_a_gear_from_it() -> None:
    """Where nothing carries torque the box is in neutral; the shift out of it begins with the torque."""
    points = [(0.5, {"C1": 0.0}), (1.5, {"C2": C / PER_PASCAL}), (2.6, {"C2": FULL})]
    # little drives and loads, so that speeds stay
    found = run(*points, until=3.6, torque=5.0, load=10.0)
    gears = cw.shifts.gears_of(found, BOX)
    assert [one.gear for one in gears] == ["1", "2"]
    (shift,) = cw.shifts.shifts_of(found, BOX)
    assert shift.inertia_phase[0] == pytest.approx(0.5, abs=1e-9)
    # a gear that is held for less than 0.3 s is passed through
    points = [(0.5, {"C1": 0.0, "C2": FULL}), (0.9, {"C2": 0.0, "C1": FULL}), (1.1, {"C1": 0.0, "C2": FULL})]
    gears = cw.shifts.gears_of(run(*points, torque=5.0, load=10.0), BOX)
    assert [one.gear for one in gears][-1] == "2"
    assert all(one.end - one.begin > 0.3 for one in gears[1:-1])

"""Diagnosis: causes that were put into a shift are found at their instant, and what is said to cure it does."""

from __future__ import annotations

import pytest

import clutchwork as cw
from support.shift_car import SENSED, car, hydraulic, survey
from support.two_clutches import BEGIN, BOX, PER_PASCAL, RAMP, SHAFT, C, ramp, run

EIGHT = cw.Gearbox.load("zf-8hp70")


def findings(found: cw.Trajectory) -> tuple[cw.shifts.Finding, ...]:
    (one,) = cw.shifts.qualities(found, BOX, torque=SHAFT)
    return cw.shifts.diagnose(found, BOX, one, torque=SHAFT)


def test_a_smooth_shift_has_none_of_them() -> None:
    opened = BEGIN + RAMP
    # as much as the gear before carried, and less than would unload the first clutch beyond zero
    made = run(*ramp("C2", BEGIN, opened, 0.88 * C / PER_PASCAL), (opened, {"C1": 0.0}), (1.6, {"C2": 1e6}))
    causes = " ".join(one.cause for one in findings(made))
    assert "ran" not in causes
    assert "tie-up" not in causes


@pytest.mark.parametrize("gap", [0.05, 0.1])
def test_a_flare_is_found_where_it_is_largest(gap: float) -> None:
    """Free from 0.6 s on, the input runs until the second clutch grips."""
    made = run((0.6, {"C1": 0.0}), (0.6 + gap, {"C2": C / PER_PASCAL}), (1.8, {"C2": 1e6}))
    (flare,) = [one for one in findings(made) if "above both gears" in one.cause]
    assert flare.time == pytest.approx(0.6 + gap, abs=5e-3)
    assert "C2 carried too little, too late" in flare.cause
    assert flare.cure.startswith("fill_time up")


def test_a_tie_up_is_found_with_its_torque() -> None:
    capacity = 2.0 * C
    made = run(*ramp("C2", 0.6, 0.8, capacity / PER_PASCAL), (0.8, {"C1": 0.0}), (1.4, {"C2": 1e6}))
    (one,) = cw.shifts.qualities(made, BOX, torque=SHAFT)
    (tied,) = [one for one in findings(made) if "tie-up" in one.cause]
    assert f"C1 held {one.tie_up:.0f} N m against C2" in tied.cause
    assert tied.time == pytest.approx(0.8, abs=5e-3)


def test_what_is_said_to_cure_a_step_at_lock_up_does() -> None:
    """A quick downshift locks with a step; with a longer inertia phase it is smaller."""
    sizes = {}
    for time in (0.2, 0.6):
        # the engine does not help
        settings = cw.shifts.ShiftSettings(inertia_time=time, pull=1e3)
        (one,) = survey(EIGHT, [("3", "2")], throttles=(0.0,), settings=settings).results
        steps = [one for one in one.record.diagnosis if "locked with a step" in one.cause]
        sizes[time] = float(steps[0].cause.split("step of ")[1].split()[0]) if steps else 0.0
        assert one.quality is not None
        if steps:
            assert "inertia_time up" in steps[0].cure
            assert steps[0].time == pytest.approx(one.quality.shift.inertia_phase[1])
    assert sizes[0.2] > 300.0
    assert sizes[0.6] < 0.6 * sizes[0.2]


@pytest.mark.parametrize(("wrong", "words", "cure"), [(0.6, "ms late", "up"), (1.3, "gripped with a jolt", "down")])
def test_a_controller_says_what_it_saw_of_a_filling(wrong: float, words: str, cure: str) -> None:
    system = hydraulic(EIGHT, "3").assemble()
    plant = cw.shifts.plant_of(system, EIGHT)
    known = {name: wrong * one.fill_time for name, one in plant.actuators.items()}
    control = cw.shifts.ShiftController(EIGHT, plant, gear="3", known=known)
    sim = cw.Simulator(system, rtol=1e-6)
    cw.shifts.drive(sim, control, 0.5, sensed=SENSED, throttle=lambda _: 0.3)
    control.request("4")
    cw.shifts.drive(sim, control, 2.5, sensed=SENSED, throttle=lambda _: 0.3)
    (record,) = control.records
    (found,) = [one for one in record.diagnosis if words in one.cause]
    assert found.cure.endswith(cure)
    assert record.end is not None
    assert record.begin < found.time < record.end
    # its controller learns the same
    learnt = control.learnt["D"].fill_time / known["D"]
    assert learnt > 1.0 if cure == "up" else learnt < 1.0


def test_a_lock_up_clutch_that_lets_go_is_named() -> None:
    """In the middle of the shift it loses its pressure."""
    d = car(EIGHT, "3", 200.0)
    engine, turbine = (next(node for node in d.nodes if node.name == name) for name in ("engine", "turbine"))
    lining = cw.Coulomb(static=0.13, kinetic=0.12)
    d.add(cw.Clutch("lock_up", base=engine, follower=turbine, friction=lining, gain=6e-3, pressure=2e5, locked=True))
    sensed = cw.shifts.Sensed(torque=("converter.turbine.torque", "lock_up.torque"), throttle="combustion.throttle")
    system = d.assemble()
    control = cw.shifts.ShiftController(EIGHT, cw.shifts.plant_of(system, EIGHT), gear="3")
    sim = cw.Simulator(system, rtol=1e-6)
    cw.shifts.drive(sim, control, 0.6, sensed=sensed, throttle=lambda _: 0.3)
    control.request("4")
    cw.shifts.drive(sim, control, 0.9, sensed=sensed, throttle=lambda _: 0.3)
    sim.set("lock_up.pressure", 0.0)
    made = cw.shifts.drive(sim, control, 2.4, sensed=sensed, throttle=lambda _: 0.3)
    (one,) = cw.shifts.qualities(made, EIGHT)
    (named,) = [found for found in cw.shifts.diagnose(made, EIGHT, one) if "lock_up let go" in found.cause]
    assert named.time == pytest.approx(0.9, abs=2e-3)

"""Signals that measures of shifts are given: units are looked at, and printed. The only gearbox needs no name."""

from __future__ import annotations

import pytest

import clutchwork as cw

BOX = cw.Gearbox.load("zf-8hp70")
GIVEN = {"torque": "housing.torque", "acceleration": "wheels.acceleration"}


def model(*names: str) -> cw.Driveline:
    """Third to fourth gear of a gearbox with a name, others beside it."""
    d = cw.Driveline("third to fourth")
    turbine, wheels = d.shaft("turbine", inertia=0.2, speed="2400 rpm"), d.shaft("wheels", inertia=30.0)
    opens = cw.Ramp(height=-1e6, duration=0.07, start=0.5, offset=1e6)
    closes = cw.Ramp(height=5e5, duration=0.4, start=0.5)
    shift = {"C": {"pressure": opens}, "D": {"pressure": closes}}
    d.add(cw.Transmission(names[0], input=turbine, output=wheels, gearbox="zf-8hp70", gear="3", shift=shift))
    for name in names[1:]:
        ends = {"input": d.shaft(f"{name}_in", inertia=0.2), "output": d.shaft(f"{name}_out", inertia=3.0)}
        d.add(cw.Transmission(name, gearbox="zf-8hp70", gear="3", **ends))
    d.add(cw.Torque("engine", shaft=turbine, torque=200.0))
    return d


@pytest.fixture(scope="module")
def run() -> cw.Trajectory:
    return model("box").simulate(1.5)


WRONG = {
    "speed for torque": (
        {"torque": "turbine.speed"},
        "torque='turbine.speed' is in [rad/s]; give a signal in [N m] or",
    ),
    "word": ({"torque": "box.D.state"}, "torque='box.D.state' is a word and has no unit"),
    "speed": (
        {"acceleration": "wheels.speed"},
        "acceleration='wheels.speed' is in [rad/s]; give a signal in [m/s2] or [rad/s2]: turbine.acceleration, ",
    ),
    "torque": ({"acceleration": "engine.torque"}, "acceleration='engine.torque' is in [N m]"),
    "heat": ({"torque": "box.D.heat"}, "torque='box.D.heat' is in [J]"),
    "number": ({"torque": 5}, "torque is 5: give the name of a signal, such as 'half_shafts.torque'"),
}


@pytest.mark.parametrize("name", WRONG)
def test_signals_in_other_units_are_refused(run: cw.Trajectory, name: str) -> None:
    given, said = WRONG[name]
    (one,) = cw.shifts.qualities(run, BOX)
    for call in (cw.shifts.qualities, lambda *args, **more: cw.shifts.diagnose(*args, one, **more)):
        with pytest.raises(cw.UseError) as caught:
            call(run, BOX, **{**GIVEN, **given})  # type: ignore[operator]
        assert said in str(caught.value)


def test_both_mistakes_are_named_and_names_that_are_not_there(run: cw.Trajectory) -> None:
    with pytest.raises(cw.UseError, match=r"^cw.shifts.qualities: 2 problems"):
        cw.shifts.qualities(run, BOX, torque="turbine.speed", acceleration="wheels.speed")
    with pytest.raises(KeyError, match=r"did you mean 'wheels.acceleration'"):
        cw.shifts.qualities(run, BOX, acceleration="wheels.accel")
    with pytest.raises(cw.UseError, match=r"box is 'zf-8hp70': give a cw.Gearbox"):
        cw.shifts.qualities(run, "zf-8hp70")  # type: ignore[arg-type]


def test_the_unit_of_a_jerk_is_that_of_its_signal(run: cw.Trajectory) -> None:
    (shaft,) = cw.shifts.qualities(run, BOX, **GIVEN)
    assert (shaft.jerk_unit, shaft.dose_unit, shaft.torque_unit) == ("rad/s3", "rad/s1.75", "N m")
    head = cw.shifts.table([shaft]).splitlines()[0]
    assert "peak jerk rad/s3  rms jerk rad/s3  dose rad/s1.75  torque hole N m" in head
    (plain,) = cw.shifts.qualities(run, BOX)
    assert "peak jerk m/s3  rms jerk m/s3  dose m/s1.75  torque hole N m" in cw.shifts.table([plain])
    assert "peak jerk m/s3 or rad/s3" in cw.shifts.table([plain, shaft])


def test_the_only_gearbox_needs_no_prefix(run: cw.Trajectory) -> None:
    assert cw.shifts.gears_of(run, BOX) == cw.shifts.gears_of(run, BOX, "box")
    assert cw.shifts.shifts_of(run, BOX) == cw.shifts.shifts_of(run, BOX, "box")
    (one,), (named,) = cw.shifts.qualities(run, BOX, **GIVEN), cw.shifts.qualities(run, BOX, "box", **GIVEN)
    assert str(one) == str(named)
    assert cw.shifts.diagnose(run, BOX, one, **GIVEN) == cw.shifts.diagnose(run, BOX, one, "box", **GIVEN)


def test_a_prefix_that_names_no_gearbox_is_told_by_its_keyword(run: cw.Trajectory) -> None:
    with pytest.raises(KeyError, match=r"no gearbox 'gearbox'; did you mean 'box'\? .*; give prefix='box'"):
        cw.shifts.qualities(run, BOX, "gearbox")
    two = model("front", "rear").simulate(0.1)
    with pytest.raises(KeyError, match="no gearbox is named; gearboxes are front, rear; give one as prefix="):
        cw.shifts.qualities(two, BOX)
    with pytest.raises(cw.UseError, match=r"'gearbox' is not a Transmission of .*give prefix='box'"):
        cw.shifts.plant_of(model("box"), BOX)
    control = cw.shifts.ShiftController(BOX, cw.shifts.plant_of(model("box"), BOX, "box"), gear="3")
    with pytest.raises(cw.UseError, match=r"drive: 1 problem\n.*'gearbox' is not a Transmission .*give prefix='box'"):
        cw.shifts.drive(cw.Simulator(model("box")), control, 0.1, throttle=0.3)


def test_a_tie_up_has_the_rows_of_the_run_and_its_events(run: cw.Trajectory) -> None:
    (one,) = cw.shifts.qualities(run, BOX)
    inside = (run.time >= one.shift.begin) & (run.time <= one.shift.end)
    before = run["box.C.torque"][run.time < one.shift.begin][-1]
    against = -run["box.C.torque"][inside] if before > 0.0 else run["box.C.torque"][inside]
    # 0.17 N m at steps of 1 ms
    assert 0.5 < against.max() <= one.tie_up < 0.6
    # a run whose rows are far apart has the events
    (coarse,) = cw.shifts.qualities(model("box").simulate(1.5, dt=0.1), BOX)
    assert coarse.tie_up == pytest.approx(one.tie_up, rel=1e-3)

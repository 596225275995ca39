"""What a trajectory gives: signals, units, balances, other instants, files."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.layout import NOT_FINITE
from clutchwork.results.ratios import phases
from clutchwork.run import simulation


def two_discs(**changes: Any) -> cw.Driveline:
    """0.2 and 0.8 kg m2, 100 and 0 rad/s, 10 N m: lock at 1.6 s and 20 rad/s, 800 J of heat."""
    d = cw.Driveline("two discs")
    engine = d.shaft("engine", inertia=0.2, speed=100.0)
    load = d.shaft("load", inertia=0.8)
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=law, gain=1.0, **{"normal_force": 100.0, **changes}))
    return d


@pytest.fixture(scope="module")
def run() -> cw.Trajectory:
    return two_discs().simulate(2.0, rtol=1e-9, atol=1e-12)


def test_speeds_torque_and_heat(run: cw.Trajectory) -> None:
    assert run.finished
    assert run["engine.speed"][-1] == pytest.approx(20.0, rel=1e-9)
    assert run["c1.heat"][-1] == pytest.approx(800.0, rel=1e-8)
    slipping = run.time < 1.6 - 1e-6
    assert run["c1.torque"][slipping] == pytest.approx(10.0)
    assert run["c1.slip"][slipping] == pytest.approx(-100.0 + 62.5 * run.time[slipping], abs=1e-6)


def test_a_locked_contact_has_no_slip_at_all(run: cw.Trajectory) -> None:
    locked = run["c1.state"] == "locked"
    assert np.all(run["c1.slip"][locked] == 0.0)
    assert np.array_equal(locked, run["c1.mode"] == 0)
    assert set(run["c1.state"]) == {"backward", "locked"}


def test_both_limits_stand_at_an_event(run: cw.Trajectory) -> None:
    event = run.events.changes()[0]
    at = np.flatnonzero(run.time == event.time)
    assert len(at) == 2
    assert list(run["c1.state"][at]) == ["backward", "locked"]
    assert run["c1.torque"][at] == pytest.approx([10.0, 0.0], abs=1e-9)


def test_units(run: cw.Trajectory) -> None:
    assert run.units["engine.speed"] == "rad/s"
    assert run.units["c1.torque"] == "N m"
    assert run.units["c1.heat"] == "J"
    assert run.units["c1.power"] == "W"
    assert set(run.units) == set(run.names)


def test_every_signal_has_one_value_per_instant(run: cw.Trajectory) -> None:
    assert all(run[name].shape == run.time.shape for name in run.names)


def test_a_misspelt_name_is_answered_with_near_ones(run: cw.Trajectory) -> None:
    with pytest.raises(KeyError, match=r"no signal 'engine.sped'.*did you mean 'engine.speed'"):
        run["engine.sped"]
    with pytest.raises(KeyError, match=r"load.heat"):
        run.to_pandas(["engine.speed", "load.heat"])


def test_signals_that_were_not_integrated_say_how_to_get_them() -> None:
    bare = two_discs().simulate(1.0, work=False, angles=False)
    with pytest.raises(KeyError, match=r"c1.heat was not computed: run with work=True"):
        bare["c1.heat"]
    with pytest.raises(KeyError, match=r"engine.angle was not computed: run with angles=True"):
        bare["engine.angle"]
    with pytest.raises(ValueError, match="run with work=True"):
        _ = bare.energy


def test_energy_balance(run: cw.Trajectory) -> None:
    energy = run.energy
    assert energy.kinetic == pytest.approx(0.5 * 1.0 * 20.0**2 - 0.5 * 0.2 * 100.0**2)
    assert energy.heat["c1"] == pytest.approx(800.0, rel=1e-8)
    assert energy.input == 0.0
    assert abs(energy.residual) <= 1e-8 * energy.turnover
    assert "residual" in str(energy)


def test_the_same_run_at_other_instants_is_exact(run: cw.Trajectory) -> None:
    # no interpolation: same bits where the instants are the same
    again = run.at(run.time)
    assert np.array_equal(again.rows, run.rows)
    assert run.at([0.8, 0.4])["engine.speed"] == pytest.approx([80.0, 60.0], rel=1e-9)
    assert run.at(0.4).time == pytest.approx([0.4])


def test_output_grids() -> None:
    d = two_discs()
    assert d.simulate(2.0, dt=0.5).time == pytest.approx([0.0, 0.5, 1.0, 1.5, 2.0])
    assert d.simulate(2.0, times=[0.25, 1.75]).time == pytest.approx([0.25, 1.75])
    steps, smooth = d.simulate(2.0, output="steps"), d.simulate(2.0)
    assert len(steps) < 100 < 1000 < len(smooth)
    assert np.all(np.isin(steps.time, smooth.time))
    assert np.max(np.diff(smooth.time)) <= 2.0 / 1000 + 1e-12


def test_the_right_limit_is_that_of_the_last_decision_at_an_instant(root: Path) -> None:
    """The launch of the six-speed gearbox locks F1, and at once something else is decided again."""
    launch = cw.Driveline.load(root / "examples/six_speed/model.toml")
    smooth = launch.simulate()
    locked = max(event.time for event in smooth.events)
    assert list(smooth.time).count(locked) == 2
    states = launch.simulate(times=[locked, locked, np.nextafter(locked, 4.0)])["F1.state"]
    assert list(states) == ["forward", "locked", "locked"]


def test_a_jump_of_a_signal_shows_both_limits() -> None:
    d = cw.Driveline()
    shaft = d.shaft("a", inertia=1.0)
    d.add(cw.Torque("drive", shaft=shaft, torque=cw.Step(height=3.0, start=0.5)))
    run = d.simulate(1.0)
    at = np.flatnonzero(run.time == 0.5)
    assert run["drive.torque"][at] == pytest.approx([0.0, 3.0])


def test_a_load_and_its_signal_have_two_names() -> None:
    d = cw.Driveline()
    shaft = d.shaft("a", inertia=1.0, speed=50.0)
    d.add(cw.ResistingTorque("load", shaft=shaft, torque=3.0, speed=0.1))
    run = d.simulate(0.1)
    assert run["load.torque"] == pytest.approx(-3.0)
    assert run["load.torque_signal"] == pytest.approx(3.0)


def test_gears_and_housing_take_their_torques() -> None:
    # sun driven with 10 N m, ring braked: the carrier turns (1 + k) times slower, the ring takes k times the torque
    d = cw.Driveline()
    sun, carrier = d.shaft("sun", inertia=0.1), d.shaft("carrier", inertia=2.0)
    d.add(cw.Planetary("set", sun=sun, ring=d.housing, carrier=carrier, ratio=3.0))
    d.add(cw.Torque("drive", shaft=sun, torque=10.0))
    run = d.simulate(1.0)
    acceleration = 10.0 / (0.1 + 2.0 / 16.0)
    assert run["sun.acceleration"] == pytest.approx(acceleration)
    on_sun = 0.1 * acceleration - 10.0
    assert run["set.torque_sun"] == pytest.approx(on_sun)
    assert run["set.torque_ring"] == pytest.approx(3.0 * on_sun)
    assert run["set.torque_carrier"] == pytest.approx(-4.0 * on_sun)
    # the housing takes the ring and the reaction of the drive
    assert run["housing.torque"] == pytest.approx(3.0 * on_sun - 10.0)


def test_redundant_gear_rows_share_their_torque() -> None:
    d = cw.Driveline()
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    for name in ("g1", "g2"):
        d.add(cw.Gear(name, input=a, output=b, ratio=1.0))
    d.add(cw.Torque("drive", shaft=a, torque=4.0))
    run = d.simulate(0.1)
    assert run["g1.torque_output"] == pytest.approx(1.0)
    assert run["g2.torque_output"] == pytest.approx(1.0)


def test_a_prescribed_speed_tells_its_torque() -> None:
    d = cw.Driveline()
    a = d.shaft("a", inertia=2.0)
    d.add(cw.PrescribedSpeed("bench", shaft=a, speed=cw.Ramp(height=30.0, duration=3.0)))
    run = d.simulate(2.0)
    assert run["bench.torque"][-1] == pytest.approx(20.0)
    assert run["bench.power"][-1] == pytest.approx(400.0)
    assert run["bench.work"][-1] == pytest.approx(400.0)
    assert abs(run.energy.residual) <= 1e-9 * run.energy.turnover


def test_masses_speak_of_positions_and_forces() -> None:
    d = cw.Driveline()
    block = d.mass("block", mass=2.0, speed=3.0)
    d.add(cw.Brake("floor", shaft=block, friction=cw.Coulomb(static=0.5, kinetic=0.5), gain=1.0, normal_force=4.0))
    run = d.simulate(1.0)
    assert run.units["block.position"] == "m"
    assert run.units["floor.torque"] == "N"
    assert run["floor.torque"] == pytest.approx(-2.0)
    assert run["block.position"][-1] == pytest.approx(2.5)
    assert run["housing.force"] == pytest.approx(2.0)


def test_csv(run: cw.Trajectory, tmp_path: Path) -> None:
    run.to_csv(tmp_path / "out.csv", ["engine.speed", "c1.state"])
    lines = list(csv.reader((tmp_path / "out.csv").read_text().splitlines()))
    assert lines[0] == ["time [s]", "engine.speed [rad/s]", "c1.state"]
    assert [float(line[1]) for line in lines[1:]] == run["engine.speed"].tolist()
    assert lines[-1][2] == "locked"


def test_events_as_table_and_csv(run: cw.Trajectory, tmp_path: Path) -> None:
    event = run.events.of("c1")[0]
    assert event.time == pytest.approx(1.6, abs=1e-9)
    assert (event.before, event.after, event.cause) == ("backward", "locked", "slip zero")
    assert event.torque_before == pytest.approx(10.0)
    assert "1.600000" in str(run.events)
    run.events.to_csv(tmp_path / "events.csv")
    lines = list(csv.DictReader((tmp_path / "events.csv").read_text().splitlines()))
    assert float(lines[0]["time [s]"]) == event.time
    assert lines[0]["after"] == "locked"


def test_events_take_names_alone_and_tell_the_unit_of_each_number_of_both_kinds(run: cw.Trajectory) -> None:
    assert cw.Events(run.events, ["c1"]).units == run.events.units
    d = two_discs()
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Brake("b", shaft=d.mass("m", mass=1.0, speed=1.0), friction=law, gain=1.0, normal_force=10.0))
    both = d.simulate(2.0).events
    assert both.units["torque_before"] == "N m or N"
    head, first, second = str(both).splitlines()
    assert "slip acc" in head
    assert "rad/s2" not in head
    assert " m/s2 " in first
    assert first.split()[-1] == "N"
    assert " rad/s2 " in second
    assert second.split()[-2:] == ["N", "m"]


def test_pandas_and_xarray(run: cw.Trajectory) -> None:
    pytest.importorskip("pandas")
    frame = run.to_pandas(["engine.speed", "load.speed"])
    assert list(frame.columns) == ["engine.speed", "load.speed"]
    assert frame.index[-1] == 2.0
    pytest.importorskip("xarray")
    data = run.to_xarray()
    assert data["c1.torque"].attrs["units"] == "N m"
    assert data.sizes["time"] == len(run)


def test_a_controller_reads_speeds_and_sets_a_pressure() -> None:
    seen: list[float] = []

    def law(time: float, readings: Any) -> float:
        seen.append(readings["c1.slip"])
        return 100.0 if time >= 0.5 else 0.0

    run = two_discs(normal_force=cw.Sampled(law, 0.25)).simulate(3.0)
    assert seen[:3] == pytest.approx([-100.0, -100.0, -100.0])
    assert run.events.changes()[-1].time == pytest.approx(2.1, abs=1e-6)
    assert run["c1.torque"][run.time < 0.5 - 1e-9] == pytest.approx(0.0)
    calls = len(seen)
    # a grid reads the ends of steps from the interpolant, at a share that is rounded
    np.testing.assert_allclose(run.at(run.time).rows, run.rows, rtol=1e-12, atol=1e-10)
    assert len(seen) == calls == 12


def test_a_controller_that_fails_keeps_the_trajectory_so_far() -> None:
    def law(time: float, readings: Any) -> float:
        return readings["c1.sllip"] if time > 0.6 else 100.0

    with pytest.raises(cw.SimulationError, match=r"'c1.normal_force' failed at 0.75 s.*did you mean") as caught:
        two_discs(normal_force=cw.Sampled(law, 0.25)).simulate(3.0)
    assert caught.value.trajectory is not None
    assert caught.value.trajectory.time[-1] == pytest.approx(0.75)


def test_a_run_that_stops_early_says_why_and_keeps_what_it_has() -> None:
    d = two_discs(normal_force=cw.Sine(amplitude=100.0, frequency=50.0, offset=100.0))
    with pytest.warns(cw.StoppedEarly, match=r"budget of steps.*raise max_steps"):
        run = d.simulate(2.0, max_steps=10)
    assert run.status == "too_many_steps"
    assert not run.finished
    assert 0.0 < run.time[-1] < 2.0
    with pytest.raises(cw.SimulationError, match="budget of steps"):
        run.raise_for_status()


def test_progress_is_told() -> None:
    told: list[tuple[float, float]] = []
    two_discs().simulate(2.0, progress=lambda time, end: told.append((time, end)))
    assert told[-1] == (2.0, 2.0)


def test_a_system_may_be_run_many_times() -> None:
    system = two_discs().assemble()
    first, second = (cw.simulate(system, 2.0, dt=0.01) for _ in range(2))
    assert np.array_equal(first.rows, second.rows)
    assert cw.simulate(system, 2.0, method="dopri5")["load.speed"][-1] == pytest.approx(20.0, rel=1e-5)


def test_phases_end_at_the_events_whatever_the_output(root: Path) -> None:
    d = cw.Driveline.load(root / "examples" / "six_speed" / "model.toml")
    shafts = (d.nodes[0].name, d.nodes[-1].name)
    smooth, coarse = (phases(d.simulate(4.0, dt=dt), shafts) for dt in (None, 0.05))
    assert len(smooth) > 2
    assert [(p.begin, p.end, p.closed) for p in coarse] == [(p.begin, p.end, p.closed) for p in smooth]
    # the speeds are those of the solver at the event, and no row of a grid
    assert [p.measured for p in coarse] == pytest.approx([p.measured for p in smooth], rel=1e-9)


def test_what_stops_the_bare_steps_is_told_where_the_finer_rows_miss_it(monkeypatch: pytest.MonkeyPatch) -> None:
    once = simulation._once

    def stopped(job: Any, grid: Any, *rest: Any) -> Any:
        made, failure = once(job, grid, *rest)
        if grid is None:
            made.status = NOT_FINITE
        return made, failure

    monkeypatch.setattr(simulation, "_once", stopped)
    d = cw.Driveline("flywheel")
    d.add(cw.Torque("t", shaft=d.shaft("wheel", inertia=1.0), torque=cw.Sine(amplitude=1.0, frequency=1.0)))
    with pytest.warns(cw.StoppedEarly):
        # steps of one length have no rows between them, so that the run is repeated
        run = d.simulate(1.0, method="fixed", step=0.01)
    assert not run.finished

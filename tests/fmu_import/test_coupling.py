"""FMUs of other people set inputs of a driveline, with one period of delay. docs/guide/fmu-import.md"""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.c_fmus import COMPILER, small

needs_cc = pytest.mark.skipif(COMPILER is None, reason="no C compiler")
PERIOD = 0.01


def actuator() -> cw.Driveline:
    """A controller of its own physics: a slip drives a body, whose speed is the pressure that closes the clutch."""
    d = cw.Driveline("actuator")
    body = d.shaft("valve", inertia=2e-3)
    d.add(cw.Torque("command", shaft=body, torque=0.0))
    d.add(cw.Damper("drag", base=d.housing, follower=body, damping=1e-3))
    return d


def launch(pressure: Any) -> cw.Driveline:
    """Two bodies and a clutch."""
    d = cw.Driveline("launch")
    engine, load = d.shaft("engine", inertia=0.2, speed=-100.0), d.shaft("load", inertia=0.8)
    lining = cw.Coulomb(static=0.12, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=2e-2, pressure=pressure))
    return d


def by_hand() -> Callable[[float, Mapping[str, float]], float]:
    """The same controller as a function: a Simulator that holds what it read at the instant before."""
    sim = cw.Simulator(actuator())
    before: list[tuple[float, float]] = []

    def value(time: float, readings: Mapping[str, float]) -> float:
        slip = readings["c1.slip"]
        begin, held = before[-1] if before else (time, slip)
        sim.set("command.torque", held)
        # a step of an FMU ends a period after its begin, which may not be the next instant to the last bit
        sim.advance_to(begin + PERIOD if before else begin)
        before.append((time, slip))
        return float(sim["valve.speed"])

    return value


@pytest.fixture(params=["2.0", "3.0"])
def exported(request: Any, tmp_path: Path) -> Path:
    """The controller as an FMU."""
    path = tmp_path / "actuator.fmu"
    return actuator().to_fmu(path, inputs=["command.torque"], version=request.param, picture=False)


def controller(path: Path, **more: Any) -> cw.FMU:
    """The controller, reading the slip."""
    return cw.FMU(path, PERIOD, inputs={"command.torque_signal": "c1.slip"}, trust=True, **more)


def test_an_exported_controller_gives_what_it_gives_in_place(exported: Path) -> None:
    """The same steps of the same core on both sides, one period late: the same bits, also where the clutch locks."""
    got = launch(controller(exported)["valve.speed"]).simulate(1.0)
    want = launch(cw.Sampled(by_hand(), PERIOD)).simulate(1.0)
    assert got.events == want.events
    assert len(got.events) >= 1
    assert got["c1.mode"][-1] == 0
    for name in ("c1.pressure", "c1.slip", "c1.torque", "engine.speed"):
        np.testing.assert_array_equal(got[name], want[name])
    # what is read at one instant shows at the next
    rows = got.at([0.5 * PERIOD, 1.5 * PERIOD])
    assert rows["c1.pressure"][0] == 0.0
    assert rows["c1.pressure"][1] > 0.0


def test_runs_begin_afresh_and_answer_at_other_instants_without_the_fmu(exported: Path) -> None:
    driveline = launch(controller(exported)["valve.speed"])
    first, second = driveline.simulate(0.5), driveline.simulate(0.5)
    np.testing.assert_array_equal(first["c1.slip"], second["c1.slip"])
    exported.unlink()
    # what it decided is replayed
    again = pickle.loads(pickle.dumps(first))
    for run in (first, again, copy.deepcopy(first)):
        assert run.at([0.25])["c1.slip"] == pytest.approx(np.interp(0.25, first.time, first["c1.slip"]), abs=1e-2)
    with pytest.raises(cw.SimulationError, match=r"FMU 'actuator': it cannot be read: No such file"):
        driveline.simulate(0.5)


def test_another_file_in_its_place_is_refused(exported: Path) -> None:
    driveline = launch(controller(exported)["valve.speed"])
    other = cw.Driveline("actuator")
    other.add(cw.Torque("command", shaft=other.shaft("valve", inertia=1.0), torque=0.0))
    other.to_fmu(exported, inputs=["command.torque"], picture=False)
    with pytest.raises(cw.SimulationError, match=r"has changed: make cw.FMU again"):
        driveline.simulate(0.1)


def test_models_copies_and_sweeps_have_an_fmu_each(exported: Path) -> None:
    driveline = launch(controller(exported)["valve.speed"])
    want = driveline.simulate(0.3)["c1.slip"]
    for made in (copy.deepcopy(driveline), pickle.loads(pickle.dumps(driveline))):
        np.testing.assert_array_equal(made.simulate(0.3)["c1.slip"], want)
    swept = cw.sweep(driveline, 0.3, vary={"c1.gain": [2e-2, 4e-2]}, outputs=["c1.slip"])
    assert swept["c1.slip"][0] == want[-1]
    assert swept["c1.slip"][1] != want[-1]


def test_a_simulator_steps_resets_and_refuses_states(exported: Path) -> None:
    driveline = launch(controller(exported)["valve.speed"])
    want = driveline.simulate(0.3, times=[0.1, 0.2, 0.3])["c1.slip"]
    sim = cw.Simulator(driveline)
    for _ in range(2):
        got = []
        for _ in range(3):
            sim.advance(0.1)
            got.append(sim["c1.slip"])
        np.testing.assert_array_equal(got, want)
        state = sim.save()
        sim.reset()
    words = "'c1.pressure' is set by an FMU, which begins at the start of a run, and no state of a run holds its own"
    for go_on in (sim.restore, lambda state: cw.Simulator(driveline, start=state)):
        with pytest.raises(cw.StateError, match=words):
            go_on(state)
    with pytest.raises(cw.StateError, match=words):
        cw.simulate(driveline, 1.0, start=state)
    # set from outside it needs no FMU, nor does its state
    sim.set("c1.pressure", 1e5)
    sim.advance(0.1)
    sim.restore(sim.save())
    # and an FMU that was left out for a while does not go on as if nothing had been
    sim.reset()
    sim.advance(0.1)
    sim.set("c1.pressure", 1e5)
    sim.advance(0.1)
    sim.release("c1.pressure")
    with pytest.raises(cw.SimulationError, match=r"was not asked in its step from 0.09 to 0.2 s"):
        sim.advance(0.1)


def test_a_model_file_has_fmus_for_those_who_trust_it(exported: Path, tmp_path: Path) -> None:
    driveline = launch(controller(exported)["valve.speed"])
    path = tmp_path / "model.toml"
    driveline.save(path)
    assert 'pressure = {fmu = "actuator", output = "valve.speed"}' in path.read_text()
    with pytest.raises(cw.ModelError) as raised:
        cw.Driveline.load(path)
    assert str(raised.value).count("\n") == 1
    assert "runs a library of another program with your permissions; where you know where it is" in str(raised.value)
    read = cw.Driveline.load(path, trust=True)
    assert read.to_dict() == driveline.to_dict()
    np.testing.assert_array_equal(read.simulate(0.3)["c1.slip"], driveline.simulate(0.3)["c1.slip"])


def test_mistakes_of_a_model_file_are_told_with_their_lines(exported: Path, tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    launch(controller(exported)["valve.speed"]).save(path)
    text = path.read_text()
    for wrong, words in (
        (text.replace("period = 0.01", "period = -1.0"), "period is -1.0: give a time in s above 0"),
        (text.replace("period = 0.01", "perod = 0.01"), "perod is an unknown key; did you mean 'period'?"),
        (text.replace("actuator.fmu", "actuato.fmu"), "it cannot be read: No such file"),
        (text.replace('fmu = "actuator"', 'fmu = "actuater"'), "is not an FMU of this model; did you mean 'actuator'?"),
        (text.replace('output = "valve.speed"', "output = [1]"), "[1] is not an output; outputs are"),
        (text.replace('"c1.slip"', "3"), "inputs: 'command.torque_signal' is 3: give names of results"),
        (text.replace('path = "actuator.fmu"', "path = 7"), "path = 7: must be a string"),
        (text.replace("period = 0.01\n", ""), "period is missing"),
        (text.replace("valve.speed", "valve.sped"), "'valve.sped' is not an output; did you mean 'valve.speed'?"),
        (text.replace("torque_signal", "torque_sgnal"), "'command.torque_sgnal' is not an input; did you mean"),
    ):
        path.write_text(wrong)
        with pytest.raises(cw.ModelError) as raised:
            cw.Driveline.load(path, trust=True)
        assert words in str(raised.value)
        assert "line " in str(raised.value)


def test_the_command_line_asks_for_trust(exported: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from clutchwork.command.main import main

    path = tmp_path / "model.toml"
    launch(controller(exported)["valve.speed"]).save(path)
    for command in (["run", "--t-end", "0.1"], ["check"]):
        assert main([command[0], str(path), *command[1:]]) == 3
        assert "give --trust to run or check" in capsys.readouterr().err
        assert main([command[0], str(path), *command[1:], "--trust"]) == 0
        capsys.readouterr()


def test_wrong_calls_are_told_at_once(exported: Path) -> None:
    with pytest.raises(cw.UseError) as raised:
        cw.FMU(exported, "1 m", inputs={"a": 1}, parameters={"b": "c"}, time_limit=0)  # type: ignore[dict-item]
    told = str(raised.value)
    for words in (
        "period is '1 m'",
        "inputs: 'a' is 1",
        "parameters: 'b' is 'c'",
        "time_limit is 0",
        "give trust=True",
    ):
        assert words in told
    with pytest.raises(cw.FMUError, match=r"'command' is not an input; inputs are command.torque_signal|did you mean"):
        cw.FMU(exported, PERIOD, inputs={"command": "c1.slip"}, trust=True)
    with pytest.raises(cw.FMUError, match=r"FMU 'actuator': 'valve.sped' is not an output; did you mean 'valve.speed'"):
        controller(exported)["valve.sped"]
    unknown = cw.FMU(exported, PERIOD, inputs={"command.torque_signal": "c1.slop"}, trust=True)
    with pytest.raises(cw.SimulationError, match=r"FMU 'actuator' reads 'command.torque_signal' from 'c1.slop': "):
        launch(unknown["valve.speed"]).simulate(0.1)


def test_parameters_and_names_are_those_of_the_fmu(exported: Path) -> None:
    heavy = controller(exported, parameters={"valve.inertia": 4e-3}, name="heavy valve")
    assert "'heavy valve'" in repr(heavy)
    assert "valve.speed" in heavy.outputs
    run = launch(heavy["valve.speed"]).simulate(0.05)
    light = launch(controller(exported)["valve.speed"]).simulate(0.05)
    ratio = light["c1.pressure"][-1] / run["c1.pressure"][-1]
    # twice the inertia gives half the speed but for the drag, whose time constant is 2 and 4 s
    assert ratio == pytest.approx(2.0, rel=0.02)


@needs_cc
def test_units_types_and_several_outputs_of_one_fmu(tmp_path: Path) -> None:
    """dx/dt = u in steps of 0.1 s, held: x is 0, 0, 0.1 w0, ... whatever else is read from the same instance."""
    fmu = cw.FMU(
        small(tmp_path / "small.fmu"),
        0.1,
        inputs={"u": "a.speed", "p": "c.pressure", "on": "a.speed"},
        parameters={"bias": 1.0},
        trust=True,
    )
    assert fmu.outputs == ("y", "q", "steps", "is on")
    d = cw.Driveline("several")
    a = d.shaft("a", inertia=1.0, speed=10.0)
    d.add(cw.Torque("t", shaft=a, torque=0.0))
    d.add(
        cw.Brake(
            "c", shaft=d.shaft("b", inertia=1.0), gain=1e-6, pressure=3e5, friction=cw.Coulomb(static=0.1, kinetic=0.1)
        )
    )
    for name in ("y", "q", "steps", "is on"):
        d.add(cw.Torque(name, shaft=d.shaft(f"of {name}", inertia=1.0), torque=fmu[name]))
    run = d.simulate(0.5, times=[0.05, 0.15, 0.25, 0.35])
    np.testing.assert_allclose(run["y.torque"], [0.0, 1.1, 2.2, 3.3], rtol=1e-14)
    np.testing.assert_array_equal(run["steps.torque"], [0.0, 1.0, 2.0, 3.0])
    np.testing.assert_array_equal(run["is on.torque"], [1.0, 1.0, 1.0, 1.0])
    # 3e5 Pa are 30 decibar; it gives twice that number in bar, a unit that it does not define
    np.testing.assert_allclose(run["q.torque"], [60e5] * 4, rtol=1e-15)


@needs_cc
def test_fmi_3_has_its_types_too(tmp_path: Path) -> None:
    fmu = cw.FMU(small(tmp_path / "s.fmu", "3.0"), 0.1, inputs={"u": "a.speed", "on": "a.speed"}, trust=True)
    assert fmu.outputs == ("y", "is on")
    with pytest.raises(cw.FMUError, match=r"'many' is not a single number, and only those can be exchanged"):
        fmu["many"]
    d = cw.Driveline("three")
    d.shaft("a", inertia=1.0, speed=10.0)
    for name in fmu.outputs:
        d.add(cw.Torque(name, shaft=d.shaft(f"of {name}", inertia=1.0), torque=fmu[name]))
    run = d.simulate(0.5, times=[0.05, 0.15, 0.25])
    np.testing.assert_allclose(run["y.torque"], [0.0, 1.0, 2.0], rtol=1e-15)
    np.testing.assert_array_equal(run["is on.torque"], [1.0, 1.0, 1.0])


@needs_cc
def test_a_start_between_instants_waits_for_the_first(tmp_path: Path) -> None:
    fmu = cw.FMU(small(tmp_path / "s.fmu"), 0.1, parameters={"bias": 1.0}, trust=True)
    d = cw.Driveline("late")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=fmu["y"]))
    run = d.simulate(0.5, t_start=0.25, times=[0.28, 0.35, 0.45])
    np.testing.assert_allclose(run["t.torque"], [0.0, 0.0, 0.1], rtol=1e-15)

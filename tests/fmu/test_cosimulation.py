"""Co-simulation gives what `simulate` and `Simulator` give. docs/guide/fmu.md"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from fmpy.validation import validate_fmu

import clutchwork as cw
from clutchwork.signals.bases.waveform import value
from fmu.conftest import INPUTS, SIX_SPEED
from support.fmus import DISCARD, Fmu
from support.project import ROOT

PRESSURES = INPUTS[:3]
SPEEDS = [f"w{number}.speed" for number in range(1, 9)]
EXAMPLES = sorted(path.parent.name for path in (ROOT / "examples").glob("*/model.toml"))


def of_model(name: str, time: float) -> float:
    """What the model says of a signal, from the left."""
    system = cw.Driveline.load(SIX_SPEED).assemble()
    return value(next(item.signal for item in system.inputs if item.name == name), time)


@pytest.mark.parametrize("version", ["2.0", "3.0"])
@pytest.mark.parametrize("example", EXAMPLES)
def test_every_example_is_a_valid_fmu_that_ends_as_simulate_does(tmp_path: Any, example: str, version: str) -> None:
    driveline = cw.Driveline.load(ROOT / "examples" / example / "model.toml")
    path = driveline.to_fmu(tmp_path / "one.fmu", version=version, picture=False)
    assert validate_fmu(str(path)) == []
    end = float(driveline.simulation["t_end"])
    want = driveline.simulate(times=[0.0, end])
    fmu = Fmu(path, tmp_path / "unpacked")
    names = [name for name, one in fmu.variables.items() if one.causality == "output" and one.variability != "discrete"]
    with fmu.running() as run:
        run.step(0.0, end)
        got = dict(zip(names, run.get(names), strict=True))
    for name in names:
        plain = name.replace("'", "")
        scale = float(np.max(np.abs(want[plain]))) or 1.0
        # the same steps but for those that end at rows
        assert got[name] == pytest.approx(float(want[plain][-1]), abs=1e-6 * scale), name


def test_inputs_with_rates_are_exact_and_held_ones_lag(six_speed: Fmu) -> None:
    """Pressures are ramps between knots at multiples of a step, so that lines are all of them."""
    size, end = 0.01, 1.5
    want = cw.Driveline.load(SIX_SPEED).simulate(end, times=np.linspace(0.0, end, 151), rtol=1e-10)
    worst = {}
    for rates in (True, False):
        # a step holds what a ramp is at its begin
        with six_speed.running({name: of_model(name, 0.0) for name in PRESSURES}, tolerance=1e-10) as run:
            rows = [run.get(SPEEDS)]
            for k in range(150):
                begin, after = k * size, (k + 1) * size - 1e-12
                for name in PRESSURES:
                    here = of_model(name, begin)
                    run.set(name, here)
                    run.rate(name, (of_model(name, after) - here) / size if rates else 0.0)
                run.step(begin, size)
                rows.append(run.get(SPEEDS))
        worst[rates] = max(np.max(np.abs(np.array(rows)[:, i] - want[name])) for i, name in enumerate(SPEEDS))
    # slopes are differences of values that are rounded to 16 digits of 8e5 Pa; both runs have rtol 1e-10
    assert worst[True] < 1e-6
    assert worst[False] > 0.1


def test_held_inputs_give_the_bits_of_a_simulator(six_speed: Fmu) -> None:
    sim = cw.Simulator(cw.Driveline.load(SIX_SPEED).assemble().changed(dict.fromkeys(INPUTS, 0.0)))
    outputs = [*SPEEDS, "F1.torque", "F2.heat", "F4.slip"]
    with six_speed.running(dict.fromkeys(INPUTS, 0.0)) as run:
        for k in range(400):
            values = {"F1.pressure": 2e3 * k, "F2.pressure": max(0.0, 4e5 - 2e3 * k), "load.torque": 3000.0}
            sim.set(values)
            for name, one in values.items():
                run.set(name, one)
            if k % 3 == 0:
                # looking changes nothing
                run.get(outputs)
            sim.advance_to((k + 1) * 1e-3)
            run.step(k * 1e-3, (k + 1) * 1e-3 - k * 1e-3)
            assert run.get(outputs) == [sim[name] for name in outputs], k
            assert [run.mode(f"F{i}.mode") for i in (1, 2, 4)] == [sim[f"F{i}.mode"] for i in (1, 2, 4)]


def test_locked_slip_is_zero(six_speed: Fmu) -> None:
    with six_speed.running({"F1.pressure": 0.0, "F2.pressure": 9e5, "F4.pressure": 9e5}) as run:
        run.step(0.0, 3.0)
        assert run.mode("F2.mode") == 0
        assert run.get(["F2.slip"]) == [0.0]


@pytest.mark.parametrize(
    ("name", "bad"), [("F1.gain", -1.0), ("F1.gain", np.nan), ("shaft.damping", -1e30), ("F1.pressure", np.inf)]
)
def test_values_out_of_bounds_change_nothing(six_speed: Fmu, name: str, bad: float) -> None:
    """A sentence in the log, and the value stays."""
    run = six_speed.instance()
    run.begin({})
    before = run.get([name])
    with pytest.raises(Exception, match=rf"status {DISCARD}|Discard|discard"):
        run.set(name, bad)
    assert run.get([name]) == before
    assert name in run.messages[-1][2]
    run.step(0.0, 0.1)
    run.free()


def test_each_step_has_a_budget_of_its_own(made: Any) -> None:
    """The counters of the core count over the life of a run."""
    driveline = cw.Driveline("two discs")
    driveline.simulation["max_steps"] = 50
    engine, load = driveline.shaft("engine", inertia=1.0, speed=10.0), driveline.shaft("load", inertia=1.0)
    driveline.add(cw.SpringDamper("shaft", base=engine, follower=load, stiffness=100.0, damping=0.1))
    with made(driveline).running() as run:
        for k in range(200):
            run.step(0.01 * k, 0.01)


def test_events_are_in_the_log(six_speed: Fmu) -> None:
    run = six_speed.instance(log=True)
    run.begin({"F2.pressure": 9e5, "F4.pressure": 9e5})
    run.step(0.0, 3.0)
    events = [text for _, category, text in run.messages if category == "events"]
    assert any("F2" in text and "locked" in text and "(slip zero)" in text for text in events), events
    run.free()


@pytest.mark.parametrize("six_speed", ["3.0"], indirect=True)
def test_early_return_and_event_mode(six_speed: Fmu) -> None:
    """Steps end at events where the master wants it, and the whole way is the same."""
    pressures = {"F2.pressure": 9e5, "F4.pressure": 9e5}
    with six_speed.running(pressures) as through:
        through.step(0.0, 3.0)
        want = through.get(SPEEDS)
    run = six_speed.instance(event_mode=True, early_return=True)
    run.begin(pressures)
    run.raw.updateDiscreteStates()
    run.raw.enterStepMode()
    time, stops = 0.0, list[float]()
    while time < 3.0:
        needed, _, early, time = run.step(time, 3.0 - time)
        assert early == needed
        if needed:
            stops.append(time)
            run.raw.enterEventMode()
            run.raw.updateDiscreteStates()
            run.raw.enterStepMode()
    assert stops
    assert run.get(SPEEDS) == pytest.approx(want, rel=1e-12)
    run.free()


def ramped(made: Any, version: str) -> Fmu:
    """A shaft of 1/3 kg m2 whose torque is an input."""
    driveline = cw.Driveline("one")
    shaft = driveline.shaft("shaft", inertia=1.0 / 3.0)
    driveline.add(cw.Torque("drive", shaft=shaft, torque=0.0))
    fmu: Fmu = made(driveline, inputs=["drive.torque"], version=version)
    return fmu


@pytest.mark.parametrize("version", ["2.0", "3.0"])
@pytest.mark.parametrize("rate_first", [True, False])
def test_the_order_of_value_and_rate_does_not_matter(made: Any, version: str, rate_first: bool) -> None:
    """100 N m/s over 1 s on 1/3 kg m2 are 150 rad/s; a refused step keeps the rate."""
    with ramped(made, version).running() as run:
        if rate_first:
            run.rate("drive.torque_signal", 100.0)
            run.set("drive.torque", 0.0)
        else:
            run.set("drive.torque", 0.0)
            run.rate("drive.torque_signal", 100.0)
        with pytest.raises(Exception, match=r"status 3|Error"):
            run.step(5.0, 1.0)
        run.step(0.0, 1.0)
        assert run.get(["shaft.speed"])[0] == pytest.approx(150.0, rel=1e-9)


def test_a_rate_of_fmi_3_stays_until_it_is_set(made: Any) -> None:
    with ramped(made, "3.0").running() as run:
        run.rate("drive.torque_signal", 100.0)
        for k in range(10):
            run.set("drive.torque", 10.0 * k)
            run.step(0.1 * k, 0.1)
        assert run.get(["shaft.speed"])[0] == pytest.approx(150.0, rel=1e-9)


def test_knots_inside_are_announced_and_both_sides_are_seen(made: Any) -> None:
    """A torque of 6 N m up to 0.5 s, then 9, on 3 kg m2; in event mode the right limit is shown, also after a state."""
    driveline = cw.Driveline("one")
    shaft = driveline.shaft("shaft", inertia=3.0)
    driveline.add(cw.Torque("drive", shaft=shaft, torque=cw.Table([(0, 6), (0.5, 6), (0.5, 9), (1, 9), (1, 6)])))
    run = made(driveline, version="3.0").instance(event_mode=True)
    run.begin({})
    found = [run.raw.updateDiscreteStates()]
    run.raw.enterStepMode()
    run.step(0.0, 0.5)
    assert run.get(["shaft.acceleration"]) == pytest.approx([2.0], rel=1e-12)
    run.raw.enterEventMode()
    assert run.get(["shaft.acceleration"]) == pytest.approx([3.0], rel=1e-12)
    run.go_to(run.state())
    assert run.get(["shaft.acceleration"]) == pytest.approx([3.0], rel=1e-12)
    found.append(run.raw.updateDiscreteStates())
    run.raw.enterStepMode()
    run.step(0.5, 0.5)
    run.raw.enterEventMode()
    found.append(run.raw.updateDiscreteStates())
    assert [flags[-1] for flags in found[:2]] == [0.5, 1.0]
    assert [flags[-2] for flags in found] == [True, True, False]
    run.free()


def test_a_budget_that_is_too_small_ends_the_step(made: Any) -> None:
    driveline = cw.Driveline("swings")
    engine, load = driveline.shaft("engine", inertia=1.0, speed=10.0), driveline.shaft("load", inertia=1.0)
    driveline.add(cw.SpringDamper("shaft", base=engine, follower=load, stiffness=1e4, damping=0.1))
    driveline.simulation["max_steps"] = 20
    run = made(driveline).instance()
    run.begin({})
    with pytest.raises(Exception, match=r"status 3|Error"):
        run.step(0.0, 10.0)
    assert "budget" in run.messages[-1][2]
    run.free()


def test_an_fmu_without_outputs_is_valid(tmp_path: Any) -> None:
    path = cw.Driveline.load(SIX_SPEED).to_fmu(tmp_path / "none.fmu", outputs=[], picture=False)
    assert validate_fmu(str(path)) == []


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_steps_of_one_length_are_those_of_a_simulator(tmp_path: Any, version: str) -> None:
    driveline = cw.Driveline.load(SIX_SPEED)
    how = {"method": "fixed", "step": 1e-3}
    path = driveline.to_fmu(tmp_path / "fixed.fmu", inputs=INPUTS, version=version, picture=False, **how)
    assert validate_fmu(str(path)) == []
    fmu = Fmu(path, tmp_path / "unpacked")
    sim = cw.Simulator(driveline.assemble().changed(dict.fromkeys(INPUTS, 0.0)), **how)
    with fmu.running(dict.fromkeys(INPUTS, 0.0)) as run:
        for k in range(200):
            values = {"F1.pressure": 2e3 * k, "F2.pressure": max(0.0, 4e5 - 2e3 * k)}
            sim.set(values)
            for name, one in values.items():
                run.set(name, one)
            sim.advance_to((k + 1) * 1e-3)
            run.step(k * 1e-3, (k + 1) * 1e-3 - k * 1e-3)
        assert run.get(SPEEDS) == [sim[name] for name in SPEEDS]


def test_a_step_of_one_length_ends_an_early_return(tmp_path: Any) -> None:
    """A master that wants events gets control at the end of the step in which a contact has changed."""
    how = {"method": "fixed", "step": 1e-3}
    path = cw.Driveline.load(SIX_SPEED).to_fmu(tmp_path / "fixed.fmu", version="3.0", picture=False, **how)
    fmu = Fmu(path, tmp_path / "unpacked")
    want = cw.Driveline.load(SIX_SPEED).simulate(3.0, **how)
    run = fmu.instance(early_return=True)
    run.begin({})
    time, stops = 0.0, list[float]()
    while time < 3.0:
        _, _, early, time = run.step(time, 3.0 - time)
        stops += [time] if early else []
    # in one step there may be several
    assert np.unique(np.ceil(np.array([event.time for event in want.events]) / 1e-3 - 1e-9)) == pytest.approx(
        np.array(stops) / 1e-3, abs=1e-6
    )
    assert run.get(["w8.speed"])[0] == want["w8.speed"][-1]
    run.free()

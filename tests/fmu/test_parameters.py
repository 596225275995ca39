"""Parameters of an FMU are those of the driveline: as if it had been assembled with them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from fmu.conftest import INPUTS, SIX_SPEED
from support.fmus import Fmu

SEEN = ["w1.speed", "w8.speed", "F2.heat", "shaft.torque"]
START = {"F1.pressure": 2e5, "F2.pressure": 6e5, "F4.pressure": 8e5, "load.torque": 1000.0}


def parameters(fmu: Fmu, variability: str) -> dict[str, Any]:
    """Parameters of a kind by name."""
    return {n: v for n, v in fmu.variables.items() if v.causality == "parameter" and v.variability == variability}


def test_the_six_speed_gearbox_has_all_that_follows_straight_lines(six_speed: Fmu) -> None:
    tunable, fixed = parameters(six_speed, "tunable"), parameters(six_speed, "fixed")
    assert {"shaft.damping", "F1.gain", "F6.friction.static", "engine.gain"} <= set(tunable)
    assert {"w1.inertia", "w8.inertia", "w1.speed_start", "shaft.stiffness"} <= set(fixed)
    assert not [name for name in six_speed.variables if name.endswith(".ratio")]


def test_every_parameter_acts_as_an_assembly_with_it(six_speed: Fmu) -> None:
    """Tunable ones to the bit; fixed ones within the round-off of sums of inertias, which a stiff shaft makes 1e-9."""
    system = cw.Driveline.load(SIX_SPEED).assemble()
    plain = cw.System.of(system.source, system.independent).changed({**dict.fromkeys(INPUTS, 0.0), **START})
    for kind in ("tunable", "fixed"):
        for name, one in parameters(six_speed, kind).items():
            value = 1.1 * float(one.start) or 0.01
            sim = cw.Simulator(plain.changed({name.removesuffix("_start"): value}))
            sim.advance(0.2)
            with six_speed.running({**START, name: value}) as run:
                run.step(0.0, 0.2)
                got = np.array(run.get(SEEN))
            want = np.array([sim[signal] for signal in SEEN])
            scale = np.maximum(np.abs(want), 1.0)
            assert np.all(np.abs(got - want) <= (0.0 if kind == "tunable" else 1e-8) * scale), name


def test_tunable_parameters_change_while_it_runs(six_speed: Fmu) -> None:
    sim = cw.Simulator(cw.Driveline.load(SIX_SPEED).assemble().changed({**dict.fromkeys(INPUTS, 0.0), **START}))
    with six_speed.running(START) as run:
        for k, gain in enumerate((0.05, 0.06, 0.07)):
            sim.set("F2.gain", gain)
            run.set("F2.gain", gain)
            sim.advance_to(0.1 * (k + 1))
            run.step(0.1 * k, 0.1 * (k + 1) - 0.1 * k)
            assert run.get(SEEN) == [sim[name] for name in SEEN]


@pytest.mark.parametrize("states", [False, True])
def test_formulas_have_the_bits_of_a_simulator(made: Any, states: bool) -> None:
    """Their numbers are parameters."""
    d = cw.Driveline("formula")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    numbers: dict[str, Any] = {"mu": 0.25, "f": 0.05, "w": "30 rpm"}
    law: cw.Law = cw.Formula("mu + f*exp(-v/w)", **numbers)
    if states:
        rates = {"z": "s*(v - abs(v)*z/(mu + f*exp(-abs(v)/w)))"}
        law = cw.DynamicFormula("z + 0.001*v", rates=rates, at_rest="mu + f", s="500 1/rad", **numbers)
    ramp = cw.Ramp(height=400.0, duration=0.3)
    d.add(cw.Clutch("c", base=engine, follower=load, friction=law, gain=0.4, normal_force=ramp))
    fmu, seen = made(d), ["engine.speed", "c.torque", "c.heat"]
    assert {"c.friction.mu", "c.friction.f", "c.friction.w"} <= set(parameters(fmu, "tunable"))
    sim = cw.Simulator(d.assemble().changed({"c.friction.mu": 0.21}))
    with fmu.running({"c.friction.mu": 0.21}) as run:
        for k in range(20):
            sim.advance_to(0.05 * (k + 1))
            run.step(0.05 * k, 0.05 * (k + 1) - 0.05 * k)
            assert run.get(seen) == [sim[name] for name in seen]


def test_fixed_parameters_and_results_cannot_be_set_later(six_speed: Fmu) -> None:
    run = six_speed.instance()
    run.begin(START)
    for name in ("w8.inertia", "w8.speed"):
        with pytest.raises(Exception, match=r"status 3|Error"):
            run.set(name, 1.0)
        assert name in run.messages[-1][2]
    run.free()


def test_what_does_not_fit_is_refused_at_once_with_the_reason(tmp_path: Any) -> None:
    driveline = cw.Driveline.load(SIX_SPEED)
    with pytest.raises(cw.UseError, match=r"F1.presure.*F1.pressure"):
        driveline.to_fmu(tmp_path / "a.fmu", inputs=["F1.presure"])
    with pytest.raises(cw.UseError, match="one for each value"):
        driveline.to_fmu(tmp_path / "a.fmu", parameters=["row1.ratio"])
    with pytest.raises(cw.UseError, match=r"F1.state.*F1.mode"):
        driveline.to_fmu(tmp_path / "a.fmu", outputs=["F1.state"])
    with pytest.raises(cw.UseError, match=r"2\.0"):
        driveline.to_fmu(tmp_path / "a.fmu", version="1.0")


def test_a_prescribed_speed_is_warned_of(tmp_path: Any) -> None:
    driveline = cw.Driveline("rig")
    engine, load = driveline.shaft("engine"), driveline.shaft("load", inertia=1.0)
    driveline.add(cw.PrescribedSpeed("source", shaft=engine, speed=10.0))
    driveline.add(cw.SpringDamper("shaft", base=engine, follower=load, stiffness=100.0, damping=1.0))
    with pytest.warns(cw.ModelWarning, match="rate"):
        driveline.to_fmu(tmp_path / "a.fmu", inputs=["source.speed"], picture=False)


def raised(one: Any) -> float:
    """Another value of a parameter, within its bounds."""
    value = 1.3 * float(one.start) or 0.01
    return value if one.max is None or value <= float(one.max) else 0.7 * float(one.start)


@pytest.mark.parametrize("example", ["car_launch", "engine_clutch_vehicle", "launch", "six_speed"])
def test_all_parameters_together_act_as_an_assembly_with_them(tmp_path: Any, example: str) -> None:
    """Numbers that share words of the System add up, or are not offered."""
    driveline = cw.Driveline.load(SIX_SPEED.parents[1] / example / "model.toml")
    fmu = Fmu(driveline.to_fmu(tmp_path / "one.fmu", parameters="*", picture=False), tmp_path / "unpacked")
    chosen = {**parameters(fmu, "tunable"), **parameters(fmu, "fixed")}
    # the static coefficient stays above the others, and start speeds fit their gears
    values = {n: raised(one) for n, one in chosen.items() if "friction" not in n and not n.endswith("_start")}
    system = driveline.assemble()
    pinned = cw.System.of(system.source, system.independent)
    sim = cw.Simulator(pinned.changed({name.replace("'", ""): value for name, value in values.items()}))
    seen = [n for n, one in fmu.variables.items() if one.causality == "output" and n.endswith((".speed", ".torque"))]
    sim.advance(0.3)
    with fmu.running(values) as run:
        run.step(0.0, 0.3)
        got = np.array(run.get(seen))
    want = np.array([sim[name.replace("'", "")] for name in seen])
    # words are sums in another order; stiff shafts make 1e-7 of that
    assert np.all(np.abs(got - want) <= 1e-6 * np.maximum(np.abs(want), 1.0))


def test_outputs_that_are_computed_from_parameters_follow_them(made: Any) -> None:
    """Torques of planetary rows follow from inertias, a twist from a torque over a stiffness: all of an assembly."""
    driveline = cw.Driveline.load(SIX_SPEED)
    fmu = made(driveline, inputs=INPUTS)
    fixed = parameters(fmu, "fixed")
    assert {"w1.inertia", "w8.inertia", "shaft.stiffness"} <= set(fixed)
    assert {"divider.torque_sun", "shaft.twist"} <= set(fmu.variables)
    values = {"w1.inertia": 0.3, "w4.inertia": 0.02, "w8.inertia": 20.0, "shaft.stiffness": 9e4}
    system = driveline.assemble()
    pinned = cw.System.of(system.source, system.independent)
    sim = cw.Simulator(pinned.changed({**dict.fromkeys(INPUTS, 0.0), **START, **values}))
    sim.advance(0.2)
    names = [n for n, one in fmu.variables.items() if one.causality == "output" and one.variability != "discrete"]
    with fmu.running({**START, **values}) as run:
        run.step(0.0, 0.2)
        kept = run.state()
        got = np.array(run.get(names))
        # a state brings its parameters with it, another life those of the model
        run.raw.reset()
        run.go_to(kept)
        assert run.get(names) == got.tolist()
    want = np.array([sim[name] for name in names])
    # sums of inertias in another order, which a stiff shaft makes 1e-7
    assert np.all(np.abs(got - want) <= 1e-6 * np.maximum(np.abs(want), 1.0))


def test_an_output_that_follows_along_no_line_excludes_its_parameter(tmp_path: Any) -> None:
    """Where an inertia was zero, the torque of a gear is computed from other accelerations than with one."""
    driveline = cw.Driveline.load(SIX_SPEED.parents[1] / "engine_clutch_vehicle" / "model.toml")
    how = {"outputs": ["gears.torque_output"], "picture": False}
    with pytest.raises(cw.UseError, match=r"gearbox\.inertia.*gears\.torque_output"):
        driveline.to_fmu(tmp_path / "a.fmu", parameters=["gearbox.inertia"], **how)
    plain = Fmu(driveline.to_fmu(tmp_path / "a.fmu", picture=False), tmp_path / "a")
    assert "gears.torque_output" in plain.variables
    assert "gearbox.inertia" not in plain.variables
    chosen = Fmu(driveline.to_fmu(tmp_path / "b.fmu", parameters=["gearbox.inertia"], picture=False), tmp_path / "b")
    assert "gearbox.inertia" in chosen.variables
    assert "gears.torque_output" not in chosen.variables


def test_whole_numbers_are_left_out(tmp_path: Any) -> None:
    with pytest.raises(cw.UseError, match="whole number"):
        cw.Driveline.load(SIX_SPEED.parents[1] / "car_launch" / "model.toml").to_fmu(
            tmp_path / "a.fmu", parameters=["clutch.surfaces"], picture=False
        )

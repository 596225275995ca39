"""What of a driveline can be set while a run goes on: every signal, and the parameters that physics lets change."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.schema import inputs, specs
from clutchwork.model.changes import all_names
from support import samples
from support.random_drivelines import describe

QUOTED = re.compile(r"'([^']+)'")
ELEMENTS = samples.declared(*samples.ELEMENT_ROLES)


def simulator(cls: Any) -> cw.Simulator:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        return cw.Simulator(samples.driveline(cls))


def allowed(spec: Any, low: float = 0.1) -> float:
    """A number within the bounds of a signal, near its example."""
    wanted = 0.75 * spec.example if spec.example is not None else 280.0 if spec.unit == "K" else 0.75
    return float(wanted if spec.allows(wanted) else low)


@pytest.mark.parametrize("cls", ELEMENTS, ids=lambda cls: cls.kind)
def test_every_signal_of_every_element_can_be_set(cls: Any) -> None:
    """From the instant on the signal is that value, and the run goes on; released it is that of the model again."""
    sim = simulator(cls)
    system, index = sim._system, {item.name: k for k, item in enumerate(sim._system.inputs)}
    own = {f"x.{names[0]}": spec for names, spec in inputs(cls)}
    linked = {link.name for link in system.links}
    for name in [*index, *(name for name in own if name not in index)]:
        if name in linked or getattr(system.source.elements[0], name[2:], 0.0) is None:
            continue
        spec = own.get(name)
        value = allowed(spec) if spec is not None else 280.0 if name.endswith("temperature") else 0.25
        if system.motions and name in own and name not in sim._outside.signals:
            # a position that jumps would take an infinite speed; what acts is the speed
            (problem,) = problems(sim, name, value)
            assert problem.remedy == "set 'x.speed'"
            continue
        sim.advance(0.01)
        sim.set(name, value)
        sim.advance(0.01)
        places = sim._outside.signals[name].numbers
        columns = sim.run.wiring.columns["input"]
        assert [float(sim._readout.rows[0][columns][k]) for k in places] == [value] * len(places), name
        assert sim.held[name] == value
    sim.release()
    sim.advance(0.01)
    whole = cw.simulate(system, sim.time)
    assert np.array_equal(sim._readout.rows[0][columns], whole.rows[-1][columns]) if index else True
    assert sim.run.finished


def problems(sim: cw.Simulator, name: str, value: float) -> tuple[cw.Problem, ...]:
    """Why a value is refused; nothing where it is set."""
    try:
        sim.set(name, value)
    except cw.ModelError as error:
        return error.problems
    return ()


@pytest.mark.parametrize("cls", ELEMENTS, ids=lambda cls: cls.kind)
def test_every_parameter_is_set_or_refused_with_a_reason(cls: Any) -> None:
    """What is set is what a model with that number has from then on; nothing is ignored."""
    sim = simulator(cls)
    sim.advance(0.05)
    element = sim._system.source.elements[0]
    for item, spec in specs(cls, "param", "option"):
        now = getattr(element, item.name)
        if spec.flag or spec.choices or now is None:
            continue
        value = now + 1 if spec.whole else 1.1 * now if now else 0.1
        if not spec.allows(value):
            value = 0.9 * now
        name = f"x.{item.name}"
        refused = problems(sim, name, value)
        if refused:
            assert all(problem.remedy or "did you mean" in problem.message for problem in refused), refused
            assert sim.held == {}
            continue
        wanted = sim._system.changed({name: value})
        assert sim.held == {name: value}
        sim.advance(0.01)
        sim.release(name)
        assert wanted.arrays["params"].tobytes() != sim._system.arrays["params"].tobytes()
        assert sim.held == {}
        sim.advance(0.01)
    assert sim.run.finished


def clutch() -> cw.Driveline:
    d = cw.Driveline("clutch")
    a, b = d.shaft("a", inertia=1.0, speed=100.0), d.shaft("b", inertia=2.0)
    friction = cw.Stribeck(static=0.4, kinetic=0.3, speed=5.0)
    d.add(cw.Clutch("c", base=a, follower=b, friction=friction, gain=1e-3, pressure=1e5))
    d.add(cw.SpringDamper("k", base=b, follower=d.housing, stiffness=50.0, damping=1.0))
    d.add(cw.Torque("m", shaft=a, torque=10.0))
    return d


@pytest.mark.parametrize(
    ("name", "value"),
    [("c.gain", 2e-3), ("c.friction.kinetic", 0.1), ("c.friction.speed", 1.0), ("k.damping", 4.0), ("c.gain", 1e-5)],
)
def test_a_parameter_acts_from_that_instant_on_and_makes_no_energy(name: str, value: float) -> None:
    """The motion after is that of a model with the number, begun with the motion before; the balance closes."""
    sim = cw.Simulator(clutch(), rtol=1e-10, atol=1e-12)
    sim.advance(0.4)
    kinetic = 0.5 * (sim["a.speed"] ** 2 + 2.0 * sim["b.speed"] ** 2)
    before = sim[["a.speed", "b.speed", "k.spring_torque"]]
    sim.set(name, value)
    assert 0.5 * (sim["a.speed"] ** 2 + 2.0 * sim["b.speed"] ** 2) == kinetic
    system = (
        clutch()
        .assemble()
        .changed({name: value, "a.speed": before[0], "b.speed": before[1], "k.initial_twist": before[2] / 50.0})
    )
    whole = cw.simulate(system, 1.0, rtol=1e-10, atol=1e-12)
    sim.advance(1.0)
    assert sim[["a.speed", "b.speed", "k.torque", "c.torque"]] == pytest.approx(
        [whole[one][-1] for one in ("a.speed", "b.speed", "k.torque", "c.torque")], rel=1e-6, abs=1e-6
    )
    energy = sim.run.energy
    assert abs(energy.residual) < 1e-7 * energy.turnover
    assert sim.run.at([0.2, 0.9])["c.torque"].shape == (2,)


def test_a_locked_contact_is_decided_anew() -> None:
    """Static friction that is lowered below the load lets go at once, as an event of the input."""
    d = cw.Driveline("hold")
    a = d.shaft("a", inertia=1.0)
    d.add(
        cw.Brake("b", shaft=a, friction=cw.Coulomb(static=0.4, kinetic=0.3), gain=1.0, normal_force=100.0, locked=True)
    )
    d.add(cw.Torque("m", shaft=a, torque=20.0))
    sim = cw.Simulator(d)
    sim.advance(0.5)
    assert sim["b.state"] == "locked"
    with pytest.raises(cw.ModelError, match="below the kinetic coefficient"):
        sim.set("b.friction.static", 0.1)
    sim.set({"b.friction.static": 0.15, "b.friction.kinetic": 0.1})
    sim.advance(0.5)
    event = sim.events[-1]
    assert (event.time, event.before, event.after, event.cause) == (0.5, "locked", "forward", "input")
    assert sim["a.speed"] == pytest.approx(0.5 * (20.0 - 10.0), rel=1e-6)
    sim.release("b.friction.static", "b.friction.kinetic")
    sim.advance(0.5)
    assert sim["b.state"] == "locked" or sim["a.speed"] < 5.0


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("a.inertia", 2.0, "is an inertia: changing it would create kinetic energy"),
        ("a.speed", 2.0, "is an initial value, and the run has started"),
        ("k.stiffness", 60.0, "determines the energy that the element stores"),
        ("k.initial_twist", 0.1, "is an initial value"),
        ("c.tolerance", 0.1, "says when a contact may lock"),
        (
            "c.friction",
            cw.Coulomb(static=0.4, kinetic=0.3),
            "is a signal over time, or|must be a number|another friction law",
        ),
        ("c.pressure", cw.Ramp(height=1.0, duration=1.0), "must be a number"),
        ("c.pressure", float("nan"), "must be finite"),
        ("c.pressure", None, "has no value"),
        ("c.pressure", "3 N", "has a unit that does not fit"),
        ("c.gain", -1.0, "must be > 0"),
        ("c.gain", "1e-3 Pa", "has a unit that does not fit"),
        ("c.gian", 1.0, "did you mean 'c.gain'"),
        ("c.presure", 1.0, "did you mean 'c.pressure'"),
        (3, 1.0, "neither a signal nor a parameter"),
        ("m", 1.0, "neither a signal nor a parameter"),
    ],
)
def test_what_cannot_be_set_is_refused_with_the_reason(name: Any, value: Any, words: str) -> None:
    sim = cw.Simulator(clutch())
    sim.advance(0.1)
    row = sim.save().row
    with pytest.raises((cw.ModelError, cw.UseError), match=words):
        sim.set(name, value)
    assert sim.held == {}
    assert sim.save().row == row


def test_all_mistakes_are_told_at_once_and_nothing_is_set() -> None:
    sim = cw.Simulator(clutch())
    with pytest.raises(cw.ModelError) as caught:
        sim.set({"c.pressure": 2e5, "a.inertia": 2.0, "c.gian": 3.0, "m.torque": "fast", "k.stiffness": 3.0})
    told = str(caught.value)
    assert all(word in told for word in ("a.inertia", "c.gian", "m", "k.stiffness")), told
    assert "4 problems" in told
    assert sim.held == {}
    assert sim["c.pressure"] == 1e5


def test_values_may_have_units_and_be_written_by_index() -> None:
    sim = cw.Simulator(clutch())
    sim["c.pressure"] = "2 bar"
    sim.set({"c.gain": "2000 cm3", "m.torque": np.float32(3.0), "k.damping": 2})
    assert sim.held == pytest.approx({"c.pressure": 2e5, "m.torque": 3.0, "c.gain": 2e-3, "k.damping": 2})


def test_a_signal_that_another_element_gives_is_set_there() -> None:
    d = cw.Driveline("actuator")
    a, b = d.shaft("a", inertia=1.0, speed=50.0), d.shaft("b", inertia=1.0)
    pedal = d.add(cw.PressureActuator("pedal", command=1e5, lag=0.03))
    d.add(cw.Clutch("c", base=a, follower=b, friction=cw.Coulomb(static=0.3, kinetic=0.2), gain=1e-3, pressure=pedal))
    sim = cw.Simulator(d)
    with pytest.raises(cw.ModelError, match=r"c.pressure: is given by 'pedal'; set 'pedal.command'"):
        sim.set("c.pressure", 1e5)
    sim.set("pedal.command", 3e5)
    sim.advance(0.5)
    assert sim["c.pressure"] == pytest.approx(3e5, rel=1e-4)


def test_a_sleeve_is_commanded_for_all_its_parts() -> None:
    from clutchwork import Synchroniser

    sim = simulator(Synchroniser)
    sim.set("x.command", 0.5)
    sim.advance(0.1)
    assert sim["x.forward_cone.normal_force"] == sim["x.forward_dog.command"] == 0.5


def test_prescribed_speeds_jump_as_steps_of_a_table_do() -> None:
    d = cw.Driveline("prescribed")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.PrescribedSpeed("motor", shaft=a, speed=10.0))
    friction = cw.Coulomb(static=0.3, kinetic=0.25)
    d.add(cw.Clutch("c", base=a, follower=b, friction=friction, gain=1.0, normal_force=100.0))
    sim = cw.Simulator(d)
    sim.advance(1.0)
    sim.set("motor.speed", 20.0)
    sim.advance(0.2)
    step = cw.Table([(0.0, 10.0), (1.0, 10.0), (1.0, 20.0), (2.0, 20.0)])
    whole = cw.simulate(d.assemble().changed({"motor.speed": step}), 1.2)
    assert sim["b.speed"] == pytest.approx(whole["b.speed"][-1], rel=1e-9)
    assert [(e.time, e.after) for e in sim.events.changes()] == [(e.time, e.after) for e in whole.events.changes()]
    assert abs(sim.run.energy.residual) < 1e-6 * sim.run.energy.turnover


def test_parameters_are_part_of_a_state() -> None:
    model = describe(7).driveline()
    sim = cw.Simulator(model)
    sim.advance(0.5)
    sim.set({"c0.gain": 1e-4, "c0.pressure": 3e5})
    sim.advance(0.1)
    other = cw.Simulator(model, start=sim.save())
    assert other.held == sim.held
    for one in (sim, other):
        one.set("c0.gain", 2e-4)
        one.advance(0.3)
        one.release()
        one.advance(0.3)
    assert sim.save().row == other.save().row
    assert sim.held == other.held == {}


@pytest.mark.parametrize("cls", ELEMENTS, ids=lambda cls: cls.kind)
def test_a_result_is_told_as_one_and_every_name_of_an_advice_is_known(cls: Any) -> None:
    """What follows from the motion is none that could be set; what is said to be settable is known."""
    sim = simulator(cls)
    source = sim._system.source
    changeable = set(all_names(source))
    results = set(sim.run.names) - changeable - set(sim._outside.signals) - {link.name for link in sim._system.links}
    assert results
    for name in results:
        (problem,) = problems(sim, name, 1.0)
        if name.removesuffix("_signal") in set(sim._outside.signals) - {name}:
            assert problem.remedy == f"set {name.removesuffix('_signal')!r}"
            continue
        assert problem.message.startswith("is a result, which follows from the motion"), name
        assert "did you mean" not in problem.message
        unknown = set(QUOTED.findall(problem.message.partition("what can be set of ")[2])[1:])
        assert unknown <= changeable | set(sim._outside.signals), name
        with pytest.raises(cw.ModelError) as caught:
            sim._system.changed({name: 1.0})
        advice = caught.value.problems[0].message.partition("what can be set of ")[2]
        assert set(QUOTED.findall(advice)[1:]) <= changeable


def test_what_of_a_clutch_can_be_set_is_named() -> None:
    d = cw.Driveline("pair")
    a, b = d.shaft("a", inertia=1.0, speed=5.0), d.shaft("b", inertia=1.0)
    d.add(cw.Clutch("F1", base=a, follower=b, pressure=0.0, gain=1e-4, friction=cw.Coulomb(static=0.3, kinetic=0.2)))
    d.add(cw.Torque("load", shaft=b, torque=1.0))
    names = "what can be set of 'F1': 'F1.pressure', 'F1.friction', 'F1.gain'"
    (problem,) = problems(cw.Simulator(d), "F1.torque", 3.0)
    assert problem.message.startswith("is a result")
    assert names in problem.message
    with pytest.raises(cw.ModelError) as caught:
        d.assemble().changed({"F1.slip": 3.0})
    assert names in str(caught.value)
    assert "results, which follow from the motion" in str(caught.value)
    for wrong, right in (
        ("F1.presure", "F1.pressure"),
        ("F2.gain", "F1.gain"),
        ("F1.friction.kinetc", "F1.friction.k"),
    ):
        (problem,) = problems(cw.Simulator(d), wrong, 1.0)
        assert f"did you mean '{right}" in problem.message


@pytest.mark.parametrize("value", [np.float32(3e-4), np.float64(3e-4), np.int64(1)])
def test_parameters_may_be_numbers_of_numpy(value: Any, tmp_path: Path) -> None:
    """A state holds them in its file."""
    sim = cw.Simulator(clutch())
    sim.set("c.gain", value)
    sim.advance(0.1)
    sim.save().save(tmp_path / "a.state")
    other = cw.Simulator(clutch(), start=cw.State.load(tmp_path / "a.state"))
    assert other.held == sim.held == {"c.gain": value}
    assert other.save().row == sim.save().row

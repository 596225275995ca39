"""Rows of a run that is done are finite; a run that leaves the numbers says so, with what, how large and when."""

from __future__ import annotations

import re
import warnings
from dataclasses import astuple, replace
from typing import Any

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

import clutchwork as cw
from clutchwork.declare.schema import REGISTRY, Role, specs
from support import samples
from support.amount import amount, part

# of every kind: some sixty kinds make some 700 models in `make test`
EXAMPLES = max(part(12), amount() // 25)

SIZES = (1e-300, 1e-150, 1e-30, 1e-9, 0.5, 1e3, 1e9, 1e30, 1e150, 1e200, 1e300, 1e308)
EXTREME = st.sampled_from([*SIZES, *(-size for size in SIZES), 0.0])
BUDGET: dict[str, Any] = {"max_steps": 400, "max_events": 100}


def assert_finite_or_said(model: cw.Driveline | cw.System, **options: Any) -> cw.Trajectory:
    """Run, and hold the run to its word."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.StoppedEarly)
        warnings.simplefilter("ignore", cw.FaultWarning)
        run = cw.simulate(model, 0.3, **BUDGET | options)
    assert np.isfinite(run.rows).all(), run.message
    assert np.isfinite(run.time).all()
    if run.finished:
        with np.errstate(all="ignore"):
            signals = {name: run[name] for name in run.names if not name.endswith(".state")}
        assert [name for name, values in signals.items() if not np.isfinite(values).all()] == []
        assert all(np.isfinite(astuple(event)[5:]).all() for event in run.events)
    if run.status == "not_finite":
        names = {part.rpartition(".")[0] or part for part in run.names} | {item.name for item in run.system.nodes}
        assert re.match(r"stopped at \S+ s: a value is not finite", run.message)
        assert any(name in run.message for name in names), run.message
        assert re.search(r"(nan|inf|\de[+-]?\d|\d)", run.message.partition("finite")[2]), run.message
    return run


def _signal(draw: Any) -> Any:
    size = draw(EXTREME)
    made = [
        size,
        cw.Sine(amplitude=size, frequency=draw(st.sampled_from([1e-3, 3.0, 1e3])), offset=draw(EXTREME)),
        cw.Step(height=size, start=0.1),
        cw.Ramp(height=size, duration=0.2),
        cw.Table([(0.0, 1.0), (0.15, size), (0.3, draw(EXTREME))]),
    ]
    return draw(st.sampled_from(made))


def _changed(draw: Any, component: Any) -> Any:
    """One to three numbers of a component are extreme, within their bounds."""
    found = [
        (item.name, spec)
        for item, spec in specs(type(component), "param", "signal")
        if not spec.choices and not spec.flag and not spec.whole
    ]
    for name, spec in draw(st.lists(st.sampled_from(found), max_size=3)) if found else ():
        if spec.what == "signal":
            component = replace(component, **{name: _signal(draw)})
            continue
        size = draw(EXTREME)
        if spec.allows(size):
            component = replace(component, **{name: size})
    return component


@st.composite
def pairs(draw: Any, kind: str, role: Role) -> cw.Driveline:
    """A driveline with one element of a kind, or a clutch with a law of a kind, and extreme numbers."""
    d = cw.Driveline(kind)
    speeds = st.sampled_from([0.0, 1.0, -30.0, 1e30, 1e150, 1e200, -1e308])
    inertias = st.sampled_from([1e-300, 1e-30, 1e-3, 1.0, 1e30, 1e150, 1e308])
    nodes: dict[str, Any] = {
        "rotation": d.shaft("a", inertia=draw(inertias), speed=draw(speeds)),
        "other": d.shaft("b", inertia=draw(inertias), speed=draw(speeds)),
        "plates": d.thermal("plates", capacity=draw(inertias)),
        "air": d.ambient("air", temperature=290.0),
    }
    third = d.shaft("c", inertia=0.2)
    nodes["translation"] = d.mass("m", mass=draw(inertias))
    if role is Role.LAW:
        law = _changed(draw, samples.law(REGISTRY[role][kind]))
        d.add(cw.Torque("push", shaft=nodes["rotation"], torque=_signal(draw)))
        ends = {"base": nodes["other"], "follower": nodes["rotation"]}
        d.add(_changed(draw, cw.Clutch("x", **ends, friction=law, gain=1.0, normal_force=3.0)))
        return d
    cls = REGISTRY[role][kind]
    values = samples.fields(cls, nodes)
    if "carrier" in values:
        values["carrier"] = third
    d.add(_changed(draw, cls("x", **values)))
    return d


KINDS = [(kind, role) for role in (*samples.ELEMENT_ROLES, Role.LAW) for kind in REGISTRY[role]]


@pytest.mark.filterwarnings("ignore::clutchwork.ModelWarning")
@pytest.mark.parametrize(("kind", "role"), KINDS, ids=[kind for kind, _ in KINDS])
@settings(max_examples=EXAMPLES, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_rows_of_every_element_and_law_are_finite(kind, role, data):
    try:
        system = data.draw(pairs(kind, role)).assemble()
    except cw.ModelError:
        # what cannot be assembled has no rows
        return
    output = data.draw(st.sampled_from([{"dt": 0.01}, {"output": "steps"}, {"times": [0.3]}, {}]))
    assert_finite_or_said(system, method=data.draw(st.sampled_from(["rodas5p", "dopri5"])), **output)


def _clutch(**changes: Any) -> cw.Driveline:
    d = cw.Driveline("clutch")
    a = d.shaft("a", inertia=changes.get("inertia", 1.0), speed=changes.get("speed", 0.0))
    b = d.shaft("b", inertia=2.0)
    law = cw.Coulomb(static=0.2, kinetic=0.1)
    force = changes.get("force", 10.0)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=changes.get("gain", 1.0), normal_force=force))
    d.add(cw.Torque("t", shaft=a, torque=cw.Sine(amplitude=changes.get("amplitude", 1.0), frequency=3.0)))
    d.add(cw.Spring("k", base=d.housing, follower=b, stiffness=changes.get("stiffness", 50.0)))
    return d


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"gain": 1e308, "force": 1e308}, "c"),
        ({"speed": 1e200}, "a.speed"),
        ({"inertia": 1e-300}, None),
        ({"stiffness": 1e308, "speed": 1e3}, None),
        ({"amplitude": 1e308}, None),
        ({"force": cw.Ramp(height=1e308, duration=1e-3), "gain": 1e10}, "c"),
    ],
)
def test_what_leaves_the_numbers_is_named(changes, named):
    run = assert_finite_or_said(_clutch(**changes))
    if named is not None:
        assert run.status == "not_finite"
        assert named in run.message


def test_the_last_finite_rows_are_kept():
    d = _clutch(gain=1.0, force=cw.Step(height=1e308, start=0.25), amplitude=1.0)
    law = cw.Coulomb(static=1e5, kinetic=1e5)
    d.add(cw.Brake("more", shaft=d.nodes[0], friction=law, gain=1e5, normal_force=d.elements[0].normal_force))
    run = assert_finite_or_said(d, dt=0.01)
    assert run.status == "not_finite"
    assert 0.2 <= run.time[-1] <= 0.25
    assert run.message.startswith("stopped at 0.2")

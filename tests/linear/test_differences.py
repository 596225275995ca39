"""Linear systems against central differences of what the core does after a small push, in all states of many runs."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.schema import Role, specs
from clutchwork.linear.instant import instant_of
from support import random_contacts, random_drivelines, random_large, samples
from support.amount import seeds
from support.perturbed import Standing, mismatch

# differences over a part h = 1e-5 of each size miss h^2 times third derivatives, and round-off over h is 1e-11
CLOSE = 1e-6

# of each random driveline
INSTANTS = np.linspace(0.013, 1.987, 9)


@pytest.mark.parametrize("seed", seeds(24))
def test_random_drivelines_in_all_their_states(seed):
    run = random_drivelines.describe(seed).driveline().simulate(random_drivelines.T_END)
    for at in INSTANTS:
        standing = Standing(instant_of(run, at))
        locked = int(np.sum(standing.instant.modes == 0))
        speeds = [state for state in standing.linear.states if state.name.endswith(".speed")]
        assert len(speeds) == len(run.system.nodes) - locked
        assert mismatch(standing) < CLOSE, at


@pytest.mark.parametrize("seed", seeds(60))
def test_random_contacts_with_loops_and_freewheels(seed):
    run = random_contacts.driveline(seed).simulate(random_contacts.T_END)
    for at in (0.017, 0.26, 0.502, 0.744, 0.987):
        # one that has failed would be whole again in the pushed system
        if not any(event.cause == "fault" and event.time <= at for event in run.events):
            assert mismatch(Standing(instant_of(run, at))) < CLOSE, at


@pytest.mark.parametrize("seed", seeds(6))
def test_many_speeds_with_gears_and_prescribed_speeds(seed):
    run = random_large.driveline(seed).simulate(random_large.T_END)
    for at in (0.017, 0.487):
        assert mismatch(Standing(instant_of(run, at))) < CLOSE, at


def moving(cls: Any) -> cw.Driveline:
    """The sample of a class, its shafts turning apart where its gears let them."""
    d = samples.driveline(cls)
    speeds = {"a": 31.0, "b": 7.0, "c": 12.0, "m": 3.0}
    turning = cw.Driveline(d.name)
    nodes: dict[str, Any] = {}
    for name, speed in speeds.items():
        old = next(node for node in d.nodes if node.name == name)
        make = turning.mass if name == "m" else turning.shaft
        size = {"mass" if name == "m" else "inertia": old.inertia}
        nodes[name] = make(name, speed=speed, **size)
    nodes = {
        "rotation": nodes["a"],
        "other": nodes["b"],
        "translation": nodes["m"],
        "third": nodes["c"],
        "plates": turning.thermal("plates", capacity=800.0, temperature=320.0),
        "air": turning.ambient("air", temperature=290.0),
    }
    values = samples.fields(cls, nodes)
    # constant signals between the bounds at which elements cut them off
    for item, spec in specs(cls, "signal"):
        if item.name in values and not spec.bound and spec.unit != "K":
            values[item.name] = 0.37 * (spec.example or (3e5 if spec.unit == "Pa" else 2.0))
    if "carrier" in values:
        values["carrier"] = nodes["third"]
    # two sides want two shafts
    values |= {name: nodes["other"] for name in ("turbine", "forward") if isinstance(values.get(name), cw.Node)}
    # a piston at its stop can be pushed one way alone
    values |= {"pressures": {"A": 4e5}} if cls is cw.ValveBody else {}
    turning.add(cls("x", **values))
    return d if turning.check() else turning


# the slope of a road follows from its position and cannot be pushed; friction at its limit can be pushed one way alone
NOT_SMOOTH = (cw.Road, cw.JenkinsElement)
SMOOTH = [cls for cls in samples.declared(*samples.ELEMENT_ROLES) if cls not in NOT_SMOOTH]


@pytest.mark.parametrize("cls", SMOOTH, ids=lambda cls: cls.__name__)
def test_every_element(cls):
    # a torque that grows with the square of the speed is infinite after a millisecond
    end = 6e-4 if cls is cw.QuadraticTorque else 0.4
    run = moving(cls).simulate(end)
    for at in (0.1 * end, 0.5 * end, 0.9 * end):
        standing = Standing(instant_of(run, at))
        assert mismatch(standing) < CLOSE, at


def rubbing(law: cw.Law) -> cw.Driveline:
    """Two discs and a contact with a law, whose load swings and whose plates get warm."""
    d = cw.Driveline(type(law).__name__)
    a, b = d.shaft("a", inertia=0.3, speed=30.0), d.shaft("b", inertia=0.7, speed=5.0)
    plates = d.thermal("plates", capacity=800.0, temperature=300.0)
    force = cw.Sine(amplitude=20.0, frequency=3.0, offset=100.0)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1.0, normal_force=force, heat=plates))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=2.0, frequency=5.0, offset=4.0)))
    return d


LAWS = samples.declared(Role.LAW)


@pytest.mark.parametrize("cls", LAWS, ids=lambda cls: cls.__name__)
def test_every_law(cls):
    run = samples_run(cls)
    for at in (0.05, 0.2, 0.4):
        standing = Standing(instant_of(run, at))
        # at steady slip the bristles of this law stand where its curve changes its second derivative
        bends = cls is cw.ElastoPlastic
        assert mismatch(standing, 1e-8 if bends else 1e-5) < (1e-5 if bends else CLOSE), at


@cache
def samples_run(cls: Any) -> Any:
    return rubbing(samples.law(cls)).simulate(0.5)

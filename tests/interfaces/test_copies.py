"""Drivelines, Systems and Trajectories as pickles, deep copies and in process pools: the same bits afterwards."""

from __future__ import annotations

import copy
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import numpy as np
import pytest
from tests.support import random_drivelines, samples

import clutchwork as cw
from clutchwork.declare.schema import REGISTRY, Role

COPIES = {
    **{f"pickle {p}": lambda thing, p=p: pickle.loads(pickle.dumps(thing, p)) for p in range(2, 6)},
    "deepcopy": copy.deepcopy,
    "copy": copy.copy,
}


def steady(time: float, signals: Any) -> float:
    """A controller that pickle finds by its name."""
    return 3.0 + 0.1 * float(signals["a.speed"]) - time


def controlled() -> cw.Driveline:
    d = cw.Driveline("controlled")
    a, b = d.shaft("a", inertia=1.0, speed=4.0), d.shaft("b", inertia=0.5)
    d.add(cw.Torque("t", shaft=a, torque=cw.Sampled(steady, period=0.05)))
    law = cw.Stribeck(static=0.3, kinetic=0.2, speed=1.0)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1.0, normal_force=cw.Ramp(height=9.0, duration=0.5)))
    d.add(cw.Brake("hold", shaft=b, friction=law, gain=1.0, normal_force=2.0))
    return d


def same_run(one: cw.Trajectory, other: cw.Trajectory) -> None:
    assert one.time.tobytes() == other.time.tobytes()
    assert one.rows.tobytes() == other.rows.tobytes()
    assert one.events == other.events
    assert one.names == other.names
    assert one.status == other.status
    for name in one.names:
        assert np.asarray(one[name]).tobytes() == np.asarray(other[name]).tobytes(), name


def models() -> list[cw.Driveline]:
    return [controlled(), *(random_drivelines.describe(seed).driveline() for seed in (3, 5))]


@pytest.mark.parametrize("way", COPIES)
def test_a_copied_system_runs_to_the_same_bits(way):
    for model in models():
        system = model.assemble()
        copied = COPIES[way](system)
        assert copied.to_bytes() == system.to_bytes()
        assert not copied.mass.flags.writeable
        with pytest.raises(TypeError):
            copied.arrays["mass"] = None
        same_run(cw.simulate(system, 0.6), cw.simulate(copied, 0.6))


@pytest.mark.parametrize("way", COPIES)
def test_a_copied_driveline_is_the_same_model(way):
    for model in models():
        copied = COPIES[way](model)
        assert copied.check() == model.check() == []
        assert copied.assemble().to_bytes() == model.assemble().to_bytes()
        assert copied.housing is model.housing
        same_run(model.simulate(0.6), copied.simulate(0.6))


@pytest.mark.parametrize("way", COPIES)
def test_a_copied_trajectory_answers_as_before(way):
    for model in models():
        run = model.simulate(0.6)
        run["a.speed" if "a.speed" in run else "s0.speed"]
        copied = COPIES[way](run)
        same_run(run, copied)
        assert copied.units == run.units
        assert copied.energy == run.energy
        assert copied.statistics == run.statistics
        assert copied.options == run.options
        same_run(run.at([0.1, 0.123, 0.6]), copied.at([0.1, 0.123, 0.6]))


@pytest.mark.parametrize("way", COPIES)
def test_there_is_one_housing(way):
    d = cw.Driveline("fixed")
    spring: Any = d.add(cw.Spring("k", base=d.housing, follower=d.shaft("a", inertia=1.0), stiffness=9.0))
    copied: Any = COPIES[way](d).elements[0]
    assert copied.base is spring.base is d.housing


def test_a_deep_copy_shares_nothing_that_changes():
    d = controlled()
    copied = copy.deepcopy(d)
    copied.shaft("more", inertia=1.0)
    assert [node.name for node in d.nodes] == ["a", "b"]
    run = d.simulate(0.2)
    other = copy.deepcopy(run)
    assert not np.shares_memory(run.rows, other.rows)


@pytest.mark.parametrize(("role", "kind"), [(role, kind) for role in samples.ELEMENT_ROLES for kind in REGISTRY[role]])
def test_every_element_is_copied(role, kind):
    d = samples.driveline(REGISTRY[role][kind])
    for way, make in COPIES.items():
        copied = make(d)
        assert copied.elements == d.elements, way
        assert copied.nodes == d.nodes, way
    system = d.assemble()
    run = cw.simulate(system, 0.02)
    made = pickle.loads(pickle.dumps((d, system, run)))
    assert made[1].to_bytes() == system.to_bytes()
    same_run(run, made[2])
    same_run(run, cw.simulate(made[1], 0.02))


@pytest.mark.parametrize("kind", REGISTRY[Role.LAW])
def test_every_law_is_copied(kind):
    law = samples.law(REGISTRY[Role.LAW][kind])
    for make in COPIES.values():
        assert make(law) == law


@pytest.mark.parametrize("kind", REGISTRY[Role.SIGNAL])
def test_every_signal_is_copied(kind, tmp_path):
    cls: Any = REGISTRY[Role.SIGNAL][kind]
    if kind == "sampled":
        signal = cls(steady, period=0.1)
    elif kind == "column":
        path = tmp_path / "made.csv"
        path.write_text("time,x\n0,1\n1,2\n")
        signal = cls(str(path), column="x")
    elif kind == "table":
        signal = cls([(0.0, 1.0), (1.0, 2.0)])
    else:
        signal = cls(**samples.fields(cls, {}))
    for make in COPIES.values():
        assert make(signal) == signal


def test_a_function_without_a_name_cannot_be_pickled_but_copied():
    d = cw.Driveline("lambda")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=cw.Sampled(lambda t, s: 1.0, period=0.1)))
    run = copy.deepcopy(d).simulate(0.5)
    same_run(run, copy.deepcopy(run))
    with pytest.raises((pickle.PicklingError, AttributeError), match="lambda"):
        pickle.dumps(d)


def _run(system: cw.System) -> cw.Trajectory:
    return cw.simulate(system, 0.6)


def test_process_pools_give_the_same_bits():
    systems = [model.assemble() for model in models()]
    with ProcessPoolExecutor(max_workers=1, mp_context=get_context("spawn")) as pool:
        runs = list(pool.map(_run, systems))
    for system, run in zip(systems, runs, strict=True):
        same_run(run, cw.simulate(system, 0.6))


def test_errors_with_a_trajectory_can_be_sent_on():
    d = controlled()
    with pytest.warns(cw.StoppedEarly) as caught:
        d.simulate(1.0, max_steps=20)
    warning = caught[0].message
    copied = pickle.loads(pickle.dumps(warning))
    assert str(copied) == str(warning)
    same_run(copied.trajectory, warning.trajectory)
    error = cw.SimulationError("why", warning.trajectory)
    same_run(pickle.loads(pickle.dumps(error)).trajectory, warning.trajectory)

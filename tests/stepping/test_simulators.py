"""Many runs side by side have the bits of single ones, whatever the others do. docs/guide/stepping.md"""

from __future__ import annotations

import signal
import threading
import warnings
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.any_model import model

STEP = 7e-3  # s
STEPS = 12


def joint(**gear: Any) -> cw.Driveline:
    """A rotor with a seal that sticks, a gear with losses, a flexible shaft, a link."""
    d = cw.Driveline("joint")
    rotor, flange = d.shaft("rotor", inertia=1.5e-4), d.shaft("flange", inertia=0.02)
    link = d.shaft("link", inertia=0.6)
    d.add(cw.Torque("motor", shaft=rotor, torque=0.0))
    stiction = cw.Stribeck(static=0.03, kinetic=0.02, speed=2.0)
    d.add(cw.Brake("seal", shaft=rotor, friction=stiction, gain=1.0, normal_force=1.0))
    d.add(cw.LossyGear("gear", input=rotor, output=flange, **{"ratio": 100.0, "efficiency": 0.7, **gear}))
    d.add(cw.SpringDamper("spring", base=flange, follower=link, stiffness=8000.0, damping=8.0))
    return d


def overloaded() -> cw.Driveline:
    """A shaft that a torque drives beyond any number once it is large."""
    d = cw.Driveline("overloaded")
    a = d.shaft("a", inertia=1e-3)
    d.add(cw.Torque("motor", shaft=a, torque=0.0))
    grip = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Brake("grip", shaft=a, friction=grip, gain=1.0, normal_force=0.0))
    return d


@pytest.mark.parametrize("seed", range(9100, 9140))
def test_random_drivelines_have_the_bits_of_single_ones(seed: int) -> None:
    """Models of every kind, three runs each, of which the second is set to other values."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        driveline = cw.Driveline.from_dict(model.model(seed))
        system = driveline.assemble()
        settings = {key: value for key, value in driveline.simulation.items() if key in ("rtol", "method", "t_start")}
        try:
            alone = [cw.Simulator(system, **settings) for _ in range(3)]
        except (cw.ClutchworkError, ValueError):
            pytest.skip("a model that cannot be stepped")
        if any(item.signal.sampling() for item in system.inputs):
            pytest.skip("functions of Python are not called side by side")
        sims = cw.Simulators(system, 3, threads=2, **settings)
        names = [name for name, unit in alone[0].units.items() if unit]
        signals = [item.name for item in system.inputs if item.name in names][:2]
        for k in range(STEPS):
            if k == STEPS // 2:
                for name in signals:
                    value = 0.9 * alone[1][name]
                    alone[1].set(name, value)
                    sims.set(name, [value], which=[1])
            sims.advance(STEP)
            for number, one in enumerate(alone):
                try:
                    one.advance(STEP)
                except cw.SimulationError:
                    assert sims.failed[number]
            if sims.failed.any():
                break
            assert sims.time.tolist() == [one.time for one in alone]
            np.testing.assert_array_equal(sims[names], [one[names] for one in alone])


@pytest.mark.parametrize("threads", [1, 3])
def test_fixed_steps_have_the_bits_of_single_ones(threads: int) -> None:
    """Each with torques of its own, of which some leave the seal at rest; two of them begin anew on the way."""
    system, count, scatter = joint().assemble(), 40, np.random.default_rng(3)
    options: dict[str, Any] = {"method": "fixed", "step": 1e-3}
    sims = cw.Simulators(system, count, threads=threads, **options)
    alone = [cw.Simulator(system, **options) for _ in range(count)]
    for k in range(30):
        if k == 15:
            sims.reset([4, 30])
            alone[4].reset(), alone[30].reset()
        torques = scatter.uniform(-0.06, 0.06, count)
        sims["motor.torque"] = torques
        for one, torque in zip(alone, torques.tolist(), strict=True):
            one.set("motor.torque", torque)
            one.advance(1e-3)
        sims.advance(1e-3)
        names = ["rotor.speed", "link.speed", "spring.torque", "gear.heat", "link.angle", "rotor.acceleration"]
        np.testing.assert_array_equal(sims[names], [one[names] for one in alone])
    assert not sims.failed.any()


def test_a_signal_that_is_set_alone_leaves_the_others_where_they_are() -> None:
    """With fixed steps: beside a table with knots and a wave, and as where others are set with it to what they were."""
    d = joint()
    knots = cw.Table([(0.0, 0.0), (0.0035, 3.0), (0.006, -2.0), (0.0105, 1.0)])
    d.add(cw.Torque("load", shaft=d.shafts[2], torque=knots))
    d.add(cw.Torque("shaker", shaft=d.shafts[1], torque=cw.Sine(amplitude=2.0, frequency=40.0)))
    alone, among = (cw.Simulators(d, 3, method="fixed", step=1e-3) for _ in range(2))
    scatter = np.random.default_rng(5)
    for _ in range(20):
        torques = scatter.uniform(-0.3, 0.3, 3)
        alone["motor.torque"] = torques
        among.set({"motor.torque": torques, "seal.normal_force": 1.0})
        alone.advance(1e-3)
        among.advance(1e-3)
        names = ["rotor.speed", "link.speed", "load.torque", "shaker.torque", "motor.torque", "seal.capacity"]
        np.testing.assert_array_equal(alone[names], among[names])
    assert len(set(alone["load.torque"])) == 1
    assert alone["load.torque"][0] == 1.0


def test_what_varies_is_that_of_a_changed_system() -> None:
    system, count = joint().assemble(), 20
    inertias, ratios = np.linspace(0.3, 0.9, count), np.tile([80.0, 100.0], count // 2)
    sims = cw.Simulators(system, count, vary={"link.inertia": inertias, "gear.ratio": ratios})
    torques = np.linspace(-0.4, 0.4, count)
    sims["motor.torque"] = torques
    sims.advance(0.05)
    for number in (0, 7, 19):
        one = cw.Simulator(system.changed({"link.inertia": inertias[number], "gear.ratio": ratios[number]}))
        one.set("motor.torque", float(torques[number]))
        one.advance(0.05)
        for name in ("link.speed", "gear.torque", "gear.heat", "spring.torque"):
            assert sims[name][number] == one[name], name


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_threads_have_no_say(threads: int) -> None:
    found = []
    for chosen in (1, threads):
        sims = cw.Simulators(joint(), 40, threads=chosen)
        sims["motor.torque"] = np.linspace(-0.5, 0.5, 40)
        for _ in range(5):
            sims.advance(1e-3)
        found.append(sims[["link.speed", "rotor.speed"]])
    np.testing.assert_array_equal(*found)


def test_one_that_ends_leaves_the_others() -> None:
    """Its numbers are NaN until it begins anew."""
    sims, alone = cw.Simulators(overloaded(), 5), cw.Simulator(overloaded())
    sims["motor.torque"] = [1.0, 1.0, 1e308, 1.0, 1.0]
    alone.set("motor.torque", 1.0)
    for _ in range(3):
        sims.advance(0.5)
        alone.advance(0.5)
    assert sims.failed.tolist() == [False, False, True, False, False]
    assert "not finite" in sims.message(2) or "finite" in sims.message(2)
    assert sims.message(0) == ""
    assert np.isnan(sims["a.speed"]).tolist() == sims.failed.tolist()
    assert sims["grip.state"].tolist() == ["open", "open", "", "open", "open"]
    assert np.isnan(sims["grip.mode"]).tolist() == sims.failed.tolist()
    assert set(sims["a.speed"][~sims.failed]) == {alone["a.speed"]}
    assert sims.time[2] < sims.time[0]
    sims.reset(sims.failed)
    assert not sims.failed.any()
    assert sims.time.tolist() == [1.5, 1.5, 0.0, 1.5, 1.5]
    assert sims["a.speed"][2] == 0.0


def test_some_go_on_and_some_wait() -> None:
    sims = cw.Simulators(joint(), 4)
    sims.set("motor.torque", [0.2, 0.3], which=[3, 1])
    sims.advance(0.02, which=[1, 3])
    assert sims.time.tolist() == [0.0, 0.02, 0.0, 0.02]
    assert (np.abs(sims["rotor.speed"]) > 0.0).tolist() == [False, True, False, True]
    sims.reset([1])
    sims.advance(0.01)
    assert sims.time.tolist() == [0.01, 0.01, 0.01, 0.03]
    # a reset forgets what was set
    assert sims["rotor.speed"][1] == 0.0


def test_step_times_do_not_drift() -> None:
    sims = cw.Simulators(joint(), 2)
    for _ in range(100):
        sims.advance(0.01)
    assert sims.time.tolist() == [1.0, 1.0]


def test_a_state_is_that_of_a_single_run() -> None:
    system = joint().assemble()
    sims, alone = cw.Simulators(system, 3), cw.Simulator(system)
    sims["motor.torque"] = 0.3
    sims.advance(0.05)
    state = sims.save(1)
    sims.advance(0.05)
    alone.restore(state)
    alone.advance(0.05)
    assert alone["link.speed"] == sims["link.speed"][0]
    sims.restore(state, which=[2])
    assert sims.time.tolist() == [0.1, 0.1, 0.05]
    sims.advance(0.05, which=[2])
    assert len(set(sims["link.speed"])) == 1
    begun = cw.Simulators(system, 2, start=state)
    begun.advance(0.05)
    assert set(begun["link.speed"]) == {alone["link.speed"]}
    begun.reset()
    assert begun.time.tolist() == [0.05, 0.05]


def test_events_are_those_of_the_last_step() -> None:
    sims = cw.Simulators(joint(), 3)
    sims.advance(0.01)
    sims.set("motor.torque", 0.5, which=[1])
    sims.advance(0.01)
    assert list(sims.events) == [1]
    assert [event.element for event in sims.events[1]] == ["seal", "gear"]
    sims.advance(0.01)
    assert sims.events == {}


def test_bounds_are_those_of_the_model() -> None:
    d = joint()
    plate = d.thermal("plate", capacity=100.0)
    d.add(cw.Convection("cooling", hot=plate, cold=d.ambient("air"), conductance=5.0))
    sims = cw.Simulators(d, 3)
    with pytest.raises(cw.ModelError, match="air"):
        sims["air.temperature"] = [280.0, 300.0, -5.0]
    assert sims["air.temperature"].tolist() == [300.0, 300.0, 300.0]
    sims["air.temperature"] = [280.0, 300.0, 320.0]
    sims.advance(1.0)
    assert (np.diff(sims["plate.temperature"]) > 0.0).all()


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda sims: sims.set("motor.torqe", 1.0), "did you mean 'motor.torque'"),
        (lambda sims: sims.set("motor.torque", [1.0, 2.0]), "give one number, or an array of 3 numbers"),
        (lambda sims: sims.set("motor.torque", [1.0, 2.0, float("nan")]), "finite"),
        (lambda sims: sims.set("motor.torque"), "one name and its values"),
        (lambda sims: sims.set({"motor.torque": 1.0}, 2.0), "values by name, or one name"),
        (lambda sims: sims.set("link.inertia", 1.0), "give it by `vary`"),
        (lambda sims: sims.message(9), "give numbers from 0 to 2"),
        (lambda sims: sims.restore("x"), "give what sims.save"),
        (lambda sims: sims.advance(-1.0), "must not be negative"),
        (lambda sims: sims.advance(0.1, which=[0, 3]), "give numbers from 0 to 2"),
        (lambda sims: sims.advance(0.1, which=[0, 0]), "each once"),
        (lambda sims: sims["rotor.sped"], "did you mean 'rotor.speed'"),
        (lambda sims: cw.Simulators(joint(), 0), "count is 0"),
        (lambda sims: cw.Simulators(joint(), 3, vary={"link.inertia": [1.0]}), "give 3 values, one for each run"),
        (lambda sims: cw.Simulators(joint(), 2, vary={"link.inertia": [1.0, -1.0]}), "inertia"),
    ],
)
def test_wrong_calls_are_named(call: Any, words: str) -> None:
    sims = cw.Simulators(joint(), 3)
    with pytest.raises((cw.ClutchworkError, KeyError), match=words):
        call(sims)
    # nothing was set
    sims.advance(0.01)
    assert sims["rotor.speed"].tolist() == [0.0, 0.0, 0.0]


def test_an_interrupt_leaves_every_run_where_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those that no thread has begun have not got there."""
    d = cw.Driveline("shaken")
    a, b = d.shaft("a", inertia=0.1), d.shaft("b", inertia=0.1)
    d.add(cw.Torque("shaker", shaft=a, torque=cw.Sine(amplitude=1.0, frequency=50.0)))
    d.add(cw.SpringDamper("spring", base=a, follower=b, stiffness=1e4, damping=0.1))
    sims = cw.Simulators(d, 200, threads=1)
    threading.Timer(0.3, signal.raise_signal, [signal.SIGINT]).start()
    with pytest.raises(KeyboardInterrupt):
        sims.advance(100.0)
    assert sims.time.tolist() == [run.time for run in sims._runs]
    assert len(set(sims.time)) > 1
    assert not sims.failed.any()
    # none has a number that nobody wrote
    assert (sims["a.speed"] == [run.row()[0] for run in sims._runs]).all()


def test_runs_that_go_on_are_not_set() -> None:
    """Another thread meets a clear error, and what goes on is not touched."""
    sims = cw.Simulators(joint(), 64, threads=2)
    refused, end = 0, 0.0
    # as long as it takes for this thread to have its turn meanwhile
    while not refused and end < 1000.0:
        end += max(3.0, end)
        gone = threading.Thread(target=sims.advance, args=(end - sims.time[0],))
        gone.start()
        while gone.is_alive():
            try:
                sims["motor.torque"] = 0.1
            except RuntimeError as error:
                assert "between two calls of advance" in str(error)  # noqa: PT017, it need not come
                refused += 1
        gone.join()
    assert refused > 0
    np.testing.assert_allclose(sims.time, end, rtol=1e-9)

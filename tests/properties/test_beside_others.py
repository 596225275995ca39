"""Contacts, ratios and loads beside what acts on them: random models, whose rows and runs keep their laws."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.amount import amount

Rng = np.random.Generator
MODELS = 40


def uniform(rng: Rng, low: float, high: float) -> float:
    return float(rng.uniform(low, high))


def coulomb(rng: Rng) -> cw.Coulomb:
    kinetic = uniform(rng, 0.05, 0.1)
    return cw.Coulomb(static=kinetic * uniform(rng, 1.0, 1.5), kinetic=kinetic)


def sine(rng: Rng, size: float, low: float = -1.0) -> cw.Sine:
    return cw.Sine(
        amplitude=uniform(rng, 0.3, 1) * size, frequency=uniform(rng, 1, 8), offset=uniform(rng, low, 1) * size
    )


def pressed(rng: Rng) -> dict[str, Any]:
    return {"friction": coulomb(rng), "gain": 1.0, "normal_force": uniform(rng, 50, 1500)}


def tied(rng: Rng) -> cw.Driveline:
    """Two shafts tied by a transmission, contacts on both of them and between them."""
    d = cw.Driveline("tied")
    a, b = d.shaft("a", inertia=uniform(rng, 0.1, 2)), d.shaft("b", inertia=uniform(rng, 0.1, 2))
    if rng.random() < 0.5:
        d.add(cw.UniversalJoint("tie", base=a, follower=b, bend_angle=uniform(rng, 0.1, 0.6)))
    else:
        d.add(cw.VariableRatio("tie", input=a, output=b, ratio=uniform(rng, 0.3, 3)))
    kinds = rng.choice(["a", "b", "ab"], size=2, replace=False)
    for kind in kinds:
        if kind == "ab":
            d.add(cw.Clutch("on_ab", base=a, follower=b, **pressed(rng)))
        else:
            d.add(cw.Brake(f"on_{kind}", shaft=a if kind == "a" else b, **pressed(rng)))
    d.add(cw.Torque("load_a", shaft=a, torque=sine(rng, 30)))
    d.add(cw.Torque("load_b", shaft=b, torque=sine(rng, 30)))
    return d


def ports(run: Any, shaft: str) -> Any:
    """What acts on a shaft of `tied`."""
    names = {"a": ("tie.base.torque", "tie.input.torque"), "b": ("tie.follower.torque", "tie.output.torque")}[shaft]
    total = run[f"load_{shaft}.torque"] + next(run[name] for name in names if name in run.names)
    if f"on_{shaft}.torque" in run.names:
        total = total + run[f"on_{shaft}.torque"]
    if "on_ab.torque" in run.names:
        total = total + run["on_ab.torque"] * (-1 if shaft == "a" else 1)
    return total


@pytest.mark.parametrize("seed", range(MODELS))
def test_transmissions_balance_what_locked_contacts_share(seed):
    d = tied(np.random.default_rng(seed))
    run = d.simulate(0.4, output="steps")
    for shaft in "ab":
        inertia = {node.name: node.inertia for node in d.nodes}[shaft]
        miss = ports(run, shaft) - inertia * run[f"{shaft}.acceleration"]
        assert np.max(abs(miss)) <= 1e-7 * np.max(abs(run[f"load_{shaft}.torque"])), seed


@pytest.mark.parametrize("seed", range(MODELS))
def test_what_is_shared_turns_with_the_ratio(seed):
    """Two contacts hold both sides of a transmission whose ratio goes on: balanced at every ratio, zero included."""
    rng = np.random.default_rng([seed, 5])
    d = cw.Driveline("turned")
    a, b = d.shaft("a", inertia=uniform(rng, 0.1, 2)), d.shaft("b", inertia=uniform(rng, 0.1, 2))
    ratio = cw.Sine(amplitude=uniform(rng, 0.5, 3), frequency=uniform(rng, 2, 6), offset=uniform(rng, -1, 1))
    d.add(cw.VariableRatio("tie", input=a, output=b, ratio=ratio))
    strong = {"friction": coulomb(rng), "gain": 1.0, "normal_force": 5000.0}
    kinds = rng.choice(["a", "b", "ab"], size=2, replace=False)
    for kind in kinds:
        if kind == "ab":
            d.add(cw.Clutch("on_ab", base=a, follower=b, **strong))
        else:
            d.add(cw.Brake(f"on_{kind}", shaft=a if kind == "a" else b, **strong))
    d.add(cw.Torque("load_a", shaft=a, torque=sine(rng, 30)))
    d.add(cw.Torque("load_b", shaft=b, torque=sine(rng, 30)))
    run = d.simulate(0.4)
    for shaft in "ab":
        miss = ports(run, shaft) - {node.name: node.inertia for node in d.nodes}[shaft] * run[f"{shaft}.acceleration"]
        assert np.max(abs(miss)) <= 1e-6 * np.max(abs(run[f"load_{shaft}.torque"])), seed


@pytest.mark.parametrize("seed", range(MODELS))
def test_a_state_beside_a_transmission_goes_on_to_the_same_bits(seed):
    rng = np.random.default_rng(seed)
    d = tied(rng)
    d.add(cw.Torque("push", shaft=d.mass("apart", mass=1.0), torque=sine(rng, 1)))
    whole = d.simulate(0.2, output="steps")
    for at in rng.choice(np.unique(whole.time)[1:-1], 3):
        rest = d.simulate(0.2, start=whole.state(at=float(at)), output="steps")
        assert np.array_equal(rest.rows[-1], whole.rows[-1]), (seed, at)


@pytest.mark.parametrize("seed", range(MODELS))
def test_a_ratio_that_jumps_draws_its_energy_from_prescribed_speeds(seed):
    rng = np.random.default_rng(seed)
    d = cw.Driveline("jump")
    a, b, c = (d.shaft(name, inertia=uniform(rng, 0.1, 2)) for name in "abc")
    first, second = (a, b) if rng.random() < 0.5 else (b, a)
    # both signs of a ratio, and a set whose ring goes on where the carrier is prescribed
    jumps = [(0.03, uniform(rng, 0.3, 2)), (0.03, uniform(rng, 0.3, 2)), (0.06, uniform(rng, 0.3, 2))]
    d.add(cw.VariableGear("gear", input=first, output=second, ratio=cw.Table(jumps)))
    d.add(
        cw.Planetary("set", sun=b, carrier=d.housing if rng.random() < 0.3 else a, ring=c, ratio=uniform(rng, 1.5, 3))
    )
    d.add(cw.PrescribedSpeed("given", shaft=a, speed=uniform(rng, -5, 5)))
    energy = d.simulate(0.1, rtol=1e-10).energy
    assert abs(energy.residual) <= 1e-8 * energy.turnover, seed


@pytest.mark.parametrize("speed", [cw.Sine(amplitude=3.0, frequency=2.0), cw.Ramp(height=2.0, duration=0.3), 1.0])
def test_a_ratio_of_zero_against_a_motion_jams(speed):
    d = cw.Driveline("zero")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.VariableGear("gear", input=a, output=b, ratio=0.0))
    d.add(cw.PrescribedAcceleration("given", shaft=a, acceleration=speed))
    with pytest.warns(cw.StoppedEarly, match="break the ratio of a transmission at 'gear'"):
        run = d.simulate(0.2)
    assert run.status == "jammed"


@pytest.mark.parametrize("seed", range(MODELS))
def test_a_ratio_that_passes_zero_against_a_motion_jams(seed):
    """Where what is left of the row turns over: the run ends there and names the transmission."""
    rng = np.random.default_rng(seed)
    d = cw.Driveline("pole")
    a, b = d.shaft("a", inertia=uniform(rng, 0.1, 2)), d.shaft("b", inertia=uniform(rng, 0.1, 2))
    frequency, phase = uniform(rng, 3, 20), uniform(rng, 0.2, 6.1)
    ratio = cw.Sine(amplitude=uniform(rng, 1, 4), frequency=frequency, phase=phase)
    d.add(cw.VariableGear("gear", input=a, output=b, ratio=ratio))
    speed: Any = uniform(rng, 0.5, 5) * rng.choice([-1, 1])
    d.add(cw.PrescribedSpeed("given", shaft=a, speed=speed))
    with pytest.warns(cw.StoppedEarly, match="break the ratio of a transmission at 'gear'"):
        run = d.simulate(1.0, work=False)
    zero = np.ceil(phase / np.pi) * np.pi
    assert run.status == "jammed", seed
    assert run.time[-1] == pytest.approx((zero - phase) / (2 * np.pi * frequency), rel=1e-6), seed


@pytest.mark.parametrize("seed", range(MODELS))
def test_a_brake_that_stops_a_converter_on_both_sides(seed):
    """At rest there is no ratio of the speeds: round-off of them does not multiply the torque of the oil."""
    rng = np.random.default_rng(seed)
    d = cw.Driveline("stopped")
    a, b = d.shaft("a", inertia=uniform(rng, 0.5, 2)), d.shaft("b", inertia=uniform(rng, 0.01, 0.1))
    d.add(cw.UniversalJoint("joint", base=a, follower=b, bend_angle=uniform(rng, 0.05, 0.4)))
    d.add(
        cw.TorqueConverter(
            "converter",
            impeller=b,
            turbine=a,
            speed_ratio=(0.0, 0.4, 0.8, 0.9, 1.0),
            torque_ratio=(uniform(rng, 1.8, 2.5), 1.6, 1.08, 1.0, 1.0),
            capacity=(1e-4, 9.3e-5, 7e-5, 5e-5, 0.0),
            lag=uniform(rng, 0.01, 0.05),
            initial_torque=uniform(rng, -200, 200),
        )
    )
    force = uniform(rng, 5, 50)
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Brake("brake", shaft=a, friction=law, gain=1.0, normal_force=force, tolerance=2e-4))
    run = d.simulate(0.6)
    assert run.status == "done", seed
    assert np.all(abs(run["brake.torque"]) <= 0.1 * force * (1 + 1e-9)), seed
    rests = (run["a.speed"] == 0) & (abs(run["b.speed"]) < 1e-12)
    assert np.count_nonzero(rests) > 10, seed
    assert np.allclose(run["converter.turbine.torque"][rests], -run["converter.impeller.torque"][rests]), seed


@pytest.mark.parametrize("seed", range(MODELS))
def test_a_closed_stop_beside_contacts_without_capacity(seed):
    """The stop holds all as long as the others have none."""
    rng = np.random.default_rng(seed)
    d = cw.Driveline("closed")
    a = d.shaft("a", inertia=uniform(rng, 0.001, 1))
    load, way, start = uniform(rng, 0.5, 20), float(rng.choice([-1, 1])), uniform(rng, 1.0, 2.0)
    d.add(cw.Torque("load", shaft=a, torque=way * load))
    d.add(cw.EndStop("stop", follower=a, upper=0.01, lower=-0.01))
    ramp = cw.Ramp(height=uniform(rng, 100, 500), duration=0.2, start=start)
    d.add(cw.Brake("ramped", shaft=a, friction=coulomb(rng), gain=1.0, normal_force=ramp))
    if rng.random() < 0.5:
        law = cw.Coulomb(static=0.0, kinetic=0.0)
        d.add(cw.Brake("smooth", shaft=a, friction=law, gain=1.0, normal_force=100.0))
    run = d.simulate(2.5)
    held = run["stop.mode"] == 0
    left = run["load.torque"] + sum(
        run[f"{name}.torque"] for name in ("stop", "ramped", "smooth") if f"{name}.torque" in run.names
    )
    assert np.count_nonzero(held) > 10, seed
    assert np.all(abs(left[held]) <= 1e-9 * load), seed


@pytest.mark.parametrize("seed", range(MODELS))
def test_contacts_of_a_motion_that_leaves_rest_are_within_their_capacity(seed):
    rng = np.random.default_rng(seed)
    d = cw.Driveline("leaves")
    a = d.shaft("a", inertia=uniform(rng, 0.1, 2))
    law = cw.Coulomb(static=0.0, kinetic=0.0) if rng.random() < 0.5 else coulomb(rng)
    d.add(cw.Brake("brake", shaft=a, friction=law, gain=1.0, normal_force=uniform(rng, 0, 1e-3)))
    frequency, height = uniform(rng, 1, 20), uniform(rng, -150, 150)
    course: Any = cw.Sine(amplitude=height, frequency=frequency)
    if rng.random() < 0.5:
        course = cw.Ramp(height=height, duration=uniform(rng, 0.01, 0.1), start=float(rng.choice([0.0, 0.05])))
    d.add(cw.PrescribedAcceleration("given", shaft=a, acceleration=course))
    run = d.simulate(0.15, output="steps")
    assert run.status == "done", seed
    assert np.all(abs(run["brake.torque"]) <= run["brake.capacity"] * (1 + 1e-9)), seed


def limited(rng: Rng) -> cw.Driveline:
    """A limited slip with a prescribed side; each of the others may have a brake."""
    d = cw.Driveline("limited")
    a, b, c = (d.shaft(name, inertia=uniform(rng, 0.3, 2)) for name in "abc")
    d.add(cw.Differential("df", carrier=b, left=c, right=a, bias=uniform(rng, 1.5, 5)))
    for shaft in (b, c):
        if rng.random() < 0.6:
            d.add(
                cw.Brake(
                    f"on_{shaft.name}", shaft=shaft, friction=coulomb(rng), gain=1.0, normal_force=uniform(rng, 0, 300)
                )
            )
    course = rng.integers(3)
    if course == 0:
        d.add(
            cw.PrescribedSpeed(
                "given", shaft=a, speed=cw.Sine(amplitude=uniform(rng, 1, 10), frequency=uniform(rng, 1, 4))
            )
        )
    elif course == 1:
        d.add(cw.PrescribedAcceleration("given", shaft=a, acceleration=uniform(rng, -20, 20)))
    else:
        d.add(cw.PrescribedSpeed("given", shaft=a, speed=cw.Ramp(height=uniform(rng, -20, 20), duration=0.3)))
    return d


@pytest.mark.parametrize("seed", range(MODELS))
def test_loads_beside_prescribed_speeds(seed):
    """Every step follows the prescribed acceleration, no row is above a capacity, and friction takes power."""
    rng = np.random.default_rng(seed)
    d = limited(rng)
    run, fine = d.simulate(0.4, rtol=1e-8), d.simulate(0.4, max_step=2e-4)
    assert run.status == "done", seed
    size = np.max(abs(run["a.speed"]))
    for shaft in "bc":
        assert abs(run[f"{shaft}.speed"][-1] - fine[f"{shaft}.speed"][-1]) <= 1e-5 * size, seed
    for name in ("df", "on_b", "on_c"):
        if f"{name}.torque" not in run.names:
            continue
        torque = run[f"{name}.torque"]
        assert np.max(run[f"{name}.power"]) <= 1e-9 * (1 + np.max(abs(torque)) * size), seed
        if name != "df":
            assert np.max(abs(torque) - run[f"{name}.capacity"]) <= 1e-9 * np.max(abs(torque)), seed


def test_contacts_between_prescribed_speeds_never_hold():
    """Whatever is locked elsewhere: beside it a differential is held between shafts that rest."""
    for seed in range(MODELS):
        rng = np.random.default_rng(seed)
        d = cw.Driveline("apart")
        a, b, c = (d.shaft(name, inertia=uniform(rng, 0.3, 2)) for name in "abc")
        d.add(cw.Differential("df", carrier=c, left=a, right=d.housing, bias=uniform(rng, 1.5, 5)))
        d.add(cw.BearingFriction("on_b", shaft=b, friction=cw.Coulomb(static=0.5, kinetic=0.4), torque=1.0))
        d.add(cw.BearingFriction("on_c", shaft=c, friction=coulomb(rng), torque=1.0))
        d.add(cw.PrescribedSpeed("given", shaft=b, speed=cw.Ramp(height=uniform(rng, -20, 20), duration=0.5)))
        run = d.simulate(0.1, output="steps")
        assert np.allclose(abs(run["on_b.torque"]), 0.4), seed


@pytest.mark.parametrize("seed", range(20))
def test_a_torque_that_jumps_takes_loads_along(seed):
    """Teeth that skip let go at once: the friction of the differential beside them never drives, in no row."""
    rng = np.random.default_rng(seed)
    d = cw.Driveline("skips")
    a, b = d.shaft("a", inertia=uniform(rng, 0.3, 2)), d.shaft("b", inertia=0.02, speed=uniform(rng, -200, -50))
    dog = {"teeth": 8, "gap": 0.02, "stiffness": uniform(rng, 200, 2000), "command": 1.0, "speed": 1e3, "engaged": True}
    d.add(cw.DogClutch("dog", base=d.housing, follower=b, **dog))
    d.add(cw.SpringDamper("k", base=b, follower=d.housing, stiffness=uniform(rng, 100, 3000), damping=0.1))
    d.add(cw.Differential("df", carrier=a, left=b, right=d.housing, bias=uniform(rng, 2, 6)))
    run = d.simulate(0.1, output="steps")
    assert run.status == "done", seed
    assert np.max(run["df.power"]) <= 1e-9 * np.max(abs(run["df.power"])), seed


@pytest.mark.parametrize("seed", range(MODELS))
def test_impacts_beside_a_closed_stop_do_not_depend_on_the_method(seed):
    rng = np.random.default_rng(seed)
    d = cw.Driveline("row")
    a, b, c = (
        d.shaft(name, inertia=uniform(rng, 0.1, 1), speed=speed)
        for name, speed in zip("abc", (59.91, 60, 60), strict=True)
    )
    d.add(cw.Backlash("ab", base=a, follower=b, gap=0.15, restitution=0.6))
    d.add(cw.Backlash("bc", base=b, follower=c, gap=0.5, restitution=0.2, initial_twist=-0.24, rest_speed=1e-3))
    d.add(cw.Torque("load", shaft=c, torque=cw.Sine(amplitude=1.0, frequency=20.0, offset=-2.4)))
    runs = [d.simulate(0.6, method=method) for method in ("auto", "rodas5p", "dopri5")]
    for one, other in itertools.pairwise(runs):
        assert [(e.element, e.after) for e in one.events] == [(e.element, e.after) for e in other.events], seed
        assert other["bc.heat"][-1] == pytest.approx(one["bc.heat"][-1], rel=1e-4), seed


def self_locking(rng: Rng) -> cw.Driveline:
    """A gear that may lock itself among rigid gears, a clutch across them and a brake."""
    d = cw.Driveline("worm")
    a = d.shaft("a", inertia=10 ** uniform(rng, -3, 0.5), speed=uniform(rng, -60, 60))
    b, c, e = (d.shaft(name, inertia=10 ** uniform(rng, -3, 0.5)) for name in "bce")
    loss = [[0.0, uniform(rng, 0.4, 0.8), uniform(rng, -0.6, 0.3), 0.0, 0.0]]
    d.add(
        cw.LossyGear(
            "lossy", input=a, output=b, ratio=float(rng.choice([-1, 1])) * uniform(rng, 1, 20), loss_table=loss
        )
    )
    d.add(cw.Gear("gear", input=b, output=c, ratio=uniform(rng, 0.5, 4)))
    d.add(cw.Clutch("across", base=a, follower=c, friction=coulomb(rng), gain=1.0, normal_force=sine(rng, 800, 0.0)))
    d.add(cw.Brake("brake", shaft=b, friction=coulomb(rng), gain=1.0, normal_force=uniform(rng, 0, 500)))
    d.add(cw.SpringDamper("k", base=c, follower=e, stiffness=uniform(rng, 50, 5000), damping=uniform(rng, 0, 5)))
    d.add(cw.Torque("drive", shaft=a, torque=sine(rng, 60)))
    d.add(cw.Torque("load", shaft=e, torque=sine(rng, 150)))
    return d


@pytest.mark.random
def test_a_self_locking_gear_in_a_redundant_set():
    for seed in range(amount(200)):
        run = self_locking(np.random.default_rng(seed)).simulate(0.5, max_steps=100_000)
        assert run.status == "done", (seed, run.message)
        assert abs(run.energy.residual) <= 1e-5 * run.energy.turnover, seed
        for name in ("across", "brake"):
            over = abs(run[f"{name}.torque"]) - run[f"{name}.capacity"]
            assert np.max(over) <= 1e-6 * (1 + np.max(run[f"{name}.capacity"])), (seed, name)


def _before_a_light_shaft(rng: Rng) -> tuple[cw.Driveline, float]:
    """A shaft without inertia whose speed follows from a ratio that vanishes, and when it does."""
    d = cw.Driveline("light")
    light = d.shaft("light", inertia=0.0)
    kind = rng.integers(3)
    if kind == 0:
        mass = d.mass("mass", mass=uniform(rng, 0.5, 5))
        d.add(cw.CrankSlider("tie", shaft=light, mass=mass, radius=0.02, rod=uniform(rng, 0.05, 1)))
        return d, 0.0
    heavy = d.housing if kind == 1 else d.shaft("heavy", inertia=uniform(rng, 0.1, 2))
    d.add(cw.Torque("load", shaft=light, torque=uniform(rng, 1, 5)))
    at, begin = uniform(rng, 0.05, 0.3), uniform(rng, 0.3, 2) * rng.choice([-1, 1])
    ratio: Any = 0.0 if rng.random() < 0.3 else cw.Table([(0.0, begin), (at, 0.0), (2.0 * at, -begin)])
    d.add(cw.VariableGear("tie", input=heavy, output=light, ratio=ratio))
    return d, 0.0 if ratio == 0.0 else at


@pytest.mark.parametrize("seed", range(MODELS))
def test_a_ratio_that_vanishes_before_a_shaft_without_inertia_jams(seed):
    """Nothing determines the speed of that shaft: the run ends there, from the start or on the way, and says so."""
    d, at = _before_a_light_shaft(np.random.default_rng([seed, 17]))
    with pytest.warns(cw.StoppedEarly, match="the shaft without inertia beside it at .tie."):
        run = d.simulate(1.0, work=False)
    assert run.status == "jammed", (seed, run.message)
    assert len(run) == 0 if at == 0.0 else run.time[-1] == pytest.approx(at, rel=1e-4), seed


@pytest.mark.parametrize("seed", range(MODELS))
def test_a_contact_that_holds_nothing_does_not_break_others_loose(seed):
    """Where a load rises from nothing one contact is at its limit, of zero: another lets go at its own, once."""
    rng = np.random.default_rng([seed, 23])
    d = cw.Driveline("nothing")
    a, b, c = (d.shaft(name, inertia=uniform(rng, 0.1, 2)) for name in "abc")
    d.add(cw.BearingFriction("nothing", shaft=c, friction=cw.Coulomb(static=0.0, kinetic=0.0), torque=1.0))
    d.add(
        cw.Clutch(
            "clutch", base=a, follower=b, friction=cw.Coulomb(static=0.1, kinetic=0.1), gain=1.0, normal_force=10.0
        )
    )
    start, rise = uniform(rng, 0.0, 0.3), uniform(rng, 20, 200)
    d.add(cw.Torque("load", shaft=b, torque=cw.Ramp(height=rise, duration=1.0, start=start)))
    run = d.simulate(0.9)
    held = run["clutch.capacity"][0]
    inertia = {node.name: node.inertia for node in d.nodes}
    expected = start + held * (inertia["a"] + inertia["b"]) / inertia["a"] / rise
    assert [event.time for event in run.events] == pytest.approx([expected] if expected < 0.9 else [], rel=1e-9), seed


@pytest.mark.parametrize("seed", range(MODELS))
def test_a_tolerance_between_prescribed_speeds_stops_nothing(seed):
    """A transmission with a capacity from a prescribed shaft to the housing: its slip passes its tolerance."""
    rng = np.random.default_rng([seed, 29])
    d = cw.Driveline("given")
    a = d.shaft("a", inertia=1.0)
    ratio = float(rng.choice([0.0, 1.0]))
    d.add(cw.VariableRatio("tie", input=a, output=d.housing, ratio=ratio, capacity=1.0, tolerance=uniform(rng, 0.1, 2)))
    size = uniform(rng, 0.1, 1)
    d.add(cw.PrescribedPosition("motion", shaft=a, position=cw.Sine(amplitude=size, frequency=uniform(rng, 5, 25))))
    run = d.simulate(0.2)
    assert run.status == "done", seed
    assert run["tie.work"][-1] < 0.0, seed


@pytest.mark.parametrize("seed", range(MODELS))
def test_a_tolerance_on_a_mass_that_a_crank_holds_stops_nothing(seed):
    """The shaft of the crank is prescribed: friction on the mass passes its tolerance and brakes against its speed."""
    rng = np.random.default_rng([seed, 31])
    d = cw.Driveline("held")
    a, m = d.shaft("a", inertia=1.0), d.mass("m", mass=uniform(rng, 0.5, 5))
    d.add(cw.CrankSlider("tie", shaft=a, mass=m, radius=0.05, rod=uniform(rng, 0.1, 1)))
    law, tolerance = cw.Coulomb(static=0.2, kinetic=0.1), uniform(rng, 0.001, 0.02)
    d.add(cw.Brake("brake", shaft=m, friction=law, gain=1.0, normal_force=10.0, tolerance=tolerance))
    d.add(cw.PrescribedSpeed("motion", shaft=a, speed=uniform(rng, 5, 40)))
    run = d.simulate(0.5)
    assert run.status == "done", seed
    sliding = np.abs(run["m.speed"]) > 1e-6
    assert np.array_equal(np.sign(run["brake.torque"][sliding]), -np.sign(run["m.speed"][sliding])), seed

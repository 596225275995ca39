"""Laws given by expressions: what the same law of the core computes, in every way of running."""

from __future__ import annotations

import copy
import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.model.pools import coefficients
from support.amount import amount
from support.runs import TIGHT

CURVE: dict[str, float] = {"static": 0.4, "kinetic": 0.3, "speed": 2.0}
BRISTLE: dict[str, float] = {**CURVE, "stiffness": 1500.0, "damping": 0.02, "viscous": 1e-3}
FALL = "kinetic + (static - kinetic)*exp(-(v/speed)**2)"
BENDING = f"v - abs(v)*z/({FALL})"
LUGRE: dict[str, Any] = {
    "expression": f"z + damping*({BENDING}) + viscous*v",
    "rates": {"z": f"stiffness*({BENDING})"},
    "at_rest": "static",
}
# the same law as it is built in and as a formula, where all operations of the core agree
SAME = {
    "coulomb": (
        cw.Coulomb(static=0.4, kinetic=0.3),
        cw.Formula("kinetic", at_rest="static", static=0.4, kinetic=0.3),
    ),
    "exponential": (
        cw.Exponential(static=0.42, slow=0.4, fast=0.3, speed=2.0),
        cw.Formula(
            "fast + (slow - fast)*exp(-abs(v)/speed)", at_rest="static", static=0.42, slow=0.4, fast=0.3, speed=2.0
        ),
    ),
    "lugre": (cw.LuGre(**BRISTLE), cw.DynamicFormula(**LUGRE, **BRISTLE)),
    "dahl": (
        cw.Dahl(kinetic=0.3, stiffness=500.0),
        cw.DynamicFormula("z", rates={"z": "s*v*(1 - z*sign(v)/mu)"}, at_rest="mu", s=500.0, mu=0.3),
    ),
}
# damping beyond passivity is warned of where the core knows what that is
pytestmark = pytest.mark.filterwarnings("ignore::clutchwork.ModelWarning")
# numbers of a formula are those of the law beside it, but for these
NAMES = {"dahl": {"kinetic": "mu", "stiffness": "s"}}


def launch(law: cw.Law, **more: Any) -> cw.Driveline:
    """A clutch that engages, and whose spring behind it swings."""
    d = cw.Driveline("launch")
    engine, hub = d.shaft("engine", inertia=0.2, speed=150.0), d.shaft("hub", inertia=0.05)
    car = d.shaft("car", inertia=1.5)
    clamp = cw.Ramp(height=800.0, duration=0.4, start=0.05)
    d.add(cw.Clutch("c", base=engine, follower=hub, friction=law, gain=0.5, normal_force=clamp, **more))
    d.add(cw.SpringDamper("shaft", base=hub, follower=car, stiffness=3e3, damping=3.0))
    d.add(cw.Torque("drive", shaft=engine, torque=40.0))
    return d


@pytest.mark.parametrize("name", ["coulomb", "exponential", "lugre"])
def test_a_formula_has_the_bits_of_the_law(name: str) -> None:
    law, written = SAME[name]
    one, other = launch(law).simulate(1.0), launch(written).simulate(1.0)
    np.testing.assert_array_equal(one.time, other.time)
    for signal in ("engine.speed", "hub.speed", "c.torque", "c.heat", "c.mode"):
        np.testing.assert_array_equal(one[signal], other[signal], signal)
    assert [(e.time, e.after) for e in one.events.changes()] == [(e.time, e.after) for e in other.events.changes()]


def test_the_stribeck_curve_is_the_same_motion() -> None:
    """The law ends steps where its fall does, which a formula does not know: the runs differ by their tolerance."""
    law, written = cw.Stribeck(**CURVE), cw.Formula(FALL, at_rest="static", **CURVE)
    for slip in (0.0, 1e-3, 0.7, 5.0, 200.0):
        assert coefficients(law, slip) == coefficients(written, slip)
    one, other = (launch(each).simulate(1.0, dt=0.01, **TIGHT) for each in (law, written))
    for signal in ("engine.speed", "c.heat"):
        # 1e-12 of the scale for each of some hundred steps of TIGHT
        np.testing.assert_allclose(one[signal], other[signal], rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize("name", SAME)
def test_gradients_are_those_of_the_law(name: str) -> None:
    law, written = SAME[name]
    names = [field for field, value in vars(law).items() if isinstance(value, float) and field != "exponent"]
    found = []
    for one, own in ((law, {}), (written, NAMES.get(name, {}))):
        by = [f"c.friction.{own.get(field, field)}" for field in names]
        found.append(launch(one).simulate(0.6, **TIGHT).gradient(of=["engine.speed", "c.heat"], by=by).matrix)
    scale = np.abs(found[0]).max(axis=1, keepdims=True)
    # what the package promises of a derivative at this tolerance; Dahl's law has other pieces
    assert np.all(np.abs(found[0] - found[1]) <= 1e-6 * scale)


def test_a_sweep_has_the_bits_of_single_runs() -> None:
    """Eight at a time in lanes, and one by one."""
    system = launch(
        cw.Formula("mu + f*exp(-v/w) + 0.01*sqrt(v/w + 1) - 0.01*atan(v/w)", mu=0.2, f=0.1, w="20 rpm")
    ).assemble()
    vary = {"c.friction.mu": np.linspace(0.2, 0.3, 5), "c.friction.w": [1.0, 2.0, 3.0, 5.0]}
    found = cw.sweep(system, 0.8, vary=vary, outputs=["engine.speed", "c.heat", cw.lock("c")])
    for number in range(len(found)):
        run = cw.simulate(system.changed(found.variant(number)), 0.8)
        assert found.flat("engine.speed")[number] == run["engine.speed"][-1]
        assert found.flat("c.heat")[number] == run["c.heat"][-1]


def test_other_expressions_are_no_lanes_of_one() -> None:
    """As many words that say something else: each run computes its own."""
    laws = [cw.Formula(f"mu + 0.1*{word}(-v/w)", mu=0.3, w=2.0) for word in ("exp", "tanh")]
    assert laws[0].problems() == laws[1].problems() == []
    system = launch(laws[0]).assemble()
    found = cw.sweep(system, 0.8, vary={"c.friction": laws}, outputs=["engine.speed"])
    alone = [launch(law).simulate(0.8)["engine.speed"][-1] for law in laws]
    assert found["engine.speed"].tolist() == alone
    assert alone[0] != alone[1]


def test_a_temperature_and_a_pressure_are_read() -> None:
    d = cw.Driveline("warm")
    shaft, lining = d.shaft("a", inertia=0.5, speed=100.0), d.thermal("plates", capacity=200.0)
    law = cw.Formula(
        "mu*(1 - k*(temperature - 300))*(p0/pressure)**0.1",
        mu=0.3,
        k="1e-3 1/K",
        p0="1 bar",
        pressure=2e5,
    )
    d.add(cw.Brake("b", shaft=shaft, friction=law, gain=1e-3, pressure=2e5, heat=lining))
    run = d.simulate(0.5, dt=0.05)
    slips = run["b.mode"] != 0
    expected = 1e-3 * 2e5 * 0.3 * (1 - 1e-3 * (run["plates.temperature"] - 300)) * 0.5**0.1
    np.testing.assert_allclose(-run["b.torque"][slips], expected[slips], rtol=1e-12)
    assert run["plates.temperature"][-1] > 305.0


def test_states_are_signals_and_start_at_zero() -> None:
    run = launch(cw.DynamicFormula(**LUGRE, **BRISTLE)).simulate(0.3)
    assert run["c.z"][0] == 0.0
    assert np.max(np.abs(run["c.z"])) == pytest.approx(0.4, abs=0.1)


def test_two_states() -> None:
    """Bristles in series with a lag of their coefficient."""
    law = cw.DynamicFormula(
        "lagged",
        rates={"z": "s*(v - abs(v)*z/mu)", "lagged": "(z - lagged)/lag"},
        at_rest="mu",
        s=500.0,
        mu=0.3,
        lag="5 ms",
    )
    d = cw.Driveline("two")
    shaft = d.shaft("a", inertia=1.0)
    d.add(cw.PrescribedSpeed("p", shaft=shaft, speed=3.0))
    d.add(cw.Brake("c", shaft=shaft, friction=law, gain=1.0, normal_force=100.0))
    run = d.simulate(0.1, dt=0.001, **TIGHT)
    # z is full after some milliradians; then the lag is an exponential
    assert run["c.torque"][-1] == pytest.approx(-30.0, rel=1e-6)
    z, lagged = run["c.z"], run["c.lagged"]
    np.testing.assert_allclose(np.gradient(lagged, run.time)[2:-2], ((z - lagged) / 5e-3)[2:-2], atol=2.0)


def test_conditions_choose() -> None:
    law = cw.Formula("where(v < w, 0.4 - 0.1*v/w, 0.3) if w > 0 and not v > 1e3 else max(0.3, min(0.1, v/w))", w=2.0)
    assert law.problems() == []
    assert [coefficients(law, slip)[0] for slip in (0.0, 1.0, 2.0, 50.0)] == pytest.approx([0.4, 0.35, 0.3, 0.3])
    assert coefficients(law, 2e3)[0] == 0.3


def test_beyond_where_it_was_looked_at_it_transmits_nothing() -> None:
    law = cw.Formula("mu - k*v", mu=0.3, k="1e-3 s/rad")
    assert law.problems() == []
    assert coefficients(law, 200.0)[0] == pytest.approx(0.1, rel=1e-14)
    assert coefficients(law, 1000.0)[0] == 0.0


def test_copies_are_equal() -> None:
    for law in (cw.Formula("mu + f*exp(-v/w)", mu=0.2, f=0.1, w="20 rpm"), cw.DynamicFormula(**LUGRE, **BRISTLE)):
        for other in (pickle.loads(pickle.dumps(law)), copy.deepcopy(law), replace(law)):
            assert other == law
            assert hash(other) == hash(law)
            assert repr(other) == repr(law)


def test_a_model_file_holds_it(tmp_path: Any) -> None:
    d = launch(cw.Formula("mu + f*exp(-v/w)", mu=0.2, f=0.1, w="20 rpm"))
    d.save(tmp_path / "model.toml")
    assert 'w = "2.0943951023931953 rad/s"' in (tmp_path / "model.toml").read_text()
    again = cw.Driveline.load(tmp_path / "model.toml")
    assert again.assemble().to_bytes() == d.assemble().to_bytes()
    assert again.assemble().changed({"c.friction.w": "30 rpm"}).source.elements[0].friction.w == pytest.approx(np.pi)


# times to rest through a kink and a jump: 0.4 tolerances off in the median of 150, five at most at 1e-6
KINK_ERROR = 10.0


@pytest.mark.random
def test_kinks_and_jumps_of_formulas_are_left_to_the_control_of_steps() -> None:
    """A speed that falls through a knee of the coefficient, against its closed form; a table ends its steps there."""
    tables, formulas = list[float](), list[float]()
    for seed in range(amount(20)):
        rng = np.random.default_rng([881, seed])
        low, fall, knee = rng.uniform(0.1, 0.3), rng.uniform(0.005, 0.05), rng.uniform(0.5, 8.0)
        start, load, high = knee * rng.uniform(1.05, 5.0), rng.uniform(20.0, 200.0), low + fall * knee
        above = (start - knee) / (load * low)
        kink = above + np.log(high / low) / (fall * load)
        curve = [(0.0, high), (knee, low), (1e3, low)]
        step = cw.Formula("where(v < knee, high, low)", low=low, high=high, knee=knee)
        laws = {
            "kink": (cw.Formula("max(low, high - fall*v)", low=low, high=high, fall=fall), kink),
            "jump": (step, above + knee / (load * high)),
            "table": (cw.FrictionTable(static=1.001 * high, kinetic=curve), kink),
        }
        for name, (law, exact) in laws.items():
            d = cw.Driveline(name)
            shaft = d.shaft("s", inertia=1.0, speed=start)
            d.add(cw.Brake("b", shaft=shaft, friction=law, gain=1.0, normal_force=load))
            error = abs(cw.lock("b").of(d.simulate(2.0 * exact, rtol=1e-6, atol=1e-6)) / exact - 1.0)
            (tables if name == "table" else formulas).append(error)
    assert max(formulas) < KINK_ERROR * 1e-6
    assert max(tables) < 0.1 * max(formulas)


@pytest.mark.parametrize("part", ["kinetic", "static"])
def test_a_coefficient_without_a_value_at_rest_ends_the_run(part: str) -> None:
    """Above 600 K the logarithm has none: what holds then is not known."""
    gone = "(1 + 0*log((600 - temperature)/300))"
    kinetic, static = (
        f"{number}*{gone}" if name == part else number for name, number in (("kinetic", "0.2"), ("static", "0.4"))
    )
    hot = cw.Ramp(offset=300.0, height=400.0, duration=1.0)
    d = cw.Driveline("hot")
    shaft = d.shaft("s", inertia=1.0)
    d.add(
        cw.Brake(
            "b", shaft=shaft, friction=cw.Formula(kinetic, at_rest=static, temperature=hot), gain=1.0, normal_force=20.0
        )
    )
    d.add(cw.Torque("t", shaft=shaft, torque=1.0))
    with pytest.warns(cw.StoppedEarly, match="a value is not finite: b.capacity is nan"):
        run = d.simulate(1.5)
    assert run.status == "not_finite"
    assert run.time[-1] < 0.75 + 1e-9

"""Gradients of two discs and a clutch against their closed form."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw

J1, J2, SPEED, GAIN, STATIC, KINETIC, PRESSURE, RISE, END = 0.2, 0.8, 100.0, 5e-4, 0.125, 0.1, 2e5, 0.2, 2.5


def two_discs():
    d = cw.Driveline("two discs")
    engine, load = d.shaft("engine", inertia=J1, speed=SPEED), d.shaft("load", inertia=J2)
    pressure = cw.Table([(0.0, 0.0), (RISE, PRESSURE), (1.0, PRESSURE)])
    lining = cw.Coulomb(static=STATIC, kinetic=KINETIC)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=GAIN, pressure=pressure))
    return d


# exact[of][by], from torque = gain kinetic pressure: engine and load meet at `lock`, J1 SPEED / (J1 + J2)
TORQUE = GAIN * KINETIC * PRESSURE
J = J1 * J2 / (J1 + J2)
LOCK = SPEED * J / TORQUE + RISE / 2
MET = J1 * SPEED / (J1 + J2)
EXACT = {
    "lock(c1)": {
        "engine.inertia": SPEED / TORQUE * (J2 / (J1 + J2)) ** 2,
        "c1.gain": -SPEED * J / TORQUE / GAIN,
        "c1.friction.kinetic": -SPEED * J / TORQUE / KINETIC,
        "c1.friction.static": 0.0,
        "engine.speed": J / TORQUE,
        "c1.pressure.times[2]": 0.5,
    },
    "load.speed": {
        "engine.inertia": SPEED * J2 / (J1 + J2) ** 2,
        "c1.gain": 0.0,
        "c1.friction.kinetic": 0.0,
        "c1.friction.static": 0.0,
        "engine.speed": J1 / (J1 + J2),
        "c1.pressure.times[2]": 0.0,
    },
    "c1.heat": {
        "engine.inertia": 0.5 * SPEED**2 * (J2 / (J1 + J2)) ** 2,
        "c1.gain": 0.0,
        "c1.friction.kinetic": 0.0,
        "c1.friction.static": 0.0,
        "engine.speed": J * SPEED,
        "c1.pressure.times[2]": 0.0,
    },
    "load.speed at 1 s": {
        "engine.inertia": 0.0,
        "c1.gain": TORQUE * (1.0 - RISE / 2) / J2 / GAIN,
        "c1.friction.kinetic": TORQUE * (1.0 - RISE / 2) / J2 / KINETIC,
        "c1.friction.static": 0.0,
        "engine.speed": 0.0,
        "c1.pressure.times[2]": -TORQUE / J2 / 2,
    },
    # the torque rises over RISE and stays
    "squared_jerk(load)": {
        "engine.inertia": 0.0,
        "c1.gain": 2 * (TORQUE / J2) ** 2 / RISE / GAIN,
        "c1.friction.kinetic": 2 * (TORQUE / J2) ** 2 / RISE / KINETIC,
        "c1.friction.static": 0.0,
        "engine.speed": 0.0,
        "c1.pressure.times[2]": -((TORQUE / J2) ** 2) / RISE**2,
    },
    "peak(c1.torque)": {
        "engine.inertia": 0.0,
        "c1.gain": TORQUE / GAIN,
        "c1.friction.kinetic": TORQUE / KINETIC,
        "c1.friction.static": 0.0,
        "engine.speed": 0.0,
        "c1.pressure.times[2]": 0.0,
    },
}
OF = [
    *(cw.lock("c1"), "load.speed", "c1.heat", cw.at("load.speed", 1.0), cw.squared_jerk("load"), cw.peak("c1.torque")),
]
BY = list(EXACT["lock(c1)"])


@pytest.fixture(scope="module")
def function():
    return cw.differentiable(two_discs(), END, of=OF, by=BY)


def test_gradients_are_those_of_the_closed_form(function):
    found = function.gradient()
    assert found.of == tuple(EXACT)
    assert found.by == tuple(BY)
    for of, by in EXACT.items():
        for name, exact in by.items():
            # by one percent of the number, against one percent of the value
            scale = abs(found.values[found.of.index(of)] / found.x[found.by.index(name)])
            assert found[of, name] == pytest.approx(exact, abs=1e-7 * scale), (of, name)


def test_all_doors_give_the_same(function):
    x = function.x0 * 1.01
    values, matrix = function.value_and_jacobian(x)
    np.testing.assert_array_equal(function(x), values)
    np.testing.assert_array_equal(function.jacobian(x), matrix)
    np.testing.assert_allclose(function.batch([function.x0, x])[1], values, rtol=1e-9)
    np.testing.assert_allclose(function.batch_jacobian([function.x0, x])[1][1], matrix, rtol=1e-9, atol=1e-9)
    weights = np.array([1.0, 0.5, 0.0, 2.0, 0.0, 0.0])
    again, gradient = function.vjp(x, weights)
    np.testing.assert_allclose(again, values, rtol=1e-9)
    np.testing.assert_allclose(gradient, weights @ matrix, rtol=1e-9, atol=1e-9)
    value, gradient = function.objective("c1.heat")(x)
    assert value == pytest.approx(values[2], rel=1e-12)
    np.testing.assert_allclose(gradient, matrix[2], rtol=1e-9, atol=1e-9)


def test_a_run_gives_its_gradient():
    run = two_discs().simulate(END)
    found = run.gradient(of=cw.lock("c1"), by=["c1.gain", "c1.pressure.values"])
    assert found.values == pytest.approx(run.events.of("c1")[0].time, rel=1e-12)
    assert found.by == ("c1.gain", *(f"c1.pressure.values[{number}]" for number in (1, 2, 3)))
    assert found["lock(c1)", "c1.gain"] == pytest.approx(EXACT["lock(c1)"]["c1.gain"], rel=1e-7)
    assert found.unit("lock(c1)", "c1.gain") == "s/m3"
    assert "[1/m3]" in str(found)
    assert found["lock(c1)"].shape == (4,)
    # all ordinates by one percent are the gain by one percent
    assert found.relative[0, 1:].sum() == pytest.approx(found.relative[0, 0], rel=1e-6)


def test_a_table_of_derivatives_says_names_and_units(function):
    found = function.gradient()
    text = repr(found)
    for part in ("lock(c1) [s]", "engine.inertia", "1.7"):
        assert part in text
    frame = found.to_pandas()
    assert frame.loc["lock(c1)", "c1.gain"] == found["lock(c1)", "c1.gain"]
    assert frame.attrs["units"]["c1.heat"]["engine.inertia"] == "J/(kg m2)"
    assert "engine.inertia" in found._repr_html_()
    with pytest.raises(cw.UnknownName, match="did you mean 'lock\\(c1\\)'"):
        found["lock(c2)"]


def test_names_that_mean_no_number_are_refused_all_at_once():
    wrong = {
        "c1.pressure": "c1.pressure is a table; take c1.pressure.values, c1.pressure.values[1]",
        "c1.pressure.values[4]": "counted from 1, c1.pressure.values[1] to c1.pressure.values[3]",
        "c1.pressure.arguments": "has no arguments; take c1.pressure.values or c1.pressure.times",
        "c1.friction": "is a Coulomb; take c1.friction.static, c1.friction.kinetic",
        "c1.locked": "is a choice, which has no derivative",
        "load.speed": "has no value; give it one in the driveline",
        "c1.gian": "did you mean 'c1.gain'?",
    }
    with pytest.raises(cw.UseError) as caught:
        cw.differentiable(two_discs(), END, of="load.speed", by=list(wrong))
    assert len(caught.value.problems) == len(wrong)
    for problem, text in zip(caught.value.problems, wrong.values(), strict=True):
        assert text in problem


def test_values_that_have_no_derivative_are_refused():
    with pytest.raises(cw.UseError, match="is a Python function, which has no derivative"):
        cw.differentiable(two_discs(), END, of={"own": lambda run: run["load.speed"][-1]}, by="c1.gain")
    with pytest.raises(cw.UseError, match="no contact 'c2'; did you mean 'c1'"):
        cw.differentiable(two_discs(), END, of=cw.lock("c2"), by="c1.gain")
    with pytest.raises(cw.NoGradient, match=r"break_away\(c1\)"):
        two_discs().simulate(END).gradient(cw.break_away("c1"), "c1.gain")


def test_points_of_another_size_are_refused(function):
    with pytest.raises(cw.UseError, match="give a finite number for each number, 6 in all"):
        function([1.0])
    with pytest.raises(cw.UseError, match="give lines of 6 numbers each"):
        function.batch([1.0])
    with pytest.raises(cw.UseError, match="name a value"):
        function.objective()


def test_squared_jerk_is_an_output_of_a_sweep_too():
    found = cw.sweep(two_discs(), END, vary={"c1.gain": [GAIN, 2 * GAIN]}, outputs=cw.squared_jerk("load"))
    exact = (TORQUE / J2) ** 2 / RISE * np.array([1.0, 4.0])
    np.testing.assert_allclose(found["squared_jerk(load)"], exact, rtol=1e-9)
    assert found.units["squared_jerk(load)"] == "rad2/s5"
    run = two_discs().simulate(END)
    assert cw.squared_jerk("load").of(run) == pytest.approx(exact[0], rel=1e-9)

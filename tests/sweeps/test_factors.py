"""Factors on numbers of a model: the same bits as the products themselves, for every name that a pattern matches."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw

END = 3.0


def discs() -> cw.Driveline:
    """Two discs, a clutch and a brake, whose gains differ."""
    d = cw.Driveline("factors")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    law = cw.Coulomb(static=0.14, kinetic=0.1)
    ramp = cw.Ramp(height=2e5, duration=0.5)
    d.add(cw.Clutch("F1", base=engine, follower=load, friction=law, gain=5e-4, pressure=ramp))
    d.add(cw.Brake("F2", shaft=load, friction=law, gain=1e-4, pressure=1e4))
    return d


def test_a_pattern_is_one_axis_with_the_bits_of_the_products():
    factors = [0.9, 1.0, 1.1]
    vary = {"F*.gain": cw.times(*factors), "engine.inertia": [0.2, 0.3]}
    found = cw.sweep(discs(), END, vary=vary, outputs=["load.speed", cw.lock("F1")])
    rows = [
        {"F1.gain": 5e-4 * factor, "F2.gain": 1e-4 * factor, "engine.inertia": inertia}
        for factor in factors
        for inertia in (0.2, 0.3)
    ]
    plain = cw.sweep(discs(), END, vary=rows, outputs=["load.speed", cw.lock("F1")])
    assert found.shape == (3, 2)
    assert found["load.speed"].ravel().tobytes() == plain["load.speed"].tobytes()
    assert found["lock(F1)"].ravel().tobytes() == plain["lock(F1)"].tobytes()
    assert found.variant(4) == rows[4]
    assert found.run(4)["load.speed"][-1] == found["load.speed"].ravel()[4]
    assert found.coords["F*.gain"].tolist() == factors
    assert found.units["F*.gain"] == "1"
    assert len(set(found["lock(F1)"].ravel().tolist())) == 6


@pytest.mark.parametrize("way", [cw.times([0.5, 2.0]), cw.times(np.array([0.5, 2.0])), cw.times(0.5, 2.0)])
def test_ways_to_give_factors(way: Any):
    (heavy,) = {cw.sweep(discs(), END, vary={"load.inertia": way}, outputs="load.speed")["load.speed"].tobytes()}
    values = cw.sweep(discs(), END, vary={"load.inertia": [0.4, 1.6]}, outputs="load.speed")
    assert heavy == values["load.speed"].tobytes()
    table = cw.variants({"load.inertia": way, "engine.inertia": [0.2, 0.2]})
    assert cw.sweep(discs(), END, vary=table, outputs="load.speed")["load.speed"].tobytes() == heavy


def test_a_design_of_factors():
    pytest.importorskip("scipy")
    design = cw.design({"F*.gain": cw.times(cw.normal(1.0, 0.05)), "engine.inertia": (0.2, 0.3)}, 8, seed=3)
    found = cw.sweep(discs(), END, vary=design, outputs=cw.lock("F1"))
    factors = cw.design({"x": cw.normal(1.0, 0.05), "y": (0.2, 0.3)}, 8, seed=3)["x"]
    assert [found.variant(k)["F2.gain"] for k in range(8)] == [1e-4 * factor for factor in factors.tolist()]
    assert found.coords["F*.gain"].tolist() == factors.tolist()
    assert "times normal(1, 0.05)" in str(design)


@pytest.mark.parametrize(
    ("vary", "told"),
    [
        ({"F*.gian": cw.times(0.9)}, "'F*.gian' matches no number of this driveline; did you mean 'F"),
        ({"G1.gain": cw.times(0.9)}, "G1.gain: is not a number, initial value or signal of this driveline"),
        ({"*.pressure": cw.times(0.9)}, "F1.pressure is Ramp(height=200000.0, duration=0.5), not a number that a "
         "factor could multiply; take 'F1.pressure.height'"),
        ({"load.speed": cw.times(2.0)}, "load.speed has no value in this driveline that a factor could multiply"),
        ({"load.angle": cw.times(2.0)}, "'load.angle' is 0 in this driveline, which no factor changes; give values"),
        ({"F1.gain": [1e-4], "F*.gain": cw.times(0.9)}, "F1.gain is varied by 'F1.gain' and 'F*.gain'; keep one"),
        ([{"F1.gain": cw.times(0.9)}], "'F1.gain' has factors, which multiply nothing here; give a column of them"),

        ({"F*.gain": cw.times(-1.0)}, "gain = -0.0005 m3: must be > 0 m3"),
    ],
)  # fmt: skip
def test_factors_on_what_is_no_number(vary: Any, told: str):
    with pytest.raises((cw.UseError, cw.ModelError)) as error:
        cw.sweep(discs(), END, vary=vary, outputs="load.speed")
    assert told in str(error.value)


@pytest.mark.parametrize(
    "wrong", [("2 Pa",), (True,), (float("nan"),), ([],), (0.9, "1"), (None,), ({"a": "0.9"},), ({},)]
)
def test_what_is_no_factor(wrong: Any):
    with pytest.raises(cw.UseError, match=r"give numbers without a unit"):
        cw.times(*wrong)


def test_factors_that_a_distribution_may_not_have():
    for wrong in (cw.discrete(["a", 0.9]), cw.normal("1 Pa", "0.1 Pa")):
        with pytest.raises(cw.UseError, match=r"give numbers without a unit"):
            cw.times(wrong)


def test_two_factors_of_a_design_are_bounds_as_any_pair():
    pytest.importorskip("scipy")
    pair, whole = ({"F1.gain": cw.times(how)} for how in ((0.9, 1.1), cw.uniform(0.9, 1.1)))
    assert cw.design(pair, 16, seed=2)["F1.gain"].tolist() == cw.design(whole, 16, seed=2)["F1.gain"].tolist()
    assert set(cw.design({"F1.gain": cw.times([0.9, 1.1])}, 16)["F1.gain"].tolist()) == {0.9, 1.1}


def test_factors_with_labels_in_an_axis_and_a_column():
    way = cw.times({"worn": 0.5, "new": np.array(2.0)})
    for vary in ({"F1.gain": way}, cw.variants({"F1.gain": way})):
        found = cw.sweep(discs(), 0.1, vary=vary, outputs="load.speed")
        assert [found.variant(k)["F1.gain"] for k in range(2)] == [2.5e-4, 1e-3]


def test_no_number_of_a_table_takes_a_factor():
    d = discs()
    d.add(cw.Torque("drive", shaft=d.shaft("other", inertia=1.0), torque=cw.Table([[0.0, 0.0], [1.0, 2.0]])))
    with pytest.raises(cw.UseError, match=r"not a number that a factor could multiply; give values: \[\.\.\.\]$"):
        cw.sweep(d, 0.1, vary={"drive.torque": cw.times(0.9)}, outputs="load.speed")
    with pytest.raises(cw.UseError, match=r"could multiply; take a pattern that leaves it out, not 'drive\.\*'$"):
        cw.sweep(d, 0.1, vary={"drive.*": cw.times(0.9)}, outputs="load.speed")
    with pytest.raises(cw.UseError, match=r"vary=cw.variants\({'F1.gain': cw.times\(0.9, 1.1\)}\)"):
        cw.Simulators(d, 2, vary={"F1.gain": cw.times(0.9, 1.1)})


def test_the_felt_jerk_of_a_sweep_is_that_of_its_runs():
    asked = {"all": cw.jerk("load"), "part": cw.jerk("load", 0.1, (0.5, 2.0)), "one": cw.at("load.speed", [0.7, 1.3])}
    found = cw.sweep(discs(), END, vary={"F*.gain": cw.times(0.9, 1.0, 1.1)}, outputs=asked)
    for number in range(3):
        run = found.run(number)
        # the speeds at these instants have round-off of their own, some 1e-13, over the window squared
        assert found["all"][number] == pytest.approx(cw.jerk("load").of(run), abs=1e-9)
        assert found["part"][number] == pytest.approx(cw.jerk("load", 0.1, (0.5, 2.0)).of(run), abs=1e-9)
        assert found["one"][number].tolist() == run.at([0.7, 1.3])["load.speed"].tolist()
    assert found.units["all"] == "rad/s3"
    early = cw.sweep(discs(), END, vary=[{}], outputs={"j": cw.jerk("load")}, max_steps=5)
    assert np.isnan(early["j"]).all()
    with pytest.raises(cw.UseError, match=r"no shaft or mass 'lode'; did you mean 'load'"):
        cw.sweep(discs(), END, vary=[{}], outputs=cw.jerk("lode"))


def test_the_felt_jerk_has_the_derivative_of_its_differences():
    of, tight = {"all": cw.jerk("load"), "slow": cw.jerk("load", 0.2, (0.5, 2.5))}, {"rtol": 1e-11, "atol": 1e-13}
    function = cw.differentiable(discs(), END, of=of, by=["F1.gain", "engine.inertia"], **tight)
    values, matrix = function.value_and_jacobian(function.x0)
    # steps that keep the instant of the largest one
    step = 1e-6
    for column, name in enumerate(("F1.gain", "engine.inertia")):
        beside = cw.sweep(discs(), END, vary={name: cw.times(1.0 - step, 1.0 + step)}, outputs=of, **tight)
        for row, output in enumerate(of):
            low, high = beside[output].tolist()
            # round-off of the speeds, 1e-13, over the window squared and the step
            size = step * function.x0[column]
            assert matrix[row, column] == pytest.approx((high - low) / (2 * size), rel=1e-4, abs=1e-10 / size)
            assert values[row] == pytest.approx(0.5 * (low + high), rel=1e-6)

"""Designs: the distributions of SciPy, the points of Latin hypercubes and Sobol sequences, the same in any parts."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.studies.points import METHODS
from support import scattered

stats = pytest.importorskip("scipy.stats")

DISTRIBUTIONS: dict[str, tuple[Any, Any]] = {
    "uniform": (cw.uniform(1.0, 3.0), stats.uniform(1.0, 2.0)),
    "log_uniform": (cw.log_uniform(1e-3, 1.0), stats.loguniform(1e-3, 1.0)),
    "normal": (cw.normal(2.0, 0.1), stats.norm(2.0, 0.1)),
    "truncated_normal": (cw.truncated_normal(2.0, 0.1, 1.9, 2.3), stats.truncnorm(-1.0, 3.0, 2.0, 0.1)),
    "upper tail": (cw.truncated_normal(0.0, 1.0, 6.0, 7.0), stats.truncnorm(6.0, 7.0)),
    "lower tail": (cw.truncated_normal(0.0, 1.0, -7.0, -6.0), stats.truncnorm(-7.0, -6.0)),
    "lognormal": (cw.lognormal(3.0, 0.2), stats.lognorm(0.2, scale=3.0)),
    "triangular": (cw.triangular(1.0, 1.5, 4.0), stats.triang(1.0 / 6.0, 1.0, 3.0)),
    "of SciPy": (stats.weibull_min(2.0), stats.weibull_min(2.0)),
}


@pytest.mark.parametrize("name", DISTRIBUTIONS)
def test_distributions_are_those_of_scipy(name: str) -> None:
    given, expected = DISTRIBUTIONS[name]
    # a slice of a Latin hypercube has one point, so that the largest distance is below its width
    drawn = cw.design({"x": given}, 4000, seed=1)["x"]
    assert stats.kstest(drawn, expected.cdf).statistic < 1.1 / 4000


def test_discrete_values_have_their_shares() -> None:
    drawn = cw.design({"x": cw.discrete([1.0, 2.0, 3.0], [1, 1, 2])}, 4000)["x"]
    assert [int(np.sum(drawn == value)) for value in (1.0, 2.0, 3.0)] == [1000, 1000, 2000]
    assert sorted(set(cw.design({"x": {"hot": 400.0, "cold": 300.0}}, 10)["x"].tolist())) == ["cold", "hot"]


@pytest.mark.parametrize("method", METHODS)
def test_points_do_not_depend_on_the_parts_they_are_drawn_in(method: str) -> None:
    points = METHODS[method](3, 5000, 7)
    whole = points.rows(0, points.count)
    assert whole.shape == (points.count, 3)
    assert ((whole > 0.0) & (whole < 1.0)).all()
    for size in (1, 613, 4096):
        first = 0 if size > 1 else points.count - 20
        parts = [points.rows(at, min(at + size, points.count)) for at in range(first, points.count, size)]
        assert np.concatenate(parts).tobytes() == whole[first:].tobytes()
    assert points.rows(900, 910).tobytes() == whole[900:910].tobytes()
    assert METHODS[method](3, 5000, 8).rows(0, 5).tobytes() != whole[:5].tobytes()


def test_equal_values_are_there_once() -> None:
    """Six of the eight variants of a point of Saltelli share each value: what follows from it is made once."""
    drawn = cw.design({name: cw.uniform(-1.0, 1.0) for name in "abcdef"}, 16, method="saltelli", seed=3)
    for one in drawn.part(8, 72).varied:
        assert len(one.values) == len(set(one.values)) == 16
        assert one.column.tobytes() == drawn[one.name][8:72].tobytes()


def test_points_fill_the_cube() -> None:
    latin = METHODS["latin"](2, 1000, 0).rows(0, 1000)
    assert all(sorted(np.floor(1000 * column).tolist()) == list(range(1000)) for column in latin.T)
    spread = {name: stats.qmc.discrepancy(METHODS[name](2, 1024, 0).rows(0, 1024)) for name in ("sobol", "random")}
    assert spread["sobol"] < 0.05 * spread["random"]


@pytest.mark.parametrize("second", [False, True])
def test_points_for_sobol_indices_stand_as_salib_takes_them(second: bool) -> None:
    analysis = pytest.importorskip("SALib.analyze.sobol")
    method = "saltelli second order" if second else "saltelli"
    points = METHODS[method](3, 8, 0)
    rows = points.rows(0, points.count)
    for column in range(3):
        a, b, ab, ba = analysis.separate_output_values(rows[:, column], 3, 8, second)
        pairs = points.pairs.rows(0, 8)  # type: ignore[attr-defined]
        assert (a == pairs[:, column]).all()
        assert (b == pairs[:, 3 + column]).all()
        assert all((ab[:, one] == (b if one == column else a)).all() for one in range(3))
        assert not second or all((ba[:, one] == (a if one == column else b)).all() for one in range(3))


def test_units() -> None:
    system = scattered.discs()
    plain = {"c1.pressure": cw.normal(2e5, 1e4), "engine.speed": cw.uniform(10.0, 20.0)}
    given = {"c1.pressure": cw.normal("2 bar", "0.1 bar"), "engine.speed": ("10 rad/s", "20 rad/s")}
    found, wanted = (cw.sweep(system, 2.0, vary=cw.design(vary, 20), outputs="load.speed") for vary in (given, plain))
    assert np.allclose(found["load.speed"], wanted["load.speed"], rtol=1e-12)
    assert np.allclose(found.coords["c1.pressure"], wanted.coords["c1.pressure"], rtol=1e-14)
    assert found.units["c1.pressure"] == "Pa"
    with pytest.raises(cw.UseError, match=r"c1\.pressure: uniform\(1, 2\) kg has a unit that does not fit"):
        cw.sweep(system, 2.0, vary=cw.design({"c1.pressure": ("1 kg", "2 kg")}, 5), outputs="load.speed")


UNKNOWN = {
    "c1.gian": r"c1\.gian: .*; did you mean 'c1\.gain'",
    "c1.pressure.values[2]": r"c1\.pressure\.values\[2\]: is inside of a table; .* whole tables: .* as 'c1\.pressure'",
}


@pytest.mark.parametrize("name", UNKNOWN)
@pytest.mark.parametrize("how", [cw.normal("2 bar", "0.1 bar"), cw.normal(2e5, 1e4)], ids=["unit", "plain"])
def test_names_are_looked_at_before_units(name: str, how: Any) -> None:
    system = scattered.discs().changed({"c1.pressure": cw.Table([(0.0, 0.0), (0.2, 2e5)])})
    with pytest.raises(cw.ClutchworkError, match=UNKNOWN[name]) as caught:
        cw.sweep(system, 2.0, vary=cw.design({name: how}, 5), outputs="load.speed")
    assert "unit" not in str(caught.value)


def test_many_values_with_one_mistake_are_told_in_one_line() -> None:
    for name, mean in (("engine.inertia", 0.2), ("c1.gain", 5e-4)):
        made = cw.design({name: cw.normal(mean, mean)}, 200)
        wrong = int(np.sum(made[name] < 0.0))
        with pytest.raises(cw.ModelError, match=f", and {wrong - 1} other values are like it; give") as caught:
            cw.sweep(scattered.discs(), 2.0, vary=made, outputs="load.speed")
        assert len(caught.value.problems) == 1


def test_a_width_in_degrees_is_one_in_kelvin() -> None:
    d = cw.Driveline()
    a, b = d.shaft("a", inertia=1.0, speed=1.0), d.shaft("b", inertia=1.0)
    air = d.ambient("air", temperature=300.0)
    c = d.add(cw.DiskClutch("c", base=a, follower=b, radius=0.1, normal_force=1.0, thermal_mass=500.0))
    d.add(cw.Convection("cooling", hot=c.plates, cold=air, conductance=20.0))
    source = d.assemble().source
    assert source is not None
    made = cw.design({"air.temperature": cw.normal("20 degC", "5 degC")}, 9).in_si(source)
    assert str(made.given["air.temperature"]) == "normal(293.15, 5)"


def test_a_sweep_takes_a_design() -> None:
    system, made = scattered.discs(), scattered.design(50, method="sobol", seed=3)
    found = cw.sweep(system, scattered.T_END, vary=made, outputs=scattered.OUTPUTS)
    assert found.coords["c1.gain"].tolist() == made["c1.gain"].tolist() == made.to_pandas()["c1.gain"].tolist()
    # both torques act until the speeds meet: 0.16 kg m2 is what the difference feels
    torque = 0.1 * made["c1.gain"] * made["c1.pressure"]
    assert np.allclose(found["lock(c1)"], 100.0 * 0.16 / torque, rtol=1e-9)


def test_values_of_any_kind() -> None:
    laws = {"grey": cw.Coulomb(static=0.2, kinetic=0.1), "red": cw.Coulomb(static=0.2, kinetic=0.2)}
    made = cw.design({"c1.friction": cw.discrete(laws), "c1.gain": (4e-4, 8e-4)}, 40)
    found = cw.sweep(scattered.discs(), 2.0, vary=made, outputs=[cw.lock("c1")]).to_pandas()
    grey = found["c1.friction"] == "grey"
    assert grey.sum() == 20
    assert np.allclose(found["lock(c1)"] * found["c1.gain"] * np.where(grey, 0.1, 0.2), 100.0 * 0.16 / 2e5)


WRONG: dict[str, tuple[Any, str]] = {
    "no distributions": (lambda: cw.design({}, 10), "vary is {}"),
    "no count": (lambda: cw.design({"x": (0, 1)}, 0), "count is 0: give a whole number of at least 1"),
    "seed": (lambda: cw.design({"x": (0, 1)}, 5, seed=-1), "seed is -1"),
    "method": (lambda: cw.design({"x": (0, 1)}, 5, method="sobl"), "did you mean 'sobol'"),
    "second order": (lambda: cw.design({"x": (0, 1)}, 5, second_order=True), "method='saltelli' alone"),
    "no distribution": (lambda: cw.design({"x": 3.0}, 5), "x: 3.0 is not a distribution"),
    "bounds": (lambda: cw.uniform(2.0, 1.0), "low is 2 and high is 1: low must be below high"),
    "deviation": (lambda: cw.normal(2.0, -1.0), "deviation is -1: it must be positive"),
    "mode": (lambda: cw.triangular(0.0, 5.0, 1.0), "mode is 5: it must lie between"),
    "number": (lambda: cw.normal(np.nan, "x"), "give a finite number"),
    "units": (lambda: cw.uniform("1 bar", 2e5), "have different units: bar, none"),
    "logarithm": (lambda: cw.lognormal(1.0, "0.1 bar"), "that of the logarithm"),
    "shares": (lambda: cw.discrete([1, 2], [1.0]), "each of 2 values"),
    "values": (lambda: cw.discrete([]), "give a list of values"),
    "column": (lambda: cw.design({"x": (0, 1)}, 5)["y"], "does not vary 'y'"),
    "call": (lambda: cw.design(count=5), "vary is missing"),  # type: ignore[call-arg]
}


@pytest.mark.parametrize("name", WRONG)
def test_mistakes(name: str) -> None:
    call, text = WRONG[name]
    with pytest.raises(cw.ClutchworkError) as error:
        call()
    assert text in str(error.value)


def test_how_it_is_shown() -> None:
    made = cw.design({"a": cw.normal("2 bar", "0.1 bar"), "b": [1, 2]}, 8, method="saltelli")
    assert repr(made) == "<Design of 32 variants: saltelli, seed 0; a, b>"
    assert "normal(2, 0.1) bar" in str(made)
    assert "discrete(1: 0.5, 2: 0.5)" in str(made)

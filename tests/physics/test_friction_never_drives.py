"""No friction law has a coefficient below zero, or it warns of it; tables beyond their ends."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.schema import Role, inputs
from clutchwork.model.pools import coefficients
from support import samples
from support.amount import amount
from support.random_laws import random_law
from support.runs import TIGHT, assert_switches

LAWS = samples.declared(Role.LAW)
SLIPS = np.concatenate([[0.0], np.geomspace(1e-3, 1e4, 50)])
FALLING = [(0.0, 0.13), (10.0, 0.12), (30.0, 0.11)]


def brake(law: cw.Law, speed: float, drive: Any = None) -> cw.Driveline:
    """A shaft of 0.5 kg m2 that a brake of 100 N m stops, times its coefficient; or one with a given speed."""
    d = cw.Driveline("brake")
    shaft = d.shaft("a", inertia=0.5, speed=speed)
    if drive is not None:
        d.add(cw.PrescribedSpeed("p", shaft=shaft, speed=drive))
    d.add(cw.Brake("b", shaft=shaft, friction=law, gain=1.0, normal_force=100.0))
    return d


def quietly(d: cw.Driveline, t_end: float, **options: Any) -> Any:
    """A run whose warnings, and an end before its time, are expected."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return d.simulate(t_end, **options)


@pytest.mark.random
@pytest.mark.parametrize("cls", [cls for cls in LAWS if cls.sticks], ids=lambda cls: cls.kind)
def test_a_law_that_sticks_has_no_coefficient_below_zero(cls: Any) -> None:
    rng = np.random.default_rng(5)
    for _ in range(amount()):
        law = random_law(cls, rng)
        driven = any(inputs(cls))
        # a table that ends with an error is not evaluated beyond it, see below
        last = law.kinetic[-1][0] if getattr(law, "extrapolation", "") == "error" and not driven else math.inf
        found = _from_runs(law) if driven else [coefficients(law, slip) for slip in SLIPS if slip <= last]
        assert min(min(pair) for pair in found) >= 0.0, law


def _from_runs(law: Any) -> list[tuple[float, float]]:
    """Coefficients of a law with a temperature, read from a brake at given speeds."""
    found = [(0.0, 0.0)]
    for slip in (1e-3, 3.0, 100.0, 1e4):
        run = quietly(brake(law, slip, slip), 1e-3, dt=1e-3)
        if run.status != "done":
            assert run.status == "out_of_table"
            continue
        found.append((float(-run["b.torque"][-1]) / 100.0, float(run["b.capacity"][-1])))
    return found


@pytest.mark.random
@pytest.mark.parametrize("cls", [cls for cls in LAWS if not cls.sticks], ids=lambda cls: cls.kind)
def test_a_law_that_settles_in_sliding_opposes_it_or_warns(cls: Any) -> None:
    """Held at one slip long enough for its states to settle, a law takes power from the shaft."""
    rng = np.random.default_rng(6)
    for _ in range(max(3, amount() // 10)):
        law = random_law(cls, rng)
        slip = float(np.exp(rng.uniform(math.log(1e-2), math.log(1e4))))
        # bristles with an exponent below 1 never quite settle
        run = quietly(brake(law, slip, slip), 10.0 / slip + 0.1, points=2, max_steps=2000)
        assert run["b.power"][-1] <= 1e-9 * slip or law.advice(), (law, slip)


def test_a_wind_up_with_too_small_a_range_names_the_slip_at_which_it_drives() -> None:
    law = cw.Mykhalevych(static=0.15, kinetic=0.03, elastic=1e-4, speed=2.0, viscous=0.2, range=0.2)
    named = next(message for name, message, _ in law.advice() if name == "range")
    slip = float(named.split("a slip of ")[1].split(" rad/s")[0])
    powers = [quietly(brake(law, x, x), 1.0, points=2)["b.power"][-1] for x in (0.95 * slip, 1.05 * slip)]
    assert powers[0] < 0.0 < powers[1]


@pytest.mark.parametrize("extrapolation", ["linear", "nearest"])
@pytest.mark.parametrize("cls", [cw.CoefficientTable, cw.FrictionTable])
def test_a_run_far_beyond_the_table_loses_energy(cls: Any, extrapolation: str) -> None:
    """400 rad/s with a table up to 30 rad/s, whose line falls to zero at 250 rad/s."""
    law = cls(static=0.14, kinetic=FALLING, extrapolation=extrapolation)
    d = cw.Driveline("far")
    fast, slow = d.shaft("e", inertia=0.2, speed=400.0), d.shaft("l", inertia=0.8)
    d.add(cw.Clutch("c1", base=fast, follower=slow, friction=law, gain=5e-4, pressure=2e5))
    run = quietly(d, 10.0)
    assert run.status == "done"
    assert np.max(run["c1.power"]) <= 0.0
    assert np.all(np.diff(run["c1.heat"]) >= 0.0)
    assert run.energy.residual == pytest.approx(0.0, abs=1e-4 * 16_000.0)
    # held at 0.11 it takes 11 N m; continued it takes nothing
    expected = 0.0 if extrapolation == "linear" else 11.0
    assert run["c1.torque"][0] == pytest.approx(expected, abs=1e-12)


def test_a_coefficient_table_keeps_its_values_at_both_ends_by_default() -> None:
    law = cw.CoefficientTable(static=0.2, kinetic=[(5.0, 0.1), (6.0, 0.12), (30.0, 0.11)])
    assert [coefficients(law, slip)[0] for slip in (0.0, 4.0, 5.5, 1e4)] == pytest.approx([0.1, 0.1, 0.11, 0.11])
    assert law.sliding() == 0.1
    assert brake(law, 1.0).check() == []


@pytest.mark.parametrize("cls", [cls for cls in LAWS if "extrapolation" in cls.__dataclass_fields__])
def test_every_table_keeps_its_end_values_by_default(cls: Any) -> None:
    assert cls.__dataclass_fields__["extrapolation"].default == "nearest"


def test_a_table_continued_to_zero_has_a_kink_there() -> None:
    """A load of 10 N m alone down to 250 rad/s, then J dw/dt = -10 - 100 (0.125 - w/2000): the kink is located."""
    law = cw.CoefficientTable(static=0.15, kinetic=[(0.0, 0.125), (30.0, 0.11)], extrapolation="linear")
    d = brake(law, 400.0)
    d.add(cw.Torque("load", shaft=d.nodes[0], torque=-10.0))
    run = quietly(d, 20.0, **TIGHT)
    free = 0.5 * 150.0 / 10.0
    # dw/dt = -45 + 0.1 w from 250 to 0
    lock = free + 10.0 * math.log(45.0 / 20.0)
    assert_switches(run, [(lock, "b", "forward", "locked")])


def test_a_line_that_is_below_zero_at_rest_is_refused() -> None:
    law = cw.CoefficientTable(static=0.2, kinetic=[(5.0, 0.01), (6.0, 0.1)], extrapolation="linear")
    problems = [str(p) for p in brake(law, 1.0).check()]
    wanted = "is -0.44 at 0 rad/s when it is extrapolated linearly, must be >= 0"
    assert any(wanted in text for text in problems), problems


def test_leaving_a_coefficient_table_stops_the_run_where_that_is_wanted() -> None:
    law = cw.CoefficientTable(static=0.2, kinetic=FALLING, extrapolation="error")
    run = quietly(brake(law, 0.0, cw.Ramp(height=60.0, duration=2.0)), 2.0)
    assert run.status == "out_of_table"
    assert run.time[-1] == pytest.approx(1.0, abs=1e-6)
    assert "the table covers 0 to 30 rad/s" in run.message
    # a run that starts there stops at once
    start = quietly(brake(law, 400.0), 2.0)
    assert (start.status, start.time[-1]) == ("out_of_table", 0.0)
    above = cw.CoefficientTable(static=0.2, kinetic=FALLING[1:], extrapolation="error")
    assert any("must start at 0" in str(p) for p in brake(above, 1.0).check())


ROWS = {"temperatures": [300.0, 400.0, 500.0], "speeds": [0.0, 20.0, 40.0], "static": [0.4, 0.4, 0.4]}
LINEAR: dict[str, Any] = {"extrapolation": "linear"}
CONTINUED = {
    "coefficient table": (cw.CoefficientTable(static=0.14, kinetic=FALLING, **LINEAR), ["250 rad/s"]),
    "friction table": (cw.FrictionTable(static=0.14, kinetic=FALLING, **LINEAR), ["250 rad/s"]),
    # end slope of the parabola: (1.5 * 0.005 - 0.5 * 0.001) / 1 ... below the last secant
    "smooth": (
        cw.FrictionTable(
            static=0.4, kinetic=[(0.0, 0.3), (10.0, 0.29), (20.0, 0.24)], interpolation="smooth", **LINEAR
        ),
        [f"{20 + 0.24 / 0.007:g} rad/s"],
    ),
    "temperature": (
        cw.TemperatureTable(
            static=[(300.0, 0.4), (400.0, 0.4), (500.0, 0.4)],
            kinetic=[(300.0, 0.1), (400.0, 0.2), (500.0, 0.1)],
            temperature=300.0,
            **LINEAR,
        ),
        ["600 K", "200 K"],
    ),
    "map": (
        cw.FrictionMap(
            **ROWS, kinetic=[[0.1, 0.1, 0.1], [0.2, 0.2, 0.1], [0.2, 0.2, 0.2]], temperature=300.0, **LINEAR
        ),
        ["60 rad/s", "200 K"],
    ),
    "rising": (cw.CoefficientTable(static=0.3, kinetic=[(0.0, 0.1), (10.0, 0.2)], **LINEAR), []),
    "out of reach": (cw.CoefficientTable(static=0.3, kinetic=[(0.0, 0.1), (9.0, 0.09999)], **LINEAR), []),
    "held": (cw.CoefficientTable(static=0.14, kinetic=FALLING), []),
}


@pytest.mark.parametrize("name", CONTINUED)
def test_a_continuation_that_falls_to_zero_is_warned_of_with_its_place(name: str) -> None:
    law, places = CONTINUED[name]
    said = [message for _, message, _ in law.advice()]
    assert [text for text in said if not text.startswith("falls to zero at")] == []
    assert [text.split(" at ")[1].split(" when")[0] for text in said] == places
    if places:
        with pytest.warns(cw.ModelWarning, match="falls to zero"):
            assert brake(law, 1.0).check() == []

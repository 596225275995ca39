"""Friction of a disc clutch over speed and temperature, and its tables, against closed forms and SciPy."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

import clutchwork as cw
from support.disk_clutches import GAIN, MAP, REDUCED, W0, clutch, coefficient, discs, problems
from support.runs import TIGHT, assert_switches, at_end

feature = pytest.mark.feature


@feature("friction model: over speed")
@feature("tables: linear interpolation")
def test_coefficient_over_speed() -> None:
    """A straight line k0 - s w: the slip obeys dw/dt = -(G/Jred)(k0 - s w), an exponential."""
    k0, s = 0.3, 0.0006
    table = cw.FrictionTable(static=0.35, kinetic=[(0.0, k0), (50.0, k0 - 50 * s), (200.0, k0 - 200 * s)])
    run = discs(clutch(friction=table, pressure=1e5)).simulate(3.0, **TIGHT)
    rate = GAIN * 1e5 / REDUCED
    lock = math.log(k0 / (k0 - s * W0)) / (rate * s)
    assert_switches(run, [(lock, "c1", "forward", "locked")])


@feature("friction model: over temperature")
def test_coefficient_over_temperature() -> None:
    """Heating by the slip alone: theta = theta0 + E/C, E = Jred (w0^2 - w^2)/2, and k falls with theta.

    dw/dt = -(G P/Jred) (k0 - f (theta - 300)): with u = k0 - f Jred (w0^2 - w^2)/(2 C) this is a quadratic in w,
    whose time to zero slip is an arctangent.
    """
    k0, f, capacity = 0.3, 1e-3, 80.0
    table = cw.TemperatureTable(static=[(300.0, 0.4), (400.0, 0.3)], kinetic=[(300.0, k0), (400.0, k0 - 100 * f)])
    run = discs(clutch(friction=table, pressure=1e5, thermal_mass=capacity)).simulate(3.0, **TIGHT)
    a = k0 - f * REDUCED * W0**2 / (2 * capacity)
    b = f * REDUCED / (2 * capacity)
    lock = REDUCED / (GAIN * 1e5) * math.atan(W0 * math.sqrt(b / a)) / math.sqrt(a * b)
    assert_switches(run, [(lock, "c1", "forward", "locked")])
    rise = 0.5 * REDUCED * W0**2 / capacity
    assert at_end(run, "c1.capacity") == pytest.approx((0.4 - 1e-3 * rise) * GAIN * 1e5, rel=1e-9)


@feature("friction model: over temperature and speed")
def test_coefficient_over_temperature_and_speed() -> None:
    """A bilinear map, read at prescribed slip and temperature."""
    for kelvin, slip in ((300.0, 0.0), (330.0, 40.0), (390.0, 85.0), (400.0, 100.0)):
        x, y = (kelvin - 300.0) / 100.0, slip / 100.0
        expected = (1 - x) * ((1 - y) * 0.35 + y * 0.25) + x * ((1 - y) * 0.28 + y * 0.16)
        law = cw.FrictionMap(**MAP, temperature=kelvin)
        assert coefficient(law, max(slip, 1e-9)) == pytest.approx(expected, rel=1e-9)


@feature("friction model: any law of the friction family")
@pytest.mark.parametrize(
    "law",
    [
        cw.Stribeck(static=0.15, kinetic=0.1, speed=2.0),
        cw.Exponential(static=0.15, slow=0.14, fast=0.1, speed=10.0),
        cw.LuGre(static=0.15, kinetic=0.1, speed=2.0, viscous=1e-4, stiffness=1e3, damping=2e-4),
    ],
    ids=lambda law: type(law).__name__,
)
def test_takes_any_friction_law(law: cw.Law) -> None:
    run = discs(clutch(friction=law)).simulate(4.0, rtol=1e-9, atol=1e-10, max_step=0.01)
    assert run.status == "done"
    # bristles without much damping still swing
    assert abs(at_end(run, "c1.slip")) < 1e-3
    assert at_end(run, "c1.heat") == pytest.approx(0.5 * REDUCED * W0**2, rel=1e-6)


POINTS = [(0.0, 0.3), (20.0, 0.29), (35.0, 0.2), (80.0, 0.19), (100.0, 0.19)]


@feature("tables: smooth interpolation")
def test_smooth_tables_are_the_monotone_cubic() -> None:
    """Against SciPy's pchip, which has the same slopes; also continued beyond the end."""
    interpolate = pytest.importorskip("scipy.interpolate")
    pchip = interpolate.PchipInterpolator(*zip(*POINTS, strict=True))
    law = cw.FrictionTable(static=0.35, kinetic=POINTS, interpolation="smooth")
    for slip in (1e-3, 7.0, 20.0, 26.0, 34.9, 50.0, 79.0, 90.0, 100.0):
        assert coefficient(law, slip) == pytest.approx(float(pchip(slip)), rel=1e-12)


@feature("tables: smooth interpolation")
def test_smooth_tables_have_a_continuous_slope_and_no_overshoot() -> None:
    law = cw.FrictionTable(static=0.35, kinetic=POINTS, interpolation="smooth")
    for (x, y), (x_next, y_next) in pairwise(POINTS):
        inside = [coefficient(law, x + s * (x_next - x)) for s in (0.1, 0.3, 0.5, 0.7, 0.9)]
        assert min(y, y_next) - 1e-15 <= min(inside)
        assert max(inside) <= max(y, y_next) + 1e-15
    step = 1e-5
    for x, _ in POINTS[1:-1]:
        left = (coefficient(law, x) - coefficient(law, x - step)) / step
        right = (coefficient(law, x + step) - coefficient(law, x)) / step
        # second derivatives are some 1e-3
        assert left == pytest.approx(right, abs=1e-7)


@feature("tables: smooth interpolation")
@feature("friction model: over temperature and speed")
def test_a_smooth_map_has_continuous_slopes_both_ways_and_stays_between_its_corners() -> None:
    """Also where the coefficient turns over the temperature at one slip and not at another."""
    kelvin, slips = [300.0, 350.0, 380.0, 450.0], [0.0, 20.0, 60.0, 100.0]
    rows = [[0.3, 0.25, 0.2, 0.19], [0.34, 0.24, 0.22, 0.16], [0.32, 0.26, 0.15, 0.15], [0.2, 0.19, 0.18, 0.1]]
    given = {"temperatures": kelvin, "speeds": slips, "static": [0.4, 0.4, 0.4, 0.3], "kinetic": rows}

    def at(temperature: float, slip: float) -> float:
        return coefficient(cw.FrictionMap(**given, interpolation="smooth", temperature=temperature), slip)

    for i, j in ((0, 0), (1, 1), (2, 2), (1, 0)):
        corners = [rows[i][j], rows[i + 1][j], rows[i][j + 1], rows[i + 1][j + 1]]
        for x, y in ((0.2, 0.7), (0.5, 0.5), (0.8, 0.1)):
            inside = at(kelvin[i] + x * (kelvin[i + 1] - kelvin[i]), slips[j] + y * (slips[j + 1] - slips[j]))
            assert min(corners) - 1e-12 <= inside <= max(corners) + 1e-12
    step = 1e-4
    for temperature, slip in ((350.0, 33.0), (380.0, 71.0), (333.0, 20.0), (410.0, 60.0)):
        middle = at(temperature, slip)
        over_temperature = [(at(temperature + s * step, slip) - middle) / (s * step) for s in (-1, 1)]
        over_slip = [(at(temperature, slip + s * step) - middle) / (s * step) for s in (-1, 1)]
        # second derivatives are some 1e-3
        assert over_temperature[0] == pytest.approx(over_temperature[1], abs=1e-6)
        assert over_slip[0] == pytest.approx(over_slip[1], abs=1e-6)


@feature("tables: extrapolation linear")
@pytest.mark.filterwarnings("ignore:.*falls to zero:clutchwork.ModelWarning")
@pytest.mark.parametrize("interpolation", ["linear", "smooth"])
def test_extrapolation_linear(interpolation: str) -> None:
    points = [(0.0, 0.3), (50.0, 0.25), (100.0, 0.2)]
    law = cw.FrictionTable(static=0.35, kinetic=points, interpolation=interpolation, extrapolation="linear")
    assert coefficient(law, 130.0) == pytest.approx(0.17, rel=1e-12)
    # never below zero
    assert coefficient(law, 400.0) == 0.0


@feature("tables: extrapolation nearest")
@pytest.mark.parametrize("interpolation", ["linear", "smooth"])
def test_extrapolation_nearest(interpolation: str) -> None:
    points = [(0.0, 0.3), (50.0, 0.25), (100.0, 0.2)]
    law = cw.FrictionTable(static=0.35, kinetic=points, interpolation=interpolation, extrapolation="nearest")
    assert coefficient(law, 130.0) == 0.2
    cold = cw.TemperatureTable(
        static=[(300.0, 0.4), (350.0, 0.38), (400.0, 0.3)],
        kinetic=[(300.0, 0.35), (350.0, 0.3), (400.0, 0.2)],
        temperature=250.0,
        interpolation=interpolation,
        extrapolation="nearest",
    )
    assert coefficient(cold, 10.0) == 0.35


@feature("tables: extrapolation error")
def test_extrapolation_error_stops_the_run() -> None:
    """The drive takes the slip from 50 to 110 rad/s in 1.2 s; the table ends at 100 rad/s, which is passed at 1 s."""
    law = cw.FrictionTable(static=0.35, kinetic=[(0.0, 0.3), (100.0, 0.25)], extrapolation="error")
    d = cw.Driveline("left")
    shaft = d.shaft("a", inertia=1.0)
    d.add(cw.PrescribedSpeed("p", shaft=shaft, speed=cw.Table([(0.0, 50.0), (1.2, 110.0)])))
    d.add(cw.DiskClutch("c1", base=d.housing, follower=shaft, friction=law, radius=0.1, area=1e-3, pressure=1e5))
    with pytest.warns(cw.StoppedEarly) as caught:
        run = d.simulate(1.2)
    message = str(caught[0].message)
    assert run.status == "out_of_table"
    assert run.time[-1] == pytest.approx(1.0, abs=1e-6)
    # element, time, value, range
    for words in ("'c1'", "at 1 s", "value 100", "0 to 100 rad/s"):
        assert words in message, message


@feature("tables: extrapolation error")
def test_a_temperature_that_leaves_its_table_stops_the_run() -> None:
    table = cw.TemperatureTable(
        static=[(300.0, 0.4), (310.0, 0.39)], kinetic=[(300.0, 0.35), (310.0, 0.34)], extrapolation="error"
    )
    with pytest.warns(cw.StoppedEarly) as caught:
        run = discs(clutch(friction=table, thermal_mass=20.0)).simulate(2.0)
    assert run.status == "out_of_table"
    assert at_end(run, "c1.temperature") == pytest.approx(310.0, abs=1e-5)
    assert "300 to 310 K" in str(caught[0].message)


@feature("tables: at least two points for linear, three for smooth")
def test_too_few_points_are_named() -> None:
    one = cw.FrictionTable(static=0.35, kinetic=[(0.0, 0.3)])
    two = cw.FrictionTable(static=0.35, kinetic=[(0.0, 0.3), (9.0, 0.2)], interpolation="smooth")
    assert any("has 1 points" in text and "at least 2" in text for text in problems(friction=one))
    assert any("has 2 points" in text and "at least 3" in text for text in problems(friction=two))
    thin = cw.FrictionMap(**MAP, interpolation="smooth", temperature=300.0)
    found = problems(friction=thin)
    assert any("temperatures" in text for text in found)
    assert any("speeds" in text for text in found)


@feature("tables: axes strictly increasing")
@pytest.mark.parametrize("axis", [[0.0, 5.0, 5.0], [0.0, 5.0, 4.0]])
def test_axes_that_do_not_increase_are_named(axis: list[float]) -> None:
    table = cw.FrictionTable(static=0.35, kinetic=[(x, 0.3) for x in axis])
    assert any("must increase" in text or "x must" in text for text in problems(friction=table))
    rows = {**MAP, "speeds": axis, "kinetic": [[0.3, 0.3, 0.3], [0.2, 0.2, 0.2]]}
    assert any("speeds" in text for text in problems(friction=cw.FrictionMap(**rows, temperature=300.0)))


@feature("tables: every coefficient above zero")
def test_coefficients_that_are_not_above_zero_are_named() -> None:
    table = cw.FrictionTable(static=0.35, kinetic=[(0.0, 0.3), (5.0, 0.0)])
    assert any("must be > 0" in text for text in problems(friction=table))
    rows = {**MAP, "kinetic": [[0.3, 0.2], [0.2, -0.1]]}
    assert any("> 0" in text for text in problems(friction=cw.FrictionMap(**rows, temperature=300.0)))


@feature("tables: static above kinetic, element by element")
def test_a_static_coefficient_that_is_not_above_the_kinetic_one_is_named() -> None:
    table = cw.FrictionTable(static=0.3, kinetic=[(0.0, 0.25), (5.0, 0.3)])
    assert any(
        "not above the kinetic coefficient 0.3" in text and "5 rad/s" in text for text in problems(friction=table)
    )
    fade = cw.TemperatureTable(
        static=[(300.0, 0.4), (400.0, 0.2)], kinetic=[(300.0, 0.3), (400.0, 0.2)], temperature=300.0
    )
    assert any("400 K" in text for text in problems(friction=fade))
    rows = {**MAP, "kinetic": [[0.35, 0.25], [0.31, 0.16]]}
    found = problems(friction=cw.FrictionMap(**rows, temperature=300.0))
    assert any("400 K, 0 rad/s" in text for text in found)


def test_shapes_of_a_map_that_do_not_fit_are_named() -> None:
    rows = {**MAP, "kinetic": [[0.35, 0.25, 0.2], [0.3, 0.2, 0.1]]}
    assert any("must have 2 rows" in text for text in problems(friction=cw.FrictionMap(**rows, temperature=300.0)))
    short = {**MAP, "static": [0.4]}
    assert any("for 2 temperatures" in text for text in problems(friction=cw.FrictionMap(**short, temperature=300.0)))

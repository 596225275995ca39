"""The disc clutch against closed forms, feature by feature; the marks make the parity table of the documentation."""

from __future__ import annotations

import math
import warnings
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.run.failure import FaultWarning
from support.runs import EXACT, TIGHT, assert_switches, at_end

feature = pytest.mark.feature

J1, J2, W0 = 0.2, 0.8, 100.0
REDUCED = J1 * J2 / (J1 + J2)
LINING = cw.Coulomb(static=0.35, kinetic=0.3)
# torque over pressure and coefficient of what `clutch` makes by default [m3]
GAIN = 4 * 0.13 * 1e-3


def clutch(name: str = "c1", **given: Any) -> Any:
    """Base and follower are added by `discs`; it locks at zero slip exactly."""
    return name, {"friction": LINING, "radius": 0.13, "area": 1e-3, "pressure": 2e5, "tolerance": 0.0, **given}


def discs(made: Any, speed: float = W0, torque: float = 0.0) -> cw.Driveline:
    """Two discs, the follower with the speed, and a torque on the base."""
    name, given = made
    d = cw.Driveline("discs")
    base, follower = d.shaft("base", inertia=J2), d.shaft("follower", inertia=J1, speed=speed)
    if torque:
        d.add(cw.Torque("load", shaft=base, torque=torque))
    d.add(cw.DiskClutch(name, base=base, follower=follower, **given))
    return d


def rising(slope: float) -> cw.Table:
    """A signal that rises from zero."""
    return cw.Table([(0.0, 0.0), (10.0, 10.0 * slope)])


def problems(**given: Any) -> list[str]:
    """Mistakes of a disc clutch, in words."""
    return [str(problem) for problem in discs(clutch(**given)).check()]


# ---------------------------------------------------------------- engagement


@feature("geometry: effective radius")
@feature("geometry: number of friction surfaces")
@feature("geometry: engagement area")
@feature("friction model: fixed coefficients")
@feature("state machine: lock when the slip passes zero")
@feature("state machine: slipping forward")
@feature("outputs: torque, slip, state")
def test_engagement_at_constant_pressure() -> None:
    """The slip falls with T/Jred; T = 0.3 * 4 * 0.13 m * 2e5 Pa * 1e-3 m2."""
    run = discs(clutch()).simulate(2.0, **TIGHT)
    torque = 0.3 * GAIN * 2e5
    assert_switches(run, [(REDUCED * W0 / torque, "c1", "forward", "locked")])
    assert run["c1.torque"][0] == pytest.approx(-torque, rel=1e-14)
    assert at_end(run, "follower.speed") == pytest.approx(J1 * W0 / (J1 + J2), rel=1e-12)
    assert at_end(run, "c1.slip") == 0.0
    assert list(dict.fromkeys(run["c1.state"])) == ["forward", "locked"]


@feature("outputs: capacity, power, heat, energy")
@pytest.mark.parametrize("torque", [0.0, 3.0, -2.0])
def test_heat_of_an_engagement(torque: float) -> None:
    """E = 1/2 Jred w0^2 without a load; with one it is T w0^2/(2 (T + L)/...), the time being that of the slip.

    With a load on the base the slip falls with T/Jred + L/J2, so E = T w0^2/2 over that.
    """
    run = discs(clutch(), torque=torque).simulate(3.0, **TIGHT)
    kinetic = 0.3 * GAIN * 2e5
    expected = 0.5 * kinetic * W0**2 / (kinetic / REDUCED + torque / J2)
    if torque == 0.0:
        assert expected == pytest.approx(0.5 * REDUCED * W0**2, rel=1e-14)
    assert at_end(run, "c1.heat") == pytest.approx(expected, rel=1e-9)
    assert run["c1.power"][0] == pytest.approx(-kinetic * W0, rel=1e-12)
    assert at_end(run, "c1.power") == 0.0
    assert at_end(run, "c1.capacity") == pytest.approx(0.35 * GAIN * 2e5, rel=1e-12)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


@feature("geometry: annular region")
def test_effective_radius_of_a_ring() -> None:
    """r_eff = 2/3 (ro^3 - ri^3)/(ro^2 - ri^2)."""
    ro, ri = 0.075, 0.05
    ring = cw.DiskClutch("c", **ports(), area=1e-3, pressure=1e5, outer_diameter=2 * ro, inner_diameter=2 * ri)
    assert ring.effective_radius == pytest.approx(2 / 3 * (ro**3 - ri**3) / (ro**2 - ri**2), rel=1e-14)
    d = discs(clutch(radius=None, outer_diameter=2 * ro, inner_diameter=2 * ri))
    run = d.simulate(0.01)
    assert run["c1.torque"][0] == pytest.approx(-0.3 * 4 * ring.effective_radius * 2e5 * 1e-3, rel=1e-14)
    # a thin ring keeps its digits
    thin = cw.DiskClutch("c", **ports(), area=1e-3, pressure=1e5, outer_diameter=0.2, inner_diameter=0.2 * (1 - 1e-12))
    assert thin.effective_radius == pytest.approx(0.1, rel=1e-11)


def ports() -> dict[str, cw.Node]:
    """Two shafts of no driveline."""
    return {"base": cw.Node("base", inertia=1.0), "follower": cw.Node("follower", inertia=1.0)}


@feature("wear: de-rating factor")
def test_derating_scales_the_torque_and_tends_to_uniform_wear() -> None:
    from clutchwork.elements.bases.geometry import derating_when_worn, mean_radius

    ro, ri = 0.075, 0.05
    worn = derating_when_worn(2 * ro, 2 * ri)
    assert worn == pytest.approx(0.75 * (ro + ri) ** 2 / (ro**2 + ro * ri + ri**2), rel=1e-14)
    # at uniform wear D r_eff is the mean radius
    assert worn * mean_radius(2 * ro, 2 * ri) == pytest.approx((ro + ri) / 2, rel=1e-14)
    run = discs(clutch(derating=0.8)).simulate(0.01)
    assert run["c1.torque"][0] == pytest.approx(-0.8 * 0.3 * GAIN * 2e5, rel=1e-14)


@feature("inputs: normal force")
def test_normal_force_stands_for_pressure_times_area() -> None:
    run = discs(clutch(pressure=None, normal_force=200.0)).simulate(0.01)
    assert run["c1.torque"][0] == pytest.approx(-0.3 * 4 * 0.13 * 200.0, rel=1e-14)


# ---------------------------------------------------------------- thresholds, drag, direction, start


@feature("thresholds: engagement pressure")
@feature("state machine: wait while the threshold is not reached")
def test_nothing_is_transmitted_up_to_the_threshold() -> None:
    """Pressure 1e6 t, threshold 1e5 Pa: closed from 0.1 s on; slip w0 - a (t - 0.1)^2/2."""
    run = discs(clutch(pressure=rising(1e6), threshold=1e5)).simulate(1.0, **TIGHT)
    slope = 0.3 * GAIN * 1e6
    lock = 0.1 + math.sqrt(2 * REDUCED * W0 / slope)
    assert_switches(run, [(lock, "c1", "forward", "locked")])
    waiting = run.time < 0.1
    assert set(run["c1.state"][waiting]) == {"open"}
    assert np.all(run["c1.torque"][waiting] == 0.0)
    assert set(run["c1.state"][(run.time > 0.101) & (run.time < lock - 1e-3)]) == {"forward"}


def below(load: float) -> cw.Table:
    """A load that is below zero up to the end of the run."""
    return cw.Table([(0.0, -load), (0.6, -load), (0.7, load)])


@feature("inputs: negative pressure counts as zero")
@pytest.mark.parametrize("given", [{"pressure": below(2e5)}, {"pressure": None, "normal_force": below(500.0)}])
def test_a_negative_pressure_counts_as_zero(given: dict[str, Any]) -> None:
    run = discs(clutch(**given)).simulate(0.5)
    assert np.all(run["c1.torque"] == 0.0)
    assert at_end(run, "follower.speed") == pytest.approx(W0, rel=1e-14)


@feature("viscous loss: drag coefficient")
def test_drag_acts_always_and_counts_as_the_clutch() -> None:
    """Open, the slip decays with the time constant Jred/drag; its heat is that of the clutch."""
    run = discs(clutch(pressure=0.0, drag=0.4)).simulate(1.0, **TIGHT)
    slip = W0 * math.exp(-0.4 / REDUCED)
    assert at_end(run, "c1.slip") == pytest.approx(slip, rel=1e-10)
    assert at_end(run, "c1.torque") == pytest.approx(-0.4 * slip, rel=1e-10)
    assert at_end(run, "c1.heat") == pytest.approx(0.5 * REDUCED * (W0**2 - slip**2), rel=1e-10)
    assert set(run["c1.state"]) == {"open"}
    # closed, it adds to the friction
    both = discs(clutch(drag=0.4)).simulate(0.01)
    assert both["c1.torque"][0] == pytest.approx(-(0.3 * GAIN * 2e5 + 0.4 * W0), rel=1e-12)


@feature("thresholds: velocity tolerance")
def test_locks_as_soon_as_the_slip_is_within_the_tolerance() -> None:
    """At (w0 - tolerance)/w0 of the time to zero slip; what is left of the slip ends there, momentum stays."""
    zero = REDUCED * W0 / (0.3 * GAIN * 2e5)
    for tolerance in (0.0, 1e-3, 0.5):
        run = discs(clutch(tolerance=tolerance)).simulate(1.0, **TIGHT)
        assert_switches(run, [(zero * (1 - tolerance / W0), "c1", "forward", "locked")])
        assert at_end(run, "follower.speed") == pytest.approx(J1 * W0 / (J1 + J2), rel=1e-12)
    assert cw.DiskClutch("c", **ports(), area=1e-3, pressure=1.0, radius=1.0).tolerance == 1e-3


@feature("thresholds: velocity tolerance")
def test_never_locks_above_the_tolerance() -> None:
    """The slip falls to 0.3 rad/s, driven: it is stopped only where the tolerance is larger, and then driven on."""
    for tolerance, locks in ((0.2, False), (0.4, True)):
        d = cw.Driveline("least slip")
        base, follower = d.shaft("base"), d.shaft("follower", inertia=1.0, speed=3.0)
        # drive and friction balance at a slip of 0.3 rad/s
        d.add(cw.PrescribedSpeed("p", shaft=base, speed=0.0))
        d.add(cw.Damper("way", base=base, follower=follower, damping=10.0))
        d.add(cw.Torque("drive", shaft=follower, torque=6.0))
        plates = {"friction": LINING, "radius": 1.0, "surfaces": 1, "normal_force": 10.0, "tolerance": tolerance}
        d.add(cw.DiskClutch("c1", base=base, follower=follower, **plates))
        run = d.simulate(3.0)
        assert (run["c1.slip"].min() < 0.1) == locks


@feature("direction: bidirectional")
@feature("state machine: slipping backward")
def test_slips_in_both_directions() -> None:
    for speed, state in ((W0, "forward"), (-W0, "backward")):
        run = discs(clutch(), speed=speed).simulate(0.01)
        assert run["c1.state"][0] == state
        assert np.sign(run["c1.torque"][0]) == -np.sign(speed)


@feature("direction: unidirectional")
def test_unidirectional_is_a_one_way_clutch_in_parallel() -> None:
    """The same run as with the freewheel put beside by hand: it slips forward, and is never overtaken."""
    signal = cw.Table([(0.0, 0.0), (0.5, 20.0), (1.5, -40.0), (2.0, -40.0)])
    runs = []
    for direction in ("unidirectional", "bidirectional"):
        d = cw.Driveline(direction)
        base, follower = d.shaft("base", inertia=J2), d.shaft("follower", inertia=J1, speed=5.0)
        d.add(cw.Torque("drive", shaft=follower, torque=signal))
        d.add(
            cw.DiskClutch(
                "c1",
                base=base,
                follower=follower,
                friction=LINING,
                radius=0.13,
                area=1e-3,
                pressure=2e4,
                direction=direction,
            )
        )
        if direction == "bidirectional":
            d.add(cw.OneWayClutch("way", base=base, follower=follower))
        runs.append(d.simulate(2.0, dt=0.01, **TIGHT))
    built_in, by_hand = runs
    np.testing.assert_allclose(built_in["follower.speed"], by_hand["follower.speed"], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(
        built_in["c1.torque"], by_hand["c1.torque"] + by_hand["way.torque"], rtol=1e-9, atol=1e-9
    )
    assert np.min(built_in["c1.slip"]) > -1e-9
    assert at_end(built_in, "c1.slip") == 0.0
    # it carries more than the friction could
    assert at_end(built_in, "c1.torque") > 2 * 0.35 * GAIN * 2e4


@feature("initial state: locked")
@feature("initial state: unlocked")
@feature("state machine: unlock when the torque exceeds the static limit")
def test_starts_locked_and_breaks_away_at_the_static_limit() -> None:
    """A torque 100 t on the base of which the follower takes J1/(J1 + J2): breaks away at 0.35 GAIN P."""
    d = discs(clutch(locked=True, pressure=1e5), speed=0.0)
    d.add(cw.Torque("ramp", shaft=d.nodes[0], torque=rising(200.0)))
    run = d.simulate(1.0, **TIGHT)
    limit = 0.35 * GAIN * 1e5
    assert_switches(run, [(limit / (200.0 * J1 / (J1 + J2)), "c1", "locked", "backward")])
    assert run["c1.state"][0] == "locked"
    assert discs(clutch(locked=False)).simulate(0.001)["c1.state"][0] == "forward"


# ---------------------------------------------------------------- heat and temperature


@feature("thermal: port joins a network")
@feature("thermal: slip power heats the thermal mass")
@feature("thermal: thermal mass and initial temperature")
@feature("outputs: temperature")
def test_temperature_rise_of_the_thermal_mass() -> None:
    """All the heat goes to the mass: it rises by E/C from its initial temperature."""
    run = discs(clutch(thermal_mass=500.0, initial_temperature=320.0)).simulate(2.0, **TIGHT)
    energy = 0.5 * REDUCED * W0**2
    assert run["c1.plates.temperature"][0] == 320.0
    assert at_end(run, "c1.plates.temperature") == pytest.approx(320.0 + energy / 500.0, rel=1e-12)
    assert at_end(run, "c1.plates.heat") == pytest.approx(energy, rel=1e-9)
    np.testing.assert_array_equal(run["c1.temperature"], run["c1.plates.temperature"])
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover
    # 300 K unless it is given
    assert discs(clutch(thermal_mass=500.0)).simulate(0.001)["c1.plates.temperature"][0] == 300.0


@feature("thermal: port joins a network")
def test_own_thermal_mass_cools_to_the_surroundings() -> None:
    d = discs(clutch(thermal_mass=500.0, pressure=0.0, initial_temperature=400.0))
    element: Any = d.elements[0]
    d.add(cw.Conduction("air", hot=element.plates, cold=d.ambient("around", temperature=300.0), conductance=50.0))
    run = d.simulate(10.0, **TIGHT)
    assert at_end(run, "c1.plates.temperature") == pytest.approx(300.0 + 100.0 * math.exp(-1.0), rel=1e-10)


@feature("thermal: port joins a network")
def test_heat_of_drag_and_friction_goes_to_a_node() -> None:
    d = cw.Driveline("node")
    base, follower = d.shaft("base", inertia=J2), d.shaft("follower", inertia=J1, speed=W0)
    oil = d.thermal("oil", capacity=1000.0)
    d.add(
        cw.DiskClutch(
            "c1",
            base=base,
            follower=follower,
            friction=LINING,
            radius=0.13,
            area=1e-3,
            pressure=1e5,
            drag=0.1,
            heat=oil,
        )
    )
    run = d.simulate(3.0, **TIGHT)
    assert run["c1.state"][-1] == "locked"
    assert at_end(run, "oil.heat") == pytest.approx(0.5 * REDUCED * W0**2, rel=1e-9)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


# ---------------------------------------------------------------- friction models


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


MAP: dict[str, Any] = {
    "temperatures": [300.0, 400.0],
    "speeds": [0.0, 100.0],
    "static": [0.4, 0.3],
    "kinetic": [[0.35, 0.25], [0.28, 0.16]],
}


@feature("friction model: over temperature and speed")
def test_coefficient_over_temperature_and_speed() -> None:
    """A bilinear map, read at prescribed slip and temperature."""
    for kelvin, slip in ((300.0, 0.0), (330.0, 40.0), (390.0, 85.0), (400.0, 100.0)):
        x, y = (kelvin - 300.0) / 100.0, slip / 100.0
        expected = (1 - x) * ((1 - y) * 0.35 + y * 0.25) + x * ((1 - y) * 0.28 + y * 0.16)
        law = cw.FrictionMap(**MAP, temperature=kelvin)
        assert coefficient(law, max(slip, 1e-9)) == pytest.approx(expected, rel=1e-9)


def coefficient(law: cw.Law, slip: float) -> float:
    """Kinetic coefficient at a slip [rad/s], from a clutch under prescribed speed."""
    d = cw.Driveline("law")
    shaft = d.shaft("a", inertia=1.0)
    d.add(cw.PrescribedSpeed("p", shaft=shaft, speed=slip))
    d.add(cw.DiskClutch("c", base=d.housing, follower=shaft, friction=law, radius=1.0, surfaces=1, normal_force=1.0))
    return float(-d.simulate(1e-3)["c.torque"][0])


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


# ---------------------------------------------------------------- tables

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


# ---------------------------------------------------------------- bad input


@feature("geometry: annular region")
def test_rings_that_are_none_are_named() -> None:
    ring = {"radius": None, "outer_diameter": 0.1}
    assert any("not below the outer diameter" in text for text in problems(**ring, inner_diameter=0.15))
    assert any("inner_diameter" in text and "missing" in text for text in problems(**ring))
    assert any("outer_diameter" in text and "missing" in text for text in problems(radius=None))
    assert any("together with a diameter" in text for text in problems(outer_diameter=0.2, inner_diameter=0.1))


def test_mistakes_of_the_law_hide_none_of_the_clutch() -> None:
    """All at once: the ring, the fault, too few points, and every place where the static coefficient is too low."""
    table = cw.FrictionTable(static=0.2, kinetic=[(0.0, 0.3), (5.0, 0.25)], interpolation="smooth")
    ring = {"radius": None, "outer_diameter": 0.1, "inner_diameter": 0.15}
    found = problems(friction=table, fault="cannot_unlock", **ring)
    for words in ("has 2 points", "at 0 rad/s", "at 5 rad/s", "not below the outer diameter", "nothing triggers it"):
        assert any(words in text for text in found), (words, found)
    # also where a value of the law makes no sense by itself
    broken = cw.FrictionTable(static=0.2, kinetic=[(0.0, 0.3), (5.0, 0.25), (5.0, 0.1)])
    found = problems(friction=broken, **ring)
    for words in ("appears twice", "not below the outer diameter"):
        assert any(words in text for text in found), (words, found)


def test_what_contradicts_itself_is_named() -> None:
    assert any("nothing triggers it" in text for text in problems(fault="cannot_unlock"))
    assert any("triggers no fault" in text for text in problems(fault_time=1.0))
    table = cw.TemperatureTable(static=[(300.0, 0.4), (400.0, 0.3)], kinetic=[(300.0, 0.3), (400.0, 0.2)])
    assert any("temperature" in text for text in problems(friction=table))


# ---------------------------------------------------------------- faults


def faulty(**given: Any) -> Any:
    """A locked pair that is driven through the clutch, with a fault."""
    return discs(clutch(**{"pressure": 1e5, "report": "none", **given}))


@feature("faults: triggered at a time")
@feature("faults: cannot transmit power")
@feature("faults: stays for the rest of the run")
def test_a_clutch_that_fails_at_a_time_transmits_nothing_from_then_on() -> None:
    run = faulty(fault="cannot_transmit", fault_time=0.2).simulate(1.0, **TIGHT)
    rate = 0.3 * GAIN * 1e5 / REDUCED
    failed = next(e for e in run.events if e.cause == "fault")
    assert failed.time == 0.2
    assert at_end(run, "c1.slip") == pytest.approx(W0 - rate * 0.2, rel=1e-12)
    assert np.all(run["c1.torque"][run.time > 0.2] == 0.0)
    assert run["c1.state"][-1] == "open"


@feature("faults: triggered by a signal")
@feature("faults: stays for the rest of the run")
def test_a_clutch_that_fails_by_a_signal_stays_so_when_the_signal_is_gone() -> None:
    """The signal passes 0.5 at 0.25 s and is back below at 0.35 s."""
    signal = cw.Table([(0.0, 0.0), (0.2, 0.0), (0.3, 1.0), (0.4, 0.0), (2.0, 0.0)])
    run = faulty(fault="cannot_transmit", fault_signal=signal).simulate(1.0, **TIGHT)
    failed = next(e for e in run.events if e.cause == "fault")
    assert failed.time == pytest.approx(0.25, abs=EXACT)
    assert at_end(run, "c1.torque") == 0.0


@feature("faults: triggered at a time")
@feature("faults: triggered by a signal")
def test_time_and_signal_together_trigger_at_the_earlier_instant() -> None:
    for time, expected in ((0.1, 0.1), (0.4, 0.3)):
        signal = cw.Step(height=1.0, start=0.3)
        run = faulty(fault="cannot_transmit", fault_time=time, fault_signal=signal).simulate(0.5)
        assert [e.time for e in run.events if e.cause == "fault"] == [expected]


@feature("faults: cannot unlock")
def test_a_clutch_that_cannot_unlock_slips_until_it_locks_for_good() -> None:
    """It fails while it slips, locks as it would, and then holds with its pressure gone."""
    pressure = cw.Table([(0.0, 2e5), (1.0, 2e5), (1.0, 0.0), (2.0, 0.0)])
    d = faulty(fault="cannot_unlock", fault_time=0.2, pressure=pressure)
    d.add(cw.Torque("pull", shaft=d.nodes[1], torque=cw.Table([(0.0, 0.0), (1.2, 0.0), (1.3, 90.0), (2.0, 90.0)])))
    run = d.simulate(1.6, **TIGHT)
    assert_switches(run, [(REDUCED * W0 / (0.3 * GAIN * 2e5), "c1", "forward", "locked")])
    assert at_end(run, "c1.torque") == pytest.approx(-90.0 * J2 / (J1 + J2), rel=1e-9)


@feature("faults: cannot unlock")
def test_a_clutch_that_cannot_unlock_holds_any_torque_without_pressure() -> None:
    """Locked at the start; the pressure is gone at 0.5 s, and it still holds what would tear it apart."""
    d = discs(
        clutch(
            locked=True,
            pressure=cw.Table([(0.0, 1e5), (0.5, 1e5), (0.5, 0.0), (2.0, 0.0)]),
            fault="cannot_unlock",
            fault_time=0.1,
            report="none",
        ),
        speed=0.0,
    )
    d.add(cw.Torque("drive", shaft=d.nodes[0], torque=cw.Table([(0.0, 0.0), (1.0, 500.0), (2.0, 500.0)])))
    run = d.simulate(1.5, **TIGHT)
    assert set(run["c1.state"]) == {"locked"}
    assert at_end(run, "c1.torque") == pytest.approx(500.0 * J1 / (J1 + J2), rel=1e-9)


@feature("faults: off by default")
@feature("faults: reported as nothing, a warning or an error")
def test_faults_are_reported_as_asked() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not [e for e in discs(clutch()).simulate(0.5).events if e.cause == "fault"]
        quiet = faulty(fault="cannot_transmit", fault_time=0.2).simulate(0.5)
    assert quiet.status == "done"
    with pytest.warns(FaultWarning, match="c1.*0.2 s"):
        told = faulty(fault="cannot_transmit", fault_time=0.2, report="warning").simulate(0.5)
    assert told.status == "done"
    with pytest.warns(cw.StoppedEarly, match="'c1'") as caught:
        stopped = faulty(fault="cannot_transmit", fault_time=0.2, report="error").simulate(0.5)
    assert stopped.status == "fault"
    assert stopped.time[-1] == pytest.approx(0.2, abs=EXACT)
    assert "fault" in str(caught[0].message)


# ---------------------------------------------------------------- wear


@feature("wear: a state that grows with the energy of sliding")
def test_wear_follows_the_energy_of_sliding() -> None:
    """depth = rate E/(area surfaces); off unless it is given."""
    rate = 1e-11
    ring = {"radius": None, "outer_diameter": 0.3, "inner_diameter": 0.2}
    run = discs(clutch(wear_rate=rate, **ring)).simulate(2.0, **TIGHT)
    expected = rate * 0.5 * REDUCED * W0**2 / (4 * 1e-3)
    assert at_end(run, "c1.wear.depth") == pytest.approx(expected, rel=1e-9)
    assert "c1.wear.depth" not in discs(clutch()).simulate(0.01).names


@feature("wear: changes the de-rating and the touch point")
def test_wear_lowers_the_derating_and_raises_the_touch_point() -> None:
    """A ring worn by many times its running-in depth has the capacity of uniform wear, less the shifted threshold."""
    from clutchwork.elements.bases.geometry import derating_when_worn, mean_radius

    d = cw.Driveline("worn")
    base, follower = d.shaft("base", inertia=J2), d.shaft("follower", inertia=J1, speed=W0)
    d.add(
        cw.DiskClutch(
            "c1",
            base=base,
            follower=follower,
            friction=LINING,
            outer_diameter=0.3,
            inner_diameter=0.2,
            area=1e-3,
            pressure=2e5,
            wear_rate=1e-9,
            running_in=1e-7,
            touch_shift=1e7,
        )
    )
    run = d.simulate(3.0, **TIGHT)
    depth = at_end(run, "c1.wear.depth")
    radius = mean_radius(0.3, 0.2) * derating_when_worn(0.3, 0.2)
    assert at_end(run, "c1.capacity") == pytest.approx(0.35 * 4 * radius * 1e-3 * (2e5 - 1e7 * depth), rel=1e-9)


# ---------------------------------------------------------------- exchange of base and follower


@pytest.mark.parametrize("speed", [W0, -W0])
def test_exchanging_base_and_follower_changes_signs_alone(speed: float) -> None:
    table = cw.FrictionMap(**MAP)
    runs = []
    for turned in (False, True):
        d = cw.Driveline("exchange")
        a, b = d.shaft("a", inertia=J2), d.shaft("b", inertia=J1, speed=speed)
        d.add(cw.Torque("load", shaft=a, torque=cw.Sine(amplitude=30.0, frequency=2.0)))
        ends = {"base": b, "follower": a} if turned else {"base": a, "follower": b}
        d.add(
            cw.DiskClutch(
                "c1", **ends, friction=table, radius=0.13, area=1e-3, pressure=3e4, drag=0.02, thermal_mass=300.0
            )
        )
        runs.append(d.simulate(2.0, dt=0.01))
    one, other = runs
    for name in ("a.speed", "b.speed", "c1.plates.temperature", "c1.heat"):
        np.testing.assert_allclose(one[name], other[name], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(one["c1.torque"], -other["c1.torque"], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(one["c1.slip"], -other["c1.slip"], rtol=1e-9, atol=1e-9)

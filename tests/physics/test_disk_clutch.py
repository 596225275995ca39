"""The disc clutch against closed forms, feature by feature; the marks make the parity table of the documentation."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.disk_clutches import GAIN, J1, J2, LINING, MAP, REDUCED, W0, clutch, discs, ports, rising
from support.runs import TIGHT, assert_switches, at_end

feature = pytest.mark.feature


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

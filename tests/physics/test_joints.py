"""Universal joints and cranks: closed forms, SciPy, energy. docs/theory/varying-ratios.md"""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw

BEND = 0.6


def swings(q):
    """Ratio of a joint, and its derivative by the angle."""
    d = 1.0 - (sin(BEND) * np.cos(q)) ** 2
    return cos(BEND) / d, -cos(BEND) * sin(BEND) ** 2 * np.sin(2.0 * q) / d**2


def stroke(q, r=0.05, rod=0.15):
    """Position of a slider and its two derivatives by the angle."""
    root = np.sqrt(rod**2 - (r * np.sin(q)) ** 2)
    x = r * np.cos(q) + root
    first = -r * np.sin(q) - r * r * np.sin(q) * np.cos(q) / root
    second = -r * np.cos(q) - r * r * np.cos(2 * q) / root - (r * r * np.sin(q) * np.cos(q)) ** 2 / root**3
    return x, first, second


def test_a_joint_between_free_shafts_keeps_the_energy_and_its_angle():
    d = cw.Driveline("joint")
    a, b = d.shaft("a", inertia=1.0, speed=100.0, angle=0.2), d.shaft("b", inertia=0.2)
    d.add(cw.UniversalJoint("j", base=a, follower=b, bend_angle=BEND, phase=0.3))
    run = d.simulate(1.0, dt=1e-3, rtol=1e-9)
    q, w = run["a.angle"] + 0.3, run["a.speed"]
    ratio, _ = swings(q)
    energy = (1.0 + 0.2 * ratio**2) * w**2
    assert np.ptp(energy) <= 2e-8 * energy[0]
    assert np.allclose(run["b.speed"], ratio * w, rtol=1e-7)
    angle = np.unwrap(np.arctan2(np.sin(q), cos(BEND) * np.cos(q)))
    assert np.max(abs(run["b.angle"] - (angle - angle[0]))) <= 1e-6
    assert min(run["b.speed"] / w) == pytest.approx(cos(BEND), rel=1e-4)
    assert max(run["b.speed"] / w) == pytest.approx(1.0 / cos(BEND), rel=1e-4)
    assert abs(run.energy.residual) <= 1e-8 * energy[0]


def test_a_joint_under_load_as_scipy_has_it():
    d = cw.Driveline("joint")
    a, b = d.shaft("a", inertia=0.3, speed=20.0), d.shaft("b", inertia=0.2)
    d.add(cw.UniversalJoint("j", base=a, follower=b, bend_angle=BEND))
    d.add(cw.Torque("drive", shaft=a, torque=30.0))
    d.add(cw.Damper("load", base=d.housing, follower=b, damping=0.4))
    run = d.simulate(1.0, dt=0.01, rtol=1e-10)

    def slope(_, y):
        q, w = y
        r, dr = swings(q)
        return [w, (30.0 - r * 0.4 * r * w - 0.2 * r * dr * w * w) / (0.3 + 0.2 * r * r)]

    other = solve_ivp(slope, (0.0, 1.0), [0.0, 20.0], method="DOP853", rtol=1e-12, atol=1e-12).y
    assert run["a.angle"][-1] == pytest.approx(other[0, -1], rel=1e-8)
    assert run["a.speed"][-1] == pytest.approx(other[1, -1], rel=1e-7)
    # the follower gets what is left of its own balance
    left = 0.2 * run["b.acceleration"] + 0.4 * run["b.speed"]
    assert np.allclose(run["j.torque"], left, rtol=1e-8, atol=1e-8)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


@pytest.mark.parametrize(("phase", "low", "high"), [(pi / 2, 1.0, 1.0), (0.0, cos(BEND) ** 2, cos(BEND) ** -2)])
def test_two_joints_with_a_shaft_without_inertia(phase, low, high):
    d = cw.Driveline("joints")
    a, c = d.shaft("a", inertia=1.0, speed=100.0), d.shaft("c", inertia=0.01)
    tube = d.shaft("tube", inertia=0.0)
    d.add(cw.UniversalJoint("first", base=a, follower=tube, bend_angle=BEND))
    d.add(cw.UniversalJoint("second", base=tube, follower=c, bend_angle=BEND, phase=phase))
    run = d.simulate(0.5, dt=2e-4, rtol=1e-9)
    ratio = run["c.speed"] / run["a.speed"]
    assert min(ratio) == pytest.approx(low, rel=1e-4 if phase == 0.0 else 1e-8)
    assert max(ratio) == pytest.approx(high, rel=1e-4 if phase == 0.0 else 1e-8)
    assert np.allclose(run["tube.speed"], swings(run["a.angle"])[0] * run["a.speed"], rtol=1e-7)


def test_a_free_crank_keeps_its_energy():
    d = cw.Driveline("crank")
    a, m = d.shaft("a", inertia=0.02, speed=100.0), d.mass("m", mass=2.0)
    d.add(cw.CrankSlider("c", shaft=a, mass=m, radius=0.05, rod=0.15, phase=0.3))
    run = d.simulate(0.5, dt=1e-3, rtol=1e-9)
    x, first, _ = stroke(run["a.angle"] + 0.3)
    energy = (0.02 + 2.0 * first**2) * run["a.speed"] ** 2
    assert np.ptp(energy) <= 2e-8 * energy[0]
    assert np.max(abs(run["m.position"] - x)) <= 1e-8
    assert abs(run.energy.residual) <= 1e-8 * energy[0]


def test_a_crank_against_a_spring_as_scipy_has_it():
    """A press: torque on the crank, a spring under the slider, rest at the start."""
    d = cw.Driveline("press")
    a, m = d.shaft("a", inertia=0.02), d.mass("m", mass=2.0)
    d.add(cw.CrankSlider("c", shaft=a, mass=m, radius=0.05, rod=0.15, phase=1.0))
    d.add(cw.SpringDamper("s", base=d.housing, follower=m, stiffness=2e3, damping=30.0))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=6.0, frequency=1.5)))
    run = d.simulate(1.0, dt=0.01, rtol=1e-10)
    x0 = stroke(1.0)[0]

    def slope(t, y):
        q, w = y
        x, first, second = stroke(q)
        force = -2e3 * (x - x0) - 30.0 * first * w
        torque = 6.0 * sin(3.0 * pi * t)
        return [w, (torque + first * (force - 2.0 * second * w * w)) / (0.02 + 2.0 * first**2)]

    other = solve_ivp(slope, (0.0, 1.0), [1.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-12).y
    assert run["c.angle"][-1] == pytest.approx(other[0, -1], rel=1e-7)
    assert run["a.speed"][-1] == pytest.approx(other[1, -1], rel=1e-6)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_a_rod_that_cannot_turn_is_refused():
    d = cw.Driveline("short")
    d.add(cw.CrankSlider("c", shaft=d.shaft("a", inertia=1.0), mass=d.mass("m", mass=1.0), radius=0.1, rod=0.1))
    assert any("not above the radius" in str(problem) for problem in d.check())


def test_a_brake_stops_a_joint_at_any_angle():
    """A locked follower holds the base too, whatever the ratio is there."""
    d = cw.Driveline("stop")
    a, b = d.shaft("a", inertia=0.3, speed=20.0), d.shaft("b", inertia=0.2)
    d.add(cw.UniversalJoint("j", base=a, follower=b, bend_angle=BEND))
    d.add(cw.Brake("brake", shaft=b, friction=cw.Coulomb(static=1.0, kinetic=0.9), gain=50.0, normal_force=1.0))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Table([(0.0, 0.0), (0.5, 0.0), (2.0, 90.0)])))
    run = d.simulate(2.0, dt=0.01, rtol=1e-9)
    changes = [(event.before, event.after) for event in run.events.changes()]
    assert changes == [("forward", "locked"), ("locked", "forward")]
    stopped, starts = (event.time for event in run.events.changes())
    held = (run.time > stopped) & (run.time < starts)
    assert np.max(abs(run["a.speed"][held])) <= 1e-9
    ratio, _ = swings(run["a.angle"][held][0])
    # the brake carries the torque over the ratio until that is its static one
    assert np.allclose(run["brake.torque"][held], -run["drive.torque"][held] / ratio, rtol=1e-9, atol=1e-9)
    assert 60.0 * (starts - 0.5) / ratio == pytest.approx(50.0, rel=1e-9)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover

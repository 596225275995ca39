"""Chains as polygons: the ratio within a link, extremes, energy, both ways of turning, SciPy."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw

P, Z1, Z2 = 0.0127, 7, 19
R1, R2 = P / (2 * sin(pi / Z1)), P / (2 * sin(pi / Z2))
J1, J2 = 0.02, 0.05


def _chain(speed=30.0, **values):
    d = cw.Driveline("chain")
    a, b = d.shaft("a", inertia=J1, speed=speed), d.shaft("b", inertia=J2)
    d.add(cw.Chain("chain", input=a, output=b, teeth_input=Z1, teeth_output=Z2, polygon=True, pitch=P, **values))
    return d


def _in_link(angle, teeth):
    """Angle from the middle of the link that lies on the sprocket."""
    return (angle + pi / teeth) % (2 * pi / teeth) - pi / teeth


@pytest.mark.parametrize("speed", [30.0, -30.0])
def test_the_ratio_within_a_link(speed):
    run = _chain(speed).simulate(1.0, rtol=1e-9)
    alpha, beta = _in_link(run["a.angle"], Z1), _in_link(run["b.angle"], Z2)
    strand = run["chain.strand.speed"]
    # corners take over where angles in the link jump by rounding
    assert np.abs(np.cos(run["chain.input.angle"])) == pytest.approx(np.abs(np.cos(alpha)), abs=1e-6)
    assert R1 * np.cos(alpha) * run["a.speed"] == pytest.approx(strand, abs=1e-6 * np.max(np.abs(strand)))
    assert R2 * np.cos(beta) * run["b.speed"] == pytest.approx(strand, abs=1e-6 * np.max(np.abs(strand)))
    # free: the energy is constant
    energy = 0.5 * (J1 * run["a.speed"] ** 2 + J2 * run["b.speed"] ** 2)
    assert energy == pytest.approx(energy[0], rel=1e-6)
    ratio = run["a.speed"] / run["b.speed"]
    mean = Z2 / Z1
    assert np.max(ratio) <= R2 / (R1 * cos(pi / Z1)) * (1 + 1e-6)
    assert np.min(ratio) >= R2 * cos(pi / Z2) / R1 * (1 - 1e-6)
    assert abs(run["a.angle"][-1] / run["b.angle"][-1] - mean) < 0.01 * mean


def test_a_driven_chain_as_scipy_has_it():
    d = _chain(20.0, phase_input=0.3, phase_output=-0.5)
    d.add(cw.Torque("t", shaft=d.nodes[0], torque=2.0))
    d.add(cw.Damper("load", base=d.housing, follower=d.nodes[1], damping=0.4))
    run = d.simulate(1.0, rtol=1e-10, atol=1e-10, dt=0.05)

    def rates(_, y):
        a, b, w = y
        # ratio of the speeds a over b, and its rate
        alpha, beta = _in_link(a, Z1), _in_link(b, Z2)
        i = R1 * np.cos(alpha) / (R2 * np.cos(beta))
        u = i * w
        slope = i * (-np.tan(alpha) * w + np.tan(beta) * u)
        return [w, u, (2.0 - i * 0.4 * u - J2 * i * slope * w) / (J1 + i * i * J2)]

    start = [0.3 * pi / Z1, -0.5 * pi / Z2, 20.0]
    other = solve_ivp(rates, (0.0, 1.0), start, rtol=1e-9, atol=1e-11, max_step=1e-4, t_eval=run.time)
    # SciPy steps over the corners, where the acceleration jumps
    assert run["a.speed"] == pytest.approx(other.y[2], rel=1e-4)
    assert abs(run.energy.residual) <= 1e-7 * run.energy.turnover


def test_a_corner_at_a_constant_speed():
    d = cw.Driveline("sprocket")
    a, m = d.shaft("a", inertia=0.1), d.mass("m", mass=3.0)
    d.add(cw.PolygonSprocket("s", shaft=a, mass=m, teeth=6, pitch=0.1))
    d.add(cw.PrescribedSpeed("p", shaft=a, speed=5.0))
    run = d.simulate(1.0, dt=1e-3, rtol=1e-9)
    alpha = _in_link(5.0 * run.time, 6)
    # pitch over side of a hexagon is its radius
    assert run["m.speed"] == pytest.approx(0.1 * 5.0 * np.cos(alpha), abs=1e-8)
    away = np.abs(np.abs(alpha) - pi / 6) > 1e-6
    assert run["m.acceleration"][away] == pytest.approx(-0.1 * 25.0 * np.sin(alpha[away]), abs=1e-6)
    assert run["s.torque"][away] == pytest.approx(3.0 * run["m.acceleration"][away], abs=1e-6)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"polygon": True}, "pitch is missing"),
        ({"polygon": True, "pitch": 0.01, "teeth_input": 2}, "teeth_input does not make a polygon"),
    ],
)
def test_mistakes(values, words):
    d = cw.Driveline("mistakes")
    shafts = {"input": d.shaft("a", inertia=1.0), "output": d.shaft("b", inertia=1.0)}
    d.add(cw.Chain("x", **shafts, **{"teeth_input": 9, "teeth_output": 9, **values}))
    assert words in str(d.check()[0])

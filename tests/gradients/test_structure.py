"""Numbers that give another structure: a lag of zero leaves out a state, and moves what stands behind it."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw

LAGS = (0.0, 1e-3, 0.05)
OF = ["s.speed", "k.torque", "m.torque", "q.torque"]


def driven() -> cw.System:
    """A motor without a lag on two shafts."""
    d = cw.Driveline("lag")
    s, t = d.shaft("s", inertia=1.0), d.shaft("t", inertia=2.0)
    d.add(cw.SpringDamper("k", base=s, follower=t, stiffness=100.0, damping=1.0))
    d.add(cw.ElectricMotor("m", shaft=s, command=cw.Step(height=5.0, start=0.1), max_torque=77.0))
    d.add(cw.Torque("q", shaft=t, torque=3.0))
    return d.assemble()


def test_values_of_a_structure_are_its_own() -> None:
    system = driven()
    of = {name: name for name in OF} | {"peak": cw.peak("k.torque")}
    f = cw.differentiable(system, 0.5, of=of, by=["m.lag", "q.torque"], rtol=1e-10, atol=1e-12)
    points = np.array([[lag, 3.0] for lag in LAGS])
    together = f.engine.values(points)
    for point, values in zip(points, together, strict=True):
        run = cw.simulate(system.changed({"m.lag": float(point[0])}), 0.5, rtol=1e-10, atol=1e-12)
        np.testing.assert_allclose(values[:4], [run[name][-1] for name in OF], rtol=1e-8)
        np.testing.assert_array_equal(f(point), values)
        np.testing.assert_allclose(values[4], np.abs(run["k.torque"]).max(), rtol=1e-3)


def test_derivatives_of_a_structure_are_its_own() -> None:
    f = cw.differentiable(driven(), 0.5, of=OF, by=["m.lag", "q.torque"], rtol=1e-10, atol=1e-12)
    point, weights = np.array([0.05, 3.0]), np.array([1.0, -2.0, 0.5, 3.0])
    known = np.array([(f(point + step) - f(point - step)) / 2e-5 for step in 1e-5 * np.eye(2)]).T
    found = f.gradient(point)
    np.testing.assert_allclose(found.values, f(point), rtol=1e-9)
    np.testing.assert_allclose(found.matrix, known, rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(f.vjp(point, weights)[1], weights @ known, rtol=1e-6)
    # at a lag of zero there is one side
    with pytest.raises(cw.NoGradient, match="another structure"):
        cw.differentiable(driven(), 0.5, of=OF, by=["m.lag"]).gradient()


def test_a_number_whose_zero_leaves_out_a_part_has_the_side_of_a_little_of_it() -> None:
    d = cw.Driveline("rolls")
    car = d.mass("car", mass=1000.0, speed=30.0)
    d.add(cw.Vehicle("v", mass=car, drag_area=0.6))
    wanted = {"of": "car.speed", "by": "v.rolling_rise"}
    with pytest.raises(cw.NoGradient, match=r'another structure beside it.* side="right" gives'):
        cw.differentiable(d, 1.0, **wanted).gradient()
    f = cw.differentiable(d, 1.0, **wanted, rtol=1e-12, atol=1e-14)
    found = cw.differentiable(d, 1.0, **wanted, side="right").gradient().matrix[0]
    np.testing.assert_allclose(found, (f([1e-6]) - f([0.0])) / 1e-6, rtol=1e-4)

"""Extremes at a bend of a formula, which has no event: a peak there, and a plateau from there on."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw

# N
FORCE = 20.0
SEEDS = range(4)
# what a derivative that is zero may miss, over that of the speed at the bend: as the run, and the digits of an instant
ALLOWED = 1e-6


def braked(expression: str, inertia: float, speed: float = 10.0, **numbers: float) -> cw.System:
    """A shaft that a brake brings to rest."""
    d = cw.Driveline("bent law")
    s = d.shaft("s", inertia=inertia, speed=speed)
    d.add(cw.Brake("brake", shaft=s, friction=cw.Formula(expression, **numbers), gain=1.0, normal_force=FORCE))
    return d.assemble()


@pytest.mark.parametrize("rtol", [1e-6, 1e-8, 1e-10])
@pytest.mark.parametrize("seed", SEEDS)
def test_a_peak_at_a_bend_of_a_formula(seed, rtol):
    rng = np.random.default_rng([seed, 11])
    bend, most, up, down = rng.uniform(3.0, 7.0), rng.uniform(0.3, 0.5), *rng.uniform(0.01, 0.04, 2)
    friction = "max(0.01, most - max(up*(at - v), down*(v - at)))"
    system = braked(friction, rng.uniform(0.5, 2.0), most=most, up=up, down=down, at=bend)
    f = cw.differentiable(
        system, 4.0, of={"peak": cw.peak("brake.torque")}, by=["s.inertia", "s.speed", "brake.gain"], rtol=rtol
    )
    found = f.gradient().matrix[0]
    assert f(f.x0)[0] == pytest.approx(FORCE * most, rel=rtol + 1e-8)
    assert found[2] == pytest.approx(FORCE * most, rel=10 * rtol + 1e-8)
    assert np.all(np.abs(found[:2]) <= 10 * rtol * FORCE * most + ALLOWED)


def test_a_smallest_torque_at_a_bend_of_a_formula_and_a_product_with_it():
    friction = "max(0.01, most - max(up*(at - v), down*(v - at)))"
    system = braked(friction, 1.0, most=0.4, up=0.02, down=0.03, at=5.0)
    of = {"least": cw.minimum("brake.torque"), "peak": cw.peak("brake.torque")}
    f = cw.differentiable(system, 4.0, of=of, by=["s.speed", "brake.gain"], rtol=1e-8)
    # it brakes against the speed
    np.testing.assert_allclose(f(f.x0), [-FORCE * 0.4, FORCE * 0.4], rtol=1e-7)
    np.testing.assert_allclose(f.gradient().matrix[:, 1], [-FORCE * 0.4, FORCE * 0.4], rtol=1e-7)
    np.testing.assert_allclose(f.vjp(f.x0, [1.0, 0.5])[1], [0.0, -FORCE * 0.2], atol=1e-5)


@pytest.mark.parametrize("rtol", [1e-6, 1e-8, 1e-10])
@pytest.mark.parametrize("seed", SEEDS)
def test_a_plateau_that_a_formula_reaches_within_a_step(seed, rtol):
    rng = np.random.default_rng([seed, 12])
    most, width = rng.uniform(0.3, 0.5), 10.0 ** rng.uniform(-2.0, 0.3)
    # as light as one that looks into its steps with derivatives can follow
    system = braked(f"{most} * min(1, 1/(0.5 + v/{width}))", 10.0 ** rng.uniform(-3.0, 0.0), 4 * width)
    f = cw.differentiable(
        system, 4.0, of={"peak": cw.peak("brake.torque")}, by=["s.inertia", "s.speed", "brake.gain"], rtol=rtol
    )
    assert f(f.x0)[0] == pytest.approx(FORCE * most, rel=1e-12)
    assert f.gradient().matrix[0] == pytest.approx([0.0, 0.0, FORCE * most], rel=1e-12, abs=1e-12)

"""Several contacts with states of their own beside each other: each has its own part of the linear system."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw


def pairs(count: int) -> cw.Driveline:
    """Pairs of shafts that have nothing to do with each other, each joined by bristles."""
    d = cw.Driveline("pairs")
    for k in range(count):
        a, b = d.shaft(f"a{k}", inertia=0.3, speed=20.0 + k), d.shaft(f"b{k}", inertia=0.7)
        law = cw.Dahl(kinetic=0.1, stiffness=50.0 * 10**k, exponent=1)
        d.add(cw.Clutch(f"c{k}", base=a, follower=b, friction=law, gain=1.0, normal_force=40.0))
        d.add(cw.Torque(f"t{k}", shaft=b, torque=cw.Sine(amplitude=6.0, frequency=3.0 + k)))
    return d


@pytest.mark.parametrize("rtol", [1e-4, 1e-6, 1e-9])
def test_a_pair_has_the_derivatives_that_it_has_alone(rtol: float) -> None:
    alone, beside = (
        cw.differentiable(
            pairs(count), 0.6, of="a0.speed", by=["a0.inertia", "c0.normal_force"], rtol=rtol, atol=rtol / 100
        )
        for count in (1, 3)
    )
    one, three = (np.asarray(f.gradient(f.x0).matrix)[0] for f in (alone, beside))
    # the others shorten the steps, so both agree to the tolerance of either
    assert three == pytest.approx(one, rel=100 * rtol)
    assert np.all(np.abs(one) > 0)

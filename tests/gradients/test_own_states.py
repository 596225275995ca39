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


@pytest.mark.parametrize("rtol", [1e-6, 1e-8])
@pytest.mark.parametrize("end", [2.0, 3.0, 20.0])
def test_a_piston_that_has_emptied_moves_nothing(end: float, rtol: float) -> None:
    """Its pressure dies away and passes zero by round-off, at an instant that says nothing.

    Until then it takes the momentum gain * kinetic * pressure * lag from a, whatever the end is.
    """
    d = cw.Driveline("emptied")
    a, b = d.shaft("a", inertia=0.2, speed=100.0), d.shaft("b", inertia=0.4, speed=50.0)
    piston = d.add(cw.PressureActuator("p", command=0.0, lag=0.05, filled=True, initial_pressure=1e5))
    law = cw.Coulomb(static=0.13, kinetic=0.11)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1e-3, pressure=piston))
    by = ["p.initial_pressure", "p.lag", "c.gain", "a.inertia"]
    found = cw.differentiable(d, end, of="a.speed", by=by, rtol=rtol).gradient()
    taken = 1e-3 * 0.11 * 1e5 * 0.05
    wanted = [-taken / 1e5 / 0.2, -taken / 0.05 / 0.2, -taken / 1e-3 / 0.2, taken / 0.04]
    np.testing.assert_allclose(np.asarray(found.matrix)[0], wanted, rtol=10 * rtol)
    assert found.problems == ()

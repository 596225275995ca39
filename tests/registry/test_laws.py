"""Every friction law: what Python says of it is what the compiled core computes."""

from __future__ import annotations

import math

import pytest

import clutchwork as cw
from clutchwork.checks import At, object_problems
from clutchwork.pools import coefficients
from clutchwork.schema import Role
from support import samples

LAWS = samples.declared(Role.LAW)


def _law(cls):
    return cls(**samples.fields(cls, {}))


@pytest.mark.parametrize("cls", LAWS, ids=lambda cls: cls.__name__)
def test_coefficient_at_vanishing_slip_agrees_with_the_core(cls):
    law = _law(cls)
    kinetic, static = coefficients(law, 0.0)
    assert static == law.static
    if law.sliding() is not None:
        assert kinetic == pytest.approx(law.sliding(), rel=1e-14)


@pytest.mark.parametrize("cls", LAWS, ids=lambda cls: cls.__name__)
@pytest.mark.parametrize("slip", [0.0, 1e-9, 0.3, 5.0, 9.9])
def test_kinetic_coefficient_is_finite_and_at_most_static(cls, slip):
    kinetic, static = coefficients(_law(cls), slip)
    assert math.isfinite(kinetic)
    assert 0.0 <= kinetic <= static


@pytest.mark.parametrize("cls", LAWS, ids=lambda cls: cls.__name__)
def test_a_sample_has_no_mistake(cls):
    assert list(object_problems(_law(cls), At("law", ""))) == []


@pytest.mark.parametrize(
    "law",
    [
        cw.Coulomb(static=0.1, kinetic=0.2),
        cw.Exponential(static=0.1, slow=0.2, fast=0.05, speed=1.0),
        cw.CoefficientTable(static=0.1, kinetic=[(0.0, 0.2), (1.0, 0.1)]),
        cw.CoefficientTable(static=0.1, kinetic=[(1.0, 0.1), (2.0, 0.05)]),
    ],
    ids=repr,
)
def test_kinetic_above_static_is_a_mistake(law):
    d = cw.Driveline()
    shaft = d.shaft("a", inertia=1.0)
    d.add(cw.Brake("b", shaft=shaft, friction=law, gain=1.0, pressure=1.0))
    (problem,) = d.check()
    assert problem.quantity == "friction.static"
    assert "below the kinetic coefficient" in str(problem)


def test_a_falling_table_is_continued_down_to_zero_slip():
    assert cw.CoefficientTable(static=0.2, kinetic=[(1.0, 0.1), (2.0, 0.05)]).sliding() == pytest.approx(0.15)

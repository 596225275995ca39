"""Gradients of an oscillator against its closed form: smooth motion, with the tolerance that the run was asked for."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw

INERTIA, STIFFNESS, SPEED, END = 0.5, 200.0, 3.0, 1.7


def oscillator():
    d = cw.Driveline("oscillator")
    a = d.shaft("a", inertia=INERTIA, speed=SPEED)
    d.add(cw.SpringDamper("k", base=d.housing, follower=a, stiffness=STIFFNESS, damping=0.0))
    return d


@pytest.mark.parametrize("time", [0.1, 0.9, END])
def test_derivatives_are_those_of_the_cosine(time):
    by = ["a.inertia", "k.stiffness", "a.speed"]
    function = cw.differentiable(oscillator(), END, of=cw.at("a.speed", time), by=by, rtol=1e-10, atol=1e-12)
    value, matrix = function.value_and_jacobian(function.x0)
    rate = np.sqrt(STIFFNESS / INERTIA)
    by_rate = -SPEED * time * np.sin(rate * time)
    exact = [-by_rate * rate / (2 * INERTIA), by_rate * rate / (2 * STIFFNESS), np.cos(rate * time)]
    assert value[0] == pytest.approx(SPEED * np.cos(rate * time), abs=1e-8 * SPEED)
    # phases that are off by the tolerance count as often as there were radians
    np.testing.assert_allclose(matrix[0], exact, atol=1e-7 * np.abs(exact).max(), rtol=1e-7)
    weights = np.ones(1)
    np.testing.assert_allclose(function.vjp(function.x0, weights)[1], matrix[0], rtol=1e-10, atol=1e-12)


def test_the_first_peak_of_the_torque_moves_with_stiffness_and_inertia():
    function = cw.differentiable(oscillator(), 0.3, of=cw.peak("k.torque"), by=["a.inertia", "k.stiffness"], rtol=1e-10)
    value, matrix = function.value_and_jacobian(function.x0)
    # speed times the root of inertia times stiffness
    peak = SPEED * np.sqrt(INERTIA * STIFFNESS)
    assert value[0] == pytest.approx(peak, rel=1e-7)
    np.testing.assert_allclose(matrix[0], [peak / (2 * INERTIA), peak / (2 * STIFFNESS)], rtol=1e-5)


def test_the_power_of_the_spring_changes_with_its_torque_and_with_its_rate():
    """-k x v of the closed form is -(1/2) sqrt(J k) v0^2 sin(2 w t): both factors change with the inertia."""
    time = 0.25
    by = ["a.inertia", "a.speed"]
    function = cw.differentiable(oscillator(), 0.3, of=cw.at("k.power", time), by=by, rtol=1e-10, atol=1e-12)
    value, matrix = function.value_and_jacobian(function.x0)
    rate, size = np.sqrt(STIFFNESS / INERTIA), -0.5 * np.sqrt(INERTIA * STIFFNESS) * SPEED**2
    power = size * np.sin(2 * rate * time)
    by_inertia = power / (2 * INERTIA) - size * np.cos(2 * rate * time) * rate * time / INERTIA
    assert value[0] == pytest.approx(power, abs=1e-7 * abs(size))
    np.testing.assert_allclose(matrix[0], [by_inertia, 2 * power / SPEED], rtol=1e-5)

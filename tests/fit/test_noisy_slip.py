"""Slips near rest whose sign noise turned are recognised, whatever the law and the noise; others are let be."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.fit import FitError, fit_law
from clutchwork.fit.measurement import measurement
from clutchwork.fit.sliding import REST, coefficients, noisy

LOAD = 500.0
STRIBECK = cw.Stribeck(static=0.13, kinetic=0.1, speed=3.0, viscous=1e-4)


def drawn(seed: int, noise: float, count: int = 1000, law: Any = STRIBECK) -> dict[str, Any]:
    """Samples between 0 and 30 rad/s whose slip has noise [rad/s]."""
    rng = np.random.default_rng(seed)
    slip = rng.uniform(0.0, 30.0, count)
    torque = LOAD * coefficients(law, slip)[0] + rng.normal(0.0, 0.5, count)
    return {
        "time": 0.01 * np.arange(count),
        "slip": slip + noise * rng.standard_normal(count),
        "torque": torque,
        "load": LOAD,
    }


@pytest.mark.parametrize("seed", range(20))
def test_a_few_of_a_thousand_signs_do_no_harm(seed: int) -> None:
    noise = float(np.random.default_rng(seed).uniform(0.1, 0.5))
    data = drawn(seed, noise)
    turned = data["slip"][data["slip"] < 0.0]
    result = fit_law(cw.Stribeck(static=0.2, kinetic=0.1, speed=1.0, viscous=1e-4), **data)
    assert result.determined, result.message
    assert result.r2 > 0.9
    # none is left, and not much else is taken for rest
    assert result.rest >= -np.min(turned, initial=0.0)
    assert result.rest < 6.0 * noise
    for name, true in (("static", 0.13), ("kinetic", 0.1), ("speed", 3.0)):
        assert result[name].value == pytest.approx(true, rel=0.1)
    if np.min(turned, initial=0.0) < -0.05:
        assert "the noise of the slip reversed the sign" in result.notes
        with pytest.raises(FitError, match="likely noise of the slip reversed the sign of"):
            fit_law(cw.Stribeck(static=0.2, kinetic=0.1, speed=1.0, viscous=1e-4), **data, rest=0.0)


def test_without_a_wrong_sign_rest_is_what_it_was() -> None:
    for seed in range(20):
        data = drawn(seed, 0.0)
        assert fit_law(STRIBECK, **data, free="kinetic").rest == REST * np.max(data["slip"])


@pytest.mark.parametrize("seed", range(10))
def test_a_spike_of_the_torque_is_not_rest(seed: int) -> None:
    data, rng = drawn(seed, 0.0), np.random.default_rng(seed)
    data["torque"][rng.integers(0, 1000, 5)] *= -1.0
    samples = measurement(**data)
    found = noisy(samples)
    # a chance one near rest is as near as noise could be
    assert np.max(found, initial=0.0) < 0.5


@pytest.mark.parametrize("seed", range(6))
def test_break_aways_of_a_noisy_slip_are_found(seed: int) -> None:
    """At rest half of the signs are wrong; the torque at which it slides off is the largest one there."""
    rng, law = np.random.default_rng(seed), cw.Coulomb(static=0.15, kinetic=0.1)
    torque, slip = [], []
    for side in (1.0, -1.0) * 4:
        torque += [*(side * np.linspace(0.0, 0.15, 40)), *np.full(40, side * 0.1)]
        slip += [*np.zeros(40), *(side * np.geomspace(0.02, 12.0, 40))]
    row = np.array(slip) + 0.03 * rng.standard_normal(len(slip))
    time, size = 0.01 * np.arange(len(slip)), 20.0
    noise = 0.01 * rng.standard_normal(len(slip))
    result = fit_law(cw.Coulomb(static=0.2, kinetic=0.2), time, row, size * np.array(torque) + noise, size)
    assert 0.05 < result.rest < 0.25
    assert result["kinetic"].value == pytest.approx(law.kinetic, rel=0.01)
    assert result["static"].value == pytest.approx(law.static, rel=0.02)
    assert result.determined, result.message

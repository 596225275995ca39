"""A driveline as the goal of a solver of SciPy, and frameworks that are not installed."""

from __future__ import annotations

import sys

import numpy as np
import pytest

import clutchwork as cw
from support.two_discs_by_numbers import two_discs

F = two_discs()


@pytest.mark.parametrize(("call", "package"), [("to_jax", "jax"), ("to_torch", "torch")])
def test_a_missing_framework_comes_with_its_remedy(call, package, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ImportError, match=rf'cw\.{call} needs {package}: pip install "clutchwork\[{package}\]"'):
        getattr(cw, call)(F)


def test_least_value():
    """Half the heat: J1 J2 / (J1 + J2) speed^2 / 2 is 400 J where J1 J2 / (J1 + J2) is 0.08 kg m2."""
    minimize = pytest.importorskip("scipy.optimize").minimize
    heat = cw.differentiable(F.system, 2.5, of="c1.heat", by="engine.inertia").objective()

    def far_off(x):
        joules, gradient = heat(x)
        return (joules / 800 - 0.5) ** 2, (joules / 800 - 0.5) / 400 * gradient

    found = minimize(far_off, [0.2], jac=True, bounds=[(0.01, 1.0)], tol=1e-12)
    np.testing.assert_allclose(found.x, 0.08 * 0.8 / (0.8 - 0.08), rtol=1e-6)


def test_objective_as_it_is():
    """Least heat within bounds lies at the least inertia, where the clutch has the least to do."""
    minimize = pytest.importorskip("scipy.optimize").minimize
    found = minimize(F.objective("c1.heat"), F.x0, jac=True, bounds=[(0.1, 0.3), (4e-4, 6e-4)])
    np.testing.assert_allclose(found.fun, 0.5 * 1e4 * 0.1 * 0.8 / 0.9, rtol=1e-8)

"""A run with derivatives, in another form of motion, takes the steps of a plain one: its values are the same.

docs/theory/integrators.md (11) to (14): the norm of the error does not depend on the form, and round-off does not reach
the lengths of steps.
"""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import clutchwork as cw
from support import example_models, random_drivelines
from support.amount import amount

# of the scale of the values; a step that is taken otherwise changes them by 1e-9 to 1e-5
SAME, OTHERWISE = 1e-10, 1e-6
EXAMPLES = ("six_speed", "calibrate_shift", "shift_sweep", "launch")


def apart(system: cw.System, t_end: float) -> float:
    """How far accelerations at the end are from those of a plain run, of their largest."""
    moving = [node.name for node in system.nodes if getattr(node, "inertia", None) or getattr(node, "mass", None)]
    names = [f"{name}.{word}" for name in moving for word in ("speed", "acceleration")]
    f = cw.differentiable(system, t_end, of=names, by=[f"{moving[0]}.speed"], rtol=1e-6, atol=1e-8)
    plain, (values, _) = np.array(f(f.x0)), f.value_and_jacobian(f.x0)
    away, size = np.abs(np.array(values) - plain), np.abs(plain)
    return max(float(away[sort].max() / (size[sort].max() or 1.0)) for sort in (slice(0, None, 2), slice(1, None, 2)))


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples(name: str) -> None:
    assert apart(*example_models.model(name)) <= SAME


@pytest.mark.random
def test_random_drivelines() -> None:
    found = list[float]()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for seed in range(max(20, amount() // 6)):
            try:
                found.append(apart(random_drivelines.describe(seed).driveline().assemble(), 2.0))
            except cw.NoGradient:
                continue
    assert len(found) > 15
    assert max(found) <= OTHERWISE
    # a contact that grazes may decide otherwise for round-off
    assert np.mean(np.array(found) > SAME) <= 0.1

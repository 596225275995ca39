"""Random courses of force on a mass: clutchwork against the independent integration."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import clutchwork as cw
from reference.friction import core, sets
from reference.friction.build import counterpart
from reference.friction.compare import assert_agree
from reference.friction.histories import Corners
from reference.friction.solve import solve
from reference.friction.systems import Pushed
from support.amount import part

# friction holds 1 N: forces of both sides, of rest and of sliding
FORCES = st.lists(st.floats(-1.6, 1.6).map(lambda f: round(f, 3)), min_size=3, max_size=5)
MASSES = st.sampled_from([0.3, 1.0, 4.0])
WITH_STATES = [name for name, law in sets.ALL.items() if law.own_states()]
STEP = 0.08  # s between the corners


def corners(forces: list[float]) -> Corners:
    """From rest through the forces, one every STEP."""
    return Corners(((0.0, 0.0), *((STEP * i, force) for i, force in enumerate(forces, 1))))


@pytest.mark.parametrize("name", WITH_STATES)
@settings(max_examples=part(3))
@given(forces=FORCES, mass=MASSES)
def test_random_load_agrees_with_the_independent_integration(name: str, forces: list[float], mass: float) -> None:
    law, force = sets.ALL[name], corners(forces)
    times = np.arange(0.0031, STEP * len(forces), 0.0067)
    if not any(forces):
        # nothing moves, and there is no full scale
        return
    expected = solve(Pushed(counterpart(law), force, mass=mass), times, knots=force.knots, atol=1e-11)
    run = core.run(core.pushed(law, cw.Table(list(force.points)), mass=mass), times)
    assert_agree(law, run, expected)

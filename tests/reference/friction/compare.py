"""Agreement of a run with an independent integration."""

from __future__ import annotations

from typing import Any

import numpy as np

from reference.friction.solve import Solution

# over full scale: asked for
AGREE = 1e-6


def assert_agree(law: Any, run: Any, expected: Solution) -> None:
    """Position, speed and friction of mass "m" and contact "c", and every state of the law, within AGREE."""
    _close(run["m.position"], expected.position)
    _close(run["m.speed"], expected.speed)
    _close(-run["c.torque"], expected.friction)
    for state, values in zip(law.own_states(), expected.states.T, strict=True):
        _close(run[f"c.{state.name}"], values)


def _close(found: Any, expected: Any) -> None:
    assert np.max(np.abs(found - expected)) <= AGREE * np.max(np.abs(expected))

"""Agreement of a run with an independent integration."""

from __future__ import annotations

from typing import Any

import numpy as np

from support.friction.solve import Solution

# over full scale: asked for
AGREE = 1e-6


def assert_agree(run: Any, expected: Solution) -> None:
    """Position, speed and friction of mass "m" and contact "c", and every state of the law, within AGREE."""
    names = [name for name in run.names if name.startswith("c.") and name[2:].split("_")[0] in _STATES]
    assert len(names) == expected.states.shape[1]
    _close(run["m.position"], expected.position)
    _close(run["m.speed"], expected.speed)
    _close(-run["c.torque"], expected.friction)
    for name, values in zip(names, expected.states.T, strict=True):
        _close(run[name], values)


_STATES = {"elastic", "element", "wind"}


def _close(found: Any, expected: Any) -> None:
    assert np.max(np.abs(found - expected)) <= AGREE * np.max(np.abs(expected))

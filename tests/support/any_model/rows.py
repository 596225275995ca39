"""What every row of a result must satisfy, whatever the model."""

from __future__ import annotations

from typing import Any

import numpy as np

from support.any_model import energy, motion, torques
from support.any_model.seen import Check, Fault, Seen

CHECKS: tuple[Check, ...] = (
    motion.finite,
    motion.times,
    torques.balance,
    torques.sticking,
    torques.drives,
    torques.laws,
    torques.flanks,
    motion.ratios,
    motion.passes,
    motion.motions,
    motion.steady,
    motion.integrals,
    motion.events,
    energy.energies,
    energy.heats,
)
# rows that a result has at least, unless it stopped at its start
LEAST = 6


def faults(run: Any) -> list[Fault]:
    """All that is wrong with the rows of a run."""
    seen = Seen(run)
    if len(seen.time) < LEAST:
        return [Fault("times", "", "few rows")] if run.status == "done" else []
    with np.errstate(all="ignore"):
        return [fault for check in CHECKS for fault in check(seen)]

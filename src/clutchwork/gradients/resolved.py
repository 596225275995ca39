"""Steps that are too long for the polynomials through their rows, so that they are split: docs/theory/gradients.md.

A prescribed motion is exact in steps of any length, and behind a jump signals of stiff parts bend sharply within a few.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.extremes import candidates
from clutchwork.gradients.refined import SHORTEST_TIME, split
from clutchwork.gradients.steps import Steps
from clutchwork.sweeps.outputs import Extreme
from clutchwork.sweeps.parts import PARTS

Array = NDArray[np.float64]

# the last coefficient of the slope of an acceleration, of the largest slope in the run, from which on a step is split
BENT = 1e-3
# that of a signal with its extreme in a step, of its largest size, and how far around it the step is split; and from
# which on what was split is so again
SHARP, AROUND, STILL_SHARP = 1e-7, 1 / 16, 1e-5


def resolved(steps: Steps, accelerations: Sequence[Array]) -> Steps:
    """The steps split where polynomials miss slopes of accelerations.

    Parameters: values in the rows of each step, a line for each step.
    """
    rough = np.zeros(len(steps), dtype=bool)
    for values in accelerations:
        coefficients = np.abs(np.einsum("nki,ni->nk", steps.basis, values)) / steps.length[:, None]
        rough |= PARTS * coefficients[:, PARTS] > BENT * coefficients[:, 1].max(initial=0.0)
    return _split(steps, {step: set((np.arange(1, PARTS) / PARTS).tolist()) for step in np.flatnonzero(rough).tolist()})


def around_tops(steps: Steps, extremes: Sequence[tuple[Extreme, Array]], sharp: float = SHARP) -> Steps:
    """The steps with an extreme split so that it is in a short part, where polynomials miss its instant or its slope.

    Parameters: values in the rows of each step, a line for each step; sharp, from which coefficient on.
    """
    cuts = dict[int, set[float]]()
    for one, values in extremes:
        size = float(np.abs(values).max(initial=0.0))
        for top in candidates(one, steps, values):
            if top.begins not in (0, len(steps)) and top.rough * steps.length[top.step] > sharp * size:
                cuts.setdefault(top.step, set()).update((top.share - AROUND, top.share + AROUND))
    return _split(steps, cuts)


def _split(steps: Steps, cuts: Mapping[int, set[float]]) -> Steps:
    kept = {step: found for step, places in cuts.items() if (found := _apart(steps, step, places))}
    return split(steps, kept) if kept else steps


def _apart(steps: Steps, step: int, places: set[float]) -> set[float]:
    """Without places that leave parts too short for a run with derivatives to look into."""
    least = SHORTEST_TIME * (1.0 + abs(float(steps.begin[step]))) / float(steps.length[step])
    kept = [0.0]
    kept += [place for place in sorted(places) if least <= place <= 1.0 - least]
    return {there for here, there in pairwise(kept) if there - here >= least}

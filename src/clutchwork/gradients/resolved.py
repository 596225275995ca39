"""Steps that are too long for the polynomials through their rows, so that they are split: docs/theory/gradients.md (19).

A prescribed motion is exact in steps of any length, and behind a jump signals of stiff parts bend sharply within a few.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.extremes import candidates
from clutchwork.gradients.refined import split
from clutchwork.gradients.steps import Steps
from clutchwork.sweeps.outputs import Extreme
from clutchwork.sweeps.parts import PARTS

Array = NDArray[np.float64]
Cuts = Iterator[tuple[int, set[float]]]

# the last coefficient of the slope of an acceleration, of the largest slope in the run, from which on a step is split
BENT = 1e-3
# that of a signal with its extreme inside of a step, of its largest size, and how far around it the step is split
SHARP, AROUND = 1e-7, 1 / 16


def resolved(steps: Steps, accelerations: Sequence[Array], extremes: Sequence[tuple[Extreme, Array]]) -> Steps:
    """The steps split where polynomials miss slopes of accelerations, or the instants of extremes.

    Parameters: values in the rows of each step, a line for each step.
    """
    cuts = dict[int, set[float]]()
    for step, places in (*_bent(steps, accelerations), *_around_tops(steps, extremes)):
        cuts.setdefault(step, set()).update(places)
    return split(steps, cuts) if cuts else steps


def _bent(steps: Steps, accelerations: Sequence[Array]) -> Cuts:
    """Steps whose polynomials of an acceleration miss its slope, in as many parts as they have rows."""
    for values in accelerations:
        coefficients = np.abs(np.einsum("nki,ni->nk", steps.basis, values)) / steps.length[:, None]
        rough = PARTS * coefficients[:, PARTS] > BENT * coefficients[:, 1].max(initial=0.0)
        yield from ((step, set((np.arange(1, PARTS) / PARTS).tolist())) for step in np.flatnonzero(rough).tolist())


def _around_tops(steps: Steps, extremes: Sequence[tuple[Extreme, Array]]) -> Cuts:
    """Steps with an extreme inside, split so that it is in a short part."""
    for one, values in extremes:
        size = float(np.abs(values).max(initial=0.0))
        for top in candidates(one, steps, values):
            if 0.0 < top.share < 1.0 and top.rough * steps.length[top.step] > SHARP * size:
                yield top.step, {place for place in (top.share - AROUND, top.share + AROUND) if 0.0 < place < 1.0}

"""Steps in which a signal bends without an event: contacts of a dependent set of which one reaches its capacity.

Polynomials miss such bends, so that steps are split at them. docs/theory/gradients.md (19)
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import NDArray

from clutchwork.assembly.wiring import wiring
from clutchwork.base.classes import dataclass
from clutchwork.gradients.extremes import reaching
from clutchwork.gradients.steps import Steps
from clutchwork.results.forms import LOCKED
from clutchwork.sweeps.outputs import Extreme
from clutchwork.sweeps.parts import PARTS

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
# values of each extreme's signal in the rows of steps, and steps in which signals may bend
Values = Callable[[Steps], tuple[Sequence[Array], Mask]]

# the last coefficient of a polynomial that misses a bend, of the largest size of the signal
ROUGH = 1e-6
# a step is first cut into so many parts, then where polynomials of its neighbours meet; so often at most
CUTS, ROUNDS = 8, 6
# shortest parts, of a step
SHORTEST = 1e-3


@dataclass(frozen=True, eq=False)
class Sharing:
    """Contacts that may share a load which the motion does not decide: their slips depend on each other."""

    rates: Array  # of each contact: how its slip follows from the independent speeds
    columns: tuple[int, ...]  # of their modes in a row

    @classmethod
    def of(cls, system: System) -> Sharing | None:
        """Those of a System, None where there are none."""
        arrays, ends = system.arrays, system.arrays["contact_rate_end"]
        rates = np.zeros((len(ends), len(arrays["initial_speed"])))
        row = np.repeat(np.arange(len(ends)), np.diff(ends, prepend=0))
        rates[row, arrays["contact_rate_column"]] = arrays["contact_rate_value"]
        modes = wiring(system).columns["contact_mode"]
        return cls(rates, tuple(range(modes.start, modes.stop))) if _depend(rates) else None

    def within(self, modes: Array) -> Mask:
        """Steps in which such contacts are locked together, from the modes in each."""
        patterns, same = np.unique(modes == LOCKED, axis=0, return_inverse=True)
        found: Mask = np.array([_depend(self.rates[locked]) for locked in patterns], dtype=bool)[same.ravel()]
        return found


def _depend(rates: Array) -> bool:
    return bool(len(rates) and np.linalg.matrix_rank(rates) < len(rates))


def refined(steps: Steps, ones: Sequence[Extreme], values: Values) -> Steps | None:
    """The steps split where signals bend near their extremes; None where they do not."""
    made = steps
    for _ in range(ROUNDS):
        cuts, (known, may_bend) = dict[int, set[float]](), values(made)
        for one, own in zip(ones, known, strict=True):
            for step in _rough(one, made, own, may_bend):
                cuts.setdefault(step, set()).update(_places(made, own, step))
        cuts = {step: places for step, places in cuts.items() if places}
        if not cuts:
            break
        made = split(made, cuts)
    return None if made is steps else made


def _rough(one: Extreme, steps: Steps, values: Array, may_bend: Mask) -> Iterator[int]:
    """Steps that reach the extreme with a polynomial that misses a bend."""
    if not may_bend.any():
        return
    last = np.abs(np.einsum("ni,ni->n", steps.basis[:, PARTS], values))
    size = float(np.abs(values).max(initial=0.0))
    for step in reaching(one, steps, values).tolist():
        if may_bend[step] and last[step] > ROUGH * size:
            yield step


def _places(steps: Steps, values: Array, step: int) -> Iterator[float]:
    """Instants that divide a step: where the polynomials of its neighbours intersect, else equal parts."""
    meeting = _meeting(steps, values, step)
    if meeting is None:
        yield from np.arange(1, CUTS) / CUTS
    elif SHORTEST < meeting < 1.0 - SHORTEST:
        yield meeting


def _meeting(steps: Steps, values: Array, step: int) -> float | None:
    """The place in a step at which the polynomials before and behind it meet; None where they do not."""
    if not 0 < step < len(steps) - 1:
        return None
    before, behind = (steps.basis[near] @ values[near] for near in (step - 1, step + 1))
    longer = [float(steps.length[step] / steps.length[near]) for near in (step - 1, step + 1)]
    # neighbours that are longer are other steps, which have nothing to do with it
    if min(longer) < 0.5 or max(longer) > 2.0:
        return None

    def apart(place: Array) -> Array:
        found: Array = polyval(1.0 + place * longer[0], before) - polyval((place - 1.0) * longer[1], behind)
        return found

    low, high = 0.0, 1.0
    if apart(np.array(low)) * apart(np.array(high)) > 0.0:
        return None
    for _ in range(50):
        middle = 0.5 * (low + high)
        below = apart(np.array(low)) * apart(np.array(middle)) <= 0.0
        low, high = (low, middle) if below else (middle, high)
    return 0.5 * (low + high)


def split(steps: Steps, cuts: Mapping[int, set[float]]) -> Steps:
    """The same steps where some are cut at places in them."""
    begins, lengths, jumps = list[float](), list[float](), list[bool]()
    for step, (begin, length) in enumerate(zip(steps.begin.tolist(), steps.length.tolist(), strict=True)):
        places = [0.0, *sorted(cuts.get(step, ())), 1.0]
        begins += [begin + place * length for place in places[:-1]]
        lengths += (np.diff(places) * length).tolist()
        jumps += [bool(steps.jumps[step]), *([False] * (len(places) - 2))]
    rows = np.zeros((len(begins), PARTS + 1), dtype=np.intp)
    shares = np.broadcast_to(np.arange(PARTS + 1) / PARTS, rows.shape)
    return Steps(np.array(begins), np.array(lengths), shares, rows, np.array(jumps)).inside()

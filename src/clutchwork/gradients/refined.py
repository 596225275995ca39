"""Steps in which a signal bends or jumps without an event, which polynomials miss, so that they are split there.

A contact of a dependent set reaches its capacity, a capacity depends on the direction of its torque, which reverses,
or a formula has a `min`, a `max`, a condition.
docs/theory/gradients.md (19)
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import NDArray

from clutchwork.assembly.wiring import wiring
from clutchwork.base.classes import dataclass
from clutchwork.gradients.extremes import reaching
from clutchwork.gradients.steps import LEAST, Steps
from clutchwork.results.forms import LOCKED
from clutchwork.sweeps.outputs import Extreme
from clutchwork.sweeps.parts import PARTS

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Places = NDArray[np.intp]


class Seen(NamedTuple):
    """What is seen in the rows of steps."""

    values: Sequence[Array]  # of the signal of each extreme
    torques: Sequence[Array | None]  # whose sign decides about it
    may_bend: Mask  # steps in which contacts share a load, or a formula bends


Values = Callable[[Steps], Seen]

# the last coefficient of a polynomial that misses a bend, of the largest size of the signal
ROUGH = 1e-6
# the same of the second one, where it is more than round-off of the signal
BENT, NOISE = 0.02, 1e-11
# what polynomials of both neighbours may miss in it, of what it changes by, and of its largest value
NEAR = 1e-5, 1e-12
# a step is first cut into so many parts, then where polynomials of its neighbours meet; so often at most
CUTS, ROUNDS = 8, 6
# what changes so much faster between two rows than beside them jumps there, where these are as close [s]
TEARS, TORN_TIME = 100.0, 1e-6
# shortest parts, of a step, and [s]
SHORTEST, SHORTEST_TIME = 1e-3, 3e-8
# capacities that differ by more on both sides of a reversing torque jump there, relative to the larger one
JUMP = 1e-9


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


@dataclass(frozen=True, eq=False)
class WithinSteps:
    """What of a System may bend or jump inside of steps."""

    sharing: Sharing | None
    torques: Mapping[str, int]  # of each capacity that is asked for: the column of its torque
    bends: bool = False  # whether formulas bend

    @classmethod
    def of(cls, system: System, ones: Sequence[Extreme]) -> WithinSteps | None:
        """That of extremes, None where there is none."""
        known, torques = wiring(system), dict[str, int]()
        for number, contact in enumerate(known.contacts):
            torques[f"{contact.name}.capacity"] = known.columns["contact_torque"].start + number
        kept = {one.signal: torques[one.signal] for one in ones if one.signal in torques}
        sharing = Sharing.of(system) if ones else None
        laws = (branch.component.friction for branch in (*known.contacts, *known.elements)) if ones else ()
        bends = any(law is not None and law.bends for law in laws)
        return cls(sharing, kept, bends) if sharing is not None or kept or bends else None

    @property
    def columns(self) -> tuple[int, ...]:
        """Those of a row that are looked at."""
        return (*(self.sharing.columns if self.sharing is not None else ()), *self.torques.values())

    def seen(self, ones: Sequence[Extreme], values: Sequence[Array], rows: Array, places: Places) -> Seen:
        """What is seen in steps.

        Parameters: values of the signals; rows, of which those of each step are at `places`: numbers of `columns`.
        """
        width = len(self.sharing.columns) if self.sharing is not None else 0
        order = {name: width + place for place, name in enumerate(self.torques)}
        torques = [rows[places, order[one.signal]] if one.signal in order else None for one in ones]
        # beside its middle no event is near
        middle = rows[places[:, 2], :width]
        bends = self.sharing.within(middle) if self.sharing is not None else np.zeros(len(places), dtype=bool)
        return Seen(values, torques, bends | self.bends)


def _depend(rates: Array) -> bool:
    return bool(len(rates) and np.linalg.matrix_rank(rates) < len(rates))


def refined(steps: Steps, ones: Sequence[Extreme], values: Values) -> Steps | None:
    """The steps split where signals bend near their extremes; None where they do not."""
    made, before = steps, [len(steps)] * len(ones)
    for turn in range(ROUNDS + 1):
        cuts, seen = dict[int, set[float]](), values(made)
        for number, (one, own, torque) in enumerate(zip(ones, seen.values, seen.torques, strict=True)):
            rough = list(_rough(one, made, own, seen.may_bend))
            # a bend is in one part of a step or two: what is as rough in most of them is round-off
            before[number] = len(rough) if len(rough) <= max(CUTS, 2 * before[number]) else 0
            for step in rough[: before[number]]:
                cuts.setdefault(step, set()).update(_places(made, own, step))
            for step, place in _turns(made, own, torque) if torque is not None else ():
                cuts.setdefault(step, set()).add(place)
        cuts = {step: places for step, places in cuts.items() if places}
        if not cuts or turn == ROUNDS:
            tears = {step: row for own in seen.values for step, row in _tears(made, own, seen.may_bend)}
            made = made.torn_at(tears) if tears else made
            break
        made = split(made, cuts)
    return None if made is steps else made


def _rough(one: Extreme, steps: Steps, values: Array, may_bend: Mask) -> Iterator[int]:
    """Steps that reach the extreme with a polynomial that misses a bend."""
    if not may_bend.any():
        return
    coefficients = np.abs(np.einsum("nki,ni->nk", steps.basis, values))
    last, size = coefficients[:, PARTS], float(np.abs(values).max(initial=0.0))
    rough = (last > ROUGH * size) | ((last > BENT * coefficients[:, 1]) & (last > NOISE * size))
    for step in reaching(one, steps, values, last).tolist():
        if may_bend[step] and rough[step]:
            yield step


def _places(steps: Steps, values: Array, step: int) -> Iterator[float]:
    """Instants that divide a step: where the polynomials of its neighbours intersect, else equal parts.

    Of one with a jump those between the rows beside it.
    """
    least = LEAST * (1.0 + abs(float(steps.begin[step]))) / float(steps.length[step])
    meeting = _meeting(steps, values, step)
    row = _tear(steps, values, step) if meeting is None else None
    first, last = (0.0, 1.0) if row is None or row == PARTS else steps.share[step, row : row + 2].tolist()
    if meeting is None and CUTS * least < last - first:
        places = first + (last - first) * np.arange(CUTS + 1) / CUTS
        yield from places[(places > 0.0) & (places < 1.0)].tolist()
    elif meeting is not None and max(SHORTEST, least) < meeting < 1.0 - max(SHORTEST, least):
        yield meeting


def _tear(steps: Steps, values: Array, step: int) -> int | None:
    """The row of a step behind which a signal jumps; the last one where it does so between it and the next one."""
    first = step - int(step > 0 and not steps.jumps[step])
    end = step + 1 + int(step + 1 < len(steps) and not steps.jumps[step + 1])
    away = np.diff(steps.times[first:end].ravel())
    rates = np.abs(np.diff(values[first:end].ravel())) / np.where(away > 0.0, away, np.inf)
    place = int(np.argmax(rates))
    row = place - (step - first) * (PARTS + 1)
    # a plateau may end beside the first rows and the last ones
    is_between = 0 < place < len(rates) - 1 and 0 <= row <= PARTS
    return row if is_between and rates[place] > TEARS * np.delete(rates, place).max() else None


def _tears(steps: Steps, values: Array, may_bend: Mask) -> Iterator[tuple[int, int]]:
    """Parts of steps, and the rows in them behind which a signal jumps, the last one where it does so between parts."""
    for step in np.flatnonzero(may_bend & ~(steps.whole & np.append(steps.whole[1:], True))).tolist():
        row = _tear(steps, values, step)
        if row == PARTS or (row is not None and np.diff(steps.times[step])[row] <= TORN_TIME):
            yield step, row


def _meeting(steps: Steps, values: Array, step: int) -> float | None:
    """The place in a step at which the polynomials before and behind it meet; None where they do not, or miss it."""
    if not 0 < step < len(steps) - 1:
        return None
    before, behind = (steps.basis[near] @ values[near] for near in (step - 1, step + 1))
    longer = [float(steps.length[step] / steps.length[near]) for near in (step - 1, step + 1)]
    # neighbours that are longer are other steps, which have nothing to do with it
    if min(longer) < 0.5 or max(longer) > 2.0:
        return None

    def sides(place: Array) -> tuple[Array, Array]:
        return polyval(1.0 + place * longer[0], before), polyval((place - 1.0) * longer[1], behind)

    def apart(place: Array) -> Array:
        found: Array = np.subtract(*sides(place))
        return found

    if (place := _zero(apart)) is None:
        return None
    known, own = np.where(steps.share[step] < place, *sides(steps.share[step])), values[step]
    allowed = NEAR[0] * float(np.ptp(own)) + NEAR[1] * float(np.abs(own).max())
    return place if np.abs(known - own).max() <= allowed else None


def _at(coefficients: Array, place: Array) -> Array:
    found: Array = np.asarray(polyval(place, coefficients))
    return found


def _zero(f: Callable[[Array], Array]) -> float | None:
    """Where a function of a place in a step passes zero; None where both ends have one sign."""
    low, high = 0.0, 1.0
    if f(np.array(low)) * f(np.array(high)) > 0.0:
        return None
    for _ in range(50):
        middle = 0.5 * (low + high)
        below = f(np.array(low)) * f(np.array(middle)) <= 0.0
        low, high = (low, middle) if below else (middle, high)
    return 0.5 * (low + high)


def _turns(steps: Steps, capacity: Array, torque: Array) -> Iterator[tuple[int, float]]:
    """Steps in which a torque reverses and a capacity jumps with it, and where."""
    ends, size = capacity[:, [0, -1]], np.abs(capacity).max(axis=1)
    turns = (torque[:, 0] > 0.0) != (torque[:, -1] > 0.0)
    for step in np.flatnonzero(turns & (np.abs(np.diff(ends, axis=1)[:, 0]) > JUMP * size)).tolist():
        place = _zero(partial(_at, steps.basis[step] @ torque[step]))
        least = SHORTEST_TIME * (1.0 + abs(float(steps.begin[step]))) / float(steps.length[step])
        if place is not None and least < place < 1.0 - least:
            yield step, place


def split(steps: Steps, cuts: Mapping[int, set[float]]) -> Steps:
    """The same steps where some are cut at places in them."""
    begins, lengths, jumps, whole = list[float](), list[float](), list[bool](), list[bool]()
    for step, (begin, length) in enumerate(zip(steps.begin.tolist(), steps.length.tolist(), strict=True)):
        places = [0.0, *sorted(cuts.get(step, ())), 1.0]
        begins += [begin + place * length for place in places[:-1]]
        lengths += (np.diff(places) * length).tolist()
        jumps += [bool(steps.jumps[step]), *([False] * (len(places) - 2))]
        whole += [bool(steps.whole[step]), *([False] * (len(places) - 2))]
    rows = np.zeros((len(begins), PARTS + 1), dtype=np.intp)
    shares = np.broadcast_to(np.arange(PARTS + 1) / PARTS, rows.shape)
    return Steps(np.array(begins), np.array(lengths), shares, rows, np.array(jumps), np.array(whole)).inside()

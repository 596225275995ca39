"""Signals that for a while are exactly what counts as zero: a little more of them acts, a little less does not."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.memoize import memoize
from clutchwork.declare.schema import inputs
from clutchwork.gradients.references import Reference, references, touched

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.words import Chart, Slopes

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# numbers of a piece of a signal: a cubic, and size, frequency, phase and decay of two waves
PIECE = 12
CUBIC, WAVES = (0, 1, 2, 3), (4, 8)
# a value that is zero, of what it is made of
ROUND_OFF = 1e-15
# what a number makes of it by round-off, for all of itself
BY_ROUND_OFF = 1e-12
# so long it must be below zero to be seen [s], and so far a number is moved for that at most, of its size
SEEN, FARTHEST = 1e-7, 1e-2


class Unpressed(NamedTuple):
    """An interval in which such a signal is zero."""

    since: float  # s
    why: str
    numbers: Mask  # those that would raise it there
    one_way: bool  # all of them the same way
    far: Array  # how far they must be moved for that to be seen


def unpressed(
    chart: Chart, words: Array, slopes: Slopes, names: Sequence[str], sizes: Array, run: tuple[float, float]
) -> Iterator[Unpressed]:
    """Intervals in which they are zero, or what their owners take off them.

    Parameters: sizes, of the numbers; run, its begin and end [s].
    """
    if not slopes.touch(*chart.words_in("segment_coef")) and not touched(chart, slopes):
        return
    for number in pressing(chart.assembled.system):
        for one in references(chart, words, slopes, number):
            yield from _at(one, number, chart, words, slopes, names, sizes, run)


def _at(
    border: Reference,
    number: int,
    chart: Chart,
    words: Array,
    slopes: Slopes,
    names: Sequence[str],
    sizes: Array,
    run: tuple[float, float],
) -> Iterator[Unpressed]:
    """Those in which one signal is at one of these values."""
    begin, end = run
    system, (time, _), (first, _) = chart.assembled.system, *map(chart.words_in, ("segment_time", "segment_coef"))
    start, count = (int(system.arrays[f"input_{what}"][number]) for what in ("first", "count"))
    pieces = words[first + PIECE * start : first + PIECE * (start + count)].reshape(count, PIECE)
    period = float(words[chart.words_in("input_period")[0] + number])
    begins = words[time + start : time + start + count]
    bounds = np.r_[begins, begins[0] + period if period > 0.0 else np.inf]
    for piece in np.flatnonzero(_rests(pieces, border)).tolist():
        # a wave acts whatever its sign
        cubic, waves = (slopes.of(first + PIECE * (start + piece) + np.array(words)) for words in (CUBIC, WAVES))
        cubic[0] -= border.slopes
        moved: Mask = np.any(cubic != 0.0, axis=0) | np.any(waves != 0.0, axis=0)
        since, until = _first_time(bounds, piece, period, begin)
        if moved.any() and since < end and until > begin:
            since, until = max(since, begin), min(until, end)
            free = ", ".join(names[column] for column in np.flatnonzero(moved).tolist())
            what = f"{system.inputs[number].name} is {border.words} from {since:g} to {until:g} s"
            one_way = _are_one_way(cubic) and not waves.any()
            acts = "a little less acts another way" if waves.any() else "a little less does not"
            why = f"{what}, where a little more of {free} acts and {acts}"
            yield Unpressed(since, why, moved, one_way, np.zeros(len(names)))
    yield from _at_knots(system, number, border, pieces, bounds, slopes, first + PIECE * start, sizes, run)


def _rests(pieces: Array, border: Reference) -> Mask:
    """Which pieces of a signal are constant at such a value."""
    found: Mask = ~pieces[:, 1:4].any(axis=1) & ~pieces[:, [4, 8]].any(axis=1) & (pieces[:, 0] == border.value)
    return found


def _first_time(bounds: Array, piece: int, period: float, begin: float) -> tuple[float, float]:
    """When a signal has a piece first behind the begin of a run [s].

    A periodic one rests in its last piece before it starts.
    """
    since, until = float(bounds[piece]), float(bounds[piece + 1])
    if period <= 0.0:
        return since, until
    if piece == len(bounds) - 2 and begin < bounds[0]:
        return begin, float(bounds[0])
    later = period * max(np.floor((begin - until) / period) + 1.0, 0.0)
    return since + later, until + later


def _at_knots(
    system: System,
    number: int,
    border: Reference,
    pieces: Array,
    bounds: Array,
    slopes: Slopes,
    first: int,
    sizes: Array,
    run: tuple[float, float],
) -> Iterator[Unpressed]:
    """Knots at which a load that counts as zero there and not beside it begins or ends.

    Parameters: first, the word of the first piece; run, its begin and end [s].
    """
    acts = ~_rests(pieces, border)
    # a run may begin at one, where it does not matter what was before
    goes_on = np.append(False, acts[:-1]) | (bounds[:-1] == run[0])
    waves = pieces[:, [4, 8]] * np.sin(pieces[:, [6, 10]])
    nothing = ROUND_OFF * np.abs(pieces[:, [0, 4, 8]]).sum(axis=1)
    value = pieces[:, 0] + waves.sum(axis=1) - border.value
    for piece in np.flatnonzero((np.abs(value) <= nothing) & acts & goes_on).tolist():
        moves = _begins(pieces[piece], slopes, first + PIECE * piece) - border.slopes
        # a wave that begins at zero is moved by its size by round-off alone
        moved = np.abs(moves) * sizes > BY_ROUND_OFF * np.abs(pieces[piece, [0, 4, 8]]).sum()
        time = float(bounds[piece])
        if moved.any() and run[0] <= time < run[1]:
            where = f"at its knot at {time:g} s, where it begins or ends"
            what = f"{system.inputs[number].name} is {border.words} {where}"
            far = SEEN * _rate(pieces[piece]) / np.where(moved, np.abs(moves), np.inf)
            far = np.minimum(far, FARTHEST * sizes)
            yield Unpressed(time, f"{what}; give that point a value", moved, _are_one_way(moves[None, moved]), far)


def _are_one_way(moves: Array) -> bool:
    """Whether all numbers move a signal the same way: else two of them may leave it as it is together."""
    return bool(np.all(moves >= 0.0) or np.all(moves <= 0.0))


def _begins(piece: Array, slopes: Slopes, first: int) -> Array:
    """Derivatives by the numbers of the value with which a piece begins, whose first word is given."""
    found: Array = slopes.of(np.array([first]))[0]
    for wave in (4, 8):
        by_size, by_phase = slopes.of(np.array([first + wave, first + wave + 2]))
        found = found + np.sin(piece[wave + 2]) * by_size + piece[wave] * np.cos(piece[wave + 2]) * by_phase
    return found


def _rate(piece: Array) -> float:
    """How fast a piece that begins at zero rises [1/s]."""
    waves = (piece[w] * (piece[w + 1] * np.cos(piece[w + 2]) - piece[w + 3] * np.sin(piece[w + 2])) for w in (4, 8))
    return abs(float(piece[1] + sum(waves)))


@memoize
def pressing(system: System) -> tuple[int, ...]:
    """Numbers of the signals that press contacts, themselves or by a piston, or count as zero below zero."""
    known = {item.name: number for number, item in enumerate(system.inputs)}
    found = (
        f"{part.name}.{name}"
        for part in (*system.contacts, *system.flows, *system.elements, *system.processes)
        for names, spec in inputs(type(part))
        for name in (names if spec.presses or spec.gain or spec.clips else ())
    )
    return tuple(known[name] for name in found if name in known)

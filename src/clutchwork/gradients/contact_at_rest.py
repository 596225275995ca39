"""Signals that are exactly zero for a while and count as zero below it: a little more of them acts, less does not."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.memoize import memoize
from clutchwork.declare.schema import inputs

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
    """Intervals in which they are zero.

    Parameters: sizes, of the numbers; run, its begin and end [s].
    """
    begin, end = run
    system, (time, _), (first, size) = chart.assembled.system, *map(chart.words_in, ("segment_time", "segment_coef"))
    for number in pressing(system) if slopes.touch(first, size) else ():
        start, count = (int(system.arrays[f"input_{what}"][number]) for what in ("first", "count"))
        pieces = words[first + PIECE * start : first + PIECE * (start + count)].reshape(count, PIECE)
        period = float(words[chart.words_in("input_period")[0] + number])
        begins = words[time + start : time + start + count]
        bounds = np.r_[begins, begins[0] + period if period > 0.0 else np.inf]
        for piece in np.flatnonzero(~pieces[:, :4].any(axis=1) & ~pieces[:, [4, 8]].any(axis=1)).tolist():
            # a wave acts whatever its sign
            cubic, waves = (slopes.of(first + PIECE * (start + piece) + np.array(words)) for words in (CUBIC, WAVES))
            moved: Mask = np.any(cubic != 0.0, axis=0) | np.any(waves != 0.0, axis=0)
            since, until = _first_time(bounds, piece, period, begin)
            if moved.any() and since < end and until > begin:
                since, until = max(since, begin), min(until, end)
                free = ", ".join(names[column] for column in np.flatnonzero(moved).tolist())
                what = f"{system.inputs[number].name} is 0 from {since:g} to {until:g} s"
                one_way = _are_one_way(cubic) and not waves.any()
                acts = "a little less acts another way" if waves.any() else "a little less does not"
                why = f"{what}, where a little more of {free} acts and {acts}"
                yield Unpressed(since, why, moved, one_way, np.zeros(len(names)))
        yield from _at_knots(system, number, pieces, bounds, slopes, first + PIECE * start, sizes, run)


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
    pieces: Array,
    bounds: Array,
    slopes: Slopes,
    first: int,
    sizes: Array,
    run: tuple[float, float],
) -> Iterator[Unpressed]:
    """Knots at which a load that is zero there and not beside it begins or ends.

    Parameters: first, the word of the first piece; run, its begin and end [s].
    """
    acts: Mask = np.asarray(pieces[:, :4].any(axis=1) | pieces[:, [4, 8]].any(axis=1))
    # a run may begin at one, where it does not matter what was before
    goes_on = np.append(False, acts[:-1]) | (bounds[:-1] == run[0])
    waves = pieces[:, [4, 8]] * np.sin(pieces[:, [6, 10]])
    nothing = ROUND_OFF * np.abs(pieces[:, [0, 4, 8]]).sum(axis=1)
    for piece in np.flatnonzero((np.abs(pieces[:, 0] + waves.sum(axis=1)) <= nothing) & acts & goes_on).tolist():
        moves = _begins(pieces[piece], slopes, first + PIECE * piece)
        # a wave that begins at zero is moved by its size by round-off alone
        moved = np.abs(moves) * sizes > BY_ROUND_OFF * np.abs(pieces[piece, [0, 4, 8]]).sum()
        time = float(bounds[piece])
        if moved.any() and run[0] <= time < run[1]:
            what = f"{system.inputs[number].name} is 0 at its knot at {time:g} s, where it begins or ends"
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

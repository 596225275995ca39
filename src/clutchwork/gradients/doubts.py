"""Where a derivative may not exist: which values and numbers are in doubt at a point, and why.

What is in doubt is settled by derivatives beside the point, so a doubt too many costs runs, one too few is a wrong
derivative. docs/theory/gradients.md (17)
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.gradients.at_bounds import held_fast, holding_nothing, without_losses
from clutchwork.gradients.at_corners import resting_at_corners
from clutchwork.gradients.at_limits import at_limits
from clutchwork.gradients.at_stops import ends, met_at_the_end, met_otherwise
from clutchwork.gradients.beginning import at_border, at_rest, at_rest_on_a_border, at_zero
from clutchwork.gradients.begins_at_knots import begun_at_knots
from clutchwork.gradients.bent_formulas import bent_formulas
from clutchwork.gradients.contact_at_rest import unpressed
from clutchwork.gradients.grazing import (
    arriving_together,
    begins_unloaded,
    crowded,
    decided_at_knots,
    jumping_together,
    moving_apart,
    refused,
    struck_together,
)
from clutchwork.gradients.knots import times_of
from clutchwork.gradients.lines import Line
from clutchwork.gradients.primal import SAME
from clutchwork.gradients.resting_loads import resting_loads
from clutchwork.gradients.run_point import Run, RunPoint
from clutchwork.gradients.runs import Runs
from clutchwork.gradients.staying import Staying
from clutchwork.sweeps.outputs import AtTimes, When

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# arrays without which no number changes how a run starts
STARTS = ("segment_coef", "contact_rate_value", "initial_speed", "initial_state")
# what lasts less than some nanoseconds is not seen: so many steps beside zero a slip starts, a border, and a state
LET_GO, AT_THE_START, BEHIND_THE_START = 1e2, 3e2, 1e3
# below its speed of rest a stop does not bounce: so many steps of its restitution
REBOUND = 1e3


class Doubt(NamedTuple):
    """A reason, and the values and the numbers that it concerns."""

    why: str
    lines: Mask
    numbers: Mask
    # what a number does on one side is the same wherever the others are on that side
    one_way: bool = False
    # nothing beside the point is looked at: there is no value
    is_closed: bool = False
    # how much farther beside the point it is looked at, and at least how far: what lasts too short is not seen
    width: float = 1.0
    least: float | Array = 0.0


@dataclass(frozen=True, eq=False)
class Doubts:
    """All that is in doubt in a run."""

    runs: Runs
    point: RunPoint
    run: Run
    lines: Sequence[Line]

    def found(self) -> Iterator[Doubt]:
        """One by one, of values that exist."""
        if not self.lines or not len(self.point.x):
            return
        yield from self._asked_at_events()
        yield from self._asked_at_knots()
        yield from self._compared()
        yield from self._kinks()
        yield from self._decisions()
        yield from self._start()
        yield from self._watched()
        yield from self._ends()

    # ------------------------------------------------------------------------------------------------------ what moves

    @property
    def _all(self) -> Mask:
        return np.ones(len(self.point.x), dtype=bool)

    def _moving_event(self, number: int) -> Mask:
        """Numbers that move an event."""
        moves = self.run.primal.functional()
        moves.add_event(number, 1.0)
        found: Mask = self.run.slope(moves) != 0.0
        return found

    def _moving_events(self, time: float) -> Mask:
        """Numbers that move any event at an instant [s]."""
        found: Mask = np.logical_or.reduce([~self._all, *map(self._moving_event, self._is_at(time))])
        return found

    def _is_at(self, time: float) -> list[int]:
        """Events at an instant [s]."""
        room = SAME * (1.0 + abs(time))
        return [number for number, other in enumerate(self._instants) if abs(other - time) <= room]

    @cached_property
    def _instants(self) -> list[float]:
        """When events are [s]."""
        found: list[float] = self.run.primal.events[:, 0].tolist()
        return found

    def _moving_knots(self) -> Mask:
        """Numbers that move any knot of a signal."""
        slopes, words_in = self.point.slopes, self.point.chart.words_in
        parts = [slopes.matrix[slopes.within(*words_in(name))] for name in ("segment_time", "input_period")]
        found: Mask = np.any(np.concatenate(parts) != 0.0, axis=0)
        return found

    def _up_to(self, time: float) -> Mask:
        """Values that look at an instant [s] or behind it."""
        return np.array([line.until >= time for line in self.lines])

    def _only(self, number: int) -> Mask:
        found: Mask = np.arange(len(self.lines)) == number
        return found

    # ---------------------------------------------------------------------------------------------------------- doubts

    def _asked_at_events(self) -> Iterator[Doubt]:
        for number, line in enumerate(self.lines):
            if line.at is not None and self._is_at(line.at):
                why = f"{line.name} is asked for at the instant of an event, {line.at:.9g} s, which moves"
                yield Doubt(f"{why}; ask before or behind it", self._only(number), self._moving_events(line.at))

    def _asked_at_knots(self) -> Iterator[Doubt]:
        knots = self.run.primal.knots
        for number, line in enumerate(self.lines if len(knots.times) or len(knots.meets) else ()):
            if line.at is not None and (self._ends_at_knot(line.at) or self._bends(line)):
                why = f"{line.name} is asked for at a knot that moves, {line.at:.9g} s; ask before or behind it"
                yield Doubt(why, self._only(number), self._moving_knots())

    def _compared(self) -> Iterator[Doubt]:
        """Speeds that are compared at instants at which torques jump: they bend where these move."""
        for number, line in enumerate(self.lines):
            if not line.compares:
                continue
            only, times = self._only(number), np.array(line.compares)
            why = f"{line.name} compares speeds at {{:.9g}} s, where {{}}; move that, or take another window"
            for time in times[self.run.primal.bends_at(line.columns, times)].tolist():
                yield Doubt(why.format(time, "a signal jumps whose knot moves"), only, self._moving_knots())
            for time in times.tolist():
                if self._is_at(time):
                    yield Doubt(why.format(time, "an event is that moves"), only, self._moving_events(time))

    def _bends(self, line: Line) -> bool:
        return bool(self.run.primal.bends_at(line.columns, np.array([line.at]))[0])

    def _ends_at_knot(self, time: float) -> bool:
        """Whether the run ends at the instant of a moving knot, whose bend is not visible."""
        is_end = time >= self.run.primal.t_end * (1.0 - SAME)
        return is_end and bool(np.any(np.abs(self.point.knots.meets - time) <= SAME * (1.0 + abs(time))))

    def _kinks(self) -> Iterator[Doubt]:
        for number, line in enumerate(self.lines):
            for time in line.kinks:
                what = (
                    f"{line.name} has a kink at {time:.9g} s, where knots meet or the run begins or ends; move a knot"
                )
                yield Doubt(what, self._only(number), self._moving_knots())

    def _decisions(self) -> Iterator[Doubt]:
        primal, system, contacts = self.run.primal, self.runs.task.system, self.runs.wanted.contacts
        knots, sizes = times_of(self.point.chart, self.point.words, primal.t_end), self.point.sizes
        begin = self.runs.wanted.begin
        inside = knots[bisect_right(knots, begin) :]
        apart = moving_apart(system, primal.grazes, primal.decided, begin, sizes)
        for time, why in chain(refused(system, primal.decided), apart):
            yield Doubt(why, self._up_to(time), self._all)
            if abs(time - begin) <= SAME * (1.0 + abs(begin)):
                yield from self._of_start(why)
        for time, why, numbers in Staying(self.runs, self.point, self.run).found():
            yield Doubt(why, self._up_to(time), numbers)
        for why in begins_unloaded(system, primal.grazes, sizes):
            yield from self._of_start(why)
        for time, why in jumping_together(system, primal.grazes, sizes):
            yield Doubt(why, self._up_to(time), self._moving_knots())
        found = chain(
            crowded(primal.events, contacts),
            struck_together(system, primal.events, contacts),
            arriving_together(system, primal.events, begin, contacts),
            decided_at_knots(primal.events, primal.grazes, inside, contacts),
            met_otherwise(system, primal.events, primal.grazes, contacts),
        )
        for time, why in found:
            yield Doubt(why, self._up_to(time), self._all)

    def _of_start(self, why: str) -> Iterator[Doubt]:
        """What leaves a border at once shows in what is asked of the start itself, seen from far enough."""
        feels = np.array([line.feels_start for line in self.lines])
        if feels.any():
            yield Doubt(why, feels, self._all, width=AT_THE_START)

    def _start(self) -> Iterator[Doubt]:
        chart, words = self.point.chart, self.point.words
        every = np.ones(len(self.lines), dtype=bool)
        for why, numbers in at_border(self.runs.task.system, self.runs.task.parameters, self.point.x):
            yield Doubt(why, every, numbers)
        for why, numbers in without_losses(chart, words, self.point.slopes):
            yield Doubt(why, every, numbers)
        for why in holding_nothing(self.runs.task.system, self.run.primal):
            yield Doubt(why, every, self._all)
        for why, columns in resting_at_corners(self.runs.task.system, self.point, self.run.primal):
            open_ = np.array([np.isin(line.columns, columns).any() for line in self.lines])
            yield Doubt(why, open_, self._all, is_closed=True)
        for why, numbers in self._resting():
            yield Doubt(why, every, numbers)
        for time, why, numbers in held_fast(chart, words, self.point.slopes, self.run.primal.events):
            yield Doubt(why, self._up_to(time), numbers, width=REBOUND)
        if not chart.stays("segment_time"):
            for why, numbers in begun_at_knots(chart, words, self.point.slopes, self.runs.wanted.begin):
                yield Doubt(why, every, numbers)
        names = [one.name for one in self.runs.task.parameters]
        begin, end = self.runs.wanted.begin, self.runs.wanted.t_end
        for one in unpressed(chart, words, self.point.slopes, names, self.point.sizes, (begin, end)):
            yield Doubt(one.why, self._up_to(one.since), one.numbers, one.one_way, least=one.far)
        if chart.stays(*STARTS):
            return
        for why, numbers in at_rest(chart, words, self.point.slopes):
            yield Doubt(why, every, numbers, width=LET_GO)
        for why, numbers in at_zero(chart, self.point.slopes):
            yield Doubt(why, every, numbers, width=BEHIND_THE_START)

    def _watched(self) -> Iterator[Doubt]:
        """What rests at borders that no guard watches."""
        given, every = (self.runs.task.system, self.point, self.run), np.ones(len(self.lines), dtype=bool)
        for why, numbers in chain(resting_loads(*given), at_limits(*given), bent_formulas(*given)):
            yield Doubt(why, every, numbers)

    def _ends(self) -> Iterator[Doubt]:
        """Events at the end of the run, and stops that are reached there: what is summed up may bend."""
        end, is_event = self.run.primal.t_end, bool(self._is_at(self.run.primal.t_end))
        if not is_event and not ends(self.runs.task.system):
            return
        asked = self._up_to(end * (1.0 - SAME)) & ~self._instants_asked
        sums = asked & np.array([line.at is None for line in self.lines])
        if is_event and sums.any():
            why = f"an event is at the end of the run, {end:.9g} s, and moves; end it before or behind that"
            yield Doubt(why, sums, self._moving_events(end))
        for why, numbers in met_at_the_end(self.runs.task.system, self.point, self.run, end) if asked.any() else ():
            yield Doubt(why, asked, numbers)

    @cached_property
    def _instants_asked(self) -> Mask:
        """Values that are instants of events."""
        ones = self.runs.task.outputs.values()
        counts = [len(one.times) if isinstance(one, AtTimes) else 1 for one in ones]
        return np.repeat([isinstance(one, When) for one in ones], counts)

    def _resting(self) -> Iterator[tuple[str, Mask]]:
        """Pistons and others that stay as they begin, and the numbers that would move them at once."""
        primal, (first, count) = self.run.primal, self.point.chart.words_in("initial_state")
        row, states = primal.row(primal.t_end), primal.columns["state"]
        starts, ends = self.point.words[first : first + count], primal.rows[row, states]
        for why, place in at_rest_on_a_border(self.runs.task.system, starts, ends):
            moves = primal.functional()
            moves.add(np.array([row]), np.array([states.start + place]), np.ones((1, 1)))
            # those that it begins with are looked at for themselves, or take the border with them
            begins = self.point.slopes.of(np.array([first + place]))[0] != 0.0
            numbers: Mask = (self.run.slope(moves) != 0.0) & ~begins
            if numbers.any():
                yield why, numbers

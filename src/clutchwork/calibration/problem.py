"""What is to be calibrated: unknowns, goal and limits of a model, all mistakes found at once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property, partial
from typing import Any

import numpy as np

from clutchwork.assembly.system import System
from clutchwork.base import ModelError, dataclass, quote
from clutchwork.base.arrays import Array
from clutchwork.base.errors import Problem as Wrong
from clutchwork.base.mistakes import Mistakes
from clutchwork.base.quote import measured
from clutchwork.calibration.limits import Limit, Settled, WeightedSum, summed
from clutchwork.calibration.moves import Moves, Variable
from clutchwork.calibration.names import TimeTable, curve, numbers
from clutchwork.calibration.terms import Jerk, OutputUnits, SquaredSlope, TimeSpan
from clutchwork.calibration.together import FACTOR, VALUE, Together
from clutchwork.declare.options import Options
from clutchwork.gradients.differentiable import refuse_outputs
from clutchwork.gradients.parameters import Tunable, changes
from clutchwork.sweeps.numbers import pair

# of bounds, in shares of themselves: a start that is out by no more is at its bound
ROUND_OFF = 1e-9
SUCH = "{'c1.pressure.values[2:]': (0.0, 8e5)}"


@dataclass(frozen=True)
class CalibrationProblem:
    """A goal to be made least and limits to be held, by unknowns that move numbers of a model."""

    system: System
    span: TimeSpan
    unknowns: tuple[Variable, ...]
    scatter: tuple[Variable, ...]
    moved: tuple[Tunable, ...]  # the numbers that unknowns and scatter move
    goal: WeightedSum
    limits: tuple[Settled, ...]
    curves: Mapping[str, TimeTable]
    unit: str  # of the goal
    begin: Array | None = None  # where the search begins, where not at the values of the model

    @cached_property
    def numbers(self) -> tuple[str, ...]:
        """Names of the numbers."""
        return tuple(one.name for one in self.moved)

    @cached_property
    def base(self) -> Array:
        """Values of the numbers in the model."""
        return np.array([one.start for one in self.moved])

    @property
    def identity(self) -> tuple[Any, ...]:
        """What makes it this problem, beside its System."""
        return (self.span, self.unknowns, self.scatter, self.goal, self.limits)

    @cached_property
    def outputs(self) -> list[Any]:
        """The outputs of a run that are needed, each once."""
        sums = (self.goal, *(limit.what for limit in self.limits))
        return list(dict.fromkeys(output for one in sums for output in one.needs(self.span)))

    @cached_property
    def start(self) -> Array:
        """The unknowns as the model has them, within their bounds."""
        own = Moves(self.unknowns, self.numbers).start(self.base) if self.begin is None else self.begin
        return np.clip(own, self.low, self.high)

    @cached_property
    def low(self) -> Array:
        """Lower bounds of the unknowns."""
        return np.array([one.low for one in self.unknowns])

    @cached_property
    def high(self) -> Array:
        """Upper bounds of the unknowns."""
        return np.array([one.high for one in self.unknowns])


def problem(
    system: System, span: TimeSpan, options: Options, free: Any, minimise: Any, subject_to: Any, scatter: Any
) -> CalibrationProblem:  # fmt: skip
    """What the arguments of a call mean; UseError names all that is wrong with them."""
    mistakes, units = Mistakes(), OutputUnits(system)
    unknowns = _unknowns(system, "free", free, mistakes)
    spread = _unknowns(system, "scatter", scatter, mistakes) if scatter is not None else ([], {})
    goal, fault = summed(minimise)
    if goal is None:
        mistakes.found.append(f"minimise: {fault}")
    limits = list(_limits(subject_to, units, mistakes))
    sums = [one for one in (goal, *(limit.what for limit in limits)) if one is not None]
    stems = dict.fromkeys(stem for one in sums for stem in one.tables)
    curves = {stem: mistakes.caught(partial(curve, system, stem), None) for stem in stems}
    mistakes.caught(partial(refuse_outputs, system, _outputs(sums, span), options, span.end), None)
    moved = unknowns[1] | spread[1]
    mistakes.found += [*_twice(unknowns[0]), *_scattered(unknowns[0], spread[0]), *outside(unknowns[0], moved)]
    # factors and shifts need not hold the nominal ones: a lining may only wear
    mistakes.found += outside([one for one in spread[0] if one.kind == VALUE], moved, "scatter")
    if not mistakes.found and goal is not None:
        mistakes.found += [fault for one in sums for fault in one.faults(span, curves)]
        mistakes.found += _restless(goal)
    mistakes.refuse("calibrate")
    assert goal is not None  # noqa: S101, what is wrong with it was refused
    made = (tuple(unknowns[0]), tuple(spread[0]), tuple(moved.values()))
    return CalibrationProblem(system, span, *made, goal, tuple(limits), curves, goal.unit(units))


def _outputs(sums: Sequence[WeightedSum], span: TimeSpan) -> dict[str, Any]:
    """The outputs of sums whose windows fit into a run."""
    terms = [one for each in sums for one, _ in each.terms if not (isinstance(one, Jerk) and one.faults(span))]
    return {str(number): one for number, one in enumerate(needed for one in terms for needed in one.needs(span))}


def _unknowns(system: System, what: str, given: Any, mistakes: Mistakes) -> tuple[list[Variable], dict[str, Tunable]]:
    """Unknowns or scatters that a mapping means, and the numbers that they move by name."""
    if not isinstance(given, Mapping) or not given:
        mistakes.found.append(f"{what} is {quote(given)}: give names with their bounds, {SUCH}")
        return [], {}
    made, moved = list[Variable](), dict[str, "Tunable"]()
    for name, ends in given.items():
        named = ends.names if isinstance(ends, Together) else (name,)
        found = [one for each in named for one in mistakes.caught(partial(numbers, system, each), ())]
        moved |= {one.name: one for one in found}
        names = [one.name for one in found]
        for twice in dict.fromkeys(one for one in names if names.count(one) > 1):
            mistakes.found.append(f"{what} of {name!r} names {twice} twice; give it once")
        if isinstance(ends, Together):
            made.append(Variable(str(name), ends.kind, tuple(one.name for one in found), ends.low, ends.high))
            continue
        for one in found:
            both = pair(ends, one.unit)
            if both is None:
                wanted = f"(low, high){f' in {one.unit}' if one.unit else ''}, or with a unit that fits"
                mistakes.found.append(f"{what} of {name!r} is {quote(ends)}: give {wanted}, the lower one first")
                break
            made.append(Variable(one.name, VALUE, (one.name,), *both, one.unit))
    return made, moved


def _twice(unknowns: Sequence[Variable]) -> Iterable[str]:
    """Numbers that two unknowns set."""
    names = [one.name for one in unknowns if one.kind == VALUE]
    for name in dict.fromkeys(one for one in names if names.count(one) > 1):
        yield f"{name} is free twice; give it once"


def _scattered(unknowns: Sequence[Variable], scatter: Sequence[Variable]) -> Iterable[str]:
    """Numbers that are free although the scatter sets them."""
    free = {name for one in unknowns for name in one.numbers}
    for one in scatter:
        if one.kind == VALUE and one.name in free:
            remedy = f"let it scatter about what is found, by cw.together({one.name!r}, factor=(0.9, 1.1)) or shift="
            yield f"{one.name} is free, and scatter sets it from {one.low:g} to {one.high:g} {one.unit}".rstrip() + (
                f"; {remedy}"
            )


def outside(unknowns: Sequence[Variable], moved: Mapping[str, Tunable], what: str = "free") -> Iterable[str]:
    """Values of the model that are not between their bounds: the search begins there."""
    for one in unknowns:
        start = {VALUE: moved[one.numbers[0]].start, FACTOR: 1.0}.get(one.kind, 0.0) if one.numbers else one.low
        room = ROUND_OFF * max(abs(one.low), abs(one.high))
        if not one.low - room <= start <= one.high + room:
            has = measured(start, one.unit) if one.kind == VALUE else f"{one.kind} {start:g}"
            ends = f"{one.low:g} to {measured(one.high, one.unit)}"
            factor = one.kind == VALUE and one.low <= 1.0 <= one.high
            other = f", or cw.together({one.name!r}, factor=({one.low:g}, {one.high:g}))" if factor else ""
            yield f"{what} of {one.name!r}: the model has {has}, outside of {ends}; give bounds around it{other}"


def _restless(goal: WeightedSum) -> Iterable[str]:
    """A goal that is least without bound."""
    for one, weight in goal.terms:
        if isinstance(one, SquaredSlope) and weight < 0.0:
            yield f"minimise: the weight of {one.name} is {weight:g}: give one > 0"


def _limits(given: Any, units: OutputUnits, mistakes: Mistakes) -> Iterable[Settled]:
    listed = [given] if isinstance(given, Limit) else given
    if not isinstance(listed, Iterable) or isinstance(listed, str | Mapping):
        mistakes.found.append(f"subject_to is {quote(given)}: give a list of cw.limit('c1.heat', upper=4e4)")
        return
    for one in listed:
        if not isinstance(one, Limit):
            mistakes.found.append(f"{quote(one)} in subject_to is not a limit: give cw.limit('c1.heat', upper=4e4)")
            continue
        found, faults = one.settled(units)
        mistakes.found += [f"subject_to: {fault}" for fault in faults]
        if found is not None:
            yield found


def refuse_bounds(found: CalibrationProblem) -> None:
    """ModelError names all bounds with which the model cannot be run.

    Times of tables are left out: with those of their neighbours moved they may be right.
    """
    problems = list[Wrong]()
    for unknowns in (found.unknowns, found.scatter):
        own = [one for one in unknowns if not any(".times[" in name for name in one.numbers)]
        # all at once, and one by one where that is refused: values may only do together
        if any(_refused(found, unknowns, own, side) for side in ("low", "high")):
            each = [_refused(found, unknowns, [one], side) for one in own for side in ("low", "high")]
            problems += [problem for several in each for problem in several]
    if problems:
        raise ModelError(list(dict.fromkeys(problems)), found.system.name)


def _refused(
    found: CalibrationProblem, unknowns: Sequence[Variable], moved: Sequence[Variable], side: str
) -> tuple[Wrong, ...]:
    """What is wrong with the model where some unknowns are at one side of their bounds."""
    moves = Moves(unknowns, found.numbers)
    x = moves.start(found.base)
    for one in moved:
        x[unknowns.index(one)] = getattr(one, side)
    names = dict.fromkeys(name for one in moved for name in one.numbers)
    try:
        if names:
            found.system.changed(changed_by(found, moves.apply(found.base, x), names))
    except ModelError as error:
        return error.problems
    return ()


def changed_by(found: CalibrationProblem, numbers: Array, names: Iterable[str]) -> dict[str, Any]:
    """What `System.changed` takes for some of the numbers."""
    wanted = set(names)
    places = [place for place, one in enumerate(found.moved) if one.name in wanted]
    return changes(found.system, [found.moved[place] for place in places], numbers[places])

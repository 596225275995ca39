"""Values and derivatives by runs of the core that carry derivatives through every event."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import wiring
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError
from clutchwork.gradients.bends import Bends, bends_of, spread
from clutchwork.gradients.bent_slips import of_bristles, of_powers
from clutchwork.gradients.doubts import Doubt, Doubts
from clutchwork.gradients.grazing import noted, passed_unseen, together
from clutchwork.gradients.jerk import massless
from clutchwork.gradients.lines import UNKNOWN, UNSEEN, Line, lines, unknown, without_derivatives
from clutchwork.gradients.measures import Context, Measure, measures
from clutchwork.gradients.run_point import Run, RunPoint
from clutchwork.gradients.runs import Runs
from clutchwork.gradients.settled import NEARER, STEP, Beside, Settling
from clutchwork.gradients.task import GradientTask, GradientValues
from clutchwork.gradients.words import Words
from clutchwork.results.gradient import NoGradient
from clutchwork.sweeps.outputs import Integral

Array = NDArray[np.float64]

# variants of one call without derivatives
MOST_AT_ONCE = 256
# reach of a number without a neighbour, next to zero on its own scale
FAR = 1e300
# directions that a run carries at the cost of one
AT_ONCE = 8
# factor of the tighter tolerance at which rough derivatives are taken again, and the least one
TIGHTER, LEAST = 1e-2, 1e-12
# least factor between two of these tolerances
FAR_APART = 10.0
# what the tightest two runs may differ by on a rough derivative, of the value over the number
APART = 1e-3
# what may be missed of a squared jerk that is still rough, of its value
MUCH = 1e-2
# a derivative may miss so much of the relative tolerance of a run
BY_TOLERANCE = 100.0
# a run is followed back from so many numbers on, and from so many more for each result
FOLLOWED_FROM, FOLLOWED_FOR_EACH = 12, 4
STILL_ROUGH = "its derivatives follow a bend or an instant at which rates cancel, and have fewer digits than the run"


@dataclass(frozen=True, eq=False)
class Exact:
    """Runs with derivatives."""

    task: GradientTask
    again: bool = False  # whether it is asked for what another one knows too little of
    words: Words | None = None  # of the driveline as functions of the numbers, where they are known
    _others: dict[tuple[tuple[str, int, int], ...], Exact] = field(default_factory=dict, repr=False)  # by structure

    @cached_property
    def runs(self) -> Runs:
        """The runs."""
        return Runs(self.task, self.words)

    @cached_property
    def _asked(self) -> Context:
        wanted = self.runs.wanted
        kept = {one.name: wanted.kept_as(one) for one in wanted.outputs.values() if isinstance(one, Integral)}
        allowed = max(UNKNOWN, BY_TOLERANCE * self.task.options.rtol)
        system = self.task.system
        bends = of_bristles(system), of_powers(system)
        return Context(wanted.contacts, kept, wanted.begin, massless(system), *bends, allowed)

    @cached_property
    def _tighter(self) -> Exact | None:
        """The same with a tighter tolerance."""
        options = self.task.options
        # the last two are far enough apart to be compared
        if options.rtol <= FAR_APART * LEAST:
            return None
        rtol = options.rtol * TIGHTER if options.rtol * TIGHTER > FAR_APART * LEAST else LEAST
        changes = {"rtol": rtol, "atol": options.atol * rtol / options.rtol}
        return Exact(replace(self.task, options=options.changed(changes)), again=True, words=self.runs.words)

    # ---------------------------------------------------------------------------------------------------------- values

    def values(self, x: Array) -> Array:
        """Values for each line of numbers, NaN where there is none."""
        found = [self._values(x[first : first + MOST_AT_ONCE]) for first in range(0, len(x), MOST_AT_ONCE)]
        return np.concatenate(found) if found else np.zeros((0, len(self.task.labels)))

    def refuse_lines(self, x: Array) -> None:
        """ModelError, which names the line, where the driveline refuses numbers of a batch."""
        for number, line in enumerate(x):
            try:
                self.runs.words.at(line)
            except ModelError as error:
                raise ModelError(error.problems, f"x[{number}] of {len(x)} lines") from None

    def _values(self, x: Array) -> Array:
        found, engines = np.zeros((len(x), len(self.task.labels))), [self._like(line) for line in x]
        for engine in dict.fromkeys(engines):
            mine = [number for number, one in enumerate(engines) if one is engine]
            runs, points = engine.runs, x[mine]
            systems = [runs.words.bytes_at(line) for line in points]
            found[mine] = runs.plain.values(systems, [runs.signals.at(line) for line in points])
        return found

    def _like(self, x: Array) -> Exact:
        """The same for the structure at a point: a number that is zero, such as a lag, may leave out a state."""
        system = self.runs.words.at(x)[0].assembled.system
        columns = wiring(system).columns
        if columns == wiring(self.task.system).columns:
            return self
        key = tuple((name, part.start, part.stop) for name, part in columns.items())
        if key not in self._others:
            self._others[key] = Exact(replace(self.task, system=system), self.again)
        return self._others[key]

    # ----------------------------------------------------------------------------------------------------- derivatives

    def gradient(self, x: Array) -> GradientValues:
        """Values and derivatives at a point, NaN for one that does not exist; NoGradient where there is none at all."""
        found = self._like(x)._found(x)  # noqa: SLF001, its own kind
        if found.problems and found.matrix.size and np.isnan(found.matrix).all():
            raise NoGradient(found.problems)
        return found

    def gradients(self, x: Array) -> tuple[Array, Array]:
        """The same for each line of numbers, NaN for all of one whose run stops early."""
        with ThreadPoolExecutor(self.task.threads) as pool:
            found = list(pool.map(self._found_or_none, x))
        shape = (len(x), len(self.task.labels), len(self.task.parameters))
        return np.array([one.values for one in found]).reshape(shape[:2]), np.array(
            [one.matrix for one in found]
        ).reshape(shape)

    def _found_or_none(self, x: Array) -> GradientValues:
        try:
            return self._like(x)._found(x)  # noqa: SLF001, its own kind
        except NoGradient:
            return GradientValues(self._values(x[None])[0], np.full((len(self.task.labels), len(x)), np.nan))

    def product(self, x: Array, weights: Array) -> tuple[Array, Array]:
        """Values at a point, and the derivatives of the weighted sum of those whose weight is not zero.

        NoGradient where one of these does not exist.
        """
        if (engine := self._like(x)) is not self:
            return engine.product(x, weights)
        used = weights != 0.0
        known = self._followed_product(x, weights) if self._is_followed_back(x, 1) else None
        if known is not None:
            return known
        found = self._found(x)
        if np.any(np.isnan(found.matrix[used])):
            raise NoGradient(found.problems)
        return found.values, weights[used] @ found.matrix[used]

    def _followed_product(self, x: Array, weights: Array) -> tuple[Array, Array] | None:
        """The same by one run that is followed back; None where anything is in doubt, or extremes are equal."""
        try:
            point = self.runs.point(x)
        except NoGradient:
            return None
        run = self._run(point, 1)
        found = [one for output in self.task.outputs.values() for one in measures(run.primal, output, self._asked)]
        if any(len(one.changes) != 1 or self._is_rough(point, run, one) for one in found) or self._doubts(
            point, run, without_derivatives(self.task.labels, found)
        ):
            return None
        if any(passed_unseen(self.task.system, run.primal.grazes)):
            return None
        whole = run.primal.functional()
        for share, one in zip(weights.tolist(), found, strict=True):
            whole.include(one.changes[0], share)
        return np.array([one.value for one in found]), run.slope(whole)

    def _is_rough(self, point: RunPoint, run: Run, one: Measure) -> bool:
        if one.is_unseen or one.lost is not None or one.unseen > UNSEEN:
            return True
        allowed = UNKNOWN if one.is_massless else self._asked.unknown
        return bool(one.missed) and bool(np.any(unknown(run, one, point.sizes) > allowed))

    # ---------------------------------------------------------------------------------------------------- at one point

    def _found(self, x: Array) -> GradientValues:
        """Values and derivatives at a point, NaN and a problem for each that does not exist.

        NoGradient where the run stops early.
        """
        try:
            known, beside = self._known(x), self._beside
        except Bends as bends:
            known, beside = self._known_without(x, bends), self._beside_alone
        return self._settled(x, beside, *known)

    def _settled(
        self, x: Array, beside: Beside, known: list[Line], doubts: list[Doubt], notes: tuple[str, ...]
    ) -> GradientValues:
        values, matrix = np.array([one.value for one in known]), np.array([one.left for one in known])
        if not doubts and all(one.left is one.right for one in known) and np.isfinite(matrix).all():
            return GradientValues(values, matrix, notes)
        settling = Settling.of(self.task, x, self.runs.sizes(x), known, doubts)
        settling.settle(beside)
        matrix = settling.matrix()
        return GradientValues(values, matrix, notes, tuple(settling.problems(matrix)))

    def _known(self, x: Array) -> tuple[list[Line], list[Doubt], tuple[str, ...]]:
        """What a run at a point says, and what is in doubt; Bends where a number is at a kink of the driveline."""
        try:
            point = self.runs.point(x)
            run, found = self.lines(point)
        except NoGradient as none:
            raise bends_of(none, self.task) from None
        notes = [*run.notes, *noted(self.task.system, run.primal.grazes, run.primal.decided), *self._steep]
        notes += [f"{one.name}: {STILL_ROUGH}" for one in found if self._repeats(one) and not one.is_open]
        return found, self._doubts(point, run, found), tuple(dict.fromkeys(notes))

    @cached_property
    def _steep(self) -> list[str]:
        """Laws whose rates have no derivatives at some states."""
        known = wiring(self.task.system)
        laws = [(one.name, one.component.friction) for one in (*known.contacts, *known.elements)]
        at = f"at {self.runs.wanted.begin:g} s and later"
        return [f"{name} {at}: {law.steep}; derivatives have few digits" for name, law in laws if law and law.steep]

    def _known_without(self, x: Array, bent: Bends) -> tuple[list[Line], list[Doubt], tuple[str, ...]]:
        """The same where some numbers are at kinks of the driveline: these are in doubt."""
        kept = np.array([number not in bent.numbers for number in range(len(x))])
        found, doubts, notes = self._values_alone(x), list[Doubt](), tuple[str, ...]()
        if kept.any():
            rest = self._with(x, np.flatnonzero(kept).tolist())
            found, doubts, notes = rest._known(x[kept])  # noqa: SLF001, its own kind
        all_ = np.ones(len(found), dtype=bool)
        doubts = [
            one._replace(
                numbers=spread(one.numbers, kept, fill=False),
                least=spread(np.broadcast_to(one.least, one.numbers.shape), kept, fill=0.0),
                one_way=False,
            )
            for one in doubts
        ]
        doubts += [
            Doubt(why, all_, np.arange(len(x)) == number, is_closed=bent.is_tied(number))
            for number, why in bent.numbers.items()
        ]
        nan = float("nan")
        whole = [one._replace(left=spread(one.left, kept, nan), right=spread(one.right, kept, nan)) for one in found]
        return whole, doubts, notes

    def _values_alone(self, x: Array) -> list[Line]:
        """Lines without derivatives, where no number has one."""
        none = np.zeros(0)
        values = zip(self.task.labels, self._values(x[None])[0].tolist(), strict=True)
        return [Line(name, value, 0.0, none, none, self.task.t_end) for name, value in values]

    def lines(self, point: RunPoint) -> tuple[Run, list[Line]]:
        """A run, and its requested outputs with plain derivatives; those that are rough are of a tighter run."""
        run, found = self._lines(point)
        if self._tighter is not None and any(self._repeats(one) for one in found):
            try:
                nearer = self._tighter.lines(self._tighter.runs.point(point.x))[1]
            except NoGradient:
                return run, found
            found = [self._nearer(here, there, point.sizes) for here, there in zip(found, nearer, strict=True)]
        return run, found if self.again else [self._as_known(one) for one in found]

    @staticmethod
    def _as_known(one: Line) -> Line:
        """A squared jerk without derivatives of which too much is missed, however tight the run."""
        is_lost = one.is_sum and one.rough and not one.several and one.missed > MUCH
        return one.opened(one.left != 0.0) if is_lost else one

    def _nearer(self, here: Line, there: Line, sizes: Array) -> Line:
        """The better one of a line and that of a tighter run; near round-off a tighter run knows no more."""
        if not here.rough:
            bent = there._replace(value=here.value, is_bent=True, rough=False)
            return bent if here.is_bent and not there.is_open else here
        if there.is_open:
            return there._replace(value=here.value)
        is_better = bool(here.several) or there.missed < here.missed
        best = there._replace(value=here.value) if is_better else here
        if here.several or not there.rough or self._tighter is None or self._tighter._tighter is not None:  # noqa: SLF001, its own kind
            return best
        size = max(abs(here.value), here.size)
        return best.opened(np.abs(here.left - there.left) * sizes > APART * size)

    def _repeats(self, one: Line) -> bool:
        """Whether a tighter run is asked for derivatives; equal extremes and bends are looked at once more alone."""
        return (one.rough and not (self.again and one.several)) or (one.is_bent and not self.again)

    def _lines(self, point: RunPoint) -> tuple[Run, list[Line]]:
        run, outputs = self._run(point, len(self.task.labels)), self.task.outputs
        found = lines(run, outputs, self.task.labels, self._asked, point.sizes)
        for time, why in passed_unseen(self.task.system, run.primal.grazes):
            found = [one.refused(why) if one.until >= time else one for one in found]
        return run, found

    def _run(self, point: RunPoint, results: int) -> Run:
        """A run, followed back where results are few and numbers many."""
        run = self.runs.taped(point) if self._is_followed_back(point.x, results) else self.runs.forward(point)
        # of events at one instant it is to be known how they move
        return (
            self.runs.forward(point) if not run.is_forward and together(run.primal.grazes, run.primal.decided) else run
        )

    @staticmethod
    def _is_followed_back(x: Array, results: int) -> bool:
        """Whether following a run back costs less than carrying derivatives along."""
        return len(x) >= FOLLOWED_FROM + FOLLOWED_FOR_EACH * results

    def _doubts(self, point: RunPoint, run: Run, found: list[Line]) -> list[Doubt]:
        return list(Doubts(self.runs, point, run, found).found())

    def _beside(self, x: Array, number: int | None) -> list[Line] | None:
        """Lines of a run beside the point, by one number alone where it is given; None where there is no run."""
        if number is not None and len(x) > AT_ONCE:
            return self._beside_alone(x, number)
        try:
            engine = self._like(x)
            found = engine.lines(engine.runs.point(x))[1]
        except (ModelError, NoGradient):
            return None
        if number is None:
            return found
        return [one._replace(left=one.left[[number]], right=one.right[[number]]) for one in found]

    def _beside_alone(self, x: Array, number: int | None) -> list[Line] | None:
        """The same by one number in a driveline of its own, which knows no kink but those nearer than it is looked."""
        if number is None:
            return None
        # of numbers that are not at a kink derivatives of words are better known from farther away
        for reach in (FAR, NEARER * STEP):
            try:
                alone = self._with(x, [number], reach)
                return alone.lines(alone.runs.point(x[[number]]))[1]
            except ModelError:
                return None
            except NoGradient:
                continue
        return None

    def _with(self, x: Array, numbers: Sequence[int], reach: float = np.inf) -> Exact:
        """The same at a point, by some of the numbers.

        Parameters: reach, how far they may be moved to find derivatives of words, of their size.
        """
        sizes, chosen = self.runs.sizes(x), [(number, self.task.parameters[number]) for number in numbers]
        parameters = tuple(
            replace(one, start=float(x[number]), reach=min(one.reach, reach * float(sizes[number])))
            for number, one in chosen
        )
        return Exact(replace(self.task, system=self.runs.words.assembled(x), parameters=parameters))

"""What a driveline gives as a function of some of its numbers, with its derivatives."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import field
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError, UseError, near
from clutchwork.base.mistakes import Mistakes
from clutchwork.base.plural import counted
from clutchwork.base.quote import quote
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.declare.options import Options
from clutchwork.declare.ports import directions
from clutchwork.gradients.exact import Exact
from clutchwork.gradients.parameters import Tunable, parameters
from clutchwork.gradients.settled import SIDES
from clutchwork.gradients.task import GradientTask, GradientValues
from clutchwork.laws.bases.formula import FormulaLaw
from clutchwork.results.channels import SPEED, channels
from clutchwork.results.gradient import Gradient
from clutchwork.run.control import controllers
from clutchwork.run.settings import merged, refuse_endless
from clutchwork.run.simulation import Assembles, model_of
from clutchwork.sweeps.batch import CoreOutputs
from clutchwork.sweeps.outputs import Asked, AtEnd, AtTimes, Computed, Output, asked
from clutchwork.sweeps.request import threads_of
from clutchwork.sweeps.result import unit_of

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.node import Number
    from clutchwork.declare.option_fields import OptionFields

Array = NDArray[np.float64]


@explained_methods("f")
@dataclass(frozen=True, eq=False, repr=False)
class Differentiable:
    """What a driveline gives, as a function of some of its numbers: `cw.differentiable` makes it.

    `f(x)` are its values for numbers x in SI, `f.value_and_jacobian(x)` values and derivatives. `f.of` names the
    values, `f.by` the numbers, `f.x0` holds those of the driveline. It never changes, and threads may share it.
    """

    task: GradientTask = field(repr=False)
    engine: Exact = field(repr=False)
    of: tuple[str, ...]
    by: tuple[str, ...]
    of_units: tuple[str, ...]  # SI
    by_units: tuple[str, ...]  # SI
    _last: list[tuple[bytes, GradientValues]] = field(repr=False, default_factory=list)  # optimisers ask twice

    @property
    def x0(self) -> Array:
        """The numbers of the driveline."""
        return np.array([one.start for one in self.task.parameters])

    @property
    def system(self) -> System:
        """The driveline with its own numbers."""
        return self.task.system

    def __call__(self, x: Any) -> Array:
        """Values for numbers in the order of `by`; NaN for an event that does not happen, or a run that stops early."""
        point = self._point(x)
        known = self._known(point)
        return known.values.copy() if known else self.task_values(point[None])[0]

    def task_values(self, points: Array) -> Array:
        """Values of lines of numbers that were looked at."""
        return self.engine.values(points)

    def value_and_jacobian(self, x: Any) -> tuple[Array, Array]:
        """Values, and their derivatives: a line for each value, a column for each number.

        A derivative that does not exist is NaN, and `f.gradient(x).problems` says why; NoGradient, a ValueError, where
        there is none at all.
        """
        found = self._found(self._point(x))
        return found.values.copy(), found.matrix.copy()

    def jacobian(self, x: Any) -> Array:
        """The derivatives alone."""
        return self.value_and_jacobian(x)[1]

    def vjp(self, x: Any, weights: Any) -> tuple[Array, Array]:
        """Values, and the derivatives of their weighted sum, at a cost that does not grow with the number of numbers.

        Parameters: weights, one for each value; one whose weight is 0 needs no derivatives. NoGradient, a ValueError,
        where a derivative of another one does not exist.
        """
        given = _line(weights, len(self.of), "weights", "value")
        return self.engine.product(self._point(x), given)

    def objective(self, of: str | Sequence[float] | None = None) -> Callable[[Any], tuple[float, Array]]:
        """A value and its gradient as a function of x, as `scipy.optimize.minimize(..., jac=True)` takes it.

        Parameters: of, the name of a value, or weights of all; it may be left out where there is one value.
        """
        weights = self._weights(of)

        def value_and_gradient(x: Any) -> tuple[float, Array]:
            values, gradient = self.vjp(x, weights)
            return float(values[weights != 0.0] @ weights[weights != 0.0]), gradient

        return value_and_gradient

    def batch(self, x: Any) -> Array:
        """Values for many lines of numbers, on threads; NaN for what is not there.

        ModelError, which names the line, where the driveline refuses its numbers.
        """
        with self._lines(x) as points:
            return self.task_values(points)

    def batch_jacobian(self, x: Any) -> tuple[Array, Array]:
        """Values and derivatives for many lines of numbers, on threads; NaN for each that does not exist.

        ModelError as in `batch`.
        """
        with self._lines(x) as points:
            return self.engine.gradients(points)

    def gradient(self, x: Any = None) -> Gradient:
        """Values and derivatives with their names and units, by default at the numbers of the driveline."""
        point = self.x0 if x is None else self._point(x)
        found = self._found(point)
        return Gradient(
            self.of,
            self.by,
            found.values,
            point,
            found.matrix,
            self.of_units,
            self.by_units,
            found.notes,
            found.problems,
        )

    def __repr__(self) -> str:
        return (
            f"<Differentiable {quote(self.system.name)}: {counted(len(self.of), 'values')} by {len(self.by)} numbers>"
        )

    # ----------------------------------------------------------------------------------------------------------- points

    def _point(self, x: Any) -> Array:
        return _line(x, len(self.by), "x", "number")

    def _points(self, x: Any) -> Array:
        try:
            points = np.asarray(x, dtype=float)
        except (TypeError, ValueError):
            points = np.zeros(0)
        if points.ndim != 2 or points.shape[1] != len(self.by) or not np.all(np.isfinite(points)):
            raise UseError("batch", [f"x is {quote(x)}: give lines of {counted(len(self.by), 'numbers')} each"])
        return np.ascontiguousarray(points)

    @contextmanager
    def _lines(self, x: Any) -> Iterator[Array]:
        """Lines of numbers; what the driveline refuses is said with the line that has it."""
        points = self._points(x)
        try:
            yield points
        except ModelError:
            self.engine.refuse_lines(points)
            raise

    def _known(self, point: Array) -> GradientValues | None:
        return next((found for key, found in self._last if key == point.tobytes()), None)

    def _found(self, point: Array) -> GradientValues:
        found = self._known(point)
        if found is None:
            found = self.engine.gradient(point)
            self._last[:] = [(point.tobytes(), found)]
        return found

    def _weights(self, of: str | Sequence[float] | None) -> Array:
        if of is None and len(self.of) == 1:
            return np.ones(1)
        if isinstance(of, str) and of in self.of:
            return np.array([float(name == of) for name in self.of])
        if of is None or isinstance(of, str):
            raise UseError("f.objective", [f"of is {quote(of)}: name a value{near(of, self.of, ', '.join(self.of))}"])
        return _line(of, len(self.of), "of", "value")


def _line(given: Any, count: int, name: str, what: str) -> Array:
    """One finite number for each of some things."""
    try:
        line = np.array(given, dtype=float)
    except (TypeError, ValueError):
        line = np.zeros(0)
    if line.shape != (count,) or not np.isfinite(line).all():
        raise UseError("f", [f"{name} is {quote(given)}: give a finite number for each {what}, {count} in all"])
    return line


@explained("cw.differentiable", of="['load.speed', cw.lock('c1')]", by="['c1.gain', 'engine.inertia']")
def differentiable(
    model: Assembles | System,
    t_end: Number | None = None,
    *,
    of: Mapping[str, Asked] | Sequence[Asked] | Asked,
    by: Sequence[str] | str,
    side: str | None = None,
    threads: int | None = None,
    options: Options | None = None,
    **changes: Unpack[OptionFields],
) -> Differentiable:
    """What a Driveline or a System gives as a function of some of its numbers, with exact derivatives.

    Parameters: t_end [s], or with a unit, options and their fields by name are those of `simulate`; of, values as
    `outputs` of `sweep`: a signal at the end, `cw.at`, `cw.lock`, `cw.maximum`, `cw.integral`, `cw.jerk` ...;
    by, names of numbers as in `System.changed`: "c1.gain", "engine.inertia", of a table "c1.pressure.values", all
    ordinates, "c1.pressure.values[3]", the third one, "c1.pressure.values[2:]", all from the second on, and
    "c1.pressure.times[3]", the time of the third knot;
    side, "left" or "right", which derivatives are given where those from both sides differ: as a number gets less, or
    grows; threads, how many runs of a batch go at once.

    Derivatives follow the events: locking, breaking away and every kink move with the numbers, which differentiating
    the steps of a solver misses. UseError names all that cannot be differentiated; where a derivative does not exist
    at a point it is NaN, and `f.gradient(x).problems` says why. docs/guide/gradients.md
    """
    system = model_of("differentiable", model, options)
    given = {**changes} if t_end is None else {**changes, "t_end": t_end}
    end, chosen = merged(system.settings, given, options)
    plain = chosen.changed({"dt": None, "times": None})
    refuse_endless(system.inputs, plain.t_start, end, plain.max_steps)
    return made(system, of, by, end, plain, threads, side, call="differentiable")


def made(
    system: System,
    of: Any,
    by: Any,
    t_end: float,
    options: Options,
    threads: int | None,
    side: Any = None,
    *,
    call: str = "gradient",
) -> Differentiable:
    """The function for the requested outputs; call, what was called, as the head of what is wrong with it."""
    mistakes = Mistakes()
    mistakes.found += _faults(options, side)
    count = mistakes.caught(lambda: threads_of(threads, call), 1)
    outputs: dict[str, Output] = mistakes.caught(lambda: asked(of, "of"), {})
    mistakes.caught(lambda: refuse_outputs(system, outputs, options, t_end), None)
    chosen: tuple[Tunable, ...] = mistakes.caught(lambda: parameters(system, by), ())
    mistakes.refuse(call)
    known = channels(system, options.angles, options.work)
    labels = [(label, unit_of(one, known)) for name, one in outputs.items() for label in _labels(name, one)]
    names, units = zip(*labels, strict=True)
    task = GradientTask(system, outputs, chosen, t_end, options, count, names, side)
    by_units = tuple(one.unit for one in chosen)
    return Differentiable(task, Exact(task), names, tuple(one.name for one in chosen), units, by_units)


def _faults(options: Options, side: Any) -> Iterator[str]:
    """What is wrong with settings."""
    if side is not None and side not in SIDES:
        yield f"side is {quote(side)}: give 'left' or 'right', or leave it out"
    if options.method == "fixed":
        yield 'method is "fixed": derivatives follow the motion between events; leave it out'


def _labels(name: str, one: Output) -> list[str]:
    """What the numbers of an output are called: of a signal at instants one for each."""
    if not isinstance(one, AtTimes) or (len(one.times) == 1 and name != one.name):
        return [name]
    return [f"{name} {time:.12g} s" for time in one.times]


def refuse_outputs(system: System, outputs: Mapping[str, Output], options: Options, t_end: float) -> None:
    """UseError names outputs that are not there, and all that has no derivative, whatever the numbers."""
    mistakes = Mistakes()
    mistakes.caught(lambda: CoreOutputs.of(system, options, outputs, t_end), None)
    mistakes.found += [*_without_derivative(system, outputs), *_words(system, options, outputs)]
    mistakes.refuse("gradient")


def _words(system: System, options: Options, outputs: Mapping[str, Output]) -> list[str]:
    """Signals that are words."""
    known = channels(system, options.angles, options.work)
    signals = (one.signal for one in outputs.values() if isinstance(one, AtEnd | AtTimes))
    words = [name for name in dict.fromkeys(signals) if name in known and not known[name].unit]
    remedy = "take a signal that is a number, or when it changes, such as cw.lock({!r})"
    return [f"{name} is a word, which has no derivative; {remedy.format(name.rpartition('.')[0])}" for name in words]


def _without_derivative(system: System, outputs: Mapping[str, Output]) -> list[str]:
    """What has no derivative."""
    problems = [
        f"{name} is a Python function, which has no derivative; "
        "take signals, or cw.squared_jerk, and differentiate what you make of them"
        for name, one in outputs.items()
        if isinstance(one, Computed)
    ]
    problems += [
        f"{one.name} is set by a Python function or an FMU, which has no derivative; take a table of what it gives"
        for one in controllers(system.inputs)
    ]
    slips = ((contact, SPEED[directions(contact)[0].domain]) for contact in system.contacts)
    laws = ((contact.name, contact.friction, unit) for contact, unit in slips)
    jumps = ((name, law.jump(unit)[0]) for name, law, unit in laws if isinstance(law, FormulaLaw))
    problems += [
        f"{name}.friction {jump}, where no event is, so that derivatives would be wrong; make it continuous"
        for name, jump in jumps
        if jump
    ]
    return problems

"""What rules see of a run: its signals with both limits at every event, whatever its output was."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import HOUSING, Branch
from clutchwork.base import dataclass
from clutchwork.declare.schema import specs
from clutchwork.hints.motion import SlipAccelerations
from clutchwork.results.channels import LOCKED

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.results.events import Events
    from clutchwork.results.recorded import Recorded

Array = NDArray[Any]

# instants of a run whose own output has others
INSTANTS = 1000
# rows of a stretch at which its torques are looked at
MOST_PLACES = 400
OPEN = 2


class RowSpan(NamedTuple):
    """Rows from `first` to `last`, both of them part of it."""

    first: int
    last: int


@dataclass(frozen=True, eq=False)
class Look:
    """A run that has at least one instant."""

    run: Recorded  # as it was made
    fine: Recorded  # the same with enough instants

    @classmethod
    def at(cls, run: Recorded) -> Look:
        """Look at a run; where its output has instants of its own it is repeated, unless it stopped early.

        One from a file that does not hold all that it was made with is looked at as it is.
        """
        own = run.options.dt is not None or run.options.times is not None or run.options.output == "steps"
        return cls(run, run.at(_instants(run)) if own and run.finished and not run.lacks else run)

    @property
    def system(self) -> System:
        """What ran."""
        return self.run.system

    @property
    def events(self) -> Events:
        """What happened to the contacts."""
        return self.run.events

    @property
    def time(self) -> Array:
        """Instants [s]."""
        return self.fine.time

    @property
    def begin(self) -> float:
        """Start of the run [s]."""
        return begins(self.run)

    @property
    def end(self) -> float:
        """Last instant [s]."""
        return float(self.time[-1])

    @property
    def duration(self) -> float:
        """How long it lasted [s]."""
        return self.end - self.begin

    @cached_property
    def motion(self) -> SlipAccelerations:
        """What moves when contacts are locked."""
        return SlipAccelerations(self.system)

    @property
    def contacts(self) -> tuple[Branch, ...]:
        """All contacts; the columns below are in their order."""
        return self.run.wiring.contacts

    def part(self, name: str) -> Array:
        """A part of the rows by its name in layout.ROW."""
        return self.fine.rows[:, self.run.wiring.columns[name]]

    @cached_property
    def mode(self) -> Array:
        """Mode of each contact."""
        made: Array = self.part("contact_mode").astype(int)
        return made

    @cached_property
    def locked(self) -> Array:
        """Whether each contact is locked."""
        made: Array = self.mode == LOCKED
        return made

    @cached_property
    def closed(self) -> Array:
        """Whether each contact takes up a torque: it is locked, or slips with a capacity."""
        made: Array = self.locked | ((self.mode != OPEN) & (self.part("contact_torque") != 0.0))
        return made

    @cached_property
    def slip(self) -> Array:
        """Slip of each contact, zero while it is locked."""
        rates = [self.rate(branch) for branch in self.contacts]
        return np.where(self.locked, 0.0, np.column_stack(rates)) if rates else np.zeros(self.mode.shape)

    def rate(self, branch: Branch, part: str = "speed") -> Array:
        """Speed or acceleration of what moves less that of its base."""
        of_nodes = self.part(part)
        terms = [factor * of_nodes[:, node] for node, factor in branch.direction.items() if node != HOUSING]
        made: Array = np.sum(terms, axis=0)
        return made

    @cached_property
    def heat(self) -> Array:
        """Heat of each contact since the start [J], its friction alone."""
        if self.run.options.work:
            return -self.part("contact_work")
        power = -self.part("contact_torque") * self.slip
        steps = 0.5 * (power[1:] + power[:-1]) * np.diff(self.time)[:, None]
        return np.concatenate([np.zeros((1, power.shape[1])), np.cumsum(steps, axis=0)])

    def holding(self, contact: int, span: RowSpan) -> float:
        """Mean torque over a span, against the slip, that would keep the slip of a contact as it is; inf: none can.

        It is the torque that the contact has, and what its slip acceleration takes beside it.
        """
        rows = np.unique(np.linspace(span.first, span.last, MOST_PLACES).astype(int))
        ease = np.array([self.motion.ease(contact, self.locked_at(int(row))) for row in rows])
        if np.any(ease <= 0.0):
            return np.inf
        torque = self.part("contact_torque")[rows, contact]
        torque = torque - self.rate(self.contacts[contact], "acceleration")[rows] / ease
        return _mean(self.time[rows], -self.mode[rows, contact] * torque)

    def locked_at(self, row: int) -> tuple[int, ...]:
        """Contacts that are locked at a row."""
        return tuple(np.flatnonzero(self.locked[row]).tolist())

    def mean(self, span: RowSpan, values: Array) -> float:
        """Mean over the time of a span of values at its rows."""
        return _mean(self.time[span.first : span.last + 1], values)

    def load(self, contact: int) -> Array | None:
        """What presses a contact, pressure or force; None where nothing does that is known."""
        name = self._pressing(contact)
        return np.asarray(self.fine[name]) if name else None

    def controlled(self, contact: int) -> bool:
        """Whether a controller decides on what presses a contact."""
        name = self._pressing(contact)
        return any(item.name == name and item.signal.sampling() is not None for item in self.system.inputs)

    def actuated(self, contact: int) -> bool:
        """Whether what presses a contact changes in the run; else it is plain friction."""
        load = self.load(contact)
        return load is not None and float(np.ptp(load)) > 0.0

    def _pressing(self, contact: int) -> str:
        """Name of the signal that presses a contact."""
        part = self.contacts[contact].component
        pressing = [item.name for item, spec in specs(type(part), "signal", "alternative") if spec.presses or spec.gain]
        return next((f"{part.name}.{name}" for name in pressing if getattr(part, name) is not None), "")

    def spans(self, chosen: Array) -> list[RowSpan]:
        """Stretches of consecutive rows that are chosen and last some time."""
        edges = np.flatnonzero(np.diff(np.concatenate([[False], chosen, [False]]).astype(int)))
        found = [RowSpan(int(first), int(stop) - 1) for first, stop in zip(edges[::2], edges[1::2], strict=True)]
        return [span for span in found if self.time[span.last] > self.time[span.first]]


def _mean(time: Array, values: Array) -> float:
    length = float(time[-1] - time[0])
    return float(np.trapezoid(values, time)) / length if length else float(np.mean(values))


def begins(run: Recorded) -> float:
    """When a run began [s], whatever its first output is."""
    return float(getattr(run.options, "t_start", 0.0))


def _instants(run: Recorded) -> Array:
    """A grid with both limits at events and at knots of signals."""
    ends = begins(run), run.t_end
    knots = {piece.start for item in run.system.inputs if not item.signal.repeats() for piece in item.signal.segments()}
    inner = np.array([t for t in (*run.events.times, *knots) if ends[0] < t < ends[1]])
    return np.sort(np.concatenate([np.linspace(*ends, INSTANTS + 1), inner, inner]))

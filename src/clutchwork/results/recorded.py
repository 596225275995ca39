"""The data of a run: its signals by name, its events, how it ended."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.declare.calls import explained_methods
from clutchwork.declare.layout import DONE, STATUSES
from clutchwork.declare.options import Options
from clutchwork.results.events import Events

if TYPE_CHECKING:
    from typing import Self

    from clutchwork.assembly.system import System
    from clutchwork.assembly.wiring import Wiring
    from clutchwork.results.channels import Channels


@explained_methods("run")
@dataclass(frozen=True, eq=False)
class Recorded:
    """What pictures, tables and reports read of a run; a `Trajectory` is what users hold."""

    system: System
    options: Options
    t_end: float  # s, the end that was asked for
    time: Array  # s
    rows: Array = field(repr=False)  # output rows of the core, layout.ROW
    events: Events = field(repr=False)
    status: str  # "done", or why the run stopped early: a name of layout.STATUS
    message: str  # "" when done; else what, where, when, and what to do
    statistics: Mapping[str, float] = field(repr=False)
    repeat: Callable[[Any], Any] = field(repr=False)  # the same run, bit for bit, at other instants [s]
    # inputs that Python functions set, where a file does not hold these: the run cannot be repeated
    lacks: tuple[str, ...] = field(repr=False)

    @property
    def finished(self) -> bool:
        """Whether the run reached its end time."""
        return self.status == STATUSES[DONE]

    @property
    def reached(self) -> float:
        """Time up to which it is known [s]: its end, or where it stopped."""
        return self.t_end if self.finished else float(self.time[-1]) if len(self) else self.options.t_start

    @property
    def wiring(self) -> Wiring:
        """Who is joined to what."""
        from clutchwork.assembly.wiring import wiring

        return wiring(self.system)

    @property
    def channels(self) -> Channels:
        """Unit and evaluation of every signal."""
        # loaded where a signal is read: sweeps and scripts that look at events alone need none
        from clutchwork.results.channels import channels

        return channels(self.system, self.options.angles, self.options.work)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all signals."""
        return tuple(self.channels)

    @cached_property
    def units(self) -> dict[str, str]:
        """Unit of every signal; KeyError with near names, as for a signal."""
        from clutchwork.results.channels import Units

        return Units((name, channel.unit) for name, channel in self.channels.items())

    def __getitem__(self, name: str) -> NDArray[Any]:
        """A signal over `time`; KeyError with near names when there is none of that name."""
        return self.channels[name].evaluate(self.rows)

    def __contains__(self, name: object) -> bool:
        return name in self.channels

    def __len__(self) -> int:
        """Number of instants."""
        return len(self.time)

    def at(self, times: Any) -> Self:
        """The same run at other instants [s], in order of time, as exact as the solver: nothing is interpolated.

        The run is repeated, bit for bit; controllers are not called again, their decisions are replayed.
        """
        again: Self = self.repeat(times)
        return again

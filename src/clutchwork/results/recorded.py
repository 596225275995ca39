"""What pictures, tables and reports need of a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.system import System
from clutchwork.assembly.wiring import Wiring
from clutchwork.declare.options import Options
from clutchwork.results.channels import Channels
from clutchwork.results.events import Events


class Recorded(Protocol):
    """A run that has been computed, such as a Trajectory."""

    @property
    def system(self) -> System:
        """What was run."""

    @property
    def options(self) -> Options:
        """How it was run."""

    @property
    def time(self) -> NDArray[np.float64]:
        """Instants [s]."""

    @property
    def rows(self) -> NDArray[np.float64]:
        """Output rows of the core, one per instant."""

    @property
    def events(self) -> Events:
        """What happened to the contacts."""

    @property
    def t_end(self) -> float:
        """The end that was asked for [s]."""

    @property
    def status(self) -> str:
        """Word for how it ended: "done", or why the run stopped early."""

    @property
    def message(self) -> str:
        """What is to be said of the status; empty when done."""

    @property
    def finished(self) -> bool:
        """Whether the run reached its end time."""

    @property
    def statistics(self) -> Mapping[str, float]:
        """What the solver did."""

    @property
    def repeat(self) -> Callable[[Any], Any]:
        """Computes it again at other instants [s]."""

    @property
    def wiring(self) -> Wiring:
        """Who is joined to what."""

    @property
    def channels(self) -> Channels:
        """Unit and evaluation of every signal."""

    @property
    def units(self) -> dict[str, str]:
        """Unit of every signal."""

    def __getitem__(self, name: str) -> NDArray[Any]:
        """A signal over time."""

    def __contains__(self, name: object) -> bool:
        """Whether there is a signal of that name."""

    def __len__(self) -> int:
        """Number of instants."""

    def at(self, times: Any) -> Recorded:
        """The same run at other instants [s]."""

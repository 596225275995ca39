"""What stands between the controller and a shift element: valves and pistons. docs/theory/shifts.md (17)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from clutchwork.base import dataclass


class Learnt(NamedTuple):
    """What shifts have shown of an element behind a piston: its fill time [s], the command at which it touches."""

    fill_time: float
    kiss: float


@dataclass(frozen=True)
class ElementActuator:
    """How a shift element is commanded, and how its torque responds; `cw.shifts.fill_test` measures it.

    Parameters:
        signal: of the command, such as "A_valve.current"
        commands: from the empty piston to full torque, in the unit of the signal; falling where a valve opens without
        current
        torques: of the slipping element at these, at rest of the piston [N m], rising
        fill_time: with the last command, until a piston that was empty touches [s]
        kiss: command at which it touches
        lag: time constant of the torque behind the command [s]
    """

    signal: str
    commands: Sequence[float]
    torques: Sequence[float]
    fill_time: float
    kiss: float
    lag: float

    @property
    def most(self) -> float:
        """Largest torque [N m]."""
        return self.torques[-1]

    def command(self, torque: float) -> float:
        """At which the element carries a torque in the long run; that of the kiss point for none."""
        return float(np.interp(torque, *self._table))

    @cached_property
    def _table(self) -> tuple[Any, Any]:
        """Torques and commands from where it touches on."""
        carrying = [n for n, value in enumerate(self.torques) if value > 0.0]
        torques, commands = ([values[n] for n in carrying] for values in (self.torques, self.commands))
        return np.array([0.0, *torques]), np.array([self.kiss, *commands])

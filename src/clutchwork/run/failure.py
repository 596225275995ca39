"""How a run that cannot go on is reported: what, where, when, and what to do about it."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import caller
from clutchwork.declare.layout import REFUSALS, STATUS
from clutchwork.declare.schema import Role, specs
from clutchwork.model.parts import is_stop
from clutchwork.run.trajectory import Trajectory

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.results.events import Event

# why a run stopped, where a value tells more
WITH_VALUE = ("not_finite", "out_of_table", "chatter")


# what cannot go on where nothing moves any more, and what to do about it where that is something of its own
JAMS = {
    "freewheel": ("prescribed speeds turn a freewheel backward", ""),
    "turned": ("a transmission whose ratio leaves it no other way turns a freewheel backward", ""),
    "stop": ("prescribed speeds go beyond a stop", ""),
    "held stop": (
        "nothing holds the shafts beside a stop that is closed",
        "give the shafts without inertia beside it some, and gears that lock themselves more efficiency",
    ),
    "ratio": ("initial speeds, prescribed ones or locked contacts break the ratio of a transmission", ""),
    "light": (
        "at its ratio nothing determines the speed of the shaft without inertia beside it",
        "give that shaft inertia, or keep the ratio away from there: from zero, or from one if it is the support",
    ),
}


class StoppedEarly(RuntimeWarning):
    """Warning that a run ended before its end time; `trajectory` holds what was computed."""

    def __init__(self, message: str, trajectory: Trajectory) -> None:
        super().__init__(message)
        self.trajectory = trajectory

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.trajectory)


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a run; `trajectory` holds what was computed before.

    It is a KeyboardInterrupt; a script that does not catch it ends with exit code 1, not that of a signal.
    """

    def __init__(self, message: str, trajectory: Trajectory) -> None:
        super().__init__(message)
        self.trajectory = trajectory

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.trajectory)


class FaultWarning(RuntimeWarning):
    """Warning that a fault was triggered that its element reports as a warning."""


def explain(status: int, component: Any, time: float, value: float, quantity: str = "", jam: str = "") -> str:
    """One line for a status of the core: message, element or quantity, value, range of a table, time, remedy.

    Parameters: quantity, a number of the row or a signal in place of a component; jam, which of `JAMS`.
    """
    name, message, remedy = STATUS[status]
    # of a run with derivatives it is not known when
    stopped = f"stopped at {time:.9g} s" if isfinite(time) else "stopped"
    if name == "refused":
        where = f"{component.name!r}" if component is not None else "this model"
        return f'method is "fixed": {message} of {where}, for {REFUSALS[int(value)][1]}: {remedy}'
    if jam:
        message, remedy = JAMS[jam][0], JAMS[jam][1] or remedy
    if name == "zeno" and quantity:
        crowded = f"{quantity!r} has more than 50 knots within a microsecond"
        return f"{stopped}: {crowded}: thin out the signal, or filter it before it becomes a table"
    if quantity:
        told = f"; the largest is {quantity}, {value:g}" if isfinite(value) else f": {quantity} is {value:g}"
        return f"{stopped}: {message}{told}: {remedy}"
    where = f" at {component.name!r}" if component is not None else ""
    ranges = covered(component) if name == "out_of_table" else ""
    seen = f" (value {value:g}{ranges})" if component is not None and name in WITH_VALUE else ""
    return f"{stopped}: {message}{where}{seen}: {remedy}"


def jam_of(system: System, component: Any, index: int) -> str:
    """Which of `JAMS` it is where a component with a number jams."""
    if component.role is Role.CONTACT:
        prescribed = len(system.prescribed_input) > 0
        if is_stop(component):
            return "stop" if prescribed else "held stop"
        return "freewheel" if prescribed else "turned"
    places = np.flatnonzero(system.transmission_element == index)
    return "light" if any(system.transmission_speed[places] >= 0) else "ratio"


def covered(component: Any) -> str:
    """Ranges of the tables of a friction law."""
    law, axes = component.friction, dict[str, str]()
    for item, spec in specs(type(law), "curve", "numbers"):
        values = [x for x, _ in getattr(law, item.name)] if spec.what == "curve" else getattr(law, item.name)
        if spec.what == "curve" or spec.rising:
            axes.setdefault(f"{min(values):g} to {max(values):g} {spec.unit_x or spec.unit}", item.name)
    return f", the table covers {' and '.join(axes)}" if axes else ""


def report_faults(run: Trajectory) -> None:
    """Warn of the faults of a run whose elements report them as a warning."""
    warn_of_faults(run.system, run.events)


def warn_of_faults(system: System, events: Iterable[Event]) -> None:
    """Warn of the faults among events."""
    contacts = {contact.name: contact for contact in system.contacts}
    for event in events:
        what = contacts[event.element].fault_warning() if event.cause == "fault" else ""
        if what:
            warnings.warn(FaultWarning(f"{event.element!r} {what} from {event.time:.9g} s on"), stacklevel=caller())

"""What happened to the contacts during a run, as a table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import astuple, fields
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import UnknownName, columns, dataclass, listed, near, quote
from clutchwork.base.memoize import memoize
from clutchwork.base.paths import fitting
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.declare.layout import CAUSES, EVENT, MODES
from clutchwork.declare.node import Domain
from clutchwork.declare.ports import directions

if TYPE_CHECKING:
    from pathlib import Path

    from clutchwork.assembly.system import System


# units of the fields of an event that have one, of contacts on shafts; and those that differ on masses
UNITS = {
    "time": "s",
    "slip_acceleration": "rad/s2",
    "torque_before": "N m",
    "torque_after": "N m",
    "energy_before": "J",
    "energy_after": "J",
}
ON_MASSES = {"rad/s2": "m/s2", "N m": "N"}
COLUMNS = [name for name, _ in EVENT]


@dataclass(frozen=True)
class Event:
    """One contact changing its state."""

    time: float  # s
    element: str  # name of the contact; "" when the event belongs to no contact
    before: str  # forward, backward, locked or open
    after: str
    cause: str  # a word of CAUSES in clutchwork.declare.layout
    # rad/s2, on masses m/s2: that with which it came where it is locked afterwards, else that with which it goes on
    slip_acceleration: float
    torque_before: float  # N m on the follower, on masses N
    torque_after: float  # N m on the follower, on masses N
    energy_before: float  # J, kinetic
    energy_after: float  # J, kinetic

    @property
    def energy_lost(self) -> float:
        """Energy taken out by an impulse at this instant [J]."""
        return self.energy_before - self.energy_after


@explained_methods("run.events")
class Events(Sequence[Event]):
    """The events of a run in order of time; print it to read it."""

    def __init__(self, events: Sequence[Event] = (), contacts: Iterable[str] | None = None) -> None:
        """Events in order of time.

        Parameters: contacts, those that `of` knows, by default those of the events; a mapping also says the motion that
        each is in, by default shafts.
        """
        self._events = tuple(events)
        on_shafts = None if contacts is None else dict.fromkeys(contacts, Domain.ROTATION)
        self._contacts = contacts if isinstance(contacts, Mapping) else on_shafts

    @property
    def units(self) -> dict[str, str]:
        """Units of the fields that have one; both where some contacts are on shafts, some on masses."""
        kinds = {self._domain(event) for event in self} or {Domain.ROTATION}
        units = {}
        for name, unit in UNITS.items():
            line = ON_MASSES.get(unit, unit)
            both = [one for kind, one in ((Domain.ROTATION, unit), (Domain.TRANSLATION, line)) if kind in kinds]
            units[name] = " or ".join(dict.fromkeys(both))
        return units

    def _domain(self, event: Event) -> Domain:
        return (self._contacts or {}).get(event.element, Domain.ROTATION)

    def _cells(self, event: Event, units: Mapping[str, str]) -> list[str]:
        """What tables show of an event; where events have several units its numbers have theirs."""
        numbers = [(event.slip_acceleration, "slip_acceleration"), (event.torque_before, "torque_before")]
        numbers.append((event.torque_after, "torque_after"))
        words = [f"{event.time:.9f}", event.element, event.before, event.after, event.cause]
        for number, name in numbers:
            text = f"{number:z.4g}" if abs(number) < 1e5 else f"{number:.3e}"
            own = UNITS[name] if self._domain(event) is Domain.ROTATION else ON_MASSES[UNITS[name]]
            words.append(text if own == units[name] else f"{text} {own}")
        return words

    @overload
    def __getitem__(self, index: int) -> Event: ...
    @overload
    def __getitem__(self, index: slice) -> Events: ...
    def __getitem__(self, index: int | slice) -> Event | Events:
        if isinstance(index, slice):
            return Events(self._events[index], self._contacts)
        return self._events[index]

    def __len__(self) -> int:
        return len(self._events)

    def __iter__(self) -> Iterator[Event]:
        return iter(self._events)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Events) and self._events == other._events

    def __hash__(self) -> int:
        return hash(self._events)

    def of(self, element: str | None = None, *, before: str = "", after: str = "", cause: str = "") -> Events:
        """The events of one contact, of one kind, or both: `run.events.of("c1", after="locked")` are its lock-ups.

        Parameters: element, a name, "" for those that belong to no contact, None for all; before and after, "forward",
        "backward", "locked" or "open"; cause, a word of the guide to results. UnknownName, a KeyError, with near names
        where there is none of that name.
        """
        known = [event.element for event in self] if self._contacts is None else [*self._contacts]
        if element and element not in known:
            remedy = f"contacts are {listed(dict.fromkeys(known))}" if known else "the model has no contacts"
            raise UnknownName(f"no contact {quote(element)}{near(element, known, remedy)}")
        wanted = {"element": element} if element is not None else {}
        for name, word in (("before", before), ("after", after), ("cause", cause)):
            words = [cause for cause, _ in CAUSES.values()] if name == "cause" else list(MODES.values())
            if word and word not in words:
                rest = "" if near(word, words) else f"; {name} is one of {listed(words)}"
                raise UnknownName(f"no {name} {quote(word)}{near(word, words)}{rest}")
            wanted |= {name: word} if word else {}
        chosen = [event for event in self if all(getattr(event, name) == word for name, word in wanted.items())]
        return Events(chosen, self._contacts)

    def changes(self) -> Events:
        """Without entries that change no torque: an open contact whose slip passes zero."""
        chosen = [event for event in self if event.before != event.after and event.cause != "passing"]
        return Events(chosen, self._contacts)

    def at_start(self) -> Events:
        """Impulses at the very start: with the first of all events, if any."""
        chosen = [event for event in self if event.cause == "impulse" and event.time == self[0].time]
        return Events(chosen, self._contacts)

    @property
    def times(self) -> NDArray[np.float64]:
        """Instants [s]."""
        return np.array([event.time for event in self], dtype=float)

    def __str__(self) -> str:
        """A table for reading."""
        units = self.units
        numbers = {"slip acc": "slip_acceleration", "torque before": "torque_before", "torque after": "torque_after"}
        # where there are two, each number has its own
        words = (word if " or " in units[name] else f"{word} {units[name]}" for word, name in numbers.items())
        head = ("time s", "element", "from", "to", "cause", *words)
        lines = [tuple(self._cells(event, units)) for event in self]
        return columns([head, *lines], right={0, 5, 6, 7}) if lines else "no events"

    __repr__ = __str__

    def to_pandas(self) -> Any:
        """A pandas DataFrame with one line for each event; `frame.attrs["units"]` holds the units. Needs pandas."""
        from clutchwork.base.extras import need

        pandas = need("pandas", "tables", "a table")
        words = ("element", "before", "after", "cause")
        frame = pandas.DataFrame(
            {
                item.name: pandas.Series(
                    [getattr(e, item.name) for e in self], dtype=str if item.name in words else float
                )
                for item in fields(Event)
            }
        )
        frame.attrs["units"] = self.units
        return frame

    def _repr_html_(self) -> str:
        """A table for a notebook."""
        from clutchwork.base import html

        units = self.units
        head = ("time, s", "element", "from", "to", "cause", f"slip acceleration, {units['slip_acceleration']}")
        torques = (f"torque before, {units['torque_before']}", f"torque after, {units['torque_after']}")
        lines = (self._cells(event, units) for event in self)
        return html.table((*head, *torques), lines, right={0, 5, 6, 7}) if self else html.paragraph("no events")

    @explained("run.events.to_csv", path="'events.csv'")
    def to_csv(self, path: str | Path) -> None:
        """Write every field of every event; the head of each column has its unit."""
        from clutchwork.base.writing import put_csv

        names, units = [item.name for item in fields(Event)], self.units
        heads = [f"{name} [{units[name]}]" if name in units else name for name in names]
        lines = ([repr(value) if isinstance(value, float) else value for value in astuple(event)] for event in self)
        put_csv(fitting("run.events.to_csv", path, "events.csv", [".csv"]), [heads, *lines])


@memoize
def contact_domains(system: System) -> dict[str, Domain]:
    """The contacts of a System in order, and the motion that each is in."""
    return {contact.name: directions(contact)[0].domain for contact in system.contacts}


def from_rows(rows: NDArray[np.float64], contacts: Mapping[str, Domain]) -> Events:
    """Name the numbers of the core."""
    # contacts that change in one instant stand in their own order
    order = np.lexsort((rows[:, COLUMNS.index("contact")], rows[:, COLUMNS.index("time")]))
    names = [*contacts]
    return Events([_event(dict(zip(COLUMNS, row, strict=True)), names) for row in rows[order].tolist()], contacts)


def _event(numbers: dict[str, float], contacts: Sequence[str]) -> Event:
    contact, before, after, cause = (int(numbers.pop(name)) for name in ("contact", "from", "to", "cause"))
    return Event(
        element=contacts[contact] if 0 <= contact < len(contacts) else "",
        before=MODES.get(before, "open"),
        after=MODES.get(after, "open"),
        cause=CAUSES[cause][0],
        **numbers,
    )

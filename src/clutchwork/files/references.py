"""Elements of a model file that refer to each other: made in the order in which they are needed."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from typing import Any

from clutchwork.declare.node import Component, HeatFlow, Node, Rate, SupplyPower, ThermalNode
from clutchwork.model.components import component_problems
from clutchwork.model.parts import Parts, take_apart

Entry = Mapping[str, Any]
REFERENCES = {"rate": Rate, "heat_flow": HeatFlow, "supply_power": SupplyPower}


class References(Container[str]):
    """The elements by name; one that another refers to is made first."""

    def __init__(self, make: Callable[[Entry, int], Component | None]) -> None:
        self._make = make
        self._entries: list[tuple[int, Entry]] = []
        self._places: dict[str, int] = {}
        self._made: dict[int, Component | None] = {}
        self._started: set[int] = set()

    def all(self, entries: Sequence[tuple[int, Entry]]) -> Iterator[Component]:
        """All elements without mistakes, in the order of the file."""
        self._entries = list(entries)
        for number, (_, entry) in enumerate(entries):
            if isinstance(entry.get("name"), str):
                self._places.setdefault(entry["name"], number)
        found = [self._at(number) for number in range(len(entries))]
        yield from (element for element in found if element is not None)

    def _at(self, number: int) -> Component | None:
        if number not in self._started:
            self._started.add(number)
            place, entry = self._entries[number]
            self._made[number] = self._make(entry, place)
        return self._made.get(number)

    def get(self, name: str) -> Component | None:
        """An element, None where it has mistakes, is being made, or is not there."""
        return self._at(self._places[name]) if name in self._places else None

    def part(self, name: object) -> Node | ThermalNode | Component | None:
        """A node or an element that is part of an element: "disc.surface", "gearbox.A"."""
        if not isinstance(name, str) or "." not in name:
            return None
        words = name.split(".")
        wholes = (self.get(".".join(words[:cut])) for cut in range(len(words) - 1, 0, -1))
        whole = next((found for found in wholes if found is not None), None)
        parts = take_apart([whole]) if whole is not None and not any(component_problems(whole)) else Parts()
        known: list[Node | ThermalNode | Component] = [*parts.nodes, *parts.thermal, *parts.components]
        return next((part for part in known if part.name == name), None)

    def unknown_part(self, name: object) -> bool:
        """Whether a name may be that of a part of an element with mistakes, which are reported where it stands."""
        words = name.split(".") if isinstance(name, str) else []
        wholes = [".".join(words[:cut]) for cut in range(len(words) - 1, 0, -1)]
        return any(whole in self and self.get(whole) is None for whole in wholes)

    def broken(self, name: str) -> bool:
        """Whether an element was read and has mistakes."""
        return self._places[name] in self._made

    def __contains__(self, name: object) -> bool:
        return name in self._places

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)


def is_named(value: Any, *known: Container[str]) -> bool:
    """Whether an input is given by another node or element: its name, or a table that names it."""
    if isinstance(value, Mapping):
        kind = value.get("type")
        known_kind = isinstance(kind, str) and kind in REFERENCES
        return isinstance(value.get("of"), str) and ("state" in value or known_kind)
    return isinstance(value, str) and any(value in names for names in known)


def referred(value: Mapping[str, Any], found: Any) -> Any:
    """A state, the rate or the heat of an element."""
    return (found, value["state"]) if "state" in value else REFERENCES[value["type"]](of=found)

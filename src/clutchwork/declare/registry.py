"""All declarations by role and kind, each imported from its file when it is first asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from enum import Enum
from functools import cache
from importlib import import_module
from os import listdir
from os.path import dirname, join, splitext
from typing import Any

# every public file in these folders declares the kind of its stem
ROOMS = ("elements", "laws", "signals")


class Role(Enum):
    """What a component is to the engine."""

    TORQUE = "torque"  # torque as a function of rate, states and inputs along one direction
    CONTACT = "contact"  # set-valued friction along one direction
    GEAR = "gear"  # rigid kinematic row between speeds, assembled in Python
    MOTION = "motion"  # prescribed speed
    FLOW = "flow"  # heat flow between two thermal nodes
    PROCESS = "process"  # states of its own that signals, rates and heats drive: an actuator, wear
    SENSOR = "sensor"  # quantities of a result between two nodes, nothing of its own
    COMPOSITE = "composite"  # made of other elements, nothing of its own
    LAW = "law"  # friction coefficient over slip
    SIGNAL = "signal"  # value over time that drives an input


class Kinds(Mapping[str, Any]):
    """The declarations of a role by kind, in the order of the alphabet.

    The file of a kind is imported when the kind is asked for, those of all kinds when somebody wants to know them.
    """

    def __init__(self) -> None:
        self._loaded: dict[str, Any] = {}

    def __getitem__(self, kind: str) -> Any:
        if kind not in self._loaded:
            _load(kind)
        return self._loaded[kind]

    def __iter__(self) -> Iterator[str]:
        _load_all()
        return iter(sorted(self._loaded))

    def __len__(self) -> int:
        _load_all()
        return len(self._loaded)

    def loaded(self) -> tuple[Any, ...]:
        """Declarations imported so far."""
        return tuple(self._loaded.values())

    def add(self, kind: str, cls: Any) -> None:
        """Register a declaration."""
        for function in _WANTED:
            function(cls)
        self._loaded[kind] = cls


REGISTRY: dict[Role, Kinds] = {role: Kinds() for role in Role}
_WANTED: list[Callable[[Any], None]] = []


def with_each(function: Callable[[Any], None]) -> None:
    """Call a function with each declaration as it is registered."""
    _WANTED.append(function)


def declared(name: str) -> Any:
    """A declaration by the name of its class, `DiskClutch` in disk_clutch.py; None where there is none."""
    found = _loaded(name)
    if found is None:
        _load(next((stem for stem in _files() if stem.replace("_", "") == name.lower()), ""))
        found = _loaded(name)
    if found is None:
        # a class may have another name than its file
        _load_all()
        found = _loaded(name)
    return found


def _loaded(name: str) -> Any:
    return next((cls for kinds in REGISTRY.values() for cls in kinds.loaded() if cls.__name__ == name), None)


@cache
def _files() -> dict[str, str]:
    """The module of each kind."""
    package, folder = __name__.partition(".")[0], dirname(dirname(__file__))
    files = [(room, *splitext(name)) for room in ROOMS for name in sorted(listdir(join(folder, room)))]
    return {stem: f"{package}.{room}.{stem}" for room, stem, end in files if end in (".py", ".pyc") and stem[0] != "_"}


def _load(kind: str) -> None:
    if kind in _files():
        import_module(_files()[kind])


@cache
def _load_all() -> None:
    for kind in _files():
        _load(kind)

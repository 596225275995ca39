"""Where knots and numbers of a page stand in its model file, so that a reader can copy the model as it became."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from clutchwork.base import ModelError
from clutchwork.signals.table import Table

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.page.knots import Dragged
    from clutchwork.page.slider import Slider

Path = tuple[str | int, ...]


def paths(system: System, dragged: list[Dragged], turned: list[Slider]) -> dict[str, list[list[str | int]]]:
    """Places in the plain data of the model by name; nothing where they are not found."""
    found = dict[str, list[list[str | int]]]()
    for one in dragged:
        beside = [(x, y + 1.0) for x, y in one.points]
        found[one.name] = _ends(system, {one.name: Table(beside)}, "points")
    for other in turned:
        for name, start in zip(other.names, other.starts, strict=True):
            values = (value for value in other.values.tolist() if value != start)
            found[name] = _moved(system, name, values)
    return found


def _moved(system: System, name: str, values: Iterable[float]) -> list[list[str | int]]:
    """Paths at which the first value that is not refused is put."""
    for value in values:
        places = [list(path) for path in _differ(system.model, _changed(system, {name: value}))]
        if places:
            return places
    return []


def _ends(system: System, changes: dict[str, Any], field: str) -> list[list[str | int]]:
    """Paths up to a field inside of which something changes."""
    cut = [path[: path.index(field) + 1] for path in _differ(system.model, _changed(system, changes)) if field in path]
    return [list(path) for path in dict.fromkeys(cut)]


def _changed(system: System, changes: dict[str, Any]) -> Any:
    try:
        return system.changed(changes).model
    except ModelError:
        return system.model


def _differ(one: Any, other: Any, path: Path = ()) -> Iterator[Path]:
    """Paths of the values in which two sets of plain data differ, those that only the second one has among them."""
    if isinstance(other, Mapping):
        known = one if isinstance(one, Mapping) else {}
        for key, value in other.items():
            yield from _differ(known.get(key), value, (*path, key))
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for number, (a, b) in enumerate(zip(one, other, strict=True)):
            yield from _differ(a, b, (*path, number))
    elif one != other:
        yield path

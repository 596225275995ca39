"""All that a page holds as plain data: bytes of the System, names, forms, knots, numbers to turn, pictures."""

from __future__ import annotations

import warnings
from base64 import b64encode
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from clutchwork.assembly.wiring import Wiring, wiring
from clutchwork.base import ModelError, dataclass
from clutchwork.declare.core import core
from clutchwork.declare.layout import CAUSES, MODES, STATUS
from clutchwork.page.knots import Dragged, chosen, refuse_controllers, roomy, with_tables
from clutchwork.page.left_out import absent
from clutchwork.page.levers import levers
from clutchwork.page.live import live
from clutchwork.page.live import plain as plain_live
from clutchwork.page.pairs import paired
from clutchwork.page.signals import FELT, listed, loops, output_of, panels, plain_panels
from clutchwork.page.slider import Bytes
from clutchwork.page.sliders import names_of, sliders
from clutchwork.page.static import PageError
from clutchwork.results.channels import Channels, channels
from clutchwork.results.forms import Slip
from clutchwork.signals.table import Table

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.options import Options
    from clutchwork.page.slider import Slider

# steps after which a run of a page stops: it must end before the next picture
MOST_STEPS = 30_000
FORMAT = 1
Path = tuple[str | int, ...]


@dataclass(frozen=True)
class PageRequest:
    """What a page shows, and what its reader may change; None: what is usual."""

    drag: Sequence[str] | None = None
    sliders: Sequence[str] | None = None
    show: Sequence[str] | None = None


def data_of(system: System, t_end: float, options: Options, wanted: PageRequest) -> dict[str, Any]:
    """The data of a page."""
    refuse_controllers(system)
    lacking = list(absent(system))
    if lacking:
        raise PageError("; ".join(lacking))
    knots = chosen(system, wanted.drag, t_end)
    if wanted.drag is None:
        # a constant pressure can be either
        for name in names_of(system, wanted.sliders or ()):
            knots.pop(name, None)
    made, dragged = with_tables(system, knots)
    spacious, room = roomy(made, dragged)
    names = [one.name for one in dragged]
    bytes_of = _bytes_of(dragged)
    turned, pairs = paired(made, sliders(made, wanted.sliders, names, bytes_of), bytes_of)
    wires, known = wiring(spacious), channels(spacious, options.angles, options.work)
    output = output_of(spacious, wires)
    shown = panels(known, wires, wanted.show, output, felt=any(one.unit in FELT for one in dragged))
    over = loops(known, wanted.show)
    picture = _live(spacious, known, wires)
    names += [name for panel in shown for name in panel.names]
    names += [name for pair in over for name in pair]
    names += [name for name in picture["signals"] if name in known] if picture else []
    return {
        "format": FORMAT,
        "name": system.name,
        "schema": str(core().schema_hash()),
        "system": b64encode(spacious.to_bytes()).decode(),
        "rowSize": wires.row_size,
        "tStart": options.t_start,
        "tEnd": t_end,
        "options": _options(options),
        "places": _places(spacious),
        "tables": [_table(one, spacious, room) for one in dragged],
        "sliders": [one.plain() for one in turned],
        "pairs": [one.plain() for one in pairs],
        "signals": listed(known, [name for name in names if name in known or name.endswith(".jerk")]),
        "panels": plain_panels(shown),
        "loops": [{"y": up, "x": across} for up, across in over],
        "contacts": list(_contacts(wires, known)),
        "components": [part.name for part in (*wires.elements, *wires.contacts)],
        "output": output,
        "schematic": picture,
        "levers": levers(wires),
        "modes": {str(number): word for number, word in MODES.items()},
        "causes": {str(number): list(words) for number, words in CAUSES.items()},
        "statuses": [_status(words, options) for words in STATUS],
        "model": _model(made),
        "paths": paths(made, dragged, turned),
    }


def _bytes_of(dragged: list[Dragged]) -> Bytes:
    """What the page has of a System."""
    return lambda one: roomy(one, dragged)[0].to_bytes()


def _status(words: tuple[str, str, str], options: Options) -> list[str]:
    """Name, message and remedy of an ending; a page has fewer steps than Python."""
    name, message, remedy = words
    if name == "too_many_steps" and options.max_steps > MOST_STEPS:
        return [name, f"a page ends after {MOST_STEPS} steps", "Python goes on"]
    return [name, message, remedy]


def _options(options: Options) -> dict[str, float]:
    """Options of the core as numbers; infinity is left to the core, for JSON has no word for it."""
    found = options.core_options() | {"max_steps": float(min(options.max_steps, MOST_STEPS))}
    return {name: float(value) for name, value in found.items() if abs(value) < float("inf")}


def _places(system: System) -> dict[str, int]:
    """Where arrays begin in the bytes."""
    return {name: system.starts[name] for name in ("input_value", "segment_time", "segment_coef")}


def _table(one: Dragged, system: System, room: dict[int, int]) -> dict[str, Any]:
    first = system.arrays["input_first"]
    inputs = [{"number": n, "first": int(first[n]), "room": room[n]} for n in one.inputs]
    points = [list(point) for point in one.points]
    return {
        "name": one.name,
        "unit": one.unit,
        "points": points,
        "lower": one.lower,
        "upper": one.upper,
        "inputs": inputs,
    }


def _contacts(wires: Wiring, known: Channels) -> Any:
    start = int(wires.columns["contact_mode"].start)
    for number, branch in enumerate(wires.contacts):
        if f"{branch.name}.slip" not in known:
            continue
        slip, heat = known[f"{branch.name}.slip"].evaluate, known.get(f"{branch.name}.heat")
        yield {
            "name": branch.name,
            "number": number,
            "mode": start + number,
            "torque": known[f"{branch.name}.torque"].evaluate.data(),
            "slip": slip.data() if isinstance(slip, Slip) else None,
            "heat": heat.evaluate.data() if heat else None,
        }


def _live(system: System, known: Channels, wires: Wiring) -> dict[str, Any] | None:
    """The schematic; None, with a warning, where its packages are missing."""
    if system.source is None:
        return None
    try:
        return plain_live(live(system.source, known, [branch.name for branch in wires.contacts]))
    except ImportError as error:
        warnings.warn(f"the page has no schematic: {error}", stacklevel=2)
        return None


def _model(made: System) -> dict[str, Any] | None:
    return dict(made.model) or None


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

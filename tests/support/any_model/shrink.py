"""The smallest model that still fails: elements, nodes and values are taken away while it does."""

from __future__ import annotations

import copy
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from clutchwork.declare.schema import specs
from support.any_model.elements import declared
from support.any_model.model import driveline, refused
from support.any_model.values import Plain

NODES = ("shaft", "mass", "thermal", "ambient")


def shrunk(made: Plain, fails: Callable[[Plain], bool], seconds: float = 60.0) -> Plain:
    """The model made smaller, step by step, for so long at most."""
    made, end = copy.deepcopy(made), time.monotonic() + seconds
    again = True
    while again and time.monotonic() < end:
        again = False
        for smaller in _smaller(made):
            if time.monotonic() > end:
                break
            if not refused(smaller) and _fails(fails, smaller):
                made, again = smaller, True
                break
    return made


def _fails(fails: Callable[[Plain], bool], made: Plain) -> bool:
    try:
        return fails(made)
    # what cannot be run at all fails in another way
    except Exception:
        return False


def _smaller(made: Plain) -> Iterator[Plain]:
    """Models with a little less."""
    for kind in ("element", *NODES):
        for place in reversed(range(len(made[kind]))):
            yield {**made, kind: made[kind][:place] + made[kind][place + 1 :]}
    for kind, simpler in (("element", _simpler), ("shaft", _body), ("mass", _body)):
        for place, one in enumerate(made[kind]):
            for other in simpler(one):
                yield {**made, kind: [*made[kind][:place], other, *made[kind][place + 1 :]]}
    for key in made["simulation"].keys() - {"t_end", "max_steps"}:
        yield {**made, "simulation": {k: v for k, v in made["simulation"].items() if k != key}}


def _body(one: Plain) -> Iterator[Plain]:
    """A shaft or mass without its start, or with a rounder inertia."""
    for key in one.keys() & {"speed", "angle"}:
        yield {name: value for name, value in one.items() if name != key}
    (size,) = one.keys() & {"inertia", "mass"}
    if one[size] not in (0.0, 1.0):
        yield from ({**one, size: value} for value in (1.0, 0.0))


def _simpler(one: Plain) -> Iterator[Plain]:
    """An element with a field less, a number for a signal, or a rounder number."""
    known = {item.name: (item, spec) for item, spec in specs(declared(one["type"]))}
    for name, value in one.items():
        if name in ("name", "type"):
            continue
        yield {key: given for key, given in one.items() if key != name}
        spec = known[name][1]
        if spec.what in ("signal", "alternative") and isinstance(value, dict | str):
            for number in (0.0, 1.0, *_levels(value)):
                yield {**one, name: number}
        if spec.what == "law" and value != {"type": "coulomb", "static": 0.1, "kinetic": 0.1}:
            yield {**one, name: {"type": "coulomb", "static": 0.1, "kinetic": 0.1}}
        if spec.what == "port" and value != "housing" and not spec.domain:
            yield {**one, name: "housing"}
        if isinstance(value, float) and value not in (0.0, 1.0):
            yield from ({**one, name: number} for number in (1.0, float(f"{value:.1g}")) if number != value)
        if isinstance(value, list) and len(value) > 1:
            yield from ({**one, name: value[:k] + value[k + 1 :]} for k in range(len(value)))
        if isinstance(value, dict) and "points" in value and len(value["points"]) > 1:
            points = value["points"]
            yield from ({**one, name: {**value, "points": points[:k] + points[k + 1 :]}} for k in range(len(points)))
        if isinstance(value, dict) and "type" in value:
            yield from ({**one, name: {k: v for k, v in value.items() if k != key}} for key in value if key != "type")


def _levels(value: object) -> Iterator[float]:
    if isinstance(value, dict):
        found = value.get("points", [[0, value.get(key)] for key in ("offset", "amplitude", "height", "value")])
        yield from (float(y) for _, y in found if isinstance(y, float))


def toml(made: Plain) -> str:
    """The model as the text of a model file."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "model.toml"
        driveline(made).save(path)
        return path.read_text(encoding="utf-8")

"""The signals that an element reports, and what each of them means: a section of its page."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from clutchwork.declare.purposes import ELEMENT_ROLES, groups
from clutchwork.declare.schema import REGISTRY, Spec, inputs, specs
from clutchwork.elements.plate_contact import PlateContact

if TYPE_CHECKING:
    from element_figures import Example

# what the signals of shafts and masses inside of an element mean
INSIDE = {
    "speed": "speed of a shaft or mass inside",
    "angle": "its angle",
    "position": "its position",
    "acceleration": "its acceleration",
}
# what the signals of a result mean that are not inputs or states
MEANINGS = {
    "torque": "torque on its follower, or on its shaft",
    "slip": "follower minus base, exactly zero while locked",
    "rate": "follower minus base",
    "power": "torque times slip or rate, the work done on the driveline",
    "work": "integral of the power",
    "heat": "heat that it has made, or taken",
    "heat_flow": "heat that flows from hot to cold, or to the inlet",
    "mode": "1 forward, 0 locked, -1 backward, 2 open",
    "state": "the mode in a word",
    "capacity": "largest torque that it can hold",
    "temperature": "temperature",
    "twist": "follower minus base, the free angle taken off",
}
# what a signal means that has another unit than others of its name, or no declaration of its own
BY_UNIT = {
    ("loss", "W"): "what it draws from its supply and does not give its shaft, which becomes heat",
    ("slip", "1"): "slip ratio that the force follows, positive where the tread is faster forward than the road",
    ("stroke", "m"): "stroke of the piston, from the force on the plates or the way that is left to them",
}


def section(cls: Any, example: Example) -> Iterator[str]:
    """The signals that the example of a page reports of the element."""
    names = [name for name, _ in example.signals]
    first = next((name for name in names if name == f"{example.name}.torque"), names[0] if names else "")
    yield f'## Results\n\n`run["{first}"]` and so on, of the example:\n' if first else "## Results\n"
    yield "{.fields}\n| signal | unit | |\n|---|---|---|"
    unused = {name for name, spec in _optional(cls) if name not in example.given}
    own, others = _own(cls, example), _meanings(PlateContact, *_elements()) | INSIDE | _supplies()
    usual = others | _meanings(cls) | MEANINGS
    for name, unit in example.signals:
        last = name.rpartition(".")[2]
        if last not in unused:
            meaning = (
                BY_UNIT.get((last, unit))
                or own.get(name)
                or usual.get(last)
                or usual.get(last.removesuffix("_signal"))
                or _at_port(last)
            )
            yield f"| `{name}` | {unit} | {meaning} |"
    yield ""


def _own(cls: Any, example: Example) -> dict[str, str]:
    """Meanings of signals that differ from the usual ones, by their whole names."""
    known = {kind: found for role in ELEMENT_ROLES for kind, found in REGISTRY[role].items()}
    found: dict[str, str] = {}
    for name, kind in example.parts:
        found |= {f"{name}.{last}": meaning for last, meaning in _along(known[kind]).items()}
        found |= {f"{name}.{last}": meaning for last, meaning in known[kind].reports.items()}
    return found | {f"{example.name}.{last}": meaning for last, meaning in cls.reports.items()}


def _along(cls: Any) -> dict[str, str]:
    """Meanings of rates and torques of an element that declares its ways."""
    acting = [way for way in cls.ways if not way.watched]
    if not cls.ways:
        return {}
    if len(acting) == 1:
        slip = f"{acting[0].doc}, exactly zero while locked"
        return {"rate": acting[0].doc, "slip": slip, "torque": "torque along its slip or rate"}
    found = {"power": "sum over all ways", "work": "integral of that"}
    for way in acting:
        found |= {f"{way.name}.rate": way.doc, f"{way.name}.torque": "torque along its rate"}
        found[f"{way.name}.power"] = "torque times rate, the work done on the driveline along this way"
    return found | {"torque": f"that of `{acting[0].name}`"}


def _supplies() -> dict[str, str]:
    """Meanings of what elements draw from a supply."""
    found = {}
    for kind in sorted({cls.supply for cls in _elements()} - {""}):
        found[f"{kind}_power"] = "what it draws from its supply, losses included; negative where it gives back"
        found[f"{kind}_energy"] = "integral of that"
    return found


def _meanings(*known: Any) -> dict[str, str]:
    """Meanings of the inputs and states of some elements, the first one that has a name gives its meaning."""
    found: dict[str, str] = {}
    for cls in known:
        for item, spec in specs(cls, "signal", "alternative"):
            found.setdefault(item.name, spec.doc)
        for state in cls.states:
            found.setdefault(state.name, state.doc)
    return found


def _elements() -> Iterator[Any]:
    for kinds in groups(*ELEMENT_ROLES).values():
        yield from kinds.values()


def _optional(cls: type) -> Iterator[tuple[str, Spec]]:
    """Inputs that count as a number where they are not given, those of plates inside included."""
    for known in (cls, PlateContact):
        for names, spec in inputs(known):
            if spec.otherwise is not None:
                yield from ((name, spec) for name in names)


def _at_port(name: str) -> str:
    found = re.fullmatch(r"torque_(\w+)", name)
    return f"torque on the {found[1]}" if found else ""

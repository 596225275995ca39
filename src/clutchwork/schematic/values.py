"""Numbers beside the symbols, chosen so that the picture stays readable: few of each element, units at all."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import MISSING
from math import floor, isfinite, log10
from numbers import Real
from typing import Any

from clutchwork.declare.node import Component, Signal
from clutchwork.declare.schema import Role, Spec, inputs, specs
from clutchwork.schematic.diagram import Thing, referred
from clutchwork.signals.bases.extremes import extremes

MOST = 2  # lines of an element
# what tells most about an element, before what else it has
FIRST = (
    "ratio", "teeth_sun", "teeth_ring", "teeth_input", "teeth_output", "stiffness", "damping", "gain", "radius",
    "holding", "torque", "nominal_torque", "peak", "conductance", "force", "thickness", "onset",
)  # fmt: skip
# shown without the name, because the unit says what it is
PLAIN = ("stiffness", "damping", "torque", "nominal_torque", "conductance", "holding", "peak", "force")
PREFIXES = ("N", "Pa", "J", "W")


def number(value: float, unit: str) -> str:
    """A number with its unit, with k, M or G where it is large."""
    first = unit.split("/")[0].split(" ")[0]
    prefix = ""
    if isfinite(value) and first in PREFIXES and abs(value) >= 1e4:
        step = min(3, floor(log10(abs(value)) / 3))
        value, prefix = value / 1000.0**step, ("", "k", "M", "G")[step]
    text = f"{value:z.4g}".replace("e+0", "e").replace("e-0", "e-").replace("-", "−")
    return f"{text} {prefix}{pretty(unit)}".rstrip() if unit not in ("1", "") else text


def pretty(unit: str) -> str:
    """A unit with raised powers and thin products."""
    return unit.replace("m2", "m²").replace("m3", "m³").replace("s2", "s²").replace(" ", "\u2009")


def node_values(thing: Thing) -> list[str]:
    """What is written at a node."""
    node = thing.source
    if thing.what == "missing":
        return ["missing"]
    if thing.what == "ambient":
        return [_given(node.temperature, "K")]
    if thing.what == "oil":
        return element_values(thing)
    if thing.what == "thermal":
        return [_given(getattr(node, "capacity", None), "J/K")] if hasattr(node, "capacity") else element_values(thing)
    inertia = node.inertia
    if not isinstance(inertia, Real):
        return ["?"]
    return [number(float(inertia), "kg m2" if thing.what == "shaft" else "kg")] if inertia else []


def element_values(thing: Thing) -> list[str]:
    """What is written at an element."""
    element, cls = thing.source, type(thing.source)
    translates = any(node.what == "mass" for node in thing.pins.values()) and element.role is not Role.GEAR
    known = {item.name: spec for item, spec in specs(cls)}
    given = {item.name: _or_none(item, element) for item, _ in specs(cls, "param", "curve")}
    lines, ports = list[str](), tuple(item.name for item, _ in specs(cls, "port"))
    if given.get("teeth_sun") and given.get("teeth_ring"):
        lines.append(f"{_count(given.pop('teeth_ring'))}:{_count(given.pop('teeth_sun'))} teeth")
    elif given.get("teeth_input") and given.get("teeth_output"):
        lines.append(f"{_count(given.pop('teeth_output'))}:{_count(given.pop('teeth_input'))} teeth")
    for name in FIRST:
        value = given.get(name)
        if isinstance(value, Real) and not isinstance(value, bool) and name not in ("teeth_sun", "teeth_ring"):
            lines.append(_line(name, float(value), _unit(element, known[name], translates), element.role, ports))
    drive = _driven(thing, translates)
    return [*lines[: MOST - bool(drive)], *drive]


def _or_none(item: Any, element: Any) -> Any:
    """A value, unless it is the default."""
    value = getattr(element, item.name, None)
    return None if item.default is not MISSING and value == item.default else value


def _line(name: str, value: float, unit: str, role: Role, ports: tuple[str, ...]) -> str:
    if name == "ratio" and role is Role.GEAR:
        return f"{'R/S' if 'sun' in ports else 'i'} = {number(value, '1')}"
    if name in PLAIN:
        return number(value, unit)
    return f"{name.replace('_', ' ')} {number(value, unit)}"


def _unit(element: Any, spec: Spec, translates: bool) -> str:
    """Unit of a parameter; that of a gain follows from what presses."""
    if "m3" in (spec.unit, *spec.units) and hasattr(element, "pressure"):
        if getattr(element, "pressure", None) is not None:
            return "m2" if translates else "m3"
        share = _is_share(getattr(element, "normal_force", None))
        return ("N" if share else "1") if translates else ("N m" if share else "m")
    alike = {"N m": "N", "N m/rad": "N/m", "N m s/rad": "N s/m", "rad/s": "m/s"}
    return alike.get(spec.unit, spec.unit) if translates else spec.unit


def _is_share(force: Any) -> bool:
    """Whether what presses is a share of the force, 0 to 1, and not a force in N."""
    if isinstance(force, Signal):
        with suppress(Exception):
            reached = [at.value for at in extremes(force)]
            return bool(reached) and max(reached) <= 1.0
    if isinstance(force, Component):
        return bool(type(force).states) and type(force).states[0].unit == "1"
    return isinstance(force, Real) and float(force) <= 1.0


def _driven(thing: Thing, translates: bool) -> list[str]:
    """The input of an element: a number, or what gives it."""
    helpers = [helper.source for helper in thing.helpers]
    declared = {item.name: (item, one) for item, one in specs(type(thing.source))}
    for names, spec in inputs(type(thing.source)):
        for name in names:
            item, shown = declared[name]
            value = _or_none(item, thing.source)
            held = value[0] if isinstance(value, tuple) and value else value
            drawn = name in thing.pins or name in thing.fixed or any(held is helper for helper in helpers)
            if value is None or drawn:
                continue
            unit = _unit(thing.source, shown, translates)
            text = _given(value, unit, "force" if translates and name == "torque" else name)
            if (unit == "1" or shown.draws) and isinstance(value, Real):
                text = f"{name.replace('_', ' ')} {text}"
            if text and (spec.otherwise is None or value != spec.otherwise):
                return [text]
    return []


def _given(value: Any, unit: str, name: str = "") -> str:
    if isinstance(value, Real) and not isinstance(value, bool):
        return number(float(value), unit)
    value = getattr(value, "value", value) if getattr(value, "kind", "") == "constant" else value
    if isinstance(value, Real):
        return number(float(value), unit)
    if isinstance(value, Signal):
        return f"{name.replace('_', ' ')}(t)" if name else "T(t)"
    return referred(value)


def _count(value: Any) -> str:
    return f"{value:g}" if isinstance(value, Real) else "?"

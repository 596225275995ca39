"""One-line `repr` of the parts of a model: nodes by name, values with units, no defaults."""

from __future__ import annotations

from dataclasses import MISSING, fields
from numbers import Real
from typing import Any

from clutchwork.base import quote
from clutchwork.declare.schema import specs
from clutchwork.declare.to_si import settled


def called(thing: Any) -> str:
    """A law or a signal as it is called, without its defaults: `Coulomb(static=0.3, kinetic=0.25)`."""
    given = [(item.name, getattr(thing, item.name, None)) for item in fields(thing) if item.repr]
    same = {item.name: item.default for item in fields(thing)}
    words = [f"{name}={_code(value)}" for name, value in given if not _is_default(value, same[name])]
    return f"{type(thing).__qualname__}({', '.join(words)})"


def element(thing: Any) -> str:
    """An element: `<Clutch 'c1': base 'engine', follower 'gearbox', gain 0.0002 m3, pressure 1e+05 Pa>`."""
    cls, parts = type(thing), []
    for item, spec in specs(cls):
        value = getattr(thing, item.name, None)
        if not _is_default(value, item.default):
            unit = settled(item.name, spec, cls, vars(thing)).unit
            listed = f" {unit}" if isinstance(value, list | tuple) and spec.what in ("curve", "numbers") else ""
            parts.append(f"{item.name} {_value(value, unit)}{listed if unit != '1' else ''}")
    return _line(cls.__qualname__, thing, parts)


def node(thing: Any) -> str:
    """A shaft, a mass or the housing: `<Node 'engine': inertia 0.2 kg m2, speed 100 rad/s>`."""
    if thing.fixed:
        return _line("Node", thing, ["does not move"])
    names, units = PLACES.get(getattr(thing.domain, "value", ""), PLACES["rotation"])
    inertia, speed, angle = (_value(value, unit) for value, unit in zip(_of_node(thing), units, strict=True))
    parts = [f"{names[0]} {inertia}"]
    parts += [f"{names[1]} {speed}"] if thing.speed is not None else []
    return _line(
        "Node", thing, parts + ([] if thing.angle is None or _is_default(thing.angle, 0.0) else [f"{names[2]} {angle}"])
    )


def thermal_node(thing: Any) -> str:
    """A thermal mass or an ambient: `<ThermalNode 'plates': capacity 500 J/K, temperature 300 K>`."""
    parts = ["ambient" if thing.capacity is None else f"capacity {_value(thing.capacity, 'J/K')}"]
    parts.append(f"temperature {_value(thing.temperature, 'K')}")
    parts += [] if thing.limit is None else [f"limit {_value(thing.limit, 'K')}"]
    return _line("ThermalNode", thing, parts)


PLACES = {
    "rotation": (("inertia", "speed", "angle"), ("kg m2", "rad/s", "rad")),
    "translation": (("mass", "speed", "position"), ("kg", "m/s", "m")),
}


def _of_node(thing: Any) -> tuple[Any, Any, Any]:
    return thing.inertia, thing.speed, thing.angle


def _line(cls: str, thing: Any, parts: list[str]) -> str:
    more = f": {', '.join(parts)}" if parts else ""
    return f"<{cls} {quote(getattr(thing, 'name', None))}{more}>"


def _is_default(value: Any, default: Any) -> bool:
    """Whether a value need not be shown because it is the default."""
    if default is MISSING:
        return False
    return value is default or (type(value) is type(default) and isinstance(value, Real | str) and value == default)


def _code(value: Any) -> str:
    """A value as Python writes it; what has a name by that."""
    if callable(value) and hasattr(value, "__qualname__"):
        return str(value.__qualname__)
    name = getattr(value, "name", None)
    return quote(name if isinstance(name, str) else value)


def _value(value: Any, unit: str) -> str:
    """A value with its unit, what is joined or gives an input by name."""
    if isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], str):
        return f"{_code(value[0])}.{value[1]}"
    text = _code(value)
    if isinstance(value, bool) or not isinstance(value, Real):
        return text
    number = f"{float(value):.6g}" if isinstance(value, float) else text
    return number if unit in ("", "1") else f"{number} {unit}"

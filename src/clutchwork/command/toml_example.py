"""An element, law or signal as lines of a model file."""

from __future__ import annotations

from typing import Any

from clutchwork.declare.examples import example
from clutchwork.declare.schema import Role, Spec, specs
from clutchwork.files.writer import toml_value


def toml_example(cls: Any) -> str:
    """Lines to copy into a model file, with the unit of each number; empty where only Python can hold it."""
    values = example(cls)
    if not values and specs(cls, "function"):
        return ""
    if cls.role is Role.SIGNAL:
        return f"pressure = {toml_value({'type': cls.kind, **values})}"
    if cls.role is Role.LAW:
        return f"friction = {toml_value({'type': cls.kind, **values})}"
    known = {item.name: spec for item, spec in specs(cls)}
    rows = [(f"{name} = {toml_value(value)}", _unit(known[name])) for name, value in values.items()]
    lines = [f"{line:<24}{unit}".rstrip() for line, unit in rows]
    return "\n".join(["[[element]]", 'name = "x1"', f'type = "{cls.kind}"', *lines])


def _unit(spec: Spec) -> str:
    """The unit as a comment."""
    if spec.what in ("port", "thermal", "law", "text") or spec.flag or spec.choices or spec.unit in ("", "1"):
        return ""
    return f"  # {spec.unit_x}, {spec.unit}" if spec.what == "curve" else f"  # {spec.unit}"

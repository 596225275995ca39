"""What value a field of a declaration expects, in words."""

from __future__ import annotations

from clutchwork.declare.quantity import within
from clutchwork.declare.schema import Role, Spec
from clutchwork.declare.wording import kinds_of


def wanted(spec: Spec, unit: str) -> str:
    """What value a field expects, in words."""
    if spec.choices:
        return f"one of {', '.join(spec.choices)}"
    return {
        "port": "a shaft",
        "thermal": "a thermal node",
        "law": f"a friction law ({kinds_of(Role.LAW)})",
        "curve": f"points in [{spec.unit_x}] and [{unit}]",
        "numbers": f"a list of numbers{within(unit)}",
        "text": "a string",
        "formula": "an expression",
        "named": f"a table of numbers{within(unit)} by name",
        "elements": "a table of elements by name, each a table of its fields",
        "data": "an object, a name, the path of a file, or a table",
    }.get(spec.what, f"a value{within(unit)}" if within(unit) else "a number")

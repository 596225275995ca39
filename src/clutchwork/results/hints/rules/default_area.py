"""A disc clutch whose area nobody gave."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from clutchwork.declare.schema import specs
from clutchwork.results.hints.hint import Hint, shown
from clutchwork.results.hints.registry import model_rule

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

NAME = "default area"


@model_rule(NAME)
def default_area(system: System) -> Iterator[Hint]:
    """A DiskClutch whose pressure, or wear, acts on an area that is the default."""
    elements: Any = system.source.elements if system.source else ()
    for clutch in elements:
        defaults = {item.name: item.default for item, spec in specs(type(clutch), "param") if spec.unit == "m2"}
        if "area" not in defaults or clutch.area != defaults["area"]:
            continue
        if clutch.pressure is None and clutch.wear_rate is None:
            continue
        load = f"1 MPa on it is {shown(1e6 * clutch.area, 'N')}" if clutch.pressure is not None else ""
        worn = "its wear is spread over it" if clutch.wear_rate is not None else ""
        message = (
            f"has the area {shown(clutch.area, 'm2')}, which is the default: {' and '.join(filter(None, (load, worn)))}"
        )
        remedy = "give the area that the pressure acts on, or normal_force"
        yield Hint(NAME, (clutch.name,), message, remedy, {"area [m2]": clutch.area})

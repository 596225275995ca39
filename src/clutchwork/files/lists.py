"""Curves and lists of numbers of a model file: lists, whose numbers may be strings with units, or tables with units."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from clutchwork.base import quote
from clutchwork.declare.quantity import PLAIN, QuantityError, in_si, scale_to_si
from clutchwork.declare.schema import Spec
from clutchwork.declare.to_si import TargetUnit, numbers_in_si, points_in_si
from clutchwork.model.numbers import At


def curve_in_si(value: Any, spec: Spec, at: At) -> Any:
    """Points in SI from a list of pairs, whose ordinates are in the unit of the place, or {points, unit_x, unit}."""
    others = (*spec.units, *at.units)
    if spec.constant and (isinstance(value, str | float | int) or (isinstance(value, Mapping) and "value" in value)):
        return in_si(value, at.unit, others, at.scale.factor, zero=at.scale.zero)
    x, y = PLAIN, at.scale
    if isinstance(value, Mapping):
        unknown = [key for key in value if key not in ("points", "unit_x", "unit")]
        if unknown or not isinstance(value.get("points"), list | tuple):
            remedy = "write {points = [[x, y], ...], unit_x, unit}"
            raise QuantityError("must be a list of points", quote(dict(value)), remedy)
        x = scale_to_si(value["unit_x"], spec.unit_x, spec.units_x) if "unit_x" in value else x
        y = scale_to_si(value["unit"], at.unit, others) if "unit" in value else y
        value = value["points"]
    return points_in_si(value, TargetUnit(spec.unit_x, spec.units_x, scale=x), TargetUnit(at.unit, others, scale=y))


def list_in_si(value: Any, spec: Spec, at: At) -> Any:
    """Numbers, or rows of them, in SI from a list, or from a table {values, unit}."""
    scale = PLAIN
    if isinstance(value, Mapping):
        unknown = [key for key in value if key not in ("values", "unit")]
        if unknown or "values" not in value:
            raise QuantityError("must be a list of numbers", quote(dict(value)), "write {values = [x, y, ...], unit}")
        scale = scale_to_si(value["unit"], at.unit, spec.units) if "unit" in value else scale
        value = value["values"]
    return numbers_in_si(value, TargetUnit(at.unit, spec.units, scale=scale))

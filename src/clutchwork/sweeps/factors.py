"""Factors on the numbers of a model, as values of a sweep or a design: `cw.times(0.9, 1.1)`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from math import isfinite
from numbers import Real
from typing import TYPE_CHECKING, Any

from clutchwork.base.errors import ModelError, UseError, near
from clutchwork.base.quote import quote
from clutchwork.declare.calls import explained
from clutchwork.model.changes import all_names, field_of, named, target, targets_of

if TYPE_CHECKING:
    from clutchwork.model.model import Model


@dataclass(frozen=True)
class Factors:
    """What numbers of the model are multiplied by: a list of factors, or for a design a distribution of them."""

    how: Any


@explained("cw.times")
def times(*factors: Any) -> Factors:
    """Factors on the number that stands in the model, for `sweep` and `design`.

    Parameters: factors, one or several, a list of them, or for `design` a distribution, such as `cw.normal(1.0, 0.02)`.
    A name may be a pattern then: `{"F*.gain": cw.times(0.9, 1.1)}` multiplies the gains of all elements whose names
    begin with F, all by the same factor.
    """
    how: Any = factors[0] if len(factors) == 1 and not isinstance(factors[0], Real) else list(factors)
    if hasattr(how, "tolist"):
        how = how.tolist()
    if isinstance(how, list | tuple):
        how = list(how)
        wrong = [one for one in how if not isinstance(one, Real) or isinstance(one, bool) or not isfinite(float(one))]
        if wrong or not how:
            what = f"{quote(wrong[0])} is not a factor" if wrong else "there are no factors"
            raise UseError("times", [f"{what}; give numbers without a unit, such as cw.times(0.9, 1.1)"])
        how = [float(one) for one in how]
    elif isinstance(how, str) or getattr(how, "unit", None):
        raise UseError("times", [f"{quote(how)} is not a factor; give numbers without a unit"])
    return Factors(how)


def multiplied(model: Model, name: str) -> dict[str, float]:
    """The numbers of a model that factors act on, by name; UseError where there is none, or something else."""
    owners = named(model)
    is_pattern = "*" in name or "?" in name
    known = [one for one in all_names(model) if fnmatchcase(one, name)] if is_pattern else [name]
    unknown = [] if is_pattern else targets_of(model, [name])[1]
    if unknown:
        raise ModelError(unknown, model.name)
    found = {one: _number_of(owners, one) for one in known}
    problems = list(_faults(model, name, found))
    if problems:
        raise UseError("times", problems)
    return {one: float(value) for one, value in found.items() if value is not None}


def _number_of(owners: Mapping[str, Any], name: str) -> Any:
    """What a name holds; None if that is not given."""
    aim = target(owners, name)
    return None if aim is None else field_of(aim)[0]


def _faults(model: Model, name: str, found: Mapping[str, Any]) -> Iterator[str]:
    numbers = {one: value for one, value in found.items() if value is not None}
    for one, value in numbers.items():
        if not isinstance(value, Real) or isinstance(value, bool):
            inside = [path for path in all_names(model) if path.startswith(f"{one}.")]
            remedy = f"; take {inside[0]!r} or another number inside of it" if inside else ""
            yield f"{one} is {quote(value)}, not a number that a factor could multiply{remedy}"
            return
    if name in found and not numbers:
        yield f"{name} has no value in this driveline that a factor could multiply; give values: [...]"
    elif not numbers:
        yield f"{name!r} matches no number of this driveline{near(name, all_names(model))}"
    elif not any(numbers.values()):
        yield f"{name!r} is 0 in this driveline, which no factor changes; give values: [...]"

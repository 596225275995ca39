"""Factors on the numbers of a model, as values of a sweep or a design: `cw.times(0.9, 1.1)`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from math import isfinite
from numbers import Real
from typing import Any

from clutchwork.base import ModelError, UseError, near, quote
from clutchwork.declare.calls import explained
from clutchwork.model.changes import all_names, field_of, named, target, targets_of
from clutchwork.model.model import Model

# what to do about a number that has no factor
VALUES = "give values: [...]"


@dataclass(frozen=True)
class Factors:
    """What numbers of the model are multiplied by: a list of factors, or for a design a distribution of them."""

    how: Any


@explained("cw.times")
def times(*factors: Any) -> Factors:
    """Factors on the number that stands in the model, for `sweep` and `design`.

    Parameters: factors, one or several, a list of them, factors by label, or for `design` a distribution, such as
    `cw.normal(1.0, 0.02)`, or (low, high). A name may be a pattern then: `{"F*.gain": cw.times(0.9, 1.1)}` multiplies
    the gains of all elements whose names begin with F, all by the same factor. Temperatures are multiplied in kelvin.
    """
    given: Any = factors[0] if len(factors) == 1 else list(factors)
    given = given.tolist() if hasattr(given, "tolist") else given
    if isinstance(given, Mapping):
        return Factors(dict(zip(given, _plain(given.values()), strict=True)))
    if isinstance(given, Real):
        return Factors(_plain([given]))
    if isinstance(given, Iterable) and not isinstance(given, str):
        # a tuple stays one: for a design two of them are bounds
        return Factors(tuple(_plain(given)) if isinstance(given, tuple) else _plain(given))
    if hasattr(given, "codes"):
        _plain(given.values)
    elif getattr(given, "unit", None) or not any(callable(getattr(given, name, None)) for name in ("quantile", "ppf")):
        _plain([given])
    return Factors(given)


def _plain(given: Iterable[Any]) -> list[float]:
    """Factors as numbers; UseError for what is none."""
    numbers = [one.item() if getattr(one, "shape", None) == () else one for one in given]
    wrong = [one for one in numbers if not _is_number(one) or not isfinite(float(one))]
    if wrong or not numbers:
        what = f"{quote(wrong[0])} is not a factor" if wrong else "there are no factors"
        raise UseError("times", [f"{what}; give numbers without a unit, such as cw.times(0.9, 1.1)"])
    return [float(one) for one in numbers]


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def refuse_factors(call: str, given: Iterable[tuple[Any, Any]]) -> None:
    """Refuse factors among values of single variants by name."""
    names = dict.fromkeys(name for name, value in given if isinstance(value, Factors))
    if names:
        remedy = "give a column of them: cw.sweep(..., vary=cw.variants({{{name!r}: cw.times(0.9, 1.1)}}))"
        told = "{name!r} has factors, which multiply nothing here; "
        raise UseError(call, [(told + remedy).format(name=name) for name in names])


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
        if not _is_number(value):
            owners = named(model)
            names = (path for path in all_names(model) if path.startswith(f"{one}."))
            inside = [path for path in names if _is_number(held := _number_of(owners, path)) and held]
            other = VALUES if one == name else f"take a pattern that leaves it out, not {name!r}"
            remedy = f"take {inside[0]!r} or another number inside of it, or {other}" if inside else other
            yield f"{one} is {quote(value)}, not a number that a factor could multiply; {remedy}"
            return
    if name in found and not numbers:
        yield f"{name} has no value in this driveline that a factor could multiply; {VALUES}"
    elif not numbers:
        yield f"{name!r} matches no number of this driveline{near(name, all_names(model))}"
    elif not any(numbers.values()):
        yield f"{name!r} is 0 in this driveline, which no factor changes; {VALUES}"

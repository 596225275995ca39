"""Which values the variants of a sweep have: a grid, a list, or a table."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import prod
from typing import Any, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import UseError, quote
from clutchwork.declare.calls import explained
from clutchwork.model import changes
from clutchwork.model.changes import Target, named, target
from clutchwork.model.model import Model
from clutchwork.sweeps.factors import Factors, multiplied, refuse_factors

Codes = NDArray[np.int64]
PLAIN = (bool, int, float, str)


@dataclass(frozen=True, eq=False)
class Varied:
    """One name with its values: each once, what to call each, and which of them each variant has."""

    name: str
    values: tuple[Any, ...]
    labels: tuple[Any, ...]
    codes: Codes
    unit: str = ""  # of SI, where the values are numbers
    # where values are factors: the numbers of the model that they multiply, by name
    numbers: Mapping[str, float] | None = None

    @property
    def column(self) -> NDArray[Any]:
        """What each variant has, as a table shows it: numbers, or labels."""
        kinds = {type(label) for label in self.labels}
        plain = kinds <= {float, int} or kinds in ({bool}, {str})
        labels = np.array(self.labels) if plain else np.array([str(label) for label in self.labels])
        return labels[self.codes] if len(labels) else labels

    @property
    def plain(self) -> tuple[Varied, ...]:
        """The same as values of the numbers that factors multiply."""
        if self.numbers is None:
            return (self,)
        made = {name: tuple(number * factor for factor in self.values) for name, number in self.numbers.items()}
        return tuple(Varied(name, values, values, self.codes) for name, values in made.items())

    def part(self, first: int, last: int) -> Varied:
        """What variants from first to last have, without the values of others."""
        used, codes = np.unique(self.codes[first:last], return_inverse=True)
        values, labels = ([given[code] for code in used.tolist()] for given in (self.values, self.labels))
        return replace(self, values=tuple(values), labels=tuple(labels), codes=codes.astype(np.int64))


@dataclass(frozen=True, eq=False)
class Variants:
    """The variants of a sweep, in order; `shape` holds the length of each axis of a grid, nothing for a table."""

    varied: tuple[Varied, ...]
    count: int
    shape: tuple[int, ...] | None = None
    design: Any = None  # what they were drawn from

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, number: int) -> dict[str, Any]:
        """The values of one variant by name."""
        place = range(self.count)[number]
        return {one.name: one.values[one.codes[place]] for one in self.plain.varied}

    @property
    def plain(self) -> Variants:
        """The same as a table of values, factors multiplied out."""
        if all(one.numbers is None for one in self.varied):
            return self
        made = [own for one in self.varied for own in one.plain]
        names = [one.name for one in made]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            by = {name: [one.name for one in self.varied for own in one.plain if own.name == name] for name in twice}
            told = [f"{name} is varied by {' and '.join(map(quote, by[name]))}; keep one of them" for name in twice]
            raise UseError("sweep", told)
        return Variants(tuple(made), self.count)

    def part(self, first: int, last: int) -> Variants:
        """Variants from first to last; the whole with its shape where these are all."""
        if (first, last) == (0, self.count):
            return self
        return Variants(tuple(one.part(first, last) for one in self.varied), last - first)

    def in_si(self, model: Model) -> Variants:
        """The same with values of SI where they have units that fit; others stay, to be refused with all mistakes."""
        owners = named(model)
        varied = (_in_si(one, target(owners, one.name)) for one in self.varied)
        made = tuple(one if one.numbers is None else with_numbers(one, model) for one in varied)
        return replace(self, varied=made)


class VariantSource(Protocol):
    """Where variants come from, as many at a time as are asked for."""

    def __len__(self) -> int: ...

    def part(self, first: int, last: int) -> Variants:
        """Variants from first to last."""

    def in_si(self, model: Model) -> VariantSource:
        """The same with values of SI where they have units that fit."""


def grid(vary: Mapping[str, Any]) -> Variants:
    """All combinations of the values of each name; the last one changes fastest."""
    factors = {name for name, values in vary.items() if isinstance(values, Factors)}
    named = {name: _listed(name, values.how if name in factors else values) for name, values in vary.items()}
    _refuse_empty([name for name, (values, _) in named.items() if not values])
    shape = tuple(len(values) for values, _ in named.values())
    count = prod(shape)
    places = np.unravel_index(np.arange(count), shape) if shape and count else [np.zeros(0, np.int64)] * len(shape)
    varied = [
        Varied(name, values, labels, np.asarray(codes, dtype=np.int64), numbers={} if name in factors else None)
        for (name, (values, labels)), codes in zip(named.items(), places, strict=True)
    ]
    return Variants(tuple(varied), count, shape)


@explained("cw.variants")
def variants(columns: Mapping[str, Any]) -> Variants:
    """A table of variants for `sweep`: a column of values for each name, all of one length.

    Parameters: columns, values by name: {"c1.gain": [...], "engine.inertia": [...]}.
    """
    if not isinstance(columns, Mapping) or not columns:
        raise UseError("variants", [f"{quote(columns)} is not a table; give columns by name"])
    factors = {name for name, values in columns.items() if isinstance(values, Factors)}
    given = {name: values.how if name in factors else values for name, values in columns.items()}
    listed = {name: _listed(name, values, labelled=name in factors)[0] for name, values in given.items()}
    _refuse_empty([name for name, values in listed.items() if not values])
    lengths = {name: len(values) for name, values in listed.items()}
    if len(set(lengths.values())) > 1:
        told = ", ".join(f"{name!r} has {length}" for name, length in lengths.items())
        raise UseError("variants", [f"columns differ in length: {told}; give each variant a value of every name"])
    made = (_column(name, values) for name, values in listed.items())
    varied = tuple(replace(one, numbers={}) if one.name in factors else one for one in made)
    return Variants(varied, next(iter(lengths.values())))


def given(vary: Any) -> VariantSource:
    """The variants that a call means: a design, a grid, a table, or a list with the values of each."""
    if isinstance(vary, Variants) or hasattr(vary, "part"):
        return cast("VariantSource", vary)
    if hasattr(vary, "columns") and hasattr(vary, "iloc"):
        # a DataFrame of pandas, or what looks like one
        return variants({str(name): vary[name].tolist() for name in vary.columns})
    if isinstance(vary, Mapping):
        return grid(vary)
    if isinstance(vary, Sequence) and not isinstance(vary, str) and all(isinstance(one, Mapping) for one in vary):
        return _of_list(vary)
    remedy = "give values by name, a list of variants, cw.variants({...}), cw.design({...}, 1000) or a DataFrame"
    raise UseError("sweep", [f"vary is {quote(vary)}: {remedy}"])


def with_numbers(one: Varied, model: Model) -> Varied:
    """Factors with the numbers of a model that they multiply."""
    return replace(one, unit="1", numbers=multiplied(model, one.name))


def _in_si(one: Varied, aim: Target | None) -> Varied:
    if aim is None or one.numbers is not None:
        return one
    unit = changes.unit_of(aim)
    if {float, int}.issuperset(map(type, one.values)):
        return replace(one, unit=unit)
    values = tuple(changes.in_si(aim, value) for value in one.values)
    labels = one.labels
    if labels == _labels(one.values):
        plain = all(isinstance(value, PLAIN) for value in values)
        given = [old if isinstance(old, str) else new for old, new in zip(one.values, values, strict=True)]
        labels = _labels(values) if plain else _labels(given, unit)
    return replace(one, values=values, labels=labels, unit=unit)


def _refuse_empty(names: Sequence[str]) -> None:
    """A name without values would leave no variant."""
    if names:
        raise UseError("sweep", [f"{name}: the list of values is empty; give at least one value" for name in names])


def _of_list(rows: Sequence[Mapping[str, Any]]) -> Variants:
    if not rows:
        raise UseError("sweep", ["vary is an empty list; give at least one variant, such as [{'c1.gain': 5e-4}]"])
    names = list(dict.fromkeys(name for row in rows for name in row))
    refuse_factors("sweep", (item for row in rows for item in row.items()))
    missing = [
        f"variant {number} has no {name!r}; give every variant a value of each name"
        for number, row in enumerate(rows)
        for name in names
        if name not in row
    ]
    if missing:
        raise UseError("sweep", missing[:20])
    return Variants(tuple(_column(name, [row[name] for row in rows]) for name in names), len(rows))


def _listed(name: object, values: Any, *, labelled: bool = True) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """Values and what to call each: themselves, the keys of a mapping, or their places."""
    if not isinstance(name, str):
        raise UseError("sweep", [f"{quote(name)} is not a name; names are such as 'c1.gain'"])
    if labelled and isinstance(values, Mapping):
        return tuple(values.values()), tuple(map(str, values))
    if isinstance(values, str) or not hasattr(values, "__len__") or not hasattr(values, "__iter__"):
        raise UseError("sweep", [f"{name}: {quote(values)} is not a list of values; write [...] around it"])
    plain = tuple(values.tolist() if hasattr(values, "tolist") else values)
    return plain, _labels(plain)


def _labels(values: Sequence[Any], unit: str = "") -> tuple[Any, ...]:
    """What to call values: themselves where all are plain, else each by itself, objects by their class and place."""
    if all(isinstance(value, PLAIN) for value in values):
        return tuple(values)
    return tuple(_label(value, place, unit) for place, value in enumerate(values))


def _label(value: Any, place: int, unit: str) -> str:
    if isinstance(value, float | int) and not isinstance(value, bool):
        return f"{value:.12g} {unit}".rstrip()
    return str(value) if isinstance(value, PLAIN) else f"{type(value).__name__} {place}"


def _column(name: str, values: Sequence[Any]) -> Varied:
    """Values of all variants, equal ones once."""
    places, codes = dict[Hashable, int](), list[int]()
    distinct = list[Any]()
    for value in values:
        # 0.0 and -0.0, 1 and True, are equal and not the same
        key = (type(value), repr(value)) if isinstance(value, bool | int | float | str) else (type(value), id(value))
        if key not in places:
            places[key] = len(distinct)
            distinct.append(value)
        codes.append(places[key])
    return Varied(name, tuple(distinct), _labels(distinct), np.array(codes, dtype=np.int64))

"""Values from the command line, `c1.pressure=2 bar`, read as a model file reads them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

from clutchwork.base import ModelError, Problem, quote
from clutchwork.base.toml_text import parsed
from clutchwork.declare.node import Node, ThermalNode
from clutchwork.declare.schema import Spec, specs
from clutchwork.declare.to_si import settled
from clutchwork.files.references import References
from clutchwork.files.values import ValueReader
from clutchwork.model.changes import PLACES, Target, changed_model, targets_of
from clutchwork.model.fields import BROKEN
from clutchwork.model.model import Model
from clutchwork.model.numbers import At
from clutchwork.model.problems import NODE_FIELDS
from clutchwork.model.thermal import NODE_FIELDS as THERMAL_FIELDS
from clutchwork.model.thermal import node_kind

FORM = "write NAME=VALUE, such as c1.gain=6e-4 or 'c1.pressure=2 bar'"


def given_values(model: Model, texts: Sequence[str], folder: str = "") -> dict[str, Any]:
    """Values in SI by name, for `System.changed`, from texts such as "c1.pressure=2 bar".

    Parameters: texts, a name of `System.changed`, an equals sign, and a value as in a model file, where a word needs
    no quotes; folder, the one that paths of CSV files begin in. ModelError with all mistakes: names that lead nowhere,
    values that are none, units that do not fit, and what is out of bounds.
    """
    found, problems = _pairs(texts)
    targets, unknown = targets_of(model, found)
    reader = _Given(folder, References(lambda _entry, _place: None))
    values = {name: reader.read(name, aim, _plain(found[name])) for name, aim in targets.items()}
    values = {name: value for name, value in values.items() if value is not BROKEN}
    problems += [*unknown, *reader.problems]
    if problems:
        try:
            changed_model(model, values)
        except ModelError as error:
            # what is out of bounds is named with the rest
            problems += error.problems
        raise ModelError(problems, "--set")
    return values


class _Given(ValueReader):
    """Reads single values."""

    def read(self, name: str, aim: Target, value: Any) -> Any:
        """A value in SI, BROKEN where it has a mistake."""
        thing, unit = aim.owner, ""
        for word in aim.path[:-1]:
            # numbers of a signal have the unit of what it drives
            unit = _spec(thing, word).unit
            thing = getattr(thing, word)
        spec = _spec(thing, aim.path[-1])
        if not isinstance(thing, Node | ThermalNode):
            given = {item.name: getattr(thing, item.name) for item in fields(thing)}
            spec = settled(aim.path[-1], spec, type(thing), given)
        owner, _, last = name.rpartition(".")
        return self._value(value, spec, At(owner, "", unit), last)


def _spec(thing: Any, word: str) -> Spec:
    if isinstance(thing, Node):
        return list(NODE_FIELDS[thing.domain].values())[PLACES.index(word)]
    if isinstance(thing, ThermalNode):
        return THERMAL_FIELDS[node_kind(thing)][word]
    return next(spec for item, spec in specs(type(thing)) if item.name == word)


def _pairs(texts: Sequence[str]) -> tuple[dict[str, str], list[Problem]]:
    """Values by name, and what is not a pair of both."""
    found, problems = dict[str, str](), list[Problem]()
    for text in texts:
        name, sign, value = (part.strip() for part in text.partition("="))
        if not (name and sign and value):
            problems.append(Problem(quote(text), "", "is not a name and a value", remedy=FORM))
        elif name in found:
            problems.append(Problem(name, "", "is given twice", remedy="give it once"))
        else:
            found[name] = value
    return found, problems


def _plain(text: str) -> Any:
    """A value as TOML, a number as Python writes it, or else a string."""
    try:
        data = parsed(f"value = {text}")
    except ValueError:
        data = {}
    if list(data) == ["value"]:
        return data["value"]
    try:
        return float(text)
    except ValueError:
        return text

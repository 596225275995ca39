"""What the checks find of a model: once, for all who ask, until the model changes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import fields, is_dataclass
from functools import cached_property
from typing import Any, NamedTuple

from clutchwork.base import Problem, dataclass
from clutchwork.declare.node import Component, Signal, TabledComposite
from clutchwork.declare.rational import Row
from clutchwork.declare.wording import of_files
from clutchwork.model.kinematics import kinematics
from clutchwork.model.loads import load_problems
from clutchwork.model.model import Model
from clutchwork.model.parts import Parts, Sensor
from clutchwork.model.problems import TOO_FAR_APART, model_advice, no_shaft, part_problems
from clutchwork.model.settings import settings_problems
from clutchwork.model.start import Started, start
from clutchwork.model.structure import Kinematics, Mechanism


@dataclass(frozen=True)
class Structure:
    """What follows from the gears of a model without mistakes."""

    parts: Parts
    mechanism: Mechanism
    kinematics: Kinematics
    begun: Started  # how the independent nodes turn at the start
    motions: list[tuple[Component, Signal]]  # prescribed speeds

    @cached_property
    def rates(self) -> list[Row]:
        """Rates of what acts over the independent speeds."""
        return [self.kinematics.over(direction) for _, direction in self.mechanism.acting]


class Findings(NamedTuple):
    """All mistakes of a model, what it allows and is rarely wanted, and its structure where it has no mistake."""

    problems: list[Problem]
    advice: list[Problem]
    structure: Structure | None


class Kept(NamedTuple):
    """Cached findings and the model content they belong to."""

    findings: Findings
    things: tuple[Any, ...]
    more: tuple[bool, object]
    changeable: list[tuple[Any, Any]]

    def lasts(self) -> bool:
        """True while the cached inputs are unchanged."""
        try:
            return all(_values(thing) == values for thing, values in self.changeable)
        except (RecursionError, TypeError):
            # what cannot be followed is reported by the checks
            return False


def findings(model: Model, incomplete: Sequence[str] = ()) -> Findings:
    """All mistakes of a model, its advice and its structure; looked for once and kept until the model changes.

    Nothing is said about the inertia of nodes in `incomplete`, which belong to elements that are not there.
    """
    things, more = (*model.nodes, None, *model.thermal, None, *model.elements), (of_files(), model.name)
    kept: Kept | None = model.kept
    if kept is None or incomplete or more != kept.more or not _identical(things, kept.things) or not kept.lasts():
        found = _find(model, incomplete)
        # mistakes are looked for again: a file beside the model may have been corrected meanwhile
        keeps = not incomplete and not found.problems
        model.kept = kept = Kept(found, things, more, _changeable(things)) if keeps else None
    found = kept.findings if kept is not None else found
    # settings are small and may hold arrays, so they are looked at each time
    wrong = list(settings_problems(model.settings))
    return found._replace(problems=[*found.problems, *wrong]) if wrong else found


def may_change(model: Model) -> bool:
    """Whether a model that was looked at holds lists or arrays, which its owner may change."""
    kept: Kept | None = model.kept
    return kept is None or bool(kept.changeable)


def _identical(these: Sequence[Any], others: Sequence[Any]) -> bool:
    return len(these) == len(others) and all(one is other for one, other in zip(these, others, strict=True))


def _changeable(things: Iterable[Any]) -> list[tuple[Any, Any]]:
    """What holds lists or arrays, which its owner may change, with all its values as they are now."""
    found = list[tuple[Any, Any]]()
    for thing in things:
        try:
            hash(thing)
        except TypeError:
            found.append((thing, _values(thing)))
    return found


def _values(value: Any) -> Any:
    """A value in tuples, whatever it is held in; an array by its bytes."""
    if is_dataclass(value):
        return tuple(_values(getattr(value, item.name)) for item in fields(value))
    if hasattr(value, "tobytes"):
        return value.tobytes()
    if hasattr(value, "items"):
        return tuple((name, _values(item)) for name, item in value.items())
    if hasattr(value, "__len__") and not isinstance(value, str):
        return tuple(map(_values, value))
    return value


def _find(model: Model, incomplete: Sequence[str]) -> Findings:
    problems, sound, touched = part_problems(model, incomplete)
    advice = model_advice(model)
    if not model.nodes and not sound.nodes:
        return Findings([*problems, no_shaft()], advice, None)
    # a sensor may be on a shaft that is not there, and moves nothing
    components = [part for part in sound.components if not problems or not isinstance(part, Sensor)]
    tabled = [] if problems else [element for element in model.elements if isinstance(element, TabledComposite)]
    grips = tuple(grip for element in tabled for grip in element.grips())
    mechanism = Mechanism((*model.nodes, *sound.nodes), tuple(components), len(sound.nodes), grips)
    try:
        made, wrong = kinematics(mechanism, incomplete=frozenset((*incomplete, *touched)))
        if made is None:
            return Findings(problems + wrong, advice, None)
        begun, motions, wrong = start(mechanism, made)
        wrong += load_problems(mechanism)
    except ArithmeticError:
        return Findings([*problems, TOO_FAR_APART], advice, None)
    problems += wrong
    return Findings(problems, advice, None if problems else Structure(sound, mechanism, made, begun, motions))

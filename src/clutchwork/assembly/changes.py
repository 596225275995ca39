"""A System with other numbers: what assembling the driveline with them gives, bit for bit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import deepcopy
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

from clutchwork.assembly.assemble import assembled
from clutchwork.assembly.patches import Numbered, Unpatched, changed_signals, patched, patches
from clutchwork.base.errors import ModelError, Problem
from clutchwork.declare.node import Component, Law, Signal
from clutchwork.declare.schema import specs
from clutchwork.declare.wording import words_of_files
from clutchwork.model.changes import changed_model, named, renewed, target, with_held
from clutchwork.model.components import component_advice, component_problems
from clutchwork.model.fields import BROKEN, SOUND, At, law_problems, value_problems
from clutchwork.model.findings import findings
from clutchwork.model.model import Model
from clutchwork.model.problems import TOO_FAR_APART
from clutchwork.model.temperatures import temperature_advice

if TYPE_CHECKING:
    from clutchwork.assembly.records import Array
    from clutchwork.base.errors import Problem as Found

UNKNOWN_SOURCE = Problem(
    "system",
    "",
    "has numbers without names, because it was made from bytes",
    remedy="assemble its driveline, or read a file of System.save",
)


def changed(
    source: Model, independent: Sequence[str], speeds: int, changes: Mapping[str, Any]
) -> tuple[Model, dict[str, Any], list[Found]]:
    """The model with other values, the fields of its System, and what is rarely wanted of it.

    Parameters: source, the model; independent, names of the independent speeds where they were asked for; speeds, how
    many there are; changes, values by name.
    """
    with words_of_files(source.from_file):
        model = changed_model(source, {name: _kept(value) for name, value in changes.items()})
        found = findings(model)
        if found.problems:
            raise ModelError(found.problems, model.name)
        try:
            made = assembled(model, independent, found)
        except ArithmeticError:
            raise ModelError([TOO_FAR_APART], model.name) from None
    count = len(made["independent"])
    if count != speeds:
        message = f"makes {count} speeds independent, where {speeds} were"
        remedy = "build a driveline of its own for it: its rigid rows are others"
        raise ModelError([Problem(", ".join(changes), "", message, remedy=remedy)], model.name)
    return model, made, found.advice


# values by the fields that lead to them
Values = list[tuple[tuple[str, ...], Any]]


class Quick(NamedTuple):
    """Other numbers of elements that nothing else depends on: the model, its arrays, and what is new by element."""

    source: Model
    arrays: dict[str, Array]
    values: dict[str, Values]
    signals: dict[int, Signal]  # by the number of their input


def quick(source: Model, where: Numbered, changes: Mapping[str, Any]) -> Quick | None:
    """The changes where they are such; None: everything must be looked at, and assembled, anew."""
    given = _given(source, where, changes)
    new = None if given is None else _right(given)
    if given is None or new is None:
        return None
    try:
        found = [patch for old, made in new.values() for patch in patches(where, old, made)]
        signals = {
            where.inputs[name]: signal for old, made in new.values() for name, signal in changed_signals(old, made)
        }
    except Unpatched:
        return None
    model = source.copy()
    by_name = {name: made for name, (_, made) in new.items()}
    inner = {id(old): own for old, own in given.values()}
    model.elements = [by_name.get(e.name) or with_held(e, inner) for e in source.elements]
    values = {name: own for name, (_, own) in given.items()}
    return Quick(model, patched(where.arrays, found), values, signals)


def _given(source: Model, where: Numbered, changes: Mapping[str, Any]) -> dict[str, tuple[Component, Values]] | None:
    """The elements that change, each with its values; None where more than elements does."""
    owners, given = named(source), dict[str, tuple[Component, Values]]()
    for name, value in changes.items():
        aim = target(owners, name)
        if aim is None or not isinstance(aim.owner, Component) or aim.owner.name in where.referred:
            return None
        given.setdefault(aim.owner.name, (aim.owner, []))[1].append((aim.path, _kept(value)))
    return given


def _right(given: Mapping[str, tuple[Component, Values]]) -> dict[str, tuple[Component, Component]] | None:
    """Elements without mistakes in the place of others; None where there are mistakes."""
    made = dict[str, tuple[Component, Component]]()
    for name, (old, values) in given.items():
        if _overlap([path for path, _ in values]):
            return None
        new = renewed(old, values)
        if not is_right(old, new):
            return None
        made[name] = old, new
    return made


def _kept(value: Any) -> Any:
    """A value, or a copy of one that holds lists, which its owner may change later."""
    try:
        hash(value)
    except TypeError:
        return deepcopy(value)
    return value


def _overlap(paths: Sequence[tuple[str, ...]]) -> bool:
    """Whether one is inside of another."""
    outer = set(paths)
    return any(path[:cut] in outer for path in paths for cut in range(1, len(path)))


def is_right(old: Component, new: Component) -> bool:
    """Whether an element has no mistake of its own and no advice, where the old one has none."""
    before, values = vars(old), vars(new)
    unlike = {name: value for name, value in values.items() if value is None or value is not before.get(name)}
    if any(value_problems(type(new), dict.fromkeys(values, BROKEN) | unlike, At(new.name, ""))):
        return False
    # rules between the values are looked at, the values no more
    values[SOUND] = True
    try:
        if any(component_problems(new)):
            return False
    finally:
        del values[SOUND]
    if _plain_numbers(type(new)).issuperset((name,) for name, value in unlike.items() if value is not before.get(name)):
        return True
    return not any(component_advice(new)) and not any(temperature_advice([new], []))


# what an element may say of its values together, and of what is made of them
RULES = ("problems", "law_problems", "entries", "parts", "initial_states", "state_scales")


def ruled(owner: Component, paths: Sequence[tuple[str, ...]]) -> Component | Law | None:
    """What is to be looked at where numbers of an element are others within their bounds: itself, its law, or nothing.

    Parameters: paths, of the fields that lead to the numbers.
    """
    law, own = owner.friction, _plain_numbers(type(owner))
    known = own | {("friction", *path) for path in (_plain_numbers(type(law)) if isinstance(law, Law) else ())}
    if not known.issuperset(paths) or any(getattr(type(owner), rule) is not getattr(Component, rule) for rule in RULES):
        return owner
    return None if own.issuperset(paths) else law


def is_right_law(law: Law) -> bool:
    """Whether there is no mistake in a law whose values are within their bounds, and no advice about it."""
    values = vars(law)
    values[SOUND] = True
    try:
        return not any(law_problems(law, At("", ""))) and not any(law.advice())
    except ArithmeticError:
        return False
    finally:
        del values[SOUND]


@cache
def _plain_numbers(cls: Any) -> frozenset[tuple[str, ...]]:
    """Paths of fields that are numbers other than temperatures, of which there is no advice about an element."""
    return frozenset((item.name,) for item, spec in specs(cls, "param", "option") if spec.unit != "K")

"""A System with other numbers: what assembling the driveline with them gives, bit for bit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import fields, replace
from functools import cache, partial
from types import MappingProxyType
from typing import Any, NamedTuple, TypeVar, cast

from clutchwork.assembly.assemble import assembled
from clutchwork.assembly.inputs import plain_signal
from clutchwork.assembly.masses import masses
from clutchwork.assembly.patches import (
    PLAIN,
    Patch,
    Unpatched,
    changed_signals,
    parameter_place,
    patched,
    patches,
    signal_patches,
)
from clutchwork.assembly.records import Array
from clutchwork.assembly.start_speeds import start_speeds
from clutchwork.assembly.system_data import GROUPS, LATER, MAKES, SystemData
from clutchwork.base.errors import ModelError, Problem, warn
from clutchwork.base.memoize import memoize
from clutchwork.declare.node import Component, Law, Node, Signal
from clutchwork.declare.schema import Spec, specs
from clutchwork.declare.wording import words_of_files
from clutchwork.model.changes import Owners, Renewed, Target, changed_model, named, renewed, target, with_values
from clutchwork.model.components import component_advice, component_problems
from clutchwork.model.fields import BROKEN, At, law_problems, signal_problems, value_problems
from clutchwork.model.findings import findings
from clutchwork.model.model import Model
from clutchwork.model.numbers import is_right as is_right_number
from clutchwork.model.parts import is_stop, role
from clutchwork.model.problems import TOO_FAR_APART
from clutchwork.model.structure import follows_load
from clutchwork.model.temperatures import temperature_advice

S = TypeVar("S", bound=SystemData)

UNKNOWN_SOURCE = Problem(
    "system",
    "",
    "has no names for its numbers, because it was made from bytes",
    remedy="assemble its driveline, or read a file of System.save",
)


def changed_system(system: S, changes: Mapping[str, Any]) -> S:
    """A System with other values by name; ModelError where they do not fit."""
    if system.source is None:
        raise ModelError([UNKNOWN_SOURCE])
    found = _of_words(system, changes) or quick(system, changes)
    # elements that are warned of are looked at as a whole
    if found is not None and not (system.warnings and found.values):
        return _with(system, found)
    source, made, advice = anew(system.source, system.wanted, len(system.independent), changes)
    for one in advice:
        if str(one) not in system.warnings:
            warn(one)
    return type(system)(**made, settings=system.settings, source=source, wanted=system.wanted)


def _with(system: S, found: Quick) -> S:
    """The same structure with other numbers."""
    # of changes of changes none waits for another
    for name in LATER:
        getattr(system, name)
    vars(system).pop(MAKES, None)
    data, starts, own_arrays = bytearray(system.to_bytes()), system.starts, cast(Any, system.arrays).copy()
    for name, array in found.arrays.items():
        array.flags.writeable = False
        data[starts[name] : starts[name] + array.nbytes] = array.data.cast("B")
        own_arrays[name] = array
    made, arrays = object.__new__(type(system)), MappingProxyType(own_arrays)
    own, kind = vars(system), cast(Any, type(system))
    vars(made).update({name: own[name] for name in _kept_names(kind)})
    numbers = system.numbered._replace(arrays=arrays)
    vars(made).update({"arrays": arrays, "numbered": numbers, MAKES: partial(found.made, system)})
    # what follows from its structure alone
    vars(made).update({"counts": system.counts, "starts": starts, "_bytes": bytes(data)})
    return made


@cache
def _kept_names(cls: Any) -> tuple[str, ...]:
    """Names of what a changed System has of the one before it."""
    return tuple(item.name for item in fields(cls) if item.name not in LATER)


def anew(
    source: Model, independent: Sequence[str], speeds: int, changes: Mapping[str, Any]
) -> tuple[Model, dict[str, Any], list[Problem]]:
    """The model with other values, the fields of its System, and what is rarely wanted of it.

    Parameters: source, the model; independent, names of the independent speeds where they were asked for; speeds, how
    many there are; changes, values by name.
    """
    with words_of_files(source.from_file):
        model = changed_model(source, {name: _kept(value) for name, value in changes.items()})
        found = findings(model)
        try:
            made = assembled(model, independent, found)
        except ArithmeticError:
            raise ModelError([TOO_FAR_APART], model.name) from None
    count = len(made["independent"])
    if count != speeds:
        message = f"makes {count} speeds independent, where {speeds} were"
        remedy = "build a new driveline for it: its rigid constraints differ"
        raise ModelError([Problem(", ".join(changes), "", message, remedy=remedy)], model.name)
    return model, made, found.advice


# values by the fields that lead to them
Values = list[tuple[tuple[str, ...], Any]]


class Quick(NamedTuple):
    """Other numbers that nothing else depends on: new arrays, and what is new of all that stands in a System."""

    arrays: dict[str, Array]  # those that differ
    aims: list[tuple[Target, Any]]
    values: dict[str, Values]  # of elements
    signals: dict[int, Signal]  # by the number of their input
    nodes: Mapping[str, Mapping[str, Any]]  # fields of shafts and masses by their names

    def made(self, old: SystemData, name: str) -> dict[str, Any]:
        """The item of a changed System with this name, and the items that are made together with it."""
        if name != "source":
            return self.content(old)
        return {"source": None if old.source is None else with_values(old.source, self.aims)}

    def content(self, old: SystemData) -> dict[str, Any]:
        """Everything of a System that holds them."""
        nodes = {id(node): replace(node, **own) for node in old.nodes if (own := self.nodes.get(node.name))}
        new = Renewed(nodes)
        made = {name: tuple(map(partial(self._part, new), getattr(old, name))) for name in GROUPS}
        gears = tuple(replace(row, gear=new.of(row.gear)) for row in old.gears) if nodes else old.gears
        inputs = list(old.inputs)
        for number, signal in self.signals.items():
            inputs[number] = replace(inputs[number], signal=signal)
        return {**made, "nodes": tuple(map(new.of, old.nodes)), "gears": gears, "inputs": tuple(inputs)}

    def _part(self, new: Renewed, part: Component) -> Any:
        """An element with other values, on the shafts of the System, which are not those of its source."""
        own = renewed(part, self.values[part.name]) if part.name in self.values else part
        return new.of(own) if self.nodes else own


@memoize
def _aim(system: SystemData, name: str) -> Target | None:
    """Where a name leads to, None: nowhere."""
    return target(owners_of(system), name)


class OwnWord(NamedTuple):
    """A number or signal of an element from which nothing follows but its own words."""

    aim: Target
    spec: Spec
    place: int  # among all parameters, or all signals


# what more may follow from a number of an element
MORE = ("directions", "own_states", "passive", "start_positions", "start_ratio")


@memoize
def _own_word(system: SystemData, name: str) -> OwnWord | None:
    """The words of a number or a signal; None where more may follow from it."""
    aim, where = _aim(system, name), system.numbered
    if aim is None or len(aim.path) != 1 or not isinstance(aim.owner, Component) or aim.owner.name in where.referred:
        return None
    owner, kind = aim.owner, type(aim.owner)
    # heat goes to the same place whatever its numbers are, in elements of this package
    follows = (*MORE, *(() if kind.heat_path.__module__.startswith("clutchwork.") else ("heat_path",)))
    if role(owner) not in PLAIN or any(getattr(kind, rule) is not getattr(Component, rule) for rule in follows):
        return None
    spec = next(spec for item, spec in specs(kind) if item.name == aim.path[0])
    given = getattr(owner, aim.path[0])
    if spec.what == "signal":
        known = (type(given) is float or isinstance(given, Signal)) and name in where.inputs
        # a signal is no number of `ruled`, but the same rules of its element look at it
        plain = known and spec.unit != "K" and not (has_rules(kind) or is_stop(owner) or follows_load(owner))
        return OwnWord(aim, spec, where.inputs[name]) if plain else None
    if type(given) is not float or spec.what != "param" or spec.choices or ruled(owner, [aim.path]) is not None:
        return None
    return OwnWord(aim, spec, parameter_place(where, owner, aim.path[0]))


# where nobody reads a message
NOWHERE = At("", "")


def _own_signal(word: OwnWord, value: Any) -> Signal | None:
    """A signal, or a number as one, kept from changes; None where it needs a further look."""
    if type(value) is float:
        return plain_signal(value) if is_right_number(value, word.spec) else None
    if not isinstance(value, Signal) or value.has_units or any(signal_problems(value, word.spec, NOWHERE)):
        return None
    return cast(Signal, _kept(value))


def _of_words(system: SystemData, changes: Mapping[str, Any]) -> Quick | None:
    """The changes where all of them are such numbers."""
    found, aims, values = list[Patch](), list[tuple[Target, Any]](), dict[str, Values]()
    signals = dict[int, Signal]()
    for name, value in changes.items():
        word = _own_word(system, name) if isinstance(name, str) else None
        if word is None:
            return None
        kept = value
        if word.spec.what == "signal":
            signal = _own_signal(word, value)
            if signal is None:
                return None
            signals[word.place], kept = signal, value if type(value) is float else signal
            try:
                found += signal_patches(system.numbered, name, signal)
            except Unpatched:
                return None
        elif is_right_number(value, word.spec):
            found.append(Patch("params", word.place, [value]))
        else:
            return None
        aims.append((word.aim, kept))
        values.setdefault(word.aim.owner.name, []).append((word.aim.path, kept))
    return Quick(patched(system.arrays, found), aims, values, signals, {}) if found else None


def quick(system: SystemData, changes: Mapping[str, Any]) -> Quick | None:
    """The changes where they are such; None: everything must be looked at, and assembled, anew."""
    where = system.numbered
    given: dict[str, tuple[Component, Values]] = {}
    aims: list[tuple[Target, Any]] = []
    of_nodes: dict[str, dict[str, Any]] = {"inertia": {}, "speed": {}}
    for name, value in changes.items():
        aim, kept = _aim(system, name) if isinstance(name, str) else None, _kept(value)
        if aim is not None and isinstance(aim.owner, Node) and aim.path[0] in of_nodes:
            of_nodes[aim.path[0]][name] = kept
        elif aim is not None and isinstance(aim.owner, Component) and aim.owner.name not in where.referred:
            given.setdefault(aim.owner.name, (aim.owner, []))[1].append((aim.path, kept))
        else:
            return None
        aims.append((aim, kept))
    found = _of_nodes(system, **of_nodes)
    new = None if found is None else _right(given)
    if found is None or new is None:
        return None
    try:
        found += [patch for old, made in new.values() for patch in patches(where, old, made)]
        signals = {
            where.inputs[name]: signal for old, made in new.values() for name, signal in changed_signals(old, made)
        }
    except Unpatched:
        return None
    values = {name: own for name, (_, own) in given.items()}
    nodes: dict[str, dict[str, Any]] = {}
    for field, own in of_nodes.items():
        for name, value in own.items():
            nodes.setdefault(name.rpartition(".")[0], {})[field] = float(value)
    return Quick(patched(where.arrays, found), aims, values, signals, nodes)


def _of_nodes(system: SystemData, inertia: Mapping[str, Any], speed: Mapping[str, Any]) -> list[Patch] | None:
    """The words of other inertias and speeds at the start; None where more follows from them."""
    found = list[Patch]()
    if inertia:
        known = masses(system)
        own = known.patches(inertia) if known is not None else None
        if own is None:
            return None
        found += own
    if speed:
        begun = start_speeds(system, *speed)
        own = begun.patches(speed) if begun is not None else None
        if own is None:
            return None
        found += own
    return found


@memoize
def owners_of(system: SystemData) -> Owners:
    """Everything of the driveline of a System that has something to change, by name."""
    return named(system.source or Model())


def _right(given: Mapping[str, tuple[Component, Values]]) -> dict[str, tuple[Component, Component]] | None:
    """Elements without mistakes in the place of others; None where there are mistakes."""
    made: dict[str, tuple[Component, Component]] = {}
    for name, (old, values) in given.items():
        if len(values) > 1 and _overlap([path for path, _ in values]):
            return None
        new = renewed(old, values)
        if not is_right(old, new):
            return None
        made[name] = old, new
    return made


def _kept(value: Any) -> Any:
    """A value, or a copy of one that holds lists, which its owner may change later."""
    if type(value) is list:
        return [*map(_kept, value)]
    try:
        hash(value)
    except TypeError:
        if type(value) is tuple:
            return (*map(_kept, value),)
        if not isinstance(value, Signal):
            return deepcopy(value)
        made = object.__new__(type(value))
        vars(made).update({item.name: _kept(getattr(value, item.name)) for item in fields(value)})
        return made
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
    if any(component_problems(new, sound=True)):
        return False
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
    if not known.issuperset(paths) or has_rules(type(owner)):
        return owner
    return None if own.issuperset(paths) else law


@cache
def has_rules(kind: Any) -> bool:
    """Whether a kind of element looks at its values together, or makes something of them."""
    return any(getattr(kind, rule) is not getattr(Component, rule) for rule in RULES)


def is_right_law(law: Law) -> bool:
    """Whether there is no mistake in a law whose values are within their bounds, and no advice about it."""
    try:
        return not any(law_problems(law, At("", ""), sound=True)) and not any(
            (*law.advice(), *law.slip_advice("rad/s"))
        )
    except ArithmeticError:
        return False


@cache
def _plain_numbers(cls: Any) -> frozenset[tuple[str, ...]]:
    """Paths of fields that are numbers other than temperatures, of which there is no advice about an element."""
    return frozenset((item.name,) for item, spec in specs(cls, "param", "option") if spec.unit != "K")

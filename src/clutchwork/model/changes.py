"""A model with other numbers: what may be changed, by name, and the same model with new values in its place.

A name is that of a shaft, mass, thermal node or element and a field of it: "engine.inertia", "c1.gain". What is inside
of a friction law or a signal follows: "c1.friction.kinetic", "c1.pressure.height". Parts that a composite holds are
named as in results: "gearbox.A.gain".
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cache
from typing import Any

from clutchwork.base import ModelError, Problem, near, quote
from clutchwork.base.errors import nearest
from clutchwork.base.frozen import Frozen
from clutchwork.declare.node import DIRECT, Component, Law, Node, Signal, TabledComposite, ThermalNode, is_reference
from clutchwork.declare.schema import Spec, specs
from clutchwork.declare.to_si import TargetUnit, field_in_si, settled
from clutchwork.model.components import component_problems
from clutchwork.model.findings import findings
from clutchwork.model.model import Model
from clutchwork.model.parts import all_parts
from clutchwork.model.problems import NODE_FIELDS, node_problems
from clutchwork.model.thermal import NODE_FIELDS as THERMAL_FIELDS
from clutchwork.model.thermal import node_kind, thermal_problems

# sorts of fields that are joined, named or called, and make another driveline
FIXED = ("port", "thermal", "text", "formula", "function", "named", "elements", "data")
SIGNALS = ("signal", "alternative")
MOST_OWN = 6
# "c1.pressure.values[3]", or without its "values"
IN_TABLE = re.compile(r"(.+?)(?:\.(?:values|times|arguments))?(?:\[.*\])?")
WHOLE = "gradients, calibrate and fit take its numbers, a sweep or a change takes whole tables: give them"
RESULTS = "speeds, torques, slips and the like are results, which follow from the motion"
# fields of a mass by the names of a shaft
PLACES = ("inertia", "speed", "angle")
# what may be, or refer to, something that is changed
REFERS = (Node, ThermalNode, Component, Law, *DIRECT, tuple, Frozen)


@dataclass(frozen=True)
class Target:
    """What a name leads to: the shaft, node or element that has it, and the fields from there."""

    owner: Any
    path: tuple[str, ...]


class Owners(dict[str, Any]):
    """All shafts, masses, thermal nodes and elements by name, and the parts that elements hold: those in `held`."""

    held: frozenset[str] = frozenset()


def named(model: Model) -> Owners:
    """Everything of a model that has something to change, by name."""
    things: list[Any] = [*model.nodes, *model.thermal, *model.elements]
    held = [part for element in model.elements for part in element.held().values()]
    made = Owners({thing.name: thing for thing in (*held, *things)})
    made.held = frozenset(part.name for part in held)
    return made


def target(owners: Mapping[str, Any], name: object) -> Target | None:
    """Where a name leads to, None: nowhere."""
    words = name.split(".") if isinstance(name, str) else []
    for cut in range(len(words) - 1, 0, -1):
        owner = owners.get(".".join(words[:cut]))
        if owner is not None:
            path = _path(owner, words[cut:])
            if path and not _is_beyond(owners, owner, path[0]):
                return Target(owner, path)
    return None


def _is_beyond(owners: Mapping[str, Any], owner: Any, word: str) -> bool:
    """Whether something of a shaft is not to be changed, because a composite holds it and has no table for it."""
    held = owners.held if isinstance(owners, Owners) else ()
    return isinstance(owner, Node) and owner.name in held and word == "angle"


def _path(owner: Any, words: list[str]) -> tuple[str, ...]:
    """The fields that words lead through; nothing where there is no such field."""
    thing, path = owner, list[str]()
    for word in words:
        known = changeable(thing)
        if word not in known:
            return ()
        path.append(known[word])
        thing = getattr(thing, known[word])
    return tuple(path)


def changeable(thing: Any) -> dict[str, str]:
    """Fields that may be changed, by the name that users know."""
    if isinstance(thing, Node):
        return dict(zip(NODE_FIELDS[thing.domain], PLACES, strict=True))
    if isinstance(thing, ThermalNode):
        names = ("temperature",) if thing.capacity is None else ("capacity", "temperature")
        return {name: name for name in names}
    return _changeable(type(thing)) if isinstance(thing, Component | Law | Signal) else {}


@cache
def _changeable(cls: Any) -> dict[str, str]:
    return {item.name: item.name for item, spec in specs(cls) if spec.what not in FIXED}


def in_si(aim: Target, value: Any) -> Any:
    """A value for a target in SI where it has a unit that fits; any other as it is."""
    thing, driven = aim.owner, None
    for name in aim.path[:-1]:
        spec = _spec(thing, name)
        if spec.what in SIGNALS:
            fits = settled(name, spec, type(thing), vars(thing))
            driven = TargetUnit(fits.unit, fits.units)
        thing = getattr(thing, name)
    name = aim.path[-1]
    spec = _spec(thing, name)
    if spec.what == "law" or spec.flag or spec.choices:
        return value
    return field_in_si(value, settled(name, spec, type(thing), vars(thing)), driven)


def unit_of(aim: Target) -> str:
    """The unit of SI of a number that a target holds, empty where it holds none."""
    thing, driven = aim.owner, ""
    for name in aim.path[:-1]:
        spec = _spec(thing, name)
        if spec.what in ("signal", "alternative"):
            driven = settled(name, spec, type(thing), vars(thing)).unit
        thing = getattr(thing, name)
    name = aim.path[-1]
    spec = _spec(thing, name)
    if spec.what == "law" or spec.flag or spec.choices:
        return ""
    # what is inside of a law is over the speeds of what the element joins
    joined = {} if thing is aim.owner else {word: node for word, node in _ports(aim.owner) if word not in vars(thing)}
    unit = settled(name, spec, type(thing), {**vars(thing), **joined}).unit
    return driven if unit == "*" else unit


def _ports(owner: Any) -> list[tuple[str, Node]]:
    return [(name, value) for name, value in vars(owner).items() if isinstance(value, Node)]


def field_of(aim: Target) -> tuple[Any, Spec]:
    """What a target holds, and what is declared of the field that holds it."""
    thing = aim.owner
    for name in aim.path[:-1]:
        thing = getattr(thing, name)
    value = getattr(thing, aim.path[-1])
    # angles that are not given count from 0
    if value is None and isinstance(thing, Node) and aim.path[-1] == "angle":
        value = 0.0
    return value, _spec(thing, aim.path[-1])


def _spec(thing: Any, name: str) -> Spec:
    """What is declared of a field."""
    if isinstance(thing, Node):
        return [*NODE_FIELDS[thing.domain].values()][PLACES.index(name)]
    if isinstance(thing, ThermalNode):
        return THERMAL_FIELDS[node_kind(thing)][name]
    return next(spec for item, spec in specs(type(thing)) if item.name == name)


def all_names(model: Model) -> Iterator[str]:
    """All names that may be changed."""
    owners = named(model)
    for name, owner in owners.items():
        yield from (below for below in _below(name, owner) if target(owners, below) is not None)


def _below(name: str, thing: Any) -> Iterator[str]:
    for word, item in changeable(thing).items():
        yield f"{name}.{word}"
        value = getattr(thing, item)
        # another element that gives an input has names of its own
        if isinstance(value, Law | Signal):
            yield from _below(f"{name}.{word}", value)


def changed_model(model: Model, changes: Mapping[str, Any]) -> Model:
    """The model with other values; ModelError names all that is unknown, and all that is wrong with the others."""
    targets, problems = targets_of(model, changes)
    new = _renewed_things(model, [(found, changes[name]) for name, found in targets.items()])
    # what has mistakes of its own cannot be taken apart
    wrong = [problem for thing in new.values() for problem in _own_problems(thing)]
    made = model if wrong else _with_things(model, new)
    problems += wrong or findings(made).problems
    if problems:
        raise ModelError(problems, model.name)
    return made


def _own_problems(thing: Any) -> Iterable[Problem]:
    """Mistakes of one shaft, thermal node or element, whatever stands beside it."""
    if isinstance(thing, Node):
        return node_problems(thing)
    return thermal_problems(thing) if isinstance(thing, ThermalNode) else component_problems(thing)


def targets_of(model: Model, names: Iterable[str]) -> tuple[dict[str, Target], list[Problem]]:
    """Where names lead to, and those that lead nowhere."""
    owners, found, problems = named(model), dict[str, Target](), list[Problem]()
    for name in names:
        aim = target(owners, name)
        if aim is None:
            problems.append(_unknown(model, owners, name))
        else:
            found[name] = aim
    return found, [*problems, *_twice(found)]


def _unknown(model: Model, owners: Mapping[str, Any], name: object) -> Problem:
    path = name if isinstance(name, str) else quote(name)
    owner, _, last = path.rpartition(".")
    thing = owners.get(owner)
    joined = [item.name for item, _ in specs(type(thing), *FIXED)] if isinstance(thing, Component) else []
    if last in joined or (thing is not None and last == "name"):
        return Problem(path, "", "is not a number", remedy="build another driveline for it")
    table = IN_TABLE.fullmatch(path)
    if table and _is_table(target(owners, table[1])):
        return Problem(path, "", "is inside of a table", remedy=f"{WHOLE} as {table[1]!r}")
    message, owner = "is not a number, initial value or signal of this driveline", owner_of(owners, path)
    if owner:
        own = [word for word in own_names(owners[owner]) if target(owners, f"{owner}.{word}") is not None]
        return Problem(path, "", f"{message}{of_owner(path, owner, own, RESULTS)}")
    such = 'names are such as "engine.inertia", "c1.gain", "c1.friction.kinetic"'
    return Problem(path, "", f"{message}{near(path, all_names(model)) or f'; {such}'}")


def _is_table(aim: Target | None) -> bool:
    """Whether a target holds a table over time, a curve or a list of numbers."""
    value = None if aim is None else field_of(aim)[0]
    return hasattr(value, "points") or (hasattr(value, "__len__") and not isinstance(value, str))


def owner_of(owners: Collection[str], path: str) -> str:
    """The shaft, node or element that a name begins with; the longest, empty where there is none."""
    words = path.split(".")
    begins = (".".join(words[:cut]) for cut in range(len(words) - 1, 0, -1))
    return next((name for name in begins if name in owners), "")


def own_names(thing: Any) -> list[str]:
    """What of a thing may be changed and has a value, signals first, then what is inside of laws and signals."""
    fields_ = changeable(thing)
    driven = {item.name for item, _ in specs(type(thing), *SIGNALS)} if isinstance(thing, Component) else set()
    there = [word for word, item in fields_.items() if getattr(thing, item) is not None]
    inside = [name.partition(".")[2] for name in _below("", thing)]
    return list(dict.fromkeys([*sorted(there, key=lambda word: word not in driven), *inside]))


def of_owner(path: str, owner: str, own: Sequence[str], rest: str = "", exact: bool = False) -> str:
    """What to do about a name of something that is there: a name of it that is like it, or what of it can be set.

    Parameters: own, names without that of the owner; rest, what else to say; exact, whether the name is right, but
    that of something else.
    """
    like = "" if exact else nearest(path[len(owner) + 1 :], own)
    if like:
        return f"; did you mean '{owner}.{like}'?"
    some = ", ".join([repr(f"{owner}.{word}") for word in own[:MOST_OWN]])
    more = " ..." if len(own) > MOST_OWN else ""
    can = f"what can be set of {owner!r}: {some}{more}" if own else f"nothing of {owner!r} can be set"
    return f"; {can}{f'; {rest}' if rest else ''}"


def _twice(targets: Mapping[str, Target]) -> Iterator[Problem]:
    """Names of a value and of something inside of it."""
    places = {(id(aim.owner), aim.path): name for name, aim in targets.items()}
    for name, aim in targets.items():
        for cut in range(1, len(aim.path)):
            outer = places.get((id(aim.owner), aim.path[:cut]))
            if outer is not None:
                yield Problem(name, "", f"is inside of {outer!r}, which is changed too", remedy="change one of them")


def with_values(model: Model, changes: Iterable[tuple[Target, Any]]) -> Model:
    """The model with other values of the targets; whatever refers to what is changed refers to the new one."""
    return _with_things(model, _renewed_things(model, changes))


def _renewed_things(model: Model, changes: Iterable[tuple[Target, Any]]) -> dict[int, Any]:
    """What has other values, by the identity of what stands in its place so far; references are still the old ones."""
    by_owner = dict[int, tuple[Any, list[tuple[tuple[str, ...], Any]]]]()
    for aim, value in changes:
        by_owner.setdefault(id(aim.owner), (aim.owner, []))[1].append((aim.path, value))
    inner = {key: by_owner.pop(key)[1] for key in _held(model.elements) if key in by_owner}
    made_of = {key: renewed(owner, given) for key, (owner, given) in by_owner.items()}
    for element in model.elements if inner else ():
        own = made_of.get(id(element), element)
        changed = with_held(element, inner, own)
        made_of |= {id(element): changed} if changed is not element else {}
    return made_of


def _with_things(model: Model, made_of: Mapping[int, Any]) -> Model:
    """The model with new things in the place of old ones."""
    new = Renewed(made_of)
    made = model.copy()
    made.nodes = [new.of(node) for node in model.nodes]
    made.thermal = [new.of(node) for node in model.thermal]
    made.elements = [new.of(element) for element in model.elements]
    # references to parts of composites, which are made anew with these
    while new.learn(model.elements):
        made.elements = [new.of(element) for element in model.elements]
    return made


def _held(elements: Iterable[Component]) -> Iterator[int]:
    """Identities of the parts that elements hold."""
    return (id(part) for element in elements for part in element.held().values())


def with_held(
    whole: Component, changes: Mapping[int, Iterable[tuple[tuple[str, ...], Any]]], made: Component | None = None
) -> Component:
    """A composite with other values of the parts that it holds.

    Parameters: changes, paths and values by the identity of a part; made, the whole where it has other values itself.
    """
    found = whole if made is None else made
    for name, part in whole.held().items():
        if id(part) in changes and isinstance(found, TabledComposite):
            found = found.with_held(name, _values_at(part, changes[id(part)]))
    return found


def renewed(thing: Any, changes: Iterable[tuple[tuple[str, ...], Any]]) -> Any:
    """A declared object with other values at paths of fields."""
    return replace(thing, **_values_at(thing, changes))


def _values_at(thing: Any, changes: Iterable[tuple[tuple[str, ...], Any]]) -> dict[str, Any]:
    """The new values of its fields."""
    values: dict[str, Any] = {}
    inner: dict[str, list[tuple[tuple[str, ...], Any]]] = {}
    for path, value in changes:
        if len(path) == 1:
            values[path[0]] = value
        else:
            inner.setdefault(path[0], []).append((path[1:], value))
    return values | {name: renewed(getattr(thing, name), below) for name, below in inner.items()}


@dataclass
class Renewed:
    """New objects in the place of old ones, and of all that refer to those."""

    given: Mapping[int, Any]  # old object by identity -> the one with other values
    # old object by identity -> itself, and what stands in its place
    made: dict[int, tuple[Any, Any]] = field(default_factory=dict)
    parts: dict[str, list[Any]] = field(default_factory=dict)  # of renewed composites, by name

    def of(self, value: Any) -> Any:
        """What stands in the place of a value."""
        key = id(value)
        if key not in self.made:
            # kept beside it, so that nothing else gets its identity
            self.made[key] = value, self._renewed(value, self.given.get(key))
        return self.made[key][1]

    def _renewed(self, value: Any, given: Any) -> Any:
        if isinstance(value, Node | ThermalNode):
            return given or self._part(value)
        if isinstance(value, Component) and given is None:
            part = self._part(value)
            return self._fields(value) if part is value else part
        if isinstance(value, tuple) and is_reference(value):
            target = self.of(value[0])
            return value if target is value[0] else (target, value[1])
        if isinstance(value, Frozen):
            new = Frozen({name: self.of(item) if isinstance(item, REFERS) else item for name, item in value.items()})
            return value if all(new[name] is item for name, item in value.items()) else new
        return self._fields(given or value) if isinstance(value, (Component, Law, *DIRECT)) else value

    def _part(self, value: Any) -> Any:
        return next((part for part in self.parts.get(value.name, ()) if type(part) is type(value)), value)

    def _fields(self, thing: Any) -> Any:
        """A thing whose fields refer to what is new; the thing itself where nothing of it is."""
        values = {}
        for item in fields(thing):
            value = getattr(thing, item.name)
            if isinstance(value, REFERS):
                new = self.of(value)
                if new is not value:
                    values[item.name] = new
        return replace(thing, **values) if values else thing

    def learn(self, elements: Iterable[Component]) -> bool:
        """Take in the parts of composites that are new; whether there are more than before."""
        found = dict[str, list[Any]]()
        for element in elements:
            new = self.of(element)
            for part in all_parts(new) if new is not element else ():
                found.setdefault(part.name, []).append(part)
        more = found.keys() != self.parts.keys()
        if more:
            self.parts = found
            self.made.clear()
        return more

"""What all declarations share, where a dataclass writes it anew for each class: a third of the time of an import."""

from __future__ import annotations

from dataclasses import MISSING, dataclass, fields
from functools import cache
from typing import Any, NamedTuple


class Call(NamedTuple):
    """How a declaration is called."""

    places: tuple[str, ...]  # fields that may be positional
    names: frozenset[str]  # all of them
    defaults: dict[str, Any]
    makers: dict[str, Any]  # functions that make a default anew
    checked: bool  # has a __post_init__


@cache
def _call(cls: Any) -> Call:
    given = [item for item in fields(cls) if item.init]
    places = tuple(item.name for item in given if not item.kw_only)
    defaults = {item.name: item.default for item in given if item.default is not MISSING}
    makers = {item.name: item.default_factory for item in given if item.default_factory is not MISSING}
    return Call(places, frozenset(item.name for item in given), defaults, makers, hasattr(cls, "__post_init__"))


def _init(thing: Any, *args: Any, **named: Any) -> None:
    cls: Any = type(thing)
    places, names, defaults, makers, checked = _call(cls)
    given = defaults | {name: make() for name, make in makers.items()} | named if makers else defaults | named
    if args:
        by_place = dict(zip(places, args, strict=False))
        given |= by_place
    # `explain` says what is wrong
    if given.keys() != names or (args and (len(args) > len(places) or not by_place.keys().isdisjoint(named))):
        raise TypeError(f"{cls.__name__}() does not take these arguments")
    vars(thing).update(given)
    if checked:
        thing.__post_init__()


def _values(thing: Any) -> tuple[Any, ...]:
    return tuple(getattr(thing, item.name) for item in fields(thing))


def _repr(thing: Any) -> str:
    shown = ", ".join(f"{item.name}={getattr(thing, item.name)!r}" for item in fields(thing) if item.repr)
    return f"{type(thing).__qualname__}({shown})"


def _eq(one: Any, other: Any) -> Any:
    return _values(one) == _values(other) if type(one) is type(other) else NotImplemented


def _hash(thing: Any) -> int:
    return hash(_values(thing))


def freeze(cls: type) -> Any:
    """A frozen dataclass whose constructor, repr, equality and hash are shared by all declarations."""
    own: Any = cls
    if "__repr__" not in vars(cls):
        own.__repr__ = _repr
    own.__init__, own.__eq__, own.__hash__ = _init, _eq, _hash
    return dataclass(frozen=True, init=False, repr=False, eq=False)(cls)

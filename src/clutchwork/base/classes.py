"""`dataclass` with methods that all classes share; that of the standard library compiles them anew for each class.

What it makes is what `dataclasses.dataclass` makes, to its users and to the functions of that module. Compiling took
most of the time of an import.
"""

from __future__ import annotations

import dataclasses
from functools import cache
from operator import attrgetter
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable
    from dataclasses import Field
    from dataclasses import dataclass as dataclass
    from inspect import Signature


@dataclasses.dataclass(init=False, repr=False, eq=False)
class _Open:
    """The class that the standard library generates for one field."""

    item: Any


@dataclasses.dataclass(frozen=True, init=False, repr=False, eq=False)
class _Frozen:
    """The same, frozen."""

    item: Any


class _Factory:
    """What stands in a signature for a default that is made anew."""

    def __repr__(self) -> str:
        return "<factory>"


FACTORY = _Factory()
# types of values that a class with a method `_accept` need not look at; it is called once where one of another is given
PLAIN: set[type] = {float, int, bool, type(None)}
_FIELD: Any = dataclasses.fields(_Frozen)[0]


class _Call(NamedTuple):
    """How a class is called."""

    places: tuple[str, ...]  # fields that may be positional
    names: frozenset[str]  # all that may be given
    defaults: dict[str, Any]
    makers: tuple[tuple[str, Callable[[], Any]], ...]  # functions that make a default anew
    own: tuple[tuple[str, Callable[[], Any]], ...]  # the same of what cannot be given
    checked: bool  # has a __post_init__
    accepts: bool  # has a method `_accept`
    named: int  # 1 where the first place is a name


@cache
def _call(cls: Any) -> _Call:
    every = dataclasses.fields(cls)
    given = [item for item in every if item.init]
    made: list[Any] = [item for item in every if item.default_factory is not dataclasses.MISSING]
    return _Call(
        tuple(item.name for item in given if not item.kw_only),
        frozenset(item.name for item in given),
        # a default that cannot be given stays with the class
        {item.name: item.default for item in given if item.default is not dataclasses.MISSING},
        tuple((item.name, item.default_factory) for item in made if item.init),
        tuple((item.name, item.default_factory) for item in made if not item.init),
        hasattr(cls, "__post_init__"),
        hasattr(cls, "_accept"),
        int(given[:1] != [] and given[0].name == "name"),
    )


def _init(thing: Any, /, *args: Any, **named: Any) -> None:
    cls: Any = type(thing)
    places, names, defaults, makers, own, checked, accepts, named_first = _call(cls)
    values = vars(thing)
    values.update(defaults)
    values.update(named)
    if args:
        if len(args) > len(places) or (named and not named.keys().isdisjoint(places[: len(args)])):
            _refuse(thing, args, named)
        values.update(zip(places, args, strict=False))
    for name, make in makers:
        if name not in values:
            values[name] = make()
    if len(values) != len(names) or not names.issuperset(named):
        _refuse(thing, args, named)
    for name, make in own:
        values[name] = make()
    if accepts and not (
        (not named or PLAIN.issuperset(map(type, named.values())))
        and (len(args) <= named_first or PLAIN.issuperset(map(type, args[named_first:])))
    ):
        thing._accept()  # noqa: SLF001, a method that classes have for this
    if checked:
        thing.__post_init__()


def _refuse(thing: Any, args: tuple[Any, ...], named: dict[str, Any]) -> None:
    """TypeError for a call that does not fit; `explain` of declarations gives classes a method that says more."""
    cls = type(thing)
    explained = getattr(cls, "_explained", None)
    if explained is not None:
        explained(cls, args, named)
    try:
        signature(cls).bind(*args, **named)
    except TypeError as error:
        raise TypeError(f"{cls.__name__}() does not take these arguments: {error}") from None


def signature(cls: Any) -> Signature:
    """How a dataclass is called: fields that may be positional, then the others."""
    from inspect import Parameter, Signature

    given = sorted((item for item in dataclasses.fields(cls) if item.init), key=lambda item: bool(item.kw_only))
    kinds = (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)
    return Signature([_parameter(item, kinds[bool(item.kw_only)]) for item in given], return_annotation=None)


def _parameter(item: Field[Any], kind: Any) -> Any:
    from inspect import Parameter

    default = Parameter.empty if item.default is dataclasses.MISSING else item.default
    if item.default_factory is not dataclasses.MISSING:
        default = FACTORY
    return Parameter(item.name, kind, default=default, annotation=item.type)


class LazySignature:
    """The signature of a class, made when it is asked for."""

    def __init__(self, made: Callable[[type], Signature]) -> None:
        self.made = made

    def __get__(self, thing: object, cls: type) -> Signature:
        return self.made(cls)


@recursive_repr()
def _repr(thing: Any) -> str:
    shown = ", ".join(f"{item.name}={getattr(thing, item.name)!r}" for item in dataclasses.fields(thing) if item.repr)
    return f"{type(thing).__qualname__}({shown})"


@cache
def _compared(cls: Any) -> Callable[[Any], Any]:
    """What gives the values that make things equal."""
    names = [item.name for item in dataclasses.fields(cls) if item.compare]
    # one name alone would give its value, not a tuple
    return attrgetter(*names) if len(names) > 1 else lambda thing: tuple(getattr(thing, name) for name in names)


def _values(thing: Any) -> Any:
    cls: Any = type(thing)
    return _compared(cls)(thing)


def _eq(one: Any, other: Any) -> Any:
    return _values(one) == _values(other) if type(one) is type(other) else NotImplemented


def _hash(thing: Any) -> int:
    return hash(_values(thing))


def _guarded(thing: Any, name: str) -> bool:
    """A class that is derived without a decorator may have attributes of its own."""
    return "__dataclass_fields__" in vars(type(thing)) or name in type(thing).__dataclass_fields__


def _setattr(thing: Any, name: str, value: Any) -> None:
    if _guarded(thing, name):
        raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")
    object.__setattr__(thing, name, value)


def _delattr(thing: Any, name: str) -> None:
    if _guarded(thing, name):
        raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")
    object.__delattr__(thing, name)


def _replace(thing: Any, /, **changes: Any) -> Any:
    return dataclasses.replace(thing, **changes)


def _fields(cls: Any, kw_only: bool) -> dict[str, Field[Any]]:
    """Fields by name, those of bases first."""
    found: dict[str, Any] = {}
    for base in cls.__mro__[-1:0:-1]:
        found |= vars(base).get("__dataclass_fields__", {})
    for name, kind in cls.__annotations__.items():
        if "ClassVar" in str(kind):
            continue
        default = vars(cls).get(name, dataclasses.MISSING)
        item: Any = default if isinstance(default, dataclasses.Field) else dataclasses.field(default=default)
        item.name, item.type, item._field_type = name, kind, _FIELD._field_type  # noqa: SLF001, as the standard does
        item.kw_only = kw_only if item.kw_only is dataclasses.MISSING else item.kw_only
        if type(item.default).__hash__ is None:
            raise ValueError(f"default of {cls.__name__}.{name} can be changed: give a default_factory")
        if item.default is not dataclasses.MISSING:
            setattr(cls, name, item.default)
        elif name in vars(cls):
            delattr(cls, name)
        found[name] = item
    return found


def _made(cls: Any, frozen: bool, own_repr: bool, eq: bool, kw_only: bool) -> Any:
    cls.__dataclass_fields__ = _fields(cls, kw_only)
    cls.__dataclass_params__ = vars(_Frozen if frozen else _Open)["__dataclass_params__"]
    cls.__init__, cls.__signature__, cls.__replace__ = _init, LazySignature(signature), _replace
    if frozen:
        cls.__setattr__, cls.__delattr__ = _setattr, _delattr
    if own_repr and "__repr__" not in vars(cls):
        cls.__repr__ = _repr
    if eq:
        # a class with an equality of its own, and none of this, has a hash of None
        hashed = vars(cls).get("__hash__") is not None
        if "__eq__" not in vars(cls):
            cls.__eq__ = _eq
        if not hashed:
            cls.__hash__ = _hash if frozen else None
    cls.__match_args__ = _call(cls).places  # type: ignore[misc]
    return cls


if not TYPE_CHECKING:

    def dataclass(
        cls: Any = None,
        /,
        *,
        frozen: bool = False,
        repr: bool = True,  # noqa: A002, as the standard library calls it
        eq: bool = True,
        kw_only: bool = False,
    ) -> Any:
        """Make a dataclass."""

        def wrap(cls: Any) -> Any:
            return _made(cls, frozen, repr, eq, kw_only)

        return wrap if cls is None else wrap(cls)

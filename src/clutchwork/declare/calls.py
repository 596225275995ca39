"""Wrong arguments of a call, all reported at once in the words of its declaration."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import is_dataclass
from types import FunctionType
from typing import Any, TypeVar

from clutchwork.base import UseError, counted, dataclass, listed, near, quote
from clutchwork.base.errors import nearest
from clutchwork.declare.expected_value import wanted
from clutchwork.declare.schema import specs

OWNERS = ("self", "cls")
F = TypeVar("F", bound=Callable[..., Any])
T = TypeVar("T", bound=type)
# what an argument of a function may be, where its declaration does not say more
SUCH = {
    "model": "d",
    "path": "'run.csv'",
    "folder": "'c'",
    "t_end": "2.0",
    "times": "[0.5, 1.0]",
    "time": "0.5",
    "dt": "0.01",
    "name": "'engine.speed'",
    "signal": "'engine.speed'",
    "unit": "'rpm'",
    "contact": "'c1'",
    "number": "0",
    "element": "'c1'",
    "changes": "{'c1.gain': 5e-4}",
    "vary": "{'c1.gain': [4e-4, 8e-4]}",
    "outputs": "['engine.speed']",
    "columns": "{'c1.gain': [4e-4, 8e-4]}",
    "frequencies": "[1.0, 10.0]",
}


def explained(call: str, **such: str) -> Callable[[F], F]:
    """Make a function raise a UseError that names every mistake of a call that does not fit its signature.

    Parameters: such, what arguments may be, as Python writes it, where that is not what `SUCH` says.
    """

    def wrap(function: F) -> F:
        @functools.wraps(function)
        def called(*args: Any, **named: Any) -> Any:
            try:
                return function(*args, **named)
            except TypeError:
                meanings = {name: f"give one, such as {name}={value}" for name, value in {**SUCH, **such}.items()}
                problems = list(_problems(function, args, named, meanings))
                if not problems:
                    raise
                raise UseError(call, problems) from None

        return called  # type: ignore[return-value]

    return wrap


def explained_methods(call: str) -> Callable[[T], T]:
    """The same for all public methods of a class that do not do so yet.

    Parameters: call, what messages call an object of the class.
    """

    def wrap(cls: T) -> T:
        for name, member in list(vars(cls).items()):
            if name.startswith("_") or (hasattr(member, "__wrapped__") and not isinstance(member, classmethod)):
                continue
            if isinstance(member, FunctionType):
                setattr(cls, name, explained(f"{call}.{name}")(member))
            elif isinstance(member, classmethod) and not hasattr(member.__func__, "__wrapped__"):
                setattr(cls, name, classmethod(explained(f"cw.{cls.__name__}.{name}")(member.__func__)))
        return cls

    return wrap


def explain(cls: Any, within: str = "cw") -> None:
    """The same for the constructor of a declaration, or of another class of a module."""
    if getattr(cls.__init__, "__module__", "") == dataclass.__module__:
        # which asks for this where a call does not fit, and costs nothing where it does
        cls._explained = staticmethod(functools.partial(_explained, within=within))
        return
    made = cls.__init__

    @functools.wraps(made)
    def construct(self: Any, *args: Any, **named: Any) -> None:
        try:
            made(self, *args, **named)
        except TypeError:
            _explained(cls, args, named, within)
            raise

    cls.__init__ = construct


def _explained(cls: Any, args: tuple[Any, ...], named: Mapping[str, Any], within: str = "cw") -> None:
    """A UseError that names every mistake of a call, if there is any."""
    problems = list(_problems(cls, args, named, _meanings(cls)))
    if problems:
        raise UseError(f"{within}.{cls.__name__}({_name(args, named)})", problems) from None


def _name(args: tuple[Any, ...], named: Mapping[str, Any]) -> str:
    name = args[0] if args else named.get("name")
    return quote(name).replace("'", '"') if isinstance(name, str) else ""


def _meanings(cls: type) -> dict[str, str]:
    """What each field expects; the unit of what a signal drives is left open."""
    if not is_dataclass(cls):
        return {}
    return {
        item.name: f"give {wanted(spec, spec.unit).replace(' in [*]', '').replace(' and [*]', '')}: {spec.doc}"
        for item, spec in specs(cls)
    }


def _problems(
    function: Callable[..., Any], args: tuple[Any, ...], named: Mapping[str, Any], meanings: Mapping[str, str]
) -> Iterator[str]:
    """Arguments that do not fit the parameters of a function; empty if all do."""
    parameters = list(inspect.signature(function).parameters.values())
    any_number = any(p.kind is p.VAR_POSITIONAL for p in parameters)
    by_place = [p.name for p in parameters if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]
    known = [p.name for p in parameters if p.name not in OWNERS and p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)]
    open_ended = any(p.kind is p.VAR_KEYWORD for p in parameters)
    given = {*by_place[: len(args)], *named}
    open_names = [other for other in known if other not in given]
    unknown = [name for name in named if name not in known]
    if open_ended:
        # others may be options: only what stands for an argument that is missing is none
        lacking = [p.name for p in parameters if p.name in open_names and p.default is p.empty]
        unknown = [name for name in unknown if nearest(name, lacking)]
    meant = {nearest(name, open_names) for name in unknown}
    spare = () if any_number else args[len(by_place) :]
    if spare:
        # those that must be given first
        rest = sorted((p for p in parameters if p.name in known), key=lambda p: p.default is not p.empty)
        yield _spare(spare, [p for p in by_place if p not in OWNERS], [p.name for p in rest if p.name not in given])
    for name in set(by_place[: len(args)]) & set(named):
        yield f"{name} is given twice, by position and by keyword; give it once"
    fields = f"known fields: {listed(known)}"
    for name in unknown:
        # the list of all is only said once, and not where a near one says enough
        said = near(name, known)
        yield f"unknown field {quote(name)}{said or (fields and f'; {fields}')}"
        fields = fields if said else ""
    filled = min(len(args), len(by_place)) if any_number else len(args)
    for p in parameters[filled:]:
        lacks = p.default is p.empty and p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY) and p.name not in named
        # values by place are meant for some of them, and so is a name close to theirs
        if lacks and p.name not in meant and not (spare and p.kind is p.KEYWORD_ONLY):
            yield f"{p.name} is missing; {meanings.get(p.name, f'give {p.name}=...')}"


def _spare(spare: tuple[Any, ...], by_place: list[str], known: list[str]) -> str:
    if by_place == ["points"] and hasattr(spare[0], "__len__"):
        return "times and values are given apart; write pairs: cw.Table([(0, 0), (1, 2e5)])"
    if by_place == ["names"] and isinstance(spare[0], str):
        return f"names are given apart; write a list of all, such as ['F1.gain', {quote(spare[0])}]"
    listed, verb = " and ".join(by_place), "is" if len(by_place) == 1 else "are"
    first = f"only {listed} {verb} positional" if by_place else "none can be given"
    example = ", ".join(f"{name}=..." for name in known[: len(spare)])
    such = f", such as {example}" if example else ""
    return f"{counted(len(spare), 'positional values')} too many: {first}; give them by keyword{such}"

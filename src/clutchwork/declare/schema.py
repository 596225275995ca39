"""How a component is declared: ports, parameters, curves, signals, states.

Standard library only, because the build imports the declarations before a compiled core exists.
A declaration is a frozen dataclass whose fields carry their unit, meaning and bounds as metadata.
The C++ header of the same stem holds the equations; `tools/gen_registry.py` pairs the two.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import MISSING, Field, field, fields
from functools import cache
from math import inf, nextafter
from typing import Any, TypeAlias, TypeVar, dataclass_transform

from clutchwork.base.classes import PLAIN, dataclass
from clutchwork.declare.hooks import hook_problems
from clutchwork.declare.registry import REGISTRY as REGISTRY
from clutchwork.declare.registry import Role as Role


@dataclass(frozen=True)
class State:
    """A continuous state that a component owns: name, unit, meaning.

    Where it follows the rate of its component, as a deflection does, an error of it counts no more than that of the
    rate would over `span` [s]. docs/theory/integrators.md An angle that starts again has a `turn` after which it does.
    """

    name: str
    unit: str
    doc: str
    span: float = 0.0
    turn: float = 0.0  # rad


@dataclass(frozen=True)
class Way:
    """A direction along which an element acts: name, meaning.

    An element of several ways sees the rates of all and gives a torque along each; a `watched` one gets none. The
    domain is that of its rate and torque, "rotation" or "translation"; empty: that of its ports. docs/theory/coupled.md
    """

    name: str
    doc: str
    watched: bool = False
    domain: str = ""


@dataclass(frozen=True)
class Spec:
    """Metadata of one declared field."""

    # "port" | "thermal" (port) | "param" | "curve" | "numbers" | "formula" | "signal" | "law" of the core;
    # "alternative" (to another signal) | "option" | "text" | "function" for Python alone;
    # "named" (numbers), "elements" and "data", tables that a composite reads
    what: str
    unit: str  # SI; "*" in a signal: the unit of what it drives
    doc: str
    optional: bool = False
    above: float | None = None
    at_least: float | None = None
    below: float | None = None
    at_most: float | None = None
    unit_x: str = ""
    units_x: tuple[str, ...] = ()
    units: tuple[str, ...] = ()  # further SI units that the quantity may have
    domain: str = ""  # of a port: "rotation" or "translation"; empty: the same as its fellow ports
    instead_of: str = ""  # of an alternative: the signal that it stands for
    gain: tuple[str, ...] = ()  # of a signal: units that the parameter `gain` has when it is given
    otherwise: float | None = None  # of a signal: its value when neither it nor its alternative is given
    draws: bool = False  # of a signal: its reader takes a flow from a process that gathers, by the hook `drawn`
    presses: bool = False  # of a signal: below zero it counts as zero, so that a constant below zero never acts
    clips: bool = False  # of a signal: below zero it counts as zero, which is no mistake
    flag: bool = False  # true or false in Python, 1 or 0 in the core
    fixed: bool = False  # says how many states there are: it stays while a run goes on
    whole: bool = False  # a whole number
    rising: str = ""  # of a curve: "strictly", or "weakly" where equal x mean a jump
    constant: bool = False  # of a curve: a number stands for the same value everywhere
    rows: bool = False  # of numbers: rows of equally many
    choices: tuple[str, ...] = ()  # a text in Python, its place among these in the core
    example: Any = None  # a value that fits the examples of the other fields
    last: int = 0  # in files and tables it stands behind its own fields, those with more further back
    difference: bool = False  # of two values, so that of temperatures it has no zero in degrees Celsius

    @property
    def bound(self) -> str:
        """The bound in words, empty when there is none."""
        signs = ((">", self.above), (">=", self.at_least), ("<", self.below), ("<=", self.at_most))
        return " and ".join(f"{sign} {value:g}" for sign, value in signs if value is not None)

    def allows(self, value: float) -> bool:
        """Whether a finite number is within the bound."""
        return (
            (self.above is None or value > self.above)
            and (self.at_least is None or value >= self.at_least)
            and (self.below is None or value < self.below)
            and (self.at_most is None or value <= self.at_most)
        )

    @property
    def ends(self) -> tuple[float, float]:
        """The smallest and the largest number within the bound, infinite where there is none."""
        lower = [-inf if self.above is None else nextafter(self.above, inf)]
        upper = [inf if self.below is None else nextafter(self.below, -inf)]
        lower += [] if self.at_least is None else [self.at_least]
        upper += [] if self.at_most is None else [self.at_most]
        return max(lower), min(upper)


def common_ends(found: Iterable[Spec]) -> tuple[float, float]:
    """The smallest and the largest number that all of them allow."""
    lower, upper = zip(*(spec.ends for spec in found), strict=True)
    return max(lower), min(upper)


def _field(spec: Spec, default: Any, kw_only: bool = True) -> Any:
    return field(default=default, metadata={"spec": spec}, kw_only=kw_only)


def port(
    doc: str,
    *,
    default: None = MISSING,  # type: ignore[assignment]
    domain: str = "",
    last: int = 0,
) -> Any:
    """What the component is attached to: a shaft, a mass or the housing; with default None: the housing.

    In the domain "thermal" it is a thermal node or an ambient, with default None: nothing.
    """
    what = "thermal" if domain == "thermal" else "port"
    return _field(Spec(what, "", doc, default is None, domain=domain, last=last), default)


def param(
    unit: str,
    doc: str,
    *,
    default: float | None = MISSING,  # type: ignore[assignment]
    above: float | None = None,
    at_least: float | None = None,
    below: float | None = None,
    at_most: float | None = None,
    units: tuple[str, ...] = (),
    whole: bool = False,
    example: float | None = None,
    difference: bool = False,
    fixed: bool = False,
    kw_only: bool = True,
) -> Any:
    """A constant number in SI units: one scalar of the C++ `Params`, in order of declaration.

    A `difference` of temperatures is never in degrees Celsius. What is `fixed` says how many states there are.
    """
    bounds = (above, at_least, below, at_most)
    more: dict[str, Any] = {"units": units, "whole": whole, "example": example, "difference": difference}
    more["fixed"] = fixed
    spec = Spec("param", unit, doc, default is None, *bounds, **more)
    return _field(spec, default, kw_only)


def flag(doc: str, *, default: bool = MISSING) -> Any:  # type: ignore[assignment]
    """True or false in Python, a scalar 1 or 0 of the C++ `Params`."""
    return _field(Spec("param", "1", doc, flag=True), default)


def choice(doc: str, *, choices: tuple[str, ...], default: str | None = MISSING) -> Any:  # type: ignore[assignment]
    """One of several words in Python, a `Word` of the C++ `Params`, whose enum the build writes from the words.

    A composite may have one with default None.
    """
    return _field(Spec("param", "1", doc, default is None, choices=choices), default)


def curve(
    unit_x: str,
    unit_y: str,
    doc: str,
    *,
    units: tuple[str, ...] = (),
    units_x: tuple[str, ...] = (),
    rising: str = "strictly",
    at_least: float | None = None,
    constant: bool = False,
    default: None = MISSING,  # type: ignore[assignment]
    example: tuple[tuple[float, float], ...] | None = None,
    kw_only: bool = True,
) -> Any:
    """A piecewise linear function as (x, y) points with x increasing: a `Curve` of the C++ `Params`.

    `at_least` bounds y; with `constant` a number may stand for one point. A composite may have one with default None.
    """
    ranges: dict[str, Any] = {"unit_x": unit_x, "units": units, "units_x": units_x, "at_least": at_least}
    spec = Spec("curve", unit_y, doc, default is None, **ranges, rising=rising, constant=constant, example=example)
    return _field(spec, default, kw_only)


def numbers(
    unit: str,
    doc: str,
    *,
    default: None = MISSING,  # type: ignore[assignment]
    units: tuple[str, ...] = (),
    rising: str = "",
    above: float | None = None,
    at_least: float | None = None,
    rows: bool = False,
    example: tuple[Any, ...] | None = None,
) -> Any:
    """A list of numbers, or with `rows` rows of equally many: a `Curve` of the C++ `Params` with points of one number.

    Rows stand one after another. With `rising` "strictly" each number must be above the one before. Left out, where it
    may be, a single zero stands for it there.
    """
    bounds: dict[str, Any] = {"above": above, "at_least": at_least, "rising": rising}
    spec = Spec("numbers", unit, doc, default is None, **bounds, units=units, rows=rows, example=example)
    return _field(spec, default)


def signal(
    unit: str,
    doc: str,
    *,
    default: float | None = MISSING,  # type: ignore[assignment]
    above: float | None = None,
    at_least: float | None = None,
    below: float | None = None,
    at_most: float | None = None,
    units: tuple[str, ...] = (),
    gain: tuple[str, ...] = (),
    instead_of: str = "",
    otherwise: float | None = None,
    presses: bool = False,
    clips: bool = False,
    draws: bool = False,
    example: float | None = None,
) -> Any:
    """An input: a number, a Signal, a thermal node (its temperature), a process (its first state), or (process, state).

    It may be a shaft (its speed), and that of flows and processes `Rate`, `HeatFlow` and `SupplyPower` of an element.
    The C++ functions get them by name, as `at.input[Input::pressure]`.

    Bounds hold for what the model knows in advance: a number, and every value that a Signal takes at or after 0 s. What
    another component or a controller gives is not bounded.

    With `instead_of` it is another way to give the signal of that name: exactly one of them is given, or
    none where that signal has a value `otherwise`. With `presses` a constant below zero is warned of; it stands in
    pictures, and so does a signal with a `gain`, the units of the parameter that multiplies it. One that `clips` counts
    as zero below it. One that `draws` is a port of a process: where a process that `gathers` gives it, that loses the
    flow which the hook `drawn` says.
    """
    what = "alternative" if instead_of else "signal"
    ranges: dict[str, Any] = {"above": above, "at_least": at_least, "below": below, "at_most": at_most}
    ways: dict[str, Any] = {"gain": gain, "instead_of": instead_of, "otherwise": otherwise, "presses": presses}
    ways |= {"draws": draws, "clips": clips}
    return _field(Spec(what, unit, doc, default is None, **ranges, **ways, units=units, example=example), default)


def formula(doc: str, *, default: None = MISSING, kw_only: bool = True, example: Any = None) -> Any:  # type: ignore[assignment]
    """An expression, or several by name: a `Curve` of the C++ `Params` with the code words of the law."""
    return _field(Spec("formula", "1", doc, default is None, example=example), default, kw_only)


def law(doc: str, *, default: object = MISSING) -> Any:
    """The friction law of a contact."""
    return _field(Spec("law", "1", doc), default)


def option(
    unit: str,
    doc: str,
    *,
    default: float | None = MISSING,  # type: ignore[assignment]
    above: float | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
    units: tuple[str, ...] = (),
    flag: bool = False,
    last: int = 0,
    example: float | None = None,
) -> Any:
    """A setting that only the assembly reads: it is not part of the C++ `Params`."""
    bounds = (above, at_least, None, at_most)
    spec = Spec("option", unit, doc, default is None, *bounds, units=units, flag=flag, last=last, example=example)
    return _field(spec, default)


def text(doc: str, *, default: str | None = MISSING, kw_only: bool = True) -> Any:  # type: ignore[assignment]
    """A path or a name."""
    return _field(Spec("text", "", doc, default is None), default, kw_only)


def named(
    unit: str,
    doc: str,
    *,
    above: float | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
    example: dict[str, float] | None = None,
) -> Any:
    """Numbers by the names of what a composite is made of: `{"S1": 0.02}`; none by default."""
    spec = Spec("named", unit, doc, True, above, at_least, None, at_most, example=example)
    return _field(spec, None)


def elements(doc: str) -> Any:
    """Elements of a composite by their names in it: for each a table of its fields, without the ports, and its `type`.

    The composite says by its hook `entries` what these are. None by default.
    """
    return _field(Spec("elements", "", doc, True), None)


def data(doc: str, *, example: Any = None) -> Any:
    """What a composite is built from: an object, a name, the path of a TOML or JSON file, or the content of one."""
    return _field(Spec("data", "", doc, example=example), MISSING)


def function(doc: str, *, kw_only: bool = True) -> Any:
    """A Python function; a model file cannot hold one."""
    return _field(Spec("function", "", doc), MISSING, kw_only)


C = TypeVar("C", bound=type)


def _check_work(cls: Any) -> None:
    words = {part.name for part in getattr(cls, "work", ())}
    if {"SOURCE", "LOSS"} <= words:
        remedy = "declare Work.SOURCE alone: what its thermal node takes is heat"
        raise TypeError(
            f"{cls.__module__}: the work of {cls.__name__} cannot be told apart as source and loss; {remedy}"
        )


@dataclass_transform(
    kw_only_default=True,
    frozen_default=True,
    field_specifiers=(port, param, flag, choice, curve, numbers, formula, signal, law, option),
)
def family(cls: C) -> C:
    """Freeze fields that several declarations share, as a base class that is not a declaration itself."""
    frozen: Any = dataclass(frozen=True, repr=False)(cls)
    return frozen  # type: ignore[no-any-return]


# what acts along one direction, and the ports that say which
RATES = (Role.TORQUE, Role.CONTACT, Role.MOTION)
ENDS = (["base", "follower"], ["shaft", "base"], ["shaft"])


def _check_ports(cls: type) -> None:
    names = [item.name for item, _ in specs(cls, "port")]
    if names not in ENDS:
        allowed = " or ".join(", ".join(ports) for ports in ENDS)
        raise TypeError(f"{cls.__module__}: ports of {cls.__name__} are {', '.join(names)}; declare {allowed}")


@dataclass_transform(
    kw_only_default=True,
    frozen_default=True,
    field_specifiers=(
        port,
        param,
        flag,
        choice,
        curve,
        numbers,
        formula,
        signal,
        law,
        option,
        text,
        function,
        named,
        elements,
        data,
    ),
)
def component(
    role: Role, *, states: tuple[State, ...] = (), hooks: tuple[str, ...] = (), ways: tuple[Way, ...] = ()
) -> Callable[[C], C]:
    """Freeze a declaration, register it under its kind, the stem of its module; `hooks`: clutchwork.declare.hooks.

    Parameters: ways, where its `directions` are others than follower - base, or shaft - base.
    """

    def register(cls: C) -> C:
        frozen: Any = dataclass(frozen=True, repr=False)(cls)
        kind = cls.__module__.rpartition(".")[2]
        wrong = hook_problems(role.value, hooks)
        if wrong:
            raise ValueError(f"{cls.__module__.replace('.', '/')}.py: {'; '.join(wrong)}")
        if role in RATES and not ways:
            _check_ports(cls)
        _check_work(cls)
        frozen.kind, frozen.role, frozen.states, frozen.hooks, frozen.ways = kind, role, states, hooks, ways
        REGISTRY[role].add(kind, frozen)
        # a signal may have values with units, whose meaning depends on what it drives
        PLAIN.update(() if role is Role.SIGNAL else (frozen,))
        schema_hash.cache_clear()
        return cls

    return register


PORTS = ("port", "thermal")
# sorts of fields that are words of the core
WORDS = ("param", "curve", "numbers", "formula")
Declared: TypeAlias = "tuple[tuple[Field[Any], Spec], ...]"
Inputs: TypeAlias = "tuple[tuple[tuple[str, ...], Spec], ...]"


def specs(cls: type, *what: str) -> Declared:
    """The declared fields of a component, in order; optionally only of some sorts."""
    return _specs(cls, what)


@cache
def _specs(cls: Any, what: tuple[str, ...]) -> Declared:
    found = [(item, item.metadata["spec"]) for item in fields(cls) if "spec" in item.metadata]
    # ports come first, also those that a base knows nothing of; sorting keeps the order of equals
    ordered = sorted(found, key=lambda pair: (pair[1].last, pair[1].what not in PORTS))
    return tuple((item, spec) for item, spec in ordered if not what or spec.what in what)


def inputs(cls: type) -> Inputs:
    """The inputs of a component in order: the names under which each can be given, and its spec."""
    return _inputs(cls)


@cache
def _inputs(cls: Any) -> Inputs:
    others = [(item.name, spec.instead_of) for item, spec in specs(cls, "alternative")]
    return tuple(
        ((item.name, *(name for name, stands_for in others if stands_for == item.name)), spec)
        for item, spec in specs(cls, "signal")
    )


def kinds(role: Role) -> list[str]:
    """The kinds of a role in the order of their number in the compiled core."""
    return list(REGISTRY[role])


COMPILED_ROLES = (Role.TORQUE, Role.CONTACT, Role.LAW, Role.FLOW, Role.PROCESS)


def schema_text() -> str:
    """Everything that the compiled core must agree on, as a string."""
    return "\n".join(compiled_text(cls) for role in COMPILED_ROLES for cls in REGISTRY[role].values())


def compiled_text(cls: Any) -> str:
    """What the compiled core must agree on of one declaration."""
    names = ",".join(_field_text(f.name, s) for f, s in specs(cls, *WORDS, "signal"))
    sort = "" if cls.role is not Role.LAW else " sticks" if cls.sticks else " compliant"
    ways = "".join(f" {way.name}" for way in cls.ways) if len(cls.ways) > 1 else ""
    gathers = " gathers" if getattr(cls, "gathers", False) else ""
    code = "".join(f" {word}" for word in getattr(cls, "code_words", ()))
    return f"{cls.role.value} {cls.kind} {names} {len(cls.states)}{sort}{ways}{gathers}{code}"


def _field_text(name: str, spec: Spec) -> str:
    choices = f"{{{'|'.join(spec.choices)}}}" if spec.choices else ""
    return f"{name}:{spec.what}[{spec.unit}]{choices}"


@cache
def schema_hash(extra: str = "") -> int:
    """63-bit fingerprint of every declaration and of the System layout."""
    # loading it takes as long as a third of the declarations
    import hashlib

    digest = hashlib.sha256((schema_text() + extra).encode()).digest()
    return int.from_bytes(digest[:8], "little") >> 1

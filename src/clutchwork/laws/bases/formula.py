"""Common base of laws given by expressions: named numbers, and their checks."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import MISSING
from functools import lru_cache
from keyword import iskeyword
from numbers import Real
from typing import Any, ClassVar, NamedTuple

from clutchwork.base import dataclass
from clutchwork.base.errors import nearest
from clutchwork.base.memoize import memoize
from clutchwork.declare import Law, SignalLike, family, formula, param, signal, units
from clutchwork.declare.pints import is_quantity
from clutchwork.declare.pints import powers_of as powers_of_pint
from clutchwork.declare.schema import specs
from clutchwork.laws.bases.dimensions import mistakes_of_units
from clutchwork.laws.bases.expression import FUNCTIONS, INPUTS, PRESSURE, TEMPERATURE, Mistake
from clutchwork.laws.bases.jumps import first_jump, where
from clutchwork.laws.bases.program import OPERATIONS, Points, Program, Texts, compiled

Found = list[tuple[str, str, str]]

# names that mean something else where a law stands
TAKEN = {*INPUTS, *FUNCTIONS, "type", "unit", "name", "e", "pi"}
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
# slips [rad/s], temperatures [K] and pressures [Pa] at which a formula is looked at: in equal steps, and closer to rest
SLIPS = tuple(
    sorted({0.0, 1e-3, 1e-2, 0.03, 0.1, 0.3, *(0.5 * k for k in range(1, 61)), *(2.0 * k for k in range(15, 151))})
)
TEMPERATURES = (250.0, 300.0, 400.0, 500.0)
PRESSURES = (1e4, 1e5, 1e6, 5e6)
ROUND_OFF = 1e-12


class Number(NamedTuple):
    """A number that a formula names: its name, and its unit in SI."""

    name: str
    unit: str


@family
class FormulaLaw(Law):
    """A law whose equations are expressions of the model over named numbers: `v_s="0.1 rad/s"`."""

    # a call may have numbers of any name
    takes_numbers: ClassVar[bool] = True
    numbers: ClassVar[tuple[Number, ...]] = ()
    code_words: ClassVar[tuple[str, ...]] = OPERATIONS  # by whose numbers the core reads its code
    written: ClassVar[type | None] = None  # what it was made from, with a field for each number

    expression: str = formula(
        "coefficient over the slip `v` [rad/s], `temperature` [K], `pressure` [Pa] and the numbers of the law",
        kw_only=False,
        example="0.1 + 0.05*exp(-v/2)",
    )
    at_rest: str | None = formula("coefficient at rest, in the same names but the slip", default=None)
    temperature: SignalLike | None = signal(
        "K", "temperature of the lining, for `temperature`", default=None, otherwise=300.0
    )
    pressure: SignalLike | None = signal("Pa", "pressure of the contact, for `pressure`", default=None, otherwise=1e5)

    def __new__(cls, *_: Any, **given: Any) -> FormulaLaw:
        return object.__new__(cls.declared_by(given))

    def __reduce__(self) -> tuple[Any, ...]:
        own: Any = type(self)
        values = {name: getattr(self, name) for name in own.__dataclass_fields__}
        return _made, (own.written or own, own.numbers, values)

    @classmethod
    def declared_by(cls, given: Mapping[str, Any]) -> type:
        """The declaration with a field for each number that a call names."""
        if cls.numbers:
            return cls
        fields = {item.name: item.default is MISSING for item, _ in specs(cls)}
        # a name that is like one that must be given is meant for that
        missing = [name for name, needed in fields.items() if needed and name not in given]
        own = sorted(name for name in given if _is_free(name) and name not in fields and not nearest(name, missing))
        return _with_numbers(cls, tuple(Number(name, _unit(given[name])) for name in own)) if own else cls

    def rate_texts(self) -> Mapping[str, Any]:
        """The rate of each state by its name."""
        return {}

    @property
    def _program(self) -> tuple[Program | None, tuple[Mistake, ...]]:
        names = tuple(one.name for one in type(self).numbers)
        rates = tuple((name, _text(rate)) for name, rate in self.rate_texts().items())
        return compiled(Texts(_text(self.expression), _text(self.at_rest), rates, names, self.sticks))

    @property
    def bends(self) -> bool:
        """Whether an operation of its expressions has a kink or a jump."""
        program, _ = self._program
        return program is not None and program.bends

    def reads(self, name: str) -> bool:
        """Whether it reads an input."""
        program, _ = self._program
        return program is None or name in program.reads

    def code(self, field: str) -> Points:
        """What the core gets for a field that is written as an expression."""
        program, _ = self._program
        if program is None:
            raise ValueError(f"{self.expression!r} is not a formula")
        return {"expression": program.code, "at_rest": program.head, "rates": program.rate_words}[field]

    def problems(self) -> Found:
        return list(self._problems())

    @memoize
    def _problems(self) -> Found:
        # asked for with every change of a driveline that keeps the law
        program, mistakes = self._program
        found = [(one.field, one.message, one.remedy) for one in mistakes]
        if program is None:
            return found
        found += self._of_units(program, "rad/s", "m/s")
        found += _unread(self, program)
        return found or next(self.faults(program), [])

    def slip_problems(self, unit: str) -> Found:
        program, _ = self._program
        found = [] if program is None else self._of_units(program, unit)
        kind = "shafts" if unit == "rad/s" else "masses"
        return [(name, f"{fault}, with the slip of {kind} [{unit}]", remedy) for name, fault, remedy in found]

    def _of_units(self, program: Program, *slips: str) -> Found:
        """What does not fit; where no number has a unit, all are in those of SI."""
        given = {one.name: one.unit for one in type(self).numbers if one.unit != "1"}
        wrong = mistakes_of_units(program, given, slips) if given else []
        return [(one.field, one.message, one.remedy) for one in wrong]

    def advice(self) -> Found:
        spare = [name for name in INPUTS[1:] if getattr(self, name) is not None and not self.reads(name)]
        return [(name, "is in no expression", "remove it, or use it in an expression") for name in spare]

    def slip_advice(self, unit: str) -> Found:
        jump, remedy = self.jump(unit)
        return [("expression", f"{jump}, where no step ends and gradients do not exist", remedy)] if jump else []

    @memoize
    def jump(self, unit: str) -> tuple[str, str]:
        """Where it jumps within the inputs of its check, "jumps from 0.4 to 0.2 at a slip of 3 rad/s", and a remedy.

        Both are empty where it does not. Parameters: unit, that of the slip.
        """
        program, _ = self._program
        found = None if program is None else first_jump(program, self.places(program), self.slips())
        if program is None or found is None:
            return "", ""
        text = f"jumps from {found.before:g} to {found.after:g}"
        if found.from_rest and found.of_coefficient:
            given = f"and give what holds at rest as at_rest={found.before:g}"
            rest = f"leave the condition out of it, {given if self.at_rest is None else 'for at_rest holds there'}"
            return f"{text} between rest and the least slip", rest
        remedy = "make it continuous, or take a FrictionTable, whose points end steps"
        return f"{text} {where(program, found.at, unit)}", remedy

    def slips(self) -> tuple[float, ...]:
        """Slips at which it is checked, rising."""
        return SLIPS

    def values(self) -> dict[str, float]:
        """Its numbers by name."""
        return {one.name: float(getattr(self, one.name)) for one in type(self).numbers}

    def faults(self, program: Program) -> Iterator[Found]:
        """What is wrong with the values of a formula at the points where it is checked."""
        raise NotImplementedError

    def places(self, program: Program) -> list[dict[str, float]]:
        """Inputs other than the slip at which it is checked."""
        warm: Sequence[float] = TEMPERATURES if TEMPERATURE in program.reads else (300.0,)
        pressed: Sequence[float] = PRESSURES if PRESSURE in program.reads else (1e5,)
        if isinstance(self.temperature, Real):
            warm = (float(self.temperature),)
        if isinstance(self.pressure, Real):
            pressed = (float(self.pressure),)
        return [{**self.values(), TEMPERATURE: t, PRESSURE: p} for t in warm for p in pressed]


def _text(value: Any) -> Any:
    """The text of an expression; empty if it is not one."""
    return value if value is None or isinstance(value, str | int | float) else ""


def no_number(program: Program, registers: Sequence[float], at: Mapping[str, float]) -> Found:
    """A part that has no finite value."""
    source = program.first_fault(registers)
    if source is None:
        return []
    remedy = "keep it away from division by zero, and from roots, logarithms and powers of negative numbers"
    return [(source.field, f"has no finite value in {source} {where(program, at)}", remedy)]


def _unread(law: FormulaLaw, program: Program) -> Found:
    """Numbers that stand in no expression, and a pressure that is read and not given."""
    names = [one.name for one in type(law).numbers]
    found = [
        (name, "is in no expression", "remove it, or use it in an expression")
        for name in names
        if name not in program.reads
    ]
    if law.pressure is None and PRESSURE in program.reads:
        found.append((PRESSURE, "is missing", "give the law the pressure [Pa] that its contact has"))
    return found


def _is_free(name: Any) -> bool:
    """Whether a number may have a name."""
    known = isinstance(name, str) and NAME.fullmatch(name) is not None and not iskeyword(name)
    return known and name not in TAKEN and (name in ("static", "kinetic") or not hasattr(FormulaLaw, name))


def _unit(value: Any) -> str:
    """The SI unit of a number as it is given; 1 if it has none, or an unknown one."""
    if isinstance(value, Mapping):
        value = f"1 {value.get('unit', '')}"
    try:
        if is_quantity(value):
            return in_si(tuple(int(power) for power in powers_of_pint(value)))
        parts = units.split(value) if isinstance(value, str) else None
        if parts is None or not parts[1]:
            return "1"
        return "K" if units.other_zero(parts[1]) else in_si(units.parse(parts[1]).powers)
    except Exception:
        return "1"


# how units are usually written
USUAL = ("rad/s", "rad", "1/rad", "s/rad", "m/s", "s/m", "1/s", "s", "K", "1/K", "Pa", "1/Pa", "N", "N m", "J", "W")
BASES = ("kg", "m", "s", "rad", "K", "A")


@lru_cache(200)
def in_si(powers: tuple[int, ...]) -> str:
    """A unit of SI with these powers of kg, m, s, rad, K and A."""
    usual = next((unit for unit in USUAL if units.powers_of(unit) == powers), "")
    if usual or not any(powers):
        return usual or "1"
    above = [_power(name, power) for name, power in zip(BASES, powers, strict=True) if power > 0]
    below = [_power(name, -power) for name, power in zip(BASES, powers, strict=True) if power < 0]
    under = f"/({' '.join(below)})" if len(below) > 1 else f"/{below[0]}" if below else ""
    return (" ".join(above) or "1") + under


def _power(name: str, power: int) -> str:
    return name if power == 1 else f"{name}{power}"


@lru_cache(1000)
def _with_numbers(cls: Any, numbers: tuple[Number, ...]) -> type:
    """A declaration with a field for each number, which counts as the one it is derived from."""
    fields = {one.name: param(one.unit, f"{one.name} of the formula") for one in numbers}
    body = {
        **fields,
        "__annotations__": dict.fromkeys(fields, "float"),
        "__module__": cls.__module__,
        "__qualname__": cls.__qualname__,
        "__doc__": cls.__doc__,
        "numbers": numbers,
        "written": cls,
    }
    made: Any = dataclass(frozen=True, repr=False)(type(cls)(cls.__name__, (cls,), body))
    return made  # type: ignore[no-any-return]


def _made(cls: Any, numbers: tuple[Number, ...], values: dict[str, Any]) -> Any:
    """A law from its numbers and the values of all fields."""
    own: Any = _with_numbers(cls, numbers) if numbers else cls
    return own(**values)

"""How one option of a run is declared: unit, meaning, default, bounds, and what it is to the compiled core."""

from __future__ import annotations

import math
from dataclasses import field
from numbers import Real
from typing import Any, NamedTuple

from clutchwork.base import dataclass, near, quote
from clutchwork.declare.quantity import QuantityError, has_unit, in_si
from clutchwork.declare.schema import Spec
from clutchwork.declare.to_si import field_in_si
from clutchwork.declare.wording import say

# beyond these the square or the reciprocal of a number leaves double precision
LEAST, MOST = 1e-300, 1e300


class Invalid(NamedTuple):
    """What is wrong with a value."""

    value: str  # "-1 s" as it was given
    message: str  # "must be a finite number above 0"
    remedy: str


@dataclass(frozen=True)
class Setting:
    """One row of the table of options."""

    spec: Spec
    default: Any
    core: bool = False  # the compiled core knows it, by the same name
    unset: float = 0.0  # the number that is None in the core

    @property
    def least(self) -> float:
        """The smallest number that is allowed; a flag is 0 or 1, a word its index."""
        if self.spec.above is not None:
            return max(LEAST, math.nextafter(self.spec.above, math.inf))
        return float(self.spec.at_least or 0.0)

    @property
    def most(self) -> float:
        """The largest number that is allowed."""
        if self.spec.flag or self.spec.choices:
            return float(max(1, len(self.spec.choices) - 1))
        return MOST if self.spec.at_most is None else self.spec.at_most

    @property
    def whole(self) -> bool:
        """Whether the core takes only whole numbers."""
        return self.spec.whole or self.spec.flag or bool(self.spec.choices)

    @property
    def unit(self) -> str:
        """The unit as it stands behind a number, with a blank; that of a bare number is empty."""
        return "" if self.spec.unit in ("", "1") else f" {self.spec.unit}"

    def number(self, value: Any) -> float:
        """A valid value as the number that the core takes."""
        if value is None:
            return self.unset
        return float(self.spec.choices.index(value) if self.spec.choices else value)

    def in_si(self, value: Any) -> Any:
        """A value in SI if it has a unit that fits; any other unchanged."""
        spec = self.spec
        if type(value) is float or spec.flag or spec.choices or spec.whole:
            return value
        return field_in_si(value, spec)

    def fault(self, value: Any) -> Invalid | None:
        """What is wrong with a value; lists of numbers are looked at where they are used."""
        spec, value = self.spec, self.in_si(value)
        if spec.what == "numbers" or (value is None and spec.optional):
            return None
        if spec.choices:
            if isinstance(value, str) and value in spec.choices:
                return None
            return Invalid(quote(value), f"must be one of {', '.join(spec.choices)}{near(value, spec.choices)}", "")
        if spec.flag:
            if isinstance(value, bool):
                return None
            return Invalid(quote(value), say("must be true or false", "must be True or False"), f"it says {spec.doc}")
        if has_unit(value):
            return self.unit_fault(value)
        message = self._wrong(_as_number(value))
        return Invalid(self._shown(value), message, f"it is the {spec.doc}") if message else None

    def unit_fault(self, value: Any) -> Invalid:
        """Why a string or a quantity of pint is not a number of this option."""
        try:
            in_si(value, self.spec.unit)
        except QuantityError as bad:
            return Invalid(bad.value, bad.message, bad.remedy)
        return Invalid(
            quote(value), f"must be a {'whole ' if self.spec.whole else ''}number", f"it is the {self.spec.doc}"
        )

    def _wrong(self, number: float | None) -> str:
        """The bound that a number violates, empty if none."""
        spec = self.spec
        if spec.whole and (number is None or math.isnan(number) or (math.isfinite(number) and number % 1.0)):
            return "must be a whole number"
        if number is None:
            return f"must be a number in{self.unit}" if self.unit else "must be a number"
        if not spec.whole and (not math.isfinite(number) or self._is_too_low(number)):
            low = f"of at least {spec.at_least:g}" if spec.above is None else f"above {spec.above:g}"
            return f"must be a finite number {low}"
        if number < self.least:
            return f"must be at least {self.least:g}"
        return f"must be at most {self.most:.16g}" if number > self.most else ""

    def _is_too_low(self, number: float) -> bool:
        """Whether a number is not above zero, or the bound where there is one; zero itself may be allowed."""
        return number <= (self.spec.above or 0.0) and number != self.spec.at_least

    def _shown(self, value: Any) -> str:
        number = _as_number(value)
        return quote(value) if number is None or self.spec.whole else f"{number:g}{self.unit}"


def setting(
    unit: str,
    doc: str,
    *,
    default: Any,
    above: float | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
    choices: tuple[str, ...] = (),
    numbers: bool = False,
    core: bool = False,
    unset: float = 0.0,
) -> Any:
    """A field of `Options`; its default says what it is: a flag, a whole number, or None for one that may be left out.

    With `core` the compiled core knows it, and None as `unset`; `numbers` are a list that does not decrease.
    """
    spec = Spec(
        "numbers" if numbers else "option",
        unit,
        doc,
        default is None,
        above,
        at_least,
        None,
        at_most,
        flag=isinstance(default, bool),
        whole=type(default) is int,
        choices=choices,
    )
    row = Setting(spec, default, core, unset)
    return field(default=default, metadata={"spec": spec, "setting": row})


def _as_number(value: object) -> float | None:
    if isinstance(value, bool) or not isinstance(value, Real):
        return None
    try:
        return float(value)
    except OverflowError:
        return math.inf

"""A hint, and several of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field
from math import ceil, floor, log10
from typing import Any

from clutchwork.base import advised, dataclass, html
from clutchwork.base.quote import printable
from clutchwork.declare.calls import explained_methods


@dataclass(frozen=True)
class Hint:
    """Something that may not be meant: where, when, the numbers that show it, and a remedy."""

    rule: str  # "never locks", a section of docs/guide/hints.md
    elements: tuple[str, ...]  # names of elements, or of shafts
    message: str
    remedy: str
    numbers: Mapping[str, float] = field(default_factory=dict)  # "capacity [N m]" -> 80.0
    begin: float | None = None  # s; None: no matter of time
    end: float | None = None  # s

    def __hash__(self) -> int:
        return hash((self.rule, self.elements, self.message))

    def to_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return {
            "rule": self.rule,
            "elements": list(self.elements),
            "message": self.message,
            "remedy": self.remedy,
            "numbers": dict(self.numbers),
            "begin_s": self.begin,
            "end_s": self.end,
        }

    def __str__(self) -> str:
        """One line for reading."""
        return printable(f"{', '.join(self.elements)}: {advised(self.message, self.remedy)}")


@explained_methods("hints")
class Hints(tuple[Hint, ...]):
    """The hints about a model or a run; print it to read them."""

    __slots__ = ()

    def of(self, element: str) -> Hints:
        """Those that name an element or a shaft."""
        return Hints(hint for hint in self if element in hint.elements)

    @property
    def rules(self) -> tuple[str, ...]:
        """The rules that found something, each once."""
        return tuple(dict.fromkeys(hint.rule for hint in self))

    def __str__(self) -> str:
        """A line for each."""
        return "\n".join(f"[{hint.rule}] {hint}" for hint in self) if self else "no hints"

    __repr__ = __str__

    def _repr_html_(self) -> str:
        """A table for a notebook: of what, what is so, what to do."""
        if not self:
            return html.paragraph("no hints")
        lines = [(hint.rule, ", ".join(hint.elements), hint.message, hint.remedy) for hint in self]
        return html.table(("hint", "about", "what is so", "what to do"), lines, most=len(lines))


def shown(value: float, unit: str) -> str:
    """A number of a message with its unit."""
    return f"{value:.4g} {unit}".removesuffix(" 1")


def more_than(factor: float) -> str:
    """A factor above 0 in three digits, rounded up except for round-off."""
    place = 10.0 ** (2 - floor(log10(factor)))
    return f"{ceil(factor * place * (1.0 - 1e-9)) / place:.4g}"


def together(names: Iterable[str]) -> str:
    """Names as a sentence has them."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last

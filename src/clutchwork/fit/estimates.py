"""Fitted parameters with their intervals, whatever they were fitted to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from typing import Any, Self

from clutchwork.base import ClutchworkError, columns, dataclass, near
from clutchwork.base.arrays import Array


@dataclass(frozen=True)
class Parameter:
    """One fitted parameter."""

    name: str  # "speed", or "kinetic[2]" for the second point of a curve
    unit: str
    value: float
    lower: float  # ends of its interval
    upper: float
    start: float
    reason: str = ""  # why the samples do not determine it
    direction: str = ""  # relative changes that the samples hardly tell from no change
    experiment: str = ""  # what would determine it

    @property
    def determined(self) -> bool:
        """Whether the samples determine it."""
        return not self.reason

    def __str__(self) -> str:
        together = self.direction and f"the samples hardly change when these change together: {self.direction}"
        open_ends = [self.reason, together, self.experiment]
        return f"{self.name} is not determined: " + "; ".join(part for part in open_ends if part)


def table(parameters: Sequence[Parameter], confidence: float) -> str:
    """Values with their intervals, for reading."""
    lines = [["parameter", "value", f"{100 * confidence:g} % from", "to", "unit", "start", ""]]
    for p in parameters:
        numbers = [f"{number:.5g}" for number in (p.value, p.lower, p.upper)]
        lines.append([p.name, *numbers, p.unit, f"{p.start:.5g}", "" if p.determined else "not determined"])
    return columns(lines, right=(1, 2, 3, 5))


@dataclass(frozen=True, eq=False, kw_only=True)
class ParameterEstimates:
    """Fitted parameters with their intervals, and whether the samples determine them.

    A parameter that the samples do not determine keeps a value, but no meaning: look at `determined`, `undetermined`
    and `message`, or call `raise_for_status`. Its value has then been chosen by the start value.
    """

    parameters: tuple[Parameter, ...]
    correlation: Array = field(repr=False)  # of the parameters, those that must be above zero by their logarithm
    confidence: float  # of the intervals
    r2: float  # share of the variation of the samples that is described
    converged: bool
    doubts: tuple[str, ...] = ()  # why the residuals are not noise
    remarks: tuple[str, ...] = ()  # on samples and search

    @property
    def invalid(self) -> tuple[str, ...]:
        """Why the fitted values cannot be used, whatever the samples say."""
        return ()

    @property
    def undetermined(self) -> tuple[Parameter, ...]:
        """Parameters that the samples do not determine."""
        return tuple(parameter for parameter in self.parameters if not parameter.determined)

    @property
    def determined(self) -> bool:
        """Whether the search ended, the values are valid, what is left is noise, and every parameter is determined."""
        return self.converged and not self.invalid and not self.doubts and not self.undetermined

    @property
    def message(self) -> str:
        """What stands in the way of using the values, one line each; empty when nothing does."""
        lines = [] if self.converged else ["the search did not converge: start closer to it or free fewer parameters"]
        return "\n".join([*lines, *self.invalid, *self.doubts, *(str(parameter) for parameter in self.undetermined)])

    @property
    def notes(self) -> str:
        """What to know about the values, one line each."""
        raise NotImplementedError

    def __getitem__(self, name: str) -> Parameter:
        for parameter in self.parameters:
            if parameter.name == name:
                return parameter
        raise KeyError(f"no fitted parameter {name!r}{near(name, [p.name for p in self.parameters])}")

    def raise_for_status(self) -> Self:
        """Return itself when everything is determined, else raise UndeterminedError."""
        if not self.determined:
            raise UndeterminedError(self)
        return self

    def data(self) -> dict[str, Any]:
        """All of it but samples and runs, for JSON."""
        return {
            "determined": self.determined,
            "converged": self.converged,
            "message": self.message,
            "notes": self.notes,
            "r2": self.r2,
            "confidence": self.confidence,
            "parameters": [{**vars(p), "determined": p.determined} for p in self.parameters],
            "correlation": self.correlation.tolist(),
        }

    def __str__(self) -> str:
        parts = [self._head, table(self.parameters, self.confidence), self.message, self.notes]
        return "\n\n".join(part for part in parts if part)

    @property
    def _head(self) -> str:
        raise NotImplementedError


class UndeterminedError(ClutchworkError, RuntimeError):
    """The measurements do not determine all free parameters; `result` holds what they do say."""

    def __init__(self, result: ParameterEstimates) -> None:
        self.result = result
        super().__init__(result.message)

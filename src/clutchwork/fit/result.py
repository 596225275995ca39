"""What a fit found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ClutchworkError, near
from clutchwork.base.plural import columns
from clutchwork.declare.node import Law
from clutchwork.fit.measurement import Measurement
from clutchwork.fit.picture import picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

# share of samples with a torque of the wrong sign that is worth telling
AGAINST = 0.01


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
        open_ends = [
            self.reason,
            self.direction and f"the samples hardly see {self.direction}",
            self.experiment,
        ]
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


@dataclass(frozen=True, eq=False, kw_only=True)
class FitResult(ParameterEstimates):
    """A fitted law, its parameters with their intervals, and how well it describes the samples."""

    law: Law
    rms: float  # N m, of the residuals over the samples that give an equation
    samples: Measurement = field(repr=False)
    fitted: Array = field(repr=False)  # torque of the fitted law at the samples [N m]
    equations: NDArray[np.bool_] = field(repr=False)  # samples that give an equation; the others only a bound
    alike: float  # correlation of neighbouring residuals, 0 where it may be chance
    faults: tuple[str, ...]  # rules of the law that the fitted values break
    advice: tuple[str, ...]  # what the fitted values allow and is rarely wanted
    rest: float  # slip below which a sample counts as at rest

    @property
    def residuals(self) -> Array:
        """Fitted minus measured torque [N m]."""
        return self.fitted - self.samples.torque

    @property
    def against(self) -> float:
        """Share of the samples that slide whose torque has the wrong sign, which a law without states cannot have."""
        slip, torque = self.samples.slip, self.samples.torque
        slides = np.abs(slip) > self.rest
        return 0.0 if self.law.own_states() else float(np.sum(slip * torque * slides < 0.0) / np.sum(slides))

    @property
    def invalid(self) -> tuple[str, ...]:
        """Why the fitted values cannot be used, whatever the samples say."""
        return tuple(f"the fitted values are not valid: {fault}" for fault in self.faults)

    @property
    def notes(self) -> str:
        """What to know about the values, one line each."""
        lines = [*self.advice, *self.remarks]
        if self.samples.turned:
            lines.append("the torque was given against the slip, as it acts on the follower; its sign was turned")
        if self.against > AGAINST:
            lines.append(
                f"in {100 * self.against:.2g} % of the samples that slide the torque drives instead of braking: give"
                f" `rest` above the noise of the slip, or remove an offset; now it is {self.rest:.3g}"
            )
        if self.alike:
            lines.append(
                f"neighbouring residuals are correlated ( {self.alike:.2f}): the law misses something or the"
                " samples were filtered; the intervals are widened for it"
            )
        return "\n".join(lines)

    def plot(self, path: str | Path | None = None) -> Figure:
        """Measured and fitted torque over time and slip, residuals; written to `path` when given. Needs matplotlib."""
        return picture(self, path)

    def data(self) -> dict[str, Any]:
        """All of it but the samples, for JSON."""
        own = {
            "law": type(self.law).kind,
            "samples": len(self.fitted),
            "equations": int(np.sum(self.equations)),
            "rms_Nm": self.rms,
        }
        return own | super().data()

    @property
    def _head(self) -> str:
        unit = "N" if self.samples.translation else "N m"
        count = f"{len(self.fitted)} samples, {int(np.sum(self.equations))} of them equations"
        return f"{type(self.law).__name__}: {count}, rms {self.rms:.3g} {unit}, r2 {self.r2:.6g}"


class UndeterminedError(ClutchworkError, RuntimeError):
    """The measurements do not determine all free parameters; `result` holds what they do say."""

    def __init__(self, result: ParameterEstimates) -> None:
        self.result = result
        super().__init__(result.message)

"""What a fit of a law to measurements found."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import dataclass
from clutchwork.fit.fitted_law import FittedLaw
from clutchwork.fit.picture import picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# share of samples with a torque of the wrong sign that is worth telling
AGAINST = 0.01


@dataclass(frozen=True, eq=False, kw_only=True)
class FitResult(FittedLaw):
    """A fitted law, its parameters with their intervals, and how well it describes the samples."""

    alike: float  # correlation of neighbouring residuals, 0 where it may be chance
    faults: tuple[str, ...]  # rules of the law that the fitted values break
    advice: tuple[str, ...]  # what the fitted values allow and is rarely wanted
    rest: float  # slip below which a sample counts as at rest

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
            lines.append("the torque was given against the slip, as it acts on the follower; its sign was reversed")
        if self.against > AGAINST:
            lines.append(
                f"in {100 * self.against:.2g} % of the samples that slide the torque drives instead of braking: give"
                f" `rest` above the noise of the slip, or remove an offset; now it is {self.rest:.3g}"
            )
        if self.alike:
            lines.append(
                f"neighbouring residuals are correlated ( {self.alike:.2f}): the law lacks an effect or the"
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

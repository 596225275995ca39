"""Losses by which residuals far outside of the noise count less; docs/guide/fit.md."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from clutchwork.base import dataclass, near, quote
from clutchwork.base.arrays import Array
from clutchwork.fit.failure import FitError

# deviations of the noise within which residuals count in full
WIDTH = 1.345
# of a median of sizes, for the deviation of normal noise
NORMAL = 1.4826
# what the noise is at least taken for, in shares of the samples
LEAST = 1e-9
# samples that vary by less, of themselves, do not vary
CONSTANT = 1e-6


def _soft(z: Array) -> tuple[Array, Array, Array]:
    root = np.sqrt(1.0 + z)
    return 2.0 * (root - 1.0), 1.0 / root, -0.5 / root**3


def _huber(z: Array) -> tuple[Array, Array, Array]:
    root, inside = np.sqrt(np.maximum(z, 1.0)), z <= 1.0
    return np.where(inside, z, 2.0 * root - 1.0), 1.0 / root, np.where(inside, 0.0, -0.5 / root**3)


def _cauchy(z: Array) -> tuple[Array, Array, Array]:
    return np.log1p(z), 1.0 / (1.0 + z), -1.0 / (1.0 + z) ** 2


# of the square of a residual over its scale: the loss, and its first and second derivative
LOSSES: dict[str, Callable[[Array], tuple[Array, Array, Array]]] = {
    "linear": lambda z: (z, np.ones_like(z), np.zeros_like(z)),
    "soft_l1": _soft,
    "huber": _huber,
    "cauchy": _cauchy,
}


@dataclass(frozen=True)
class Penalty:
    """How residuals count."""

    kind: str = "linear"
    width: float = WIDTH  # deviations of the noise beyond which they count less

    def __post_init__(self) -> None:
        if self.kind not in LOSSES:
            told = f"give one of {', '.join(map(repr, LOSSES))}{near(self.kind, LOSSES)}"
            raise FitError("loss", f"is {quote(self.kind)}", told)
        if not isinstance(self.width, int | float) or not 0.0 < self.width < np.inf:
            raise FitError("loss_width", f"is {quote(self.width)}", "give deviations of the noise, such as 1.345")

    @property
    def is_linear(self) -> bool:
        """Whether all residuals count in full."""
        return self.kind == "linear"

    def scale(self, residuals: Array, size: float) -> float:
        """Residual from which on it counts less, by the noise of the others.

        Parameters: size, of the samples.
        """
        noise = NORMAL * float(np.median(np.abs(residuals))) if len(residuals) else 0.0
        return self.width * max(noise, LEAST * size)

    def costs(self, residuals: Array, scales: Array | float) -> Array:
        """What each residual counts: its square, or less."""
        return np.asarray(scales**2 * LOSSES[self.kind]((residuals / scales) ** 2)[0])

    def felt(self, residuals: Array, scales: Array | float) -> Array:
        """Residuals as the estimate feels them: those of a linear one with the same covariance, docs/guide/fit.md."""
        z = (residuals / scales) ** 2
        _, first, second = LOSSES[self.kind](z)
        return np.asarray(residuals * first / max(float(np.mean(first + 2.0 * z * second)), 0.1))

    def searched(self, scales: Array | None) -> Any:
        """As SciPy takes it: of squares of the residuals, and of what follows them, which counts in full."""
        if scales is None or self.is_linear:
            return "linear"

        def of(z: Array) -> Array:
            made = np.vstack(LOSSES["linear"](z))
            square, count = scales**2, len(scales)
            value, first, second = LOSSES[self.kind](z[:count] / square)
            made[:, :count] = square * value, first, second / square
            return made

        return of

    def share(self, residuals: Array, values: Array, scales: Array | float) -> float:
        """Share of the variation of values that is not left in the residuals, both as they count."""
        middle = float(np.median(values)) if not self.is_linear else float(np.mean(values))
        for _ in range(0 if self.is_linear else 50):
            weights = LOSSES[self.kind](((values - middle) / scales) ** 2)[1]
            middle = float(np.sum(weights * values) / np.sum(weights))
        variation = float(np.sum(self.costs(values - middle, scales)))
        # what does not vary but by round-off has no share
        none = np.max(np.abs(values - middle)) <= CONSTANT * np.max(np.abs(values))
        return float("nan") if none else 1.0 - float(np.sum(self.costs(residuals, scales))) / variation

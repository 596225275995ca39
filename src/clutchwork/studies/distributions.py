"""How a value is scattered: distributions by name, each as its quantile function.

docs/guide/studies.md shows them; numbers may have a unit, the same for all numbers of a distribution.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import UseError, dataclass, quote
from clutchwork.base.arrays import Array
from clutchwork.base.extras import need
from clutchwork.declare.calls import explained
from clutchwork.declare.units import split
from clutchwork.sweeps.factors import Factors

InSI: TypeAlias = Callable[[Any], Any]


# of each number in the unit of the value: a place, a width, or a shape, which has no unit
PLACE, WIDTH, SHAPE = "place", "width", "shape"
NUMBERS = {
    "uniform": (PLACE, PLACE),
    "log_uniform": (PLACE, PLACE),
    "normal": (PLACE, WIDTH),
    "truncated_normal": (PLACE, WIDTH, PLACE, PLACE),
    "lognormal": (PLACE, SHAPE),
    "triangular": (PLACE, PLACE, PLACE),
}


@dataclass(frozen=True)
class Distribution:
    """A distribution of one value, made by `cw.uniform`, `cw.normal` and the like."""

    kind: str
    numbers: tuple[float, ...]
    unit: str = ""

    def quantile(self, share: Array) -> Array:
        """Values below which shares of all lie."""
        return QUANTILES[self.kind](share, *self.numbers)

    def in_si(self, of: InSI) -> Distribution:
        """The same in SI, where `of` knows what a value with a unit is."""
        factor = of(f"1 {self.unit}") - of(f"0 {self.unit}")
        made = {
            PLACE: lambda number: of(f"{number!r} {self.unit}"),
            WIDTH: lambda number: factor * number,
            SHAPE: lambda number: number,
        }
        pairs = zip(NUMBERS[self.kind], self.numbers, strict=True)
        return Distribution(self.kind, tuple(made[what](number) for what, number in pairs))

    def __str__(self) -> str:
        numbers = ", ".join(f"{number:.6g}" for number in self.numbers)
        return f"{self.kind}({numbers}){f' {self.unit}' if self.unit else ''}"


@dataclass(frozen=True)
class Discrete:
    """Values of any kind, each with its share."""

    values: tuple[Any, ...]
    labels: tuple[Any, ...]
    shares: tuple[float, ...]

    def codes(self, share: Array) -> NDArray[np.int64]:
        """Which of the values lies at each share."""
        ends = np.cumsum(self.shares)[:-1]
        return np.searchsorted(ends, share, side="right").astype(np.int64)

    def __str__(self) -> str:
        told = ", ".join(f"{label}: {share:.4g}" for label, share in zip(self.labels, self.shares, strict=True))
        return f"discrete({told})"


@explained("cw.uniform", low="0.15", high="0.25")
def uniform(low: Any, high: Any) -> Distribution:
    """Any value between two bounds, all equally likely, for `design`.

    Parameters: low, high, the bounds, in SI or with a unit.
    """
    (low, high), unit = _read("uniform", low=low, high=high)
    _rising("uniform", low=low, high=high)
    return Distribution("uniform", (low, high), unit)


@explained("cw.log_uniform", low="1e-3", high="1.0")
def log_uniform(low: Any, high: Any) -> Distribution:
    """Any value between two positive bounds, its logarithm uniform, for `design`.

    Parameters: low, high, the bounds, in SI or with a unit.
    """
    (low, high), unit = _read("log_uniform", low=low, high=high)
    _positive("log_uniform", low=low)
    _rising("log_uniform", low=low, high=high)
    return Distribution("log_uniform", (low, high), unit)


@explained("cw.normal", mean="0.2", deviation="0.01")
def normal(mean: Any, deviation: Any) -> Distribution:
    """The normal distribution, for `design`.

    Parameters: mean; deviation, the standard deviation, both in SI or with a unit.
    """
    (mean, deviation), unit = _read("normal", mean=mean, deviation=deviation)
    _positive("normal", deviation=deviation)
    return Distribution("normal", (mean, deviation), unit)


@explained("cw.truncated_normal", mean="0.2", deviation="0.01", low="0.17", high="0.23")
def truncated_normal(mean: Any, deviation: Any, low: Any, high: Any) -> Distribution:
    """The normal distribution between two bounds, nothing outside, for `design`.

    Parameters: mean and standard deviation of the whole distribution; low, high, the bounds, in SI or with a unit.
    """
    (mean, deviation, low, high), unit = _read("truncated_normal", mean=mean, deviation=deviation, low=low, high=high)
    _positive("truncated_normal", deviation=deviation)
    _rising("truncated_normal", low=low, high=high)
    return Distribution("truncated_normal", (mean, deviation, low, high), unit)


@explained("cw.lognormal", median="0.1", deviation="0.2")
def lognormal(median: Any, deviation: float) -> Distribution:
    """A positive value whose natural logarithm is normal, for `design`.

    Parameters: median, in SI or with a unit; deviation, the standard deviation of the logarithm: 0.1 is about 10 %.
    """
    (median,), unit = _read("lognormal", median=median)
    (deviation,), none = _read("lognormal", deviation=deviation)
    if none:
        raise UseError("lognormal", [f"deviation is in {none}: it is that of the logarithm, which has no unit"])
    _positive("lognormal", median=median, deviation=deviation)
    return Distribution("lognormal", (median, deviation), unit)


@explained("cw.triangular", low="0.1", mode="0.2", high="0.4")
def triangular(low: Any, mode: Any, high: Any) -> Distribution:
    """Between two bounds, most often at a value between them, for `design`.

    Parameters: low, mode, high, in SI or with a unit.
    """
    (low, mode, high), unit = _read("triangular", low=low, mode=mode, high=high)
    _rising("triangular", low=low, high=high)
    if not low <= mode <= high:
        raise UseError("triangular", [f"mode is {mode:g}: it must lie between low = {low:g} and high = {high:g}"])
    return Distribution("triangular", (low, mode, high), unit)


@explained("cw.discrete", values="[0.1, 0.2]")
def discrete(values: Any, shares: Sequence[float] | None = None) -> Discrete:
    """One of several values of any kind, numbers, friction laws or signals, for `design`.

    Parameters: values, a list, or a mapping from labels to values; shares, how often each is drawn, all alike by
    default.
    """
    labelled = isinstance(values, Mapping)
    if isinstance(values, str) or not hasattr(values, "__len__") or not len(values):
        raise UseError("discrete", [f"values are {quote(values)}: give a list of values, or values by label"])
    made = tuple(values.values()) if labelled else tuple(values.tolist() if hasattr(values, "tolist") else values)
    weights = (1.0,) * len(made) if shares is None else tuple(float(share) for share in shares)
    if len(weights) != len(made) or min(weights) < 0.0 or not 0.0 < sum(weights) < np.inf:
        raise UseError(
            "discrete", [f"shares are {quote(shares)}: give a number from 0 on for each of {len(made)} values"]
        )
    return Discrete(made, tuple(map(str, values)) if labelled else made, tuple(w / sum(weights) for w in weights))


def distribution(call: str, name: str, given: Any) -> Any:
    """What a value of a design means: a distribution, (low, high), a list to choose from, or one of scipy.stats."""
    if isinstance(given, Factors):
        return Factors(distribution(call, name, given.how))
    if isinstance(given, Distribution | Discrete) or callable(getattr(given, "ppf", None)):
        return given
    if isinstance(given, tuple) and len(given) == 2:
        return uniform(*given)
    if isinstance(given, list | Mapping | np.ndarray):
        return discrete(given)
    ways = "cw.uniform(low, high), cw.normal(mean, deviation) or the like, (low, high), or a list to choose from"
    raise UseError(call, [f"{name}: {quote(given)} is not a distribution; give {ways}"])


# -------------------------------------------------------------------------------------------------------------- numbers


def _read(call: str, **numbers: Any) -> tuple[list[float], str]:
    """Finite numbers and their unit."""
    made, units, problems = list[float](), list[str](), list[str]()
    for name, given in numbers.items():
        parts = split(given) if isinstance(given, str) else (given, "")
        number = parts[0] if parts else given
        if isinstance(number, bool) or not isinstance(number, int | float | np.number) or not np.isfinite(number):
            problems.append(f"{name} is {quote(given)}: give a finite number, in SI or with a unit")
        made.append(number)
        units.append(parts[1] if parts else "")
    if not problems and len(set(units)) > 1:
        problems.append(f"{', '.join(numbers)} have different units: {', '.join(one or 'none' for one in units)}")
    if problems:
        raise UseError(call, problems)
    return [float(number) for number in made], units[0]


def _rising(call: str, low: float, high: float) -> None:
    if not low < high:
        raise UseError(call, [f"low is {low:g} and high is {high:g}: low must be below high"])


def _positive(call: str, **numbers: float) -> None:
    wrong = [f"{name} is {number:g}: it must be positive" for name, number in numbers.items() if number <= 0.0]
    if wrong:
        raise UseError(call, wrong)


# ------------------------------------------------------------------------------------------------------------ quantiles


def _normal(share: Array) -> Array:
    return np.asarray(need("scipy.special", "study", "a design").ndtri(share))


def _below(value: float) -> float:
    return float(need("scipy.special", "study", "a design").ndtr(value))


def _truncated(share: Array, mean: float, deviation: float, low: float, high: float) -> Array:
    """Both tails are kept apart, for only small shares are exact."""
    a, b = (low - mean) / deviation, (high - mean) / deviation
    if a > 0.0:
        return -_truncated(1.0 - share, -mean, deviation, -high, -low)
    below = _below(a)
    return np.clip(mean + deviation * _normal(below + share * (_below(b) - below)), low, high)


def _triangular(share: Array, low: float, mode: float, high: float) -> Array:
    left = (mode - low) / (high - low)
    rising = low + np.sqrt(share * (high - low) * (mode - low))
    falling = high - np.sqrt((1.0 - share) * (high - low) * (high - mode))
    return np.where(share < left, rising, falling)


QUANTILES: dict[str, Callable[..., Array]] = {
    "uniform": lambda share, low, high: low + share * (high - low),
    "log_uniform": lambda share, low, high: low * (high / low) ** share,
    "normal": lambda share, mean, deviation: mean + deviation * _normal(share),
    "truncated_normal": _truncated,
    "lognormal": lambda share, median, deviation: median * np.exp(deviation * _normal(share)),
    "triangular": _triangular,
}

"""Histories of load and slip, for the independent solver and for clutchwork alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import pi, sin


@dataclass(frozen=True)
class Drift:
    """Pushed over break-away once, then a biased sine, then nothing; unit mass, loads in N.

    The sine begins at 5 s. Creep is counted from its second period on, at equal phases.
    """

    mean: float
    swing: float
    frequency: float
    end: float
    rest: float = 2.0
    begin: float = 5.0

    @property
    def corners(self) -> tuple[tuple[float, float], ...]:
        """What the sine is added to."""
        return (0.0, 0.0), (1.0, 0.0), (2.0, 1.3), (3.0, self.mean), (self.end, self.mean), (self.end, 0.0)

    @property
    def knots(self) -> tuple[float, ...]:
        """Where the load is not smooth."""
        return 1.0, 2.0, 3.0, self.begin, self.end

    def __call__(self, t: float) -> float:
        """Load, at the end its limit from the left."""
        if t <= 3.0:
            return 0.0 if t <= 1.0 else 1.3 * (t - 1.0) if t <= 2.0 else 1.3 - (1.3 - self.mean) * (t - 2.0)
        if t > self.end:
            return 0.0
        swing = self.swing * sin(2.0 * pi * self.frequency * (t - self.begin)) if t > self.begin else 0.0
        return self.mean + swing


# the two sets of the drift test: load, and the instants between which the creep is counted
FIRST = Drift(mean=0.3, swing=0.2, frequency=2.0, end=20.0)
SECOND = {peak: Drift(mean=0.5, swing=peak - 0.5, frequency=1.0, end=21.0, rest=0.1) for peak in (0.6, 0.8)}


@dataclass(frozen=True)
class Waves:
    """offset + sum of amplitude sin(2 pi frequency t + phase)."""

    waves: tuple[tuple[float, float, float], ...]  # amplitude, frequency [Hz], phase
    offset: float = 0.0

    def __call__(self, t: float) -> float:
        return self.offset + sum(a * sin(2.0 * pi * f * t + phase) for a, f, phase in self.waves)


@dataclass(frozen=True)
class Corners:
    """Linear between points."""

    points: Sequence[tuple[float, float]]

    def __call__(self, t: float) -> float:
        for (t0, y0), (t1, y1) in pairwise(self.points):
            if t <= t1:
                return y0 + (y1 - y0) * (t - t0) / (t1 - t0)
        return self.points[-1][1]

    @property
    def knots(self) -> tuple[float, ...]:
        """Where it is not smooth."""
        return tuple(t for t, _ in self.points)


def sweeps(places: Sequence[float], time: float = 1.0) -> Corners:
    """Speed that leads from place to place: rises and falls linearly, zero at every place."""
    points = [(0.0, 0.0)]
    for number, (here, there) in enumerate(pairwise(places)):
        points += [((number + 0.5) * time, 2.0 * (there - here) / time), ((number + 1.0) * time, 0.0)]
    return Corners(tuple(points))

"""Natural modes of a linear system: frequencies, damping, and how the shafts move in them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import columns, dataclass, html
from clutchwork.declare.calls import explained_methods

if TYPE_CHECKING:
    from clutchwork.linear.quantity import Quantity

Array = NDArray[Any]

# beside the fastest mode, what counts as standing still is round-off of the eigenvalues
ROUND_OFF = 1e-13
# parts of a shape below this are round-off
LEAST_PART = 1e-9


@dataclass(frozen=True, eq=False)
class NaturalMode:
    """One real eigenvalue, or a pair of complex ones."""

    eigenvalue: complex  # 1/s; of a pair the one with the positive imaginary part
    shape: Mapping[str, complex]  # of each shaft: amplitude of its speed, the largest is 1; empty where none moves
    states: Mapping[str, complex]  # of each state, in units of the largest of its sort

    @property
    def frequency(self) -> float:
        """Frequency of its oscillation [Hz]; zero if it does not oscillate."""
        return abs(self.eigenvalue.imag) / (2.0 * math.pi)

    @property
    def natural_frequency(self) -> float:
        """Undamped frequency [Hz]."""
        return abs(self.eigenvalue) / (2.0 * math.pi)

    @property
    def damping(self) -> float:
        """Damping ratio: 1 if it decays without oscillation, below zero if it grows; NaN of a free motion."""
        size = abs(self.eigenvalue)
        return -self.eigenvalue.real / size if size > 0.0 else math.nan

    @property
    def time_constant(self) -> float:
        """Time in which it falls to 1/e [s]; below zero where it grows, infinite where it does neither."""
        return -1.0 / self.eigenvalue.real if self.eigenvalue.real != 0.0 else math.inf

    @property
    def kind(self) -> str:
        """In one word: oscillates, decays, grows or free."""
        if self.eigenvalue == 0.0:
            return "free"
        if self.eigenvalue.imag:
            return "oscillates, grows" if self.eigenvalue.real > 0.0 else "oscillates"
        return "grows" if self.eigenvalue.real > 0.0 else "decays"

    def __repr__(self) -> str:
        """As a list shows it."""
        moves = _moving(self, 3)
        return f"<NaturalMode {self.kind}: {self.frequency:.4g} Hz, damping {self.damping:.3g}, {moves}>"


HEAD = ("mode", "", "frequency", "undamped", "damping", "time constant", "who moves")
RIGHT = (0, 2, 3, 4, 5)


@explained_methods("lin.modes")
class NaturalModes(Sequence[NaturalMode]):
    """The modes, slowest first; `print` shows them as a table."""

    def __init__(self, modes: Sequence[NaturalMode]) -> None:
        self._modes = tuple(modes)

    def __len__(self) -> int:
        return len(self._modes)

    def __getitem__(self, number: Any) -> Any:
        return self._modes[number]

    def __iter__(self) -> Iterator[NaturalMode]:
        return iter(self._modes)

    @property
    def swinging(self) -> tuple[NaturalMode, ...]:
        """Those that oscillate."""
        return tuple(mode for mode in self if mode.frequency > 0.0)

    def __str__(self) -> str:
        lines = [HEAD, *(_line(number, mode) for number, mode in enumerate(self, 1))]
        return columns(lines, right=RIGHT)

    def _repr_html_(self) -> str:
        """The same table for a notebook."""
        return html.table(HEAD, [_line(number, mode) for number, mode in enumerate(self, 1)], right=RIGHT)

    def __repr__(self) -> str:
        return str(self)


def eigenvalues(A: Array) -> Array:
    """Eigenvalues, slowest first, a pair one after the other."""
    values, _ = _eigen(A)
    return np.array(sorted(values, key=lambda value: (round(abs(value), 12), value.real, value.imag)), dtype=complex)


def natural_modes(A: Array, shafts: Sequence[str], shaft_speeds: Array, states: Sequence[Quantity]) -> NaturalModes:
    """The modes of a matrix.

    Parameters: shafts, and their speeds over the states, of which shapes are made.
    """
    values, vectors = _eigen(A)
    scale = np.abs(values).max(initial=0.0)
    made = []
    for value, vector in zip(values, vectors.T, strict=True):
        found = complex(value) if abs(value) > ROUND_OFF * len(values) * scale else 0j
        if abs(found.imag) <= ROUND_OFF * abs(found):
            found = complex(found.real)
        if found.imag >= 0.0:
            made.append(NaturalMode(found, _shape(shafts, shaft_speeds, vector), _states(states, vector)))
    return NaturalModes(sorted(made, key=lambda mode: (abs(mode.eigenvalue), mode.eigenvalue.real)))


def _eigen(A: Array) -> tuple[Array, Array]:
    if not len(A):
        return np.zeros(0, dtype=complex), np.zeros((0, 0), dtype=complex)
    # states in units in which rows and columns are alike: a pressure in Pa stands beside a twist in rad
    scale = _balance(A)
    values, vectors = np.linalg.eig(A * scale / scale[:, None])
    return values.astype(complex), scale[:, None] * vectors.astype(complex)


def _balance(A: Array) -> Array:
    """Powers of two, one for each state, that make rows and columns of about one size."""
    scale, size = np.ones(len(A)), np.abs(A) * (1.0 - np.eye(len(A)))
    for _ in range(60):
        rows, cols = (size * scale / scale[:, None]).sum(axis=1), (size * scale / scale[:, None]).sum(axis=0)
        usable = (rows > 0.0) & (cols > 0.0)
        factor = np.ones(len(A))
        factor[usable] = 2.0 ** np.round(0.5 * np.log2(rows[usable] / cols[usable]))
        if (factor == 1.0).all():
            break
        # half of the way, so that neighbours do not take turns
        scale = scale * np.where(np.arange(len(A)) == int(np.argmax(np.abs(np.log2(factor)))), factor, 1.0)
    return scale


def _shape(shafts: Sequence[str], shaft_speeds: Array, vector: Array) -> dict[str, complex]:
    """Speeds of the shafts, the largest as 1."""
    speeds = shaft_speeds @ vector
    size = np.abs(speeds).max(initial=0.0)
    # a mode of temperatures leaves the shafts alone
    if size <= LEAST_PART * np.abs(vector).max(initial=0.0) * max(1.0, np.abs(shaft_speeds).max(initial=0.0)):
        return {}
    speeds = speeds / speeds[int(np.argmax(np.abs(speeds) > (1.0 - 1e-9) * size))]
    return dict(zip(shafts, map(_clean, speeds), strict=True))


def _states(states: Sequence[Quantity], vector: Array) -> dict[str, complex]:
    """Parts of the states, each beside the largest one of its unit."""
    units = np.array([quantity.unit for quantity in states])
    made = np.zeros(len(vector), dtype=complex)
    for unit in set(units):
        own = units == unit
        size = np.abs(vector[own]).max()
        made[own] = vector[own] / size if size > 0.0 else 0.0
    return dict(zip((quantity.name for quantity in states), map(_clean, made), strict=True))


def _clean(value: complex) -> complex:
    real, imag = (part if abs(part) > LEAST_PART else 0.0 for part in (float(value.real), float(value.imag)))
    return complex(real, imag)


def _line(number: int, mode: NaturalMode) -> tuple[str, ...]:
    oscillates = mode.frequency > 0.0
    return (
        str(number),
        mode.kind,
        f"{mode.frequency:.4g} Hz" if oscillates else "",
        f"{mode.natural_frequency:.4g} Hz" if oscillates else "",
        f"{100.0 * mode.damping:.3g} %" if oscillates else "",
        f"{mode.time_constant:.4g} s" if math.isfinite(mode.time_constant) else "",
        _moving(mode, 5),
    )


def _moving(mode: NaturalMode, most: int) -> str:
    """The shafts that move most, each with its amplitude, and its phase where it is neither 0 nor 180 degrees."""
    parts = mode.shape or mode.states
    told = sorted((name for name in parts if abs(parts[name]) >= 0.005), key=lambda name: -abs(parts[name]))
    words = [f"{name} {_amplitude(parts[name])}" for name in told[:most]]
    more = len(told) - most
    return ", ".join(words) + (f" and {more} more" if more > 0 else "")


def _amplitude(value: complex) -> str:
    angle = math.degrees(math.atan2(value.imag, value.real))
    if abs(angle) < 0.5:
        return f"{abs(value):.2f}"
    if abs(angle) > 179.5:
        return f"{-abs(value):.2f}"
    return f"{abs(value):.2f} at {angle:.0f}°"

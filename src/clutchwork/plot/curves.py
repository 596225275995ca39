"""Curves and panels of a picture of named signals, as data: what matplotlib and plotly draw alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import UseError, dataclass, listed, quote
from clutchwork.base.arrays import Array
from clutchwork.declare.layout import MODES
from clutchwork.plot.panels import SCALES
from clutchwork.results.units import Converter, among

if TYPE_CHECKING:
    from clutchwork.results.recorded import Recorded


# what is measured in a unit, where a panel shows several quantities
WORDS = {
    "rad/s": "speed", "m/s": "speed", "rad": "angle", "m": "position", "rad/s2": "acceleration", "m/s2": "acceleration",
    "N m": "torque", "N": "force", "W": "power", "J": "energy", "K": "temperature", "Pa": "pressure", "1": "value",
}  # fmt: skip
STATE = ""  # the unit of words
# a panel has two axes, left and right
MOST_UNITS = 2


@dataclass(frozen=True, eq=False)
class Curve:
    """One line of a picture, in SI."""

    signal: str
    label: str
    unit: str
    time: Array
    values: Array
    run: str = ""  # label of the run, empty where there is one
    measured: bool = False  # samples, drawn as points
    si: str = ""  # the unit in SI where another one is asked for, which is then shown as it is

    @property
    def quantity(self) -> str:
        """What it is of its element: "torque"."""
        return self.signal.rpartition(".")[2]


@dataclass(frozen=True, eq=False)
class Side:
    """The curves of one axis: one unit."""

    curves: tuple[Curve, ...]

    @property
    def factor(self) -> float:
        """From SI to the unit that is shown."""
        return self._shown[0]

    @property
    def unit(self) -> str:
        """The unit that is shown."""
        return self._shown[1]

    @property
    def words(self) -> dict[float, str]:
        """Words for values, empty where these are numbers."""
        return {float(code): word for code, word in sorted(MODES.items())} if self.curves[0].unit == STATE else {}

    @property
    def label(self) -> str:
        """Of the axis: quantity and unit."""
        if self.words:
            return "state"
        quantities = list(dict.fromkeys(curve.quantity.replace("_", " ") for curve in self.curves))
        word = (
            quantities[0]
            if len(quantities) == 1
            else WORDS.get(self.curves[0].si or self.curves[0].unit, ", ".join(quantities[:2]))
        )
        return f"{word}, {self.unit}" if self.unit != "1" else word

    @property
    def _shown(self) -> tuple[float, str]:
        unit = self.curves[0].unit
        if any(curve.si for curve in self.curves):
            return 1.0, unit
        largest = max((float(np.max(np.abs(c.values), initial=0.0, where=_finite(c))) for c in self.curves), default=0)
        for from_unit, size, to_unit, factor in SCALES:
            if unit == from_unit and largest >= size:
                return factor, to_unit
        return 1.0, unit


def _finite(curve: Curve) -> NDArray[np.bool_]:
    return np.isfinite(curve.values)


@dataclass(frozen=True, eq=False)
class Panel:
    """One panel: the curves of its left axis, and of its right one where it has two units."""

    sides: tuple[Side, ...]

    @property
    def curves(self) -> tuple[Curve, ...]:
        """All of them."""
        return tuple(curve for side in self.sides for curve in side.curves)


def curves_of(runs: Mapping[str, Recorded], name: str) -> list[Curve]:
    """One signal of each run that has it."""
    made = list[Curve]()
    for label, run in runs.items():
        if name in run:
            unit, values = run.channels[name].unit, run[name]
            if unit == STATE:
                codes = {word: float(code) for code, word in MODES.items()}
                values = np.array([codes.get(word, np.nan) for word in values.tolist()])
            shown_as = f"{name}, {label}" if label else name
            made.append(Curve(name, shown_as, unit, run.time, np.asarray(values, dtype=float), label))
    return made


def panels_of(
    runs: Mapping[str, Recorded],
    groups: Sequence[tuple[bool, Sequence[str]]],
    extra: Sequence[Curve],
    call: str,
    shown_in: Converter,
) -> list[Panel]:
    """A panel for each unit of the loose signals, in order of appearance, and one for each group of its own."""
    spare, loose = [_in_unit(curve, shown_in) for curve in extra], dict[str, list[Curve]]()
    made = list[Panel | list[Curve]]()
    for own, names in groups:
        found = [_in_unit(curve, shown_in) for name in names for curve in curves_of(runs, name)]
        found += [curve for curve in spare if curve.signal in names]
        spare = [curve for curve in spare if curve not in found]
        units = list(dict.fromkeys(curve.unit for curve in found))
        if own and len(units) > MOST_UNITS:
            remedy = f"give a list for each of {listed(unit or 'state' for unit in units)}, or names without a list"
            raise UseError(call, [f"{quote(list(names))} has {len(units)} units, a panel has two axes; {remedy}"])
        if own:
            made.append(Panel(tuple(Side(tuple(c for c in found if c.unit == unit)) for unit in units)))
            continue
        for curve in found:
            if curve.unit not in loose:
                loose[curve.unit] = []
                made.append(loose[curve.unit])
            loose[curve.unit].append(curve)
    return [Panel((Side(_once(one)),)) if isinstance(one, list) else one for one in made]


def units_of(runs: Mapping[str, Recorded], units: Any, call: str) -> Converter:
    """What puts signals into the units that are asked for, of any of the runs."""
    made = among({name: unit for run in runs.values() for name, unit in {**run.units, "time": "s"}.items()}, units)
    if "time" in made.units:
        raise UseError(call, ["units: a picture shows the time in s; leave 'time' out"])
    return made


def _in_unit(curve: Curve, shown_in: Converter) -> Curve:
    """A curve in the unit that is asked for."""
    if curve.signal not in shown_in.units:
        return curve
    unit, values = shown_in.unit(curve.signal), shown_in.put(curve.values, curve.signal)
    return replace(curve, unit=unit, values=values, si=curve.unit)


def _once(curves: Sequence[Curve]) -> tuple[Curve, ...]:
    """A signal that two names of the call stand for is drawn once."""
    return tuple({(curve.label, curve.measured): curve for curve in curves}.values())


def thinned(time: Array, values: Array, most: int) -> tuple[Array, Array]:
    """A curve with at most so many points, none of whose peaks is lost.

    Of each of equal stretches the first, the smallest, the largest and the last value stay.
    """
    count = len(time)
    if count <= most:
        return time, values
    length = -(-count // max(1, most // 4))
    whole = count // length * length
    blocks = values[:whole].reshape(-1, length)
    starts = np.arange(0, whole, length)
    # where nothing is finite, any instant serves
    filled = np.where(np.isfinite(blocks), blocks, 0.0)
    ends = np.arange(whole, count)
    kept = [starts, starts + np.argmin(filled, axis=1), starts + np.argmax(filled, axis=1), starts + length - 1]
    if ends.size:
        rest = np.where(np.isfinite(values[whole:]), values[whole:], 0.0)
        kept.append(np.array([whole, whole + int(np.argmin(rest)), whole + int(np.argmax(rest)), count - 1]))
    chosen: Any = np.unique(np.concatenate(kept))
    return time[chosen], values[chosen]

"""Which words of a System each number, curve and signal of its driveline reaches, and what follows from that.

Own numbers of elements and inertias are written into the arrays without assembling them, so it costs little to look at
what one alone changes. Nothing else looks for it: changes, sweeps, gradients, steps and pages ask this table.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from functools import cached_property
from itertools import islice
from math import inf, nextafter
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.changes import UNKNOWN_SOURCE, owners_of
from clutchwork.assembly.during_runs import NOTHING, OTHER, SIGNAL, Stays, stays
from clutchwork.assembly.inputs import plain_signal
from clutchwork.assembly.masses import is_mass, masses
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError, ModelWarning, near
from clutchwork.base.memoize import memoize
from clutchwork.declare.node import Signal
from clutchwork.model.changes import SIGNALS, Target, all_names, field_of, renewed, target, unit_of
from clutchwork.signals.table import Table

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.schema import Spec

Places = NDArray[np.int64]
Reach = Mapping[str, Places]

# by so much of their scale numbers are moved; those at a bound go to one side alone
PROBES = (1e-3, -1.7e-3, 2.3e-3, -2.9e-3)
# values of signals, of which one fits any
LEVELS = (1.0, 0.5, 300.0, 0.0, -1.0, 2.0, 0.25, 310.0)
# arrays that hold signals alone
OF_SIGNALS = ("input_first", "input_count", "input_period", "input_value", "segment_time", "segment_coef")


@dataclass(frozen=True, eq=False)
class Parameter:
    """Something of a driveline that may be changed, by its name in `System.changed`."""

    name: str
    value: Any
    unit: str
    bounds: tuple[float, float]  # what its declaration allows
    # places that another value changes in each array, in flat order; nothing: it acts on nothing here
    reach: Reach
    is_word: bool  # each of these is the number itself
    inputs: tuple[int, ...]  # numbers of the signals that it is
    _system: System
    _beside: System | None

    @property
    def is_signal(self) -> bool:
        """Whether it is a signal and nothing else."""
        return bool(self.inputs) and self.reach.keys() <= set(OF_SIGNALS)

    @cached_property
    def words(self) -> Places:
        """Words of eight bytes in the bytes of the System that it changes, in order."""
        starts = self._system.starts
        found = [starts[name] // 8 + places for name, places in self.reach.items() if _is_real(self._system, name)]
        return np.sort(np.concatenate([np.zeros(0, dtype=np.int64), *found]))

    @cached_property
    def derivative(self) -> NDArray[np.float64] | None:
        """Derivatives of its words, the same for all values; None: they depend on the value, or nobody knows them."""
        if self.is_word:
            return np.ones(len(self.words))
        known = masses(self._system) if is_mass(self.name) else None
        if known is None or self.name not in known.places:
            return None
        starts, made = self._system.starts, known.derivatives(self.name)
        found = {starts[array] // 8 + place: slope for (array, place), slope in made.items()}
        return np.array([found[word] for word in self.words.tolist()])

    @cached_property
    def stays(self) -> Stays | None:
        """Why it cannot change while a run goes on, and what to do instead; None: it can."""
        if self.is_signal:
            return None if _is_whole(self._system, self.name) else SIGNAL
        if self._beside is None:
            return OTHER
        return stays(self._system, self._system, self._beside) if self.reach else NOTHING

    @property
    def when(self) -> str:
        """When it may change: "during a run" or "before a run"."""
        return "during a run" if self.stays is None else "before a run"


class Parameters(Mapping[str, Parameter]):
    """Everything of a System that may be changed, by name; each is looked at when it is first asked for."""

    def __init__(self, system: System) -> None:
        if system.source is None:
            raise ModelError([UNKNOWN_SOURCE])
        self._system, self._source = system, system.source

    def __getitem__(self, name: str) -> Parameter:
        if target(owners_of(self._system), name) is None:
            raise KeyError(f"{name!r} is nothing that may be changed{near(name, self)}")
        return parameter(self._system, name)

    def __iter__(self) -> Iterator[str]:
        return all_names(self._source)

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __repr__(self) -> str:
        return f"<Parameters: {', '.join(self)}>"


@memoize
def parameter(system: System, name: str) -> Parameter:
    """One of them; its name must be known."""
    aim = target(owners_of(system), name)
    assert aim is not None, name
    value, spec = field_of(aim)
    seen, last, inputs = list[Reach | None](), None, tuple[int, ...]()
    is_word = isinstance(value, Real) and not is_shared(aim)
    for there, made in islice(_moved(system, name, value, spec), 2):
        reach, last = differing(system, made), made
        seen.append(reach)
        is_word = is_word and _is_word(made, reach, there)
        inputs = inputs or _inputs(system, made, aim, there)
        if not is_word:
            break
    reach = seen[0] if seen and seen[0] is not None else {}
    is_word = is_word and len(seen) == 2 and _same(*seen)
    return Parameter(name, value, unit_of(aim), bounds_of(spec), reach, is_word, inputs, system, last)


def is_shared(aim: Target) -> bool:
    """Whether the assembly makes something of a number together with others, such as the larger of two."""
    return field_of(aim)[1].what == "option" or aim.path[-1] == "band"


def bounds_of(*found: Spec) -> tuple[float, float]:
    """The least and the largest number that all declarations allow."""
    lower = [nextafter(spec.above, inf) for spec in found if spec.above is not None]
    upper = [nextafter(spec.below, -inf) for spec in found if spec.below is not None]
    lower += [spec.at_least for spec in found if spec.at_least is not None]
    upper += [spec.at_most for spec in found if spec.at_most is not None]
    return max(lower, default=-inf), min(upper, default=inf)


def differing(one: System, other: System) -> Reach | None:
    """Places in which the arrays of two Systems differ in any bit; None where they are of different sizes."""
    found = dict[str, Places]()
    for name, array in one.arrays.items():
        new = other.arrays[name]
        if new is array:
            continue
        if new.shape != array.shape:
            return None
        bits = np.dtype(f"u{array.dtype.itemsize}")
        places = np.flatnonzero(array.reshape(-1).view(bits) != new.reshape(-1).view(bits))
        found |= {name: places} if len(places) else {}
    return found


def _moved(system: System, name: str, value: Any, spec: Spec) -> Iterator[tuple[Any, System]]:
    """Other values, and the System with each; those that are refused are left out."""
    for there in _others(value, spec):
        try:
            with warnings.catch_warnings():
                # what is rarely wanted was said of the driveline
                warnings.simplefilter("ignore", ModelWarning)
                made = system.changed({name: there})
        except ModelError:
            continue
        yield there, made


def _others(value: Any, spec: Spec) -> Iterator[Any]:
    """Values beside one."""
    if isinstance(value, Real) and not isinstance(value, bool):
        whole, scale = spec.whole or spec.fixed, abs(float(value)) or 1.0
        yield from (int(value) + step for step in (1, -1)) if whole else (float(value) + p * scale for p in PROBES)
    elif isinstance(value, bool) or spec.choices:
        yield from (other for other in (spec.choices or (True, False)) if other != value)
    elif isinstance(value, Signal) and type(value).segments is Table.segments:
        yield from map(Table, _tables(vars(value)["points"]))
    elif isinstance(value, Signal) and spec.what in SIGNALS:
        yield from (Table([(0.0, level), (1.0, level)]) for level in LEVELS if spec.allows(level))
    elif _is_table(value):
        yield from _tables(value)


def _is_table(value: Any) -> bool:
    return hasattr(value, "__len__") and not isinstance(value, str) and len(value) > 0


def _tables(values: Any) -> Iterator[Any]:
    """Tables whose numbers are others, each by another share: ordinates of pairs, or all numbers of a list."""
    pairs = all(_is_table(row) and len(row) == 2 for row in values)
    flat = [float(row[1]) for row in values] if pairs else []
    size = max(map(abs, flat), default=0.0) or 1.0
    for share in PROBES if pairs else ():
        yield [[x, y + share * size * (1 + i / len(values))] for i, (x, y) in enumerate(values)]
    for share in () if pairs else PROBES:
        yield [_scaled(row, 1.0 + share * (1 + i / len(values))) for i, row in enumerate(values)]


def _scaled(row: Any, factor: float) -> Any:
    return [one * factor for one in row] if hasattr(row, "__len__") else row * factor


def _is_word(made: System, reach: Reach | None, value: float) -> bool:
    """Whether all that is new is a number itself."""
    own = reach.items() if reach else ()
    return bool(reach) and all(
        _is_real(made, name) and bool(np.all(made.arrays[name].reshape(-1)[places] == value)) for name, places in own
    )


def _is_real(system: System, array: str) -> bool:
    return bool(system.arrays[array].dtype.kind == "f")


def _same(one: Reach | None, other: Reach | None) -> bool:
    return bool(one and other) and one.keys() == other.keys() and all(map(np.array_equal, one.values(), other.values()))


def _inputs(system: System, made: System, aim: Target, value: Any) -> tuple[int, ...]:
    """Numbers of the signals that something is, or is inside of."""
    signal = _signal_with(aim, value)
    if signal is None:
        return ()
    both = enumerate(zip(system.inputs, made.inputs, strict=True))
    return tuple(number for number, (old, new) in both if new.signal == signal != old.signal)


def _signal_with(aim: Target, value: Any) -> Signal | None:
    """The signal that a value makes; None where it is in none."""
    for cut in range(1, len(aim.path) + 1):
        outer, spec = field_of(Target(aim.owner, aim.path[:cut]))
        if spec.what in SIGNALS:
            rest = aim.path[cut:]
            return renewed(outer, [(rest, value)]) if rest else plain_signal(value)
    return None


def _is_whole(system: System, name: str) -> bool:
    """Whether a name is that of a signal, not of something inside of one."""
    aim = target(owners_of(system), name)
    return aim is not None and field_of(aim)[1].what in SIGNALS

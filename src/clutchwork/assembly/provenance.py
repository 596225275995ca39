"""Which words of a System each number, curve and signal of its driveline reaches, and what follows from that.

Own numbers of elements and inertias are written into the arrays without assembling them, so it costs little to look at
what one alone changes. Nothing else looks for it: changes, sweeps, gradients, steps and pages ask this table.
decisions/0043
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property, partial
from itertools import chain, islice
from numbers import Real
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.changes import UNKNOWN_SOURCE, changed_system, owners_of
from clutchwork.assembly.during_runs import NOTHING, OTHER, SIGNAL, Stays, stays
from clutchwork.assembly.inputs import plain_signal
from clutchwork.assembly.masses import is_mass, masses
from clutchwork.assembly.system_data import SystemData
from clutchwork.base import ModelError, ModelWarning, dataclass, near
from clutchwork.base.memoize import memoize
from clutchwork.declare.node import Signal
from clutchwork.declare.schema import Spec
from clutchwork.model.changes import SIGNALS, Target, all_names, field_of, renewed, target, unit_of
from clutchwork.signals.table import Table

Places = NDArray[np.int64]
Reach = Mapping[str, Places]
# another value, the System with it, and what differs there
Look: TypeAlias = "tuple[Any, SystemData, Reach]"

# by so much of their scale numbers are moved; those at a bound go to one side alone
PROBES = (1e-3, -1.7e-3, 2.3e-3, -2.9e-3)
# and by so much where it is asked whether what follows is a straight line
FAR = (0.5, 1.0, -0.5, -1.0)
# values of signals, of which some fit any
LEVELS = (1.0, 0.5, 300.0, 0.0, -1.0)
# arrays that hold signals alone
OF_SIGNALS = {"input_first", "input_count", "input_period", "input_value", "segment_time", "segment_coef"}


@dataclass(frozen=True, eq=False)
class SystemParameter:
    """Something of a driveline that may be changed, by its name in `System.changed`."""

    name: str
    value: Any
    unit: str
    bounds: tuple[float, float]  # what its declaration allows
    # places that another value changes in each array, in flat order; empty: none, or all arrays get other sizes
    reach: Reach
    is_word: bool  # each of these is the number itself
    inputs: tuple[int, ...]  # numbers of the signals that it is, or is inside of
    _spec: Spec
    _system: SystemData
    _another: Any  # another value that it may have; None: there is none

    @property
    def is_plain(self) -> bool:
        """Whether it is declared as a number."""
        return self._spec.what in ("param", "option")

    @property
    def is_whole(self) -> bool:
        """Whether it is a whole number, such as one of teeth."""
        return self._spec.whole

    @property
    def about(self) -> str:
        """What its declaration says of it."""
        return self._spec.doc

    @property
    def is_signal(self) -> bool:
        """Whether it reaches signals and nothing else."""
        return bool(self.inputs) and self.reach.keys() <= OF_SIGNALS

    @property
    def is_sum(self) -> bool:
        """Whether its words are sums over it and others like it, as the mass matrix is over inertias."""
        return self.derivative is not None and not self.is_word

    @cached_property
    def words(self) -> Places:
        """Words of eight bytes in the bytes of the System that it changes, in order."""
        known = {name: places for name, places in self.reach.items() if _is_real(self._system, name)}
        found = [self._system.starts[name] // 8 + places for name, places in known.items()]
        return np.sort(np.concatenate([np.zeros(0, dtype=np.int64), *found]))

    @cached_property
    def derivative(self) -> NDArray[np.float64] | None:
        """Derivatives of its words, the same for all values; None: they depend on the value, or are unknown."""
        if self.is_word:
            return np.ones(len(self.words))
        known = masses(self._system) if is_mass(self.name) else None
        if known is None or self.name not in known.places:
            return None
        starts, made = self._system.starts, known.derivatives(self.name)
        found = {starts[array] // 8 + place: slope for (array, place), slope in made.items()}
        # where inertias are round, a word beside those of the masses may depend on them too
        if not found.keys() >= set(self.words.tolist()):
            return None
        return np.array([found[word] for word in self.words.tolist()])

    @cached_property
    def stays(self) -> Stays | None:
        """Why it cannot change while a run goes on, and what to do instead; None: it can."""
        if self.is_signal:
            return None if self._spec.what in SIGNALS else SIGNAL
        other = None if self._another is None else _changed(self._system, self.name, self._another)
        if other is None:
            return OTHER
        return stays(self._system, self._system, other) or (None if self.reach else NOTHING)

    @cached_property
    def slopes(self) -> NDArray[np.float64] | None:
        """Derivatives of its words where all of them are straight lines over its value; None elsewhere."""
        if self.derivative is not None:
            return self.derivative
        system, value = self._system, float(self.value)
        made = [(x, new) for x in self.far if (new := _changed(system, self.name, x)) is not None]
        is_real = all(_is_real(system, array) for array in self.reach)
        if not is_real or len(made) < 2 or any(differing(system, new) is None for _, new in made):
            return None
        base = _words(system)
        found = np.array([(_words(new) - base) / (x - value) for x, new in made])
        # the last digits of words are round-off
        straight = np.allclose(found, found[0], rtol=1e-12, atol=1e-14 * np.max(np.abs(found)))
        moved = np.flatnonzero(found[0])
        return found[0][moved] if straight and np.array_equal(moved, self.words) else None

    @property
    def far(self) -> list[float]:
        """Values within its bounds that are far from its own."""
        value, (low, high) = float(self.value), self.bounds
        return [x for share in FAR if low < (x := value + share * (abs(value) or 1.0)) < high]

    @property
    def when(self) -> str:
        """When it may change: "during a run" or "before a run"."""
        return "during a run" if self.stays is None else "before a run"

    def is_word_at(self, value: float) -> bool:
        """Whether with another value its words are that, and nothing else changes."""
        made = _changed(self._system, self.name, value)
        return made is not None and _is_value(made, differing(self._system, made), self.reach, value)


class JointChanges:
    """Whether numbers of a System act on its words apart from each other, where several change at once."""

    def __init__(self, system: SystemData, numbers: Mapping[str, SystemParameter]) -> None:
        self._system, self._base = system, _words(system)
        moved = {name: _moved(system, name, found.far) for name, found in numbers.items()}
        self._values = {name: one[0] for name, one in moved.items() if one is not None}
        self._changes = {name: one[1] - self._base for name, one in moved.items() if one is not None}

    def add_up(self, names: Sequence[str]) -> bool:
        """Whether the words with other values of all of them are the sums of what each changes alone."""
        if any(name not in self._values for name in names):
            return False
        made = _with(self._system, {name: self._values[name] for name in names})
        if made is None or differing(self._system, made) is None:
            return False
        change, found = sum(self._changes[name] for name in names), _words(made) - self._base
        return bool(np.allclose(found, change, rtol=1e-9, atol=1e-12 * max(float(np.max(np.abs(found))), 1e-300)))


def _moved(system: SystemData, name: str, values: Sequence[float]) -> tuple[float, NDArray[np.float64]] | None:
    """Another value that is taken, and the words with it."""
    made = ((value, _changed(system, name, value)) for value in values)
    return next(((value, _words(one)) for value, one in made if one is not None), None)


class SystemParameters(Mapping[str, SystemParameter]):
    """Everything of a System that may be changed, by name; each is looked at when it is first asked for."""

    def __init__(self, system: SystemData) -> None:
        if system.source is None:
            raise ModelError([UNKNOWN_SOURCE])
        self._system, self._source = system, system.source

    def __getitem__(self, name: str) -> SystemParameter:
        if target(owners_of(self._system), name) is None:
            raise KeyError(f"{name!r} is not a number that can be changed{near(name, self)}")
        return parameter(self._system, name)

    def __iter__(self) -> Iterator[str]:
        return all_names(self._source)

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __repr__(self) -> str:
        return f"<SystemParameters: {', '.join(self)}>"


@memoize
def parameter(system: SystemData, name: str) -> SystemParameter:
    """One of them; its name must be known."""
    aim: Any = target(owners_of(system), name)
    value, spec = field_of(aim)
    looks = islice(_looks(system, name, _others(value, spec)), 2)
    first: Look = next(looks, (None, system, {}))
    # a signal may be what is tried first
    other, made, reach = first if first[2] else next((look for look in looks if look[2]), first)
    is_number = isinstance(value, Real) and not isinstance(value, bool) and not is_shared(aim) and bool(reach)
    # on both sides, which are assembled only where the first one is such
    sides = chain([(other, made, reach)], looks)
    is_word = is_number and all(_is_value(made, differs, reach, there) for there, made, differs in sides)
    inputs = _inputs(system, made, aim, other)
    return SystemParameter(name, value, unit_of(aim), spec.ends, reach, is_word, inputs, spec, system, other)


def _looks(system: SystemData, name: str, values: Iterator[Any]) -> Iterator[Look]:
    """Values that are allowed, the System with each, and what differs there; nothing where arrays get other sizes."""
    for value in values:
        made = _changed(system, name, value)
        if made is not None:
            yield value, made, differing(system, made) or {}


def is_shared(aim: Target) -> bool:
    """Whether the assembly makes something of a number together with others, such as the larger of two."""
    return field_of(aim)[1].what == "option" or aim.path[-1] == "band"


def differing(one: SystemData, other: SystemData) -> Reach | None:
    """Places in which the arrays of two Systems differ in any bit; None where they are of different sizes."""
    found = dict[str, Places]()
    for name, array in one.arrays.items():
        new = other.arrays[name]
        if new.shape != array.shape:
            return None
        bits = np.dtype(f"u{array.dtype.itemsize}")
        if new is not array and np.any(unlike := array.reshape(-1).view(bits) != new.reshape(-1).view(bits)):
            found[name] = np.flatnonzero(unlike)
    return found


def _changed(system: SystemData, name: str, value: Any) -> SystemData | None:
    """The System with another value; None where that is refused."""
    return _with(system, {name: value})


def _with(system: SystemData, changes: Mapping[str, Any]) -> SystemData | None:
    """The System with other values; None where they are refused."""
    with warnings.catch_warnings():
        # what is rarely wanted was said of the driveline
        warnings.simplefilter("ignore", ModelWarning)
        try:
            return changed_system(system, changes)
        except ModelError:
            return None


def _others(value: Any, spec: Spec) -> Iterator[Any]:
    """Other values that the field may take, near the present one."""
    if isinstance(value, bool) or spec.choices:
        yield from (other for other in (spec.choices or (True, False)) if other != value)
    elif isinstance(value, Real):
        number: Any = value
        whole, scale = isinstance(number, int) and (spec.whole or spec.fixed), abs(float(number)) or 1.0
        steps = (1, -1) if whole else tuple(share * scale for share in PROBES)
        yield from (number + step for step in steps if spec.allows(number + step))
    elif isinstance(value, Signal) and type(value).segments is Table.segments:
        yield from map(Table, _tables(vars(value)["points"]))
    elif isinstance(value, Signal) and spec.what in SIGNALS:
        yield from (Table([(0.0, level), (1.0, level)]) for level in LEVELS if spec.allows(level))
    elif hasattr(value, "__len__") and spec.what in ("curve", "numbers"):
        yield from _tables(value)


def _tables(values: Any) -> Iterator[Any]:
    """Tables with other numbers, each by another share: ordinates of pairs, or all numbers of a list or of rows."""
    pairs = all(hasattr(row, "__len__") and len(row) == 2 for row in values)
    size = max((abs(float(row[1])) for row in values), default=0.0) or 1.0 if pairs else 0.0
    for share in PROBES if len(values) else ():
        moves = [share * (1 + i / len(values)) for i in range(len(values))]
        both = zip(values, moves, strict=True)
        yield [[row[0], row[1] + move * size] if pairs else _scaled(row, 1.0 + move) for row, move in both]


def _scaled(row: Any, factor: float) -> Any:
    return [one * factor for one in row] if hasattr(row, "__len__") else row * factor


def _is_value(made: SystemData, differs: Reach | None, reach: Reach, value: float) -> bool:
    """Whether a value itself is at all places, and nothing differs elsewhere."""
    if differs is None or not differs.keys() <= reach.keys():
        return False
    inside = all(np.isin(places, reach[name]).all() for name, places in differs.items())
    words = (made.arrays[name].reshape(-1)[places] for name, places in reach.items() if _is_real(made, name))
    return inside and all(map(partial(_is_real, made), reach)) and all(np.all(own == value) for own in words)


def _words(system: SystemData) -> NDArray[np.float64]:
    """All real numbers of a System by their places in its bytes; zero where something else is."""
    words = np.zeros(len(system.to_bytes()) // 8)
    for name, array in system.arrays.items():
        if _is_real(system, name):
            first = system.starts[name] // 8
            words[first : first + array.size] = array.reshape(-1)
    return words


def _is_real(system: SystemData, array: str) -> bool:
    return bool(system.arrays[array].dtype.kind == "f")


def _inputs(system: SystemData, made: SystemData, aim: Target, value: Any) -> tuple[int, ...]:
    """Numbers of the signals that something is, or is inside of."""
    signal = _signal_with(aim, value)
    both = enumerate(zip(system.inputs, made.inputs, strict=True)) if signal is not None else ()
    return tuple(number for number, (old, new) in both if new.signal == signal != old.signal)


def _signal_with(aim: Target, value: Any) -> Signal | None:
    """The signal that a value makes; None where it is in none."""
    for cut in range(1, len(aim.path) + 1):
        outer, spec = field_of(Target(aim.owner, aim.path[:cut]))
        if spec.what in SIGNALS:
            rest = aim.path[cut:]
            return renewed(outer, [(rest, value)]) if rest else plain_signal(value)
    return None

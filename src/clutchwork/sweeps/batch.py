"""Blocks of variants through the compiled core, and the outputs from what it gives."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import row_columns
from clutchwork.base import UseError, listed, near
from clutchwork.declare.core import core
from clutchwork.declare.layout import DONE, INTERRUPTED
from clutchwork.results.channels import Channels, channels
from clutchwork.results.forms import LOCKED, all_reads, is_of_structure
from clutchwork.sweeps.axes import Plan, systems_of
from clutchwork.sweeps.outputs import (
    AtEnd,
    AtTimes,
    Computed,
    Extreme,
    FeltJerk,
    Integral,
    Output,
    SquaredJerk,
    When,
    missing,
)
from clutchwork.sweeps.parts import PARTS, squared_jerk, steps_of

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.options import Options
    from clutchwork.sweeps.system_words import Axis
    from clutchwork.sweeps.variants import Codes

Array = NDArray[Any]
Progress = Callable[[int], None]

# numbers that one block may keep, some 64 MB
MOST_KEPT = 8_000_000
# variants of one block: enough that threads seldom wait for the last one, few enough to report progress
MOST_VARIANTS = 2048
# the same where rows in steps are kept, which are looked at while they are in the cache
MOST_IN_STEPS = 512
# rows that a variant is expected to have in steps
ROWS_EXPECTED = 2000
# outputs that are looked for within the steps
IN_STEPS = (Extreme, SquaredJerk)


@dataclass(frozen=True)
class RunSetup:
    """How the core is to run: up to when, with which options, on how many threads."""

    t_end: float
    options: Options
    threads: int


@dataclass(frozen=True, eq=False)
class CoreOutputs:
    """The outputs that the core gives, and the rows they need."""

    outputs: Mapping[str, Output]
    channels: Channels
    contacts: tuple[str, ...]
    begin: float  # s
    t_end: float

    @classmethod
    def of(cls, system: System, options: Options, outputs: Mapping[str, Output], t_end: float) -> CoreOutputs:
        """Of a System, without those that need a Trajectory."""
        known = channels(system, options.angles, options.work)
        native = {name: one for name, one in outputs.items() if not isinstance(one, Computed)}
        return cls(native, known, tuple(contact.name for contact in system.contacts), options.t_start, t_end)

    def __post_init__(self) -> None:
        """Refuse names that are not there, all at once."""
        problems = [text for one in self.outputs.values() for text in self._faults(one)]
        if problems:
            raise UseError("sweep", problems)

    def _faults(self, one: Output) -> Iterator[str]:
        if isinstance(one, When):
            if one.contact not in self.contacts:
                there = f"contacts are {listed(self.contacts)}" if self.contacts else "the driveline has no contact"
                yield f"no contact {one.contact!r}{near(one.contact, self.contacts, there)}"
        elif not isinstance(one, Computed):
            try:
                self.channels[one.signal]
            except KeyError as error:
                yield missing(one, str(error), self.channels)
                return
            if isinstance(one, Integral) and not one.kept_as(self.channels):
                yield f"{one.signal} has no exact integral: {self._instead(one.signal.removesuffix('.loss'))}"
            if isinstance(one, FeltJerk):
                yield from one.faults(self.begin, self.t_end)
            if isinstance(one, Extreme) and not self.channels[one.signal].unit:
                yield f"{one.signal} is a word, which has no {one.kind}; take {one.signal.removesuffix('state')}mode"
            if isinstance(one, AtTimes) and one.times[-1] > self.t_end:
                yield f"{one.name} {one.times[-1]:g} s is after t_end = {self.t_end:g} s"
            if isinstance(one, AtTimes) and one.times[0] < self.begin:
                yield f"{one.name} {one.times[0]:g} s is before t_start = {self.begin:g} s"

    def _instead(self, motor: str) -> str:
        """What to take for an integral that there is not."""
        drawn = next((name for name in self.channels if name.startswith(f"{motor}.") and name.endswith("_energy")), "")
        if drawn:
            return f"it is what {drawn} grows by, less what {motor}.work does; take both as outputs"
        return "give a power of an element, a speed or an acceleration, or a function of the run"

    def signals(self, *kinds: type) -> list[str]:
        """Signals that outputs of some kinds are made of."""
        found = list[Any](one for one in self.outputs.values() if isinstance(one, kinds))
        return [one.signal if isinstance(one, IN_STEPS) else self.kept_as(one) for one in found]

    @cached_property
    def grid(self) -> Array:
        """Instants of the grid: those asked for, the start of integrals, the end."""
        asked = {time for one in self.outputs.values() if isinstance(one, AtTimes) for time in one.times}
        start = {self.begin} if self.signals(Integral) else set()
        felt = {time for one in self.outputs.values() if isinstance(one, FeltJerk) for time in self.felt(one).tolist()}
        # one at an event is shown once, from the left, as a run that is asked for it
        return np.array(sorted(asked | start | felt | {self.t_end}))

    def felt(self, one: FeltJerk) -> Array:
        """Instants at which a jerk needs the speed."""
        return one.times(self.begin, self.t_end)

    @cached_property
    def all_signals(self) -> tuple[str, ...]:
        """Signals that any output is made of."""
        return tuple(dict.fromkeys(self.signals(AtEnd, AtTimes, FeltJerk, Integral, *IN_STEPS)))

    @property
    def in_steps(self) -> bool:
        """Whether rows within the steps of the solver are needed."""
        return bool(self.signals(*IN_STEPS))

    @property
    def needs_grid(self) -> bool:
        """Whether rows at instants are needed that the steps do not give."""
        return bool(self.signals(AtTimes, FeltJerk)) or not self.in_steps

    def kept_as(self, one: AtEnd | AtTimes | FeltJerk | Integral) -> str:
        """The signal that an output is read from."""
        return one.kept_as(self.channels) if isinstance(one, Integral) else one.signal

    @property
    def events(self) -> bool:
        """Whether events are needed."""
        return any(isinstance(one, When) for one in self.outputs.values())


@dataclass(frozen=True, eq=False)
class Block:
    """What the core gave for consecutive variants."""

    first: int
    status: Array
    detail: Array
    values: dict[str, Array]
    raised: BaseException | None


class Batch:
    """All variants of a plan, block by block."""

    def __init__(self, plan: Plan, wanted: CoreOutputs, way: RunSetup) -> None:
        self.plan, self.wanted, self.way = plan, wanted, way

    @property
    def length(self) -> int:
        """Variants of one block."""
        columns = sorted(all_reads(self.wanted.channels[name].evaluate for name in self.wanted.all_signals))
        rows = len(self.wanted.grid) + (ROWS_EXPECTED if self.wanted.in_steps else 0)
        most = min(MOST_VARIANTS, MOST_IN_STEPS) if self.wanted.in_steps else MOST_VARIANTS
        return max(1, min(most, MOST_KEPT // (rows * (len(columns) + 1))))

    def run(self, first: int, last: int, progress: Progress | None) -> Block:
        """Variants from first to last."""
        systems, base = self.plan.systems(first, last)
        self._refuse_other_rows(systems)
        forms = Forms(self.plan, self.wanted, first, last, systems, base)
        block = Block(first, np.full(last - first, INTERRUPTED), np.full((last - first, 4), np.nan), {}, None)
        before = 0
        for axes, members in self._layouts(systems):
            who = np.flatnonzero(np.isin(base, members))
            if not len(who):
                continue
            call = Call(axes, [systems[member] for member in members], np.searchsorted(members, base[who]), who)
            told = None if progress is None else partial(_add, progress, before)
            block = self._ran(block, call, forms, told)
            if block.raised is not None:
                break
            before += len(who)
        return block

    def _refuse_other_rows(self, systems: Sequence[System]) -> None:
        sizes = row_columns(self.plan.base.counts)
        if any(row_columns(system.counts) != sizes for system in systems):
            message = "values that vary give the driveline other states, so that its signals are others"
            raise UseError("sweep", [f"{message}; sweep over each kind of driveline on its own"])

    def _layouts(self, systems: Sequence[System]) -> Iterator[tuple[list[Axis], NDArray[np.int64]]]:
        """Axes, and numbers of the systems that they fit: all whose arrays have the same lengths."""
        if not self.plan.axes:
            yield [], np.arange(len(systems))
            return
        own, groups = self.plan.key(self.plan.base), dict[Any, list[int]]()
        whole = [number for number, system in enumerate(systems) if id(system) in self.plan.whole]
        if whole:
            yield [], np.array(whole)
        for number, system in enumerate(systems):
            if id(system) not in self.plan.whole:
                groups.setdefault(self.plan.key(system), []).append(number)
        for key, members in groups.items():
            axes = self.plan.axes if key == own else self.plan.axes_on(systems[members[0]])
            yield axes, np.array(members)

    def _ran(self, block: Block, call: Call, forms: Forms, progress: Progress | None) -> Block:
        """The block with what the core gave for some of its variants."""
        wanted, found = self.wanted, None
        if wanted.in_steps:
            found = self._native(call, forms, PARTS, None if wanted.needs_grid else progress)
            _keep_ends(block, call, found)
            _from_steps(block, call, forms, found)
        if wanted.needs_grid and (found is None or found.raised is None):
            found = self._native(call, forms, 0, progress)
            _keep_ends(block, call, found)
            _from_grid(block, call, forms, found)
        assert found is not None  # noqa: S101, one of both is needed
        if wanted.events:
            _from_events(block, call, wanted, found)
        # what was begun and not ended counts as not begun
        for values in block.values.values():
            values[block.status == INTERRUPTED] = np.nan if values.dtype.kind == "f" else ""
        return replace(block, raised=found.raised)

    def _native(self, call: Call, forms: Forms, parts: int, progress: Progress | None) -> Native:
        axes = [(axis.place, axis.words) for axis in call.axes]
        codes = [axis.codes[forms.first + call.who] for axis in call.axes]
        choice = np.ascontiguousarray(np.stack([call.base, *codes], axis=1), dtype=np.int64)
        options = list(self.way.options.core_options().items())
        grid = np.zeros(0) if parts else self.wanted.grid
        systems = [system.to_bytes() for system in call.systems]
        threads = min(self.way.threads, max(1, len(call.who) // 2))
        columns, events = np.array(forms.columns, dtype=np.int64), self.wanted.events
        inside = np.array(sorted(forms.inside), dtype=np.int64) if parts else columns
        return Native(
            *core().sweep(
                systems, axes, choice, options, self.way.t_end, grid, parts, columns, events, threads, progress, inside
            )
        )


def _add(progress: Progress, before: int, done: int) -> None:
    progress(before + done)


@dataclass(frozen=True, eq=False)
class Call:
    """Variants of one layout: their axes, their Systems, which of these each has, and its place in the block."""

    axes: Sequence[Axis]
    systems: Sequence[System]
    base: NDArray[np.int64]
    who: NDArray[np.intp]


class Native(NamedTuple):
    """What one call of the core gives."""

    status: Array
    detail: Array
    rows: Array | None  # of a grid: variants, instants, columns
    # of each thread: variants, counts, times, rows of what is read inside of steps, events, first and last rows
    parts: list[tuple[Array, Array, Array, Array, Array, Array]]
    raised: BaseException | None


class Forms:
    """How signals follow from the columns that are kept, for each variant of a block."""

    def __init__(
        self, plan: Plan, wanted: CoreOutputs, first: int, last: int, systems: Sequence[System], base: NDArray[np.int64]
    ) -> None:
        self.wanted, self.first = wanted, first
        made = dict[tuple[str, ...], tuple[list[Channels], NDArray[np.int64]]]()
        bound = tuple(one.name for one in plan.bound)
        whole = dict[str, tuple[list[Any], NDArray[np.int64]]]()
        for name in wanted.all_signals:
            form = wanted.channels[name].evaluate
            if is_of_structure(name, form):
                whole[name] = [form], np.zeros(last - first, dtype=np.int64)
                continue
            relevant = plan.relevant(name)
            names = tuple(one.name for one in relevant)
            if names not in made:
                own, which = (systems, base) if names == bound else systems_of(plan.base, relevant, first, last)
                made[names] = [channels(system, True, True) for system in own], which
            found, which = made[names]
            whole[name] = [signals[name].evaluate for signals in found], which
        self.columns = sorted(all_reads(form for forms, _ in whole.values() for form in forms))
        in_steps = wanted.signals(*IN_STEPS)
        self.inside = all_reads(form for name, (forms, _) in whole.items() if name in in_steps for form in forms)
        self.forms = _over(self.columns, whole)
        self.inner = _over(sorted(self.inside), {name: whole[name] for name in in_steps})

    def values(self, name: str, rows: Array, variant: Callable[[], Array], inside: bool = False) -> Array:
        """A signal over rows.

        Parameters: variant, gives of which variant of the block each row is, where forms differ; inside, rows of what
        is read in steps.
        """
        forms, which = (self.inner if inside else self.forms)[name]
        if len(forms) == 1:
            return np.asarray(forms[0](rows))
        found = np.empty(len(rows))
        codes = which[variant()]
        for code, form in enumerate(forms):
            mine = codes == code
            found[mine] = form(rows[mine])
        return found


def _over(columns: Sequence[int], forms: Mapping[str, tuple[list[Any], Codes]]) -> dict[str, tuple[list[Any], Codes]]:
    """Forms over rows that have these columns alone."""
    places = {column: place for place, column in enumerate(columns)}
    return {name: ([form.over(places) for form in own], which) for name, (own, which) in forms.items()}


def _keep_ends(block: Block, call: Call, found: Native) -> None:
    """Take over how the variants ended."""
    block.status[call.who] = found.status
    block.detail[call.who] = found.detail


def _place(block: Block, name: str, like: Array, more: tuple[int, ...] = ()) -> Array:
    """The values of an output for the whole block, empty before the first call."""
    if name not in block.values:
        plain = like.dtype.kind in "fiub"
        shape = (len(block.status), *more)
        block.values[name] = np.full(shape, np.nan) if plain else np.full(shape, "", dtype=like.dtype)
    return block.values[name]


def _from_grid(block: Block, call: Call, forms: Forms, found: Native) -> None:
    """Signals at instants and at the end, and changes from the start to the end."""
    wanted, rows = forms.wanted, found.rows
    assert rows is not None  # noqa: S101, the call was for a grid
    flat = rows.reshape(rows.shape[0] * rows.shape[1], rows.shape[2])
    variant = partial(np.repeat, call.who, rows.shape[1])
    reached = (found.status == DONE)[:, None] | ~np.isnan(rows).all(axis=2) if rows.shape[2] else None
    for name, one in wanted.outputs.items():
        if isinstance(one, AtTimes | AtEnd | FeltJerk | Integral):
            signal = wanted.kept_as(one)
            whole = forms.values(signal, _finite(flat), variant).reshape(rows.shape[:2])
            _set_grid(block, call, name, one, wanted, whole, reached)


def _finite(rows: Array) -> Array:
    """Rows that were not reached hold NaN; as a mode of a contact they must be a number."""
    return np.where(np.isnan(rows), 0.0, rows)


def _set_grid(
    block: Block, call: Call, name: str, one: Output, wanted: CoreOutputs, values: Array, reached: Array | None
) -> None:
    there = np.ones(values.shape, dtype=bool) if reached is None else reached
    if isinstance(one, AtTimes):
        at = np.searchsorted(wanted.grid, one.times)
        out = _place(block, name, values, (len(one.times),))
        out[call.who] = np.where(there[:, at], values[:, at], out[call.who])
        return
    out = _place(block, name, values)
    ended = block.status[call.who] == DONE
    if isinstance(one, FeltJerk):
        chosen = one.largest(values[:, np.searchsorted(wanted.grid, wanted.felt(one))])
    else:
        chosen = values[:, -1] - values[:, 0] if isinstance(one, Integral) else values[:, -1]
    out[call.who[ended]] = chosen[ended]


def _from_steps(block: Block, call: Call, forms: Forms, found: Native) -> None:
    """Extremes over the steps, and the same as from a grid where the last row is enough."""
    wanted = forms.wanted
    for variants, counts, times, rows, _, edges in found.parts:
        some = counts > 0
        who, starts = call.who[variants[some]], (np.cumsum(counts) - counts)[some]
        variant, alone = partial(np.repeat, call.who[variants], counts), partial(np.asarray, who)
        ended, first, last = block.status[who] == DONE, edges[some, 0], edges[some, 1]
        for name, one in wanted.outputs.items():
            if isinstance(one, Extreme):
                values = forms.values(one.signal, rows, variant, True)
                _place(block, name, values)[who] = one.reduced(values, starts) if len(starts) else ()
            elif isinstance(one, SquaredJerk):
                jerks = _squared(times, forms.values(one.signal, rows, variant, True), starts)
                _place(block, name, jerks)[who[ended]] = jerks[ended]
            elif isinstance(one, AtEnd | Integral) and not wanted.needs_grid:
                value = forms.values(wanted.kept_as(one), last, alone)
                if isinstance(one, Integral):
                    value = value - forms.values(wanted.kept_as(one), first, alone)
                _place(block, name, value)[who[ended]] = value[ended]


def _squared(times: Array, values: Array, starts: Array) -> Array:
    """Squared jerk of each stretch of rows that begins at one of the starts."""
    bounds = pairwise([*starts.tolist(), len(times)])
    found = [squared_jerk(times[a:b], values[a:b], steps_of(times[a:b])) for a, b in bounds]
    return np.array(found, dtype=float)


def _from_events(block: Block, call: Call, wanted: CoreOutputs, found: Native) -> None:
    """Times of events."""
    events = np.concatenate([part[4] for part in found.parts]) if found.parts else np.zeros((0, 5))
    for name, one in wanted.outputs.items():
        if isinstance(one, When):
            mine = events[events[:, 2] == wanted.contacts.index(one.contact)]
            was, became = mine[:, 3] == LOCKED, mine[:, 4] == LOCKED
            mine = mine[became & ~was if one.kind == "lock" else was & ~became]
            mine = mine[np.lexsort((mine[:, 1], mine[:, 0]))]
            variants = mine[:, 0].astype(np.int64)
            firsts = np.searchsorted(variants, np.arange(len(call.who)), "left")
            lasts = np.searchsorted(variants, np.arange(len(call.who)), "right")
            place = firsts + one.number - 1 if one.number > 0 else lasts + one.number
            there = (place >= firsts) & (place < lasts)
            _place(block, name, np.zeros(1))[call.who[there]] = mine[place[there], 1]

"""Many runs of one driveline with other numbers, in one call."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Unpack

from clutchwork.assembly.system import System
from clutchwork.base import ModelWarning, caller
from clutchwork.base.progress import followed
from clutchwork.declare.calls import explained
from clutchwork.declare.options import Options
from clutchwork.executors.choice import executor
from clutchwork.executors.pace import chunk_size
from clutchwork.run.simulation import Assembles
from clutchwork.sweeps.batch import Block
from clutchwork.sweeps.outputs import Asked
from clutchwork.sweeps.request import ordered, refuse_unfit, threads_of
from clutchwork.sweeps.result import Missing, OutputWarning, Sweep
from clutchwork.sweeps.runs import ended, run_all
from clutchwork.sweeps.variants import Variants

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from clutchwork.declare.node import Number
    from clutchwork.declare.option_fields import OptionFields
    from clutchwork.executors.executor import Alive
    from clutchwork.sweeps.request import Order

Told = Callable[[int, int], None]


@explained("sweep")
def sweep(
    model: Assembles | System,
    t_end: Number | None = None,
    *,
    vary: Any,
    outputs: Mapping[str, Asked] | Sequence[Asked] | Asked,
    threads: int | None = None,
    on: Any = None,
    options: Options | None = None,
    progress: bool | Told = False,
    **changes: Unpack[OptionFields],
) -> Sweep:
    """Run a Driveline or a System with many sets of values, and keep the chosen outputs of each run.

    Parameters: t_end [s], or with a unit, options and their fields by name are those of `simulate`; vary, values by
    name (all combinations), a list with the values of each variant, `cw.variants` or a DataFrame; in place of values
    `cw.times(0.9, 1.1)` multiplies the numbers in the model of all names that match a pattern; outputs, what is
    kept; threads, how many run at once, by default as many as there are cores; on, where they run: this process,
    "ray" or "dask" for processes, the address of a cluster for other machines; progress, True for a bar of tqdm, or a
    function of (variants done, variants).

    Names are those of `System.changed`; values may have units, "2 bar", and are kept in SI. An output is the name of a
    signal, for its value at the end, `cw.at`, `cw.maximum`, `cw.minimum`, `cw.peak`, `cw.integral`, `cw.jerk`,
    `cw.lock` or `cw.break_away`, or a function of the Trajectory; a mapping gives them names.

    A variant that stops early has its status, and does not affect the others; the value of a function that raises is
    missing, with an `OutputWarning`, and `problems` of the result lists all of them. Ctrl-C ends the sweep with what is
    done.
    """
    order, count = ordered("sweep", model, t_end, vary, outputs, options, changes), threads_of(threads)
    with followed(progress, len(order), "sweep", "(done, variants)", unit=" runs") as told, warnings.catch_warnings():
        # a value may be rarely wanted; that of a single run is given there
        warnings.simplefilter("ignore", ModelWarning)
        if on is None:
            made = run_all(order.whole, count, told or _silent)
        else:
            made = run_on(order, on, count, threads, told or _silent)
    if made.problems:
        one, *more = made.problems
        also = f"; {len(more)} more, which .problems lists" if more else ""
        warnings.warn(OutputWarning(f"{one}{also}; the value is missing"), stacklevel=caller())
    return made


def _silent(done: int) -> None:
    """No progress was requested."""


@dataclass(frozen=True, eq=False)
class VariantChunk:
    """Consecutive variants."""

    first: int
    variants: Variants


@dataclass(frozen=True, eq=False)
class ChunkResult:
    """What a worker found of a piece."""

    block: Block
    problems: list[Missing]


def run_on(order: Order, on: Any, threads: int, asked: int | None, told: Callable[[int], None]) -> Sweep:
    """The result for all variants; SweepInterrupted with what is done after Ctrl-C."""
    whole = order.whole
    made, done, job = Sweep.empty(whole), 0, order.without_variants
    refuse_unfit(order.system, whole.variants)
    with executor("sweep", on, threads, asked) as workers:
        try:
            size = chunk_size(workers, job, len(order), lambda count: worked(job, _piece(order, 0, count)))
            with closing(workers.run(worked, job, pieces(order, size))) as all_found:
                for found in all_found:
                    made.take(found.block)
                    made.problems.extend(found.problems)
                    done += len(found.block.status)
                    told(done)
        except KeyboardInterrupt as stop:
            return ended(made, stop)
    made.problems.sort()
    return made


def pieces(order: Order, size: int) -> Iterator[VariantChunk]:
    """All variants, so many at a time."""
    return (_piece(order, first, min(first + size, len(order))) for first in range(0, len(order), size))


def _piece(order: Order, first: int, last: int) -> VariantChunk:
    return VariantChunk(first, order.source.part(first, last))


def worked(job: Order, piece: VariantChunk, alive: Alive | None = None) -> ChunkResult:
    """What a worker does with a piece."""
    told = (lambda _: None) if alive is None else (lambda _: alive())
    made = run_all(job.of(piece.variants), 1, told)
    problems = [one._replace(variant=piece.first + one.variant) for one in made.problems]
    return ChunkResult(Block(piece.first, made.codes, made.detail, made.values, None), problems)

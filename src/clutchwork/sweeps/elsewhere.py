"""The runs of a sweep on the workers of an executor, chunk by chunk; the same bits as in this process."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from clutchwork.executors.choice import executor
from clutchwork.executors.pace import chunk_size
from clutchwork.sweeps.batch import Block
from clutchwork.sweeps.request import refuse_unfit
from clutchwork.sweeps.result import Missing, Sweep
from clutchwork.sweeps.runs import ended, run_all
from clutchwork.sweeps.variants import Variants

if TYPE_CHECKING:
    from clutchwork.executors.executor import Alive
    from clutchwork.sweeps.request import Order


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

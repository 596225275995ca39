"""What a worker does with a chunk: run it, write it, return its number."""

from __future__ import annotations

import socket
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from clutchwork.executors.executor import ExecutorError
from clutchwork.studies.parts import DataField, Written, file_of, write
from clutchwork.sweeps.runs import run_all

if TYPE_CHECKING:
    from clutchwork.executors.executor import Alive
    from clutchwork.sweeps.request import Order
    from clutchwork.sweeps.variants import Variants


@dataclass(frozen=True, eq=False)
class StudyJob:
    """What all chunks share."""

    order: Order  # without its variants
    folder: Path
    columns: tuple[DataField, ...]


@dataclass(frozen=True, eq=False)
class Chunk:
    """Consecutive variants, for one part of the data set."""

    number: int
    first: int
    variants: Variants


def work(job: StudyJob, chunk: Chunk, alive: Alive) -> tuple[int, Written]:
    """Run and write a chunk; its number, and what is known of its part."""
    begun = time.time()
    made = run_all(job.order.of(chunk.variants), 1, lambda _: alive())
    return chunk.number, write(job.folder, chunk.number, job.columns, made, chunk.first, begun)


def refuse_elsewhere(folder: Path, number: int, made: Written) -> None:
    """ExecutorError where a worker has written into a folder that is not the one of this machine."""
    machine = made.worker.rpartition(" ")[0]
    if machine != socket.gethostname() and not file_of(folder, number).exists():
        remedy = "give a folder that all machines share under the same path"
        raise ExecutorError(f"{machine} wrote into {folder}, and nothing is there on this machine; {remedy}")

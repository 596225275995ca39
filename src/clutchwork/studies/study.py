"""Very many runs into a data set on disk, which goes on where it was ended."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from clutchwork.assembly.system import System, SystemFormatError
from clutchwork.base import ModelWarning, UseError, caller, quote
from clutchwork.base.paths import folder as made_folder
from clutchwork.base.paths import path_of
from clutchwork.base.progress import followed
from clutchwork.declare.calls import explained
from clutchwork.declare.options import Options
from clutchwork.executors.choice import executor
from clutchwork.executors.pace import chunk_size
from clutchwork.run.simulation import Assembles
from clutchwork.studies.fingerprints import of_source
from clutchwork.studies.lock import locked
from clutchwork.studies.manifest import FILE, MODEL, Manifest, asked_of, now, refuse_other, versions
from clutchwork.studies.parts import Written, columns_of, there, without_leftovers
from clutchwork.studies.result import Study
from clutchwork.studies.work import Chunk, StudyJob, refuse_elsewhere, work
from clutchwork.sweeps.outputs import Asked, Computed
from clutchwork.sweeps.request import Order, ordered, refuse_unfit, threads_of
from clutchwork.sweeps.result import OutputWarning
from clutchwork.sweeps.runs import in_python, run_all

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from clutchwork.declare.node import Number
    from clutchwork.declare.option_fields import OptionFields
    from clutchwork.executors.executor import Executor
    from clutchwork.sweeps.result import Sweep

Told = Callable[[int, int], None]
# variants that tell which columns there are
FIRST = 4


class StudyInterrupted(KeyboardInterrupt):
    """Ctrl-C during a study; `study` holds what is there, and the same call continues with the rest."""

    def __init__(self, message: str, study: Study) -> None:
        super().__init__(message)
        self.study = study

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.study)


@explained("study", folder="'out/study'")
def study(
    model: Assembles | System,
    t_end: Number | None = None,
    *,
    vary: Any,
    outputs: Mapping[str, Asked] | Sequence[Asked] | Asked,
    folder: str | Path,
    threads: int | None = None,
    on: Any = None,
    chunk: int | None = None,
    options: Options | None = None,
    progress: bool | Told = False,
    **changes: Unpack[OptionFields],
) -> Study:
    """Run very many variants into a data set of Parquet files, or continue one that was interrupted.

    Parameters: those of `sweep`, with `vary` best a `cw.design`, and folder, of the data set, on a disk that all
    workers share; chunk, how many variants go into one file, by default so many that a worker needs some seconds.

    Each worker writes its results, a chunk at a time; nothing else is kept in memory. The same call continues after an
    interruption of any kind, here or on other machines, and at most the chunks in progress are lost. A study that is
    complete is read, not run. StudyError where the folder holds a study of another model or design.
    """
    order, count = ordered("study", model, t_end, vary, outputs, options, changes), threads_of(threads, "study")
    if chunk is not None and (not isinstance(chunk, int) or isinstance(chunk, bool) or chunk < 1):
        raise UseError("study", [f"chunk is {quote(chunk)}: give a whole number of at least 1, or nothing"])
    where = made_folder(path_of("study", folder, "out/study").absolute())
    with locked(where), warnings.catch_warnings():
        # a value may be rarely wanted; that of a single run is given there
        warnings.simplefilter("ignore", ModelWarning)
        was = Study.load(where) if (where / FILE).exists() else None
        begin = 0 if was is None else len(was)
        with followed(progress, len(order), "study", "(done, variants)", begin, unit=" runs") as told:
            made = _Going(order, where, on, _at_once(order, count), threads, chunk).all(was, told or _silent)
    missing = sum(part.missing for part in made.parts.values())
    if missing:
        message = f"functions of outputs raised {missing} times; these values are missing"
        warnings.warn(OutputWarning(message), stacklevel=caller())
    return made


def _silent(done: int) -> None:
    """No progress was requested."""


def _at_once(order: Order, count: int) -> int:
    """Threads that are of use: what calls Python in a run gains nothing by several."""
    computed = any(isinstance(one, Computed) for one in order.outputs.values())
    return 1 if computed or in_python(order.of(order.source.part(0, min(1, len(order))))) else count


class _Going:
    """A study while it runs."""

    def __init__(self, order: Order, folder: Path, on: Any, threads: int, asked: int | None, chunk: int | None) -> None:
        self.order, self.folder, self.chunk = order, folder, chunk
        self.on, self.threads, self.asked = on, threads, asked

    def all(self, was: Study | None, told: Callable[[int], None]) -> Study:
        """Run what is missing of what was there, or everything."""
        fingerprint, ends = of_source(self.order.source)
        wanted = asked_of(self.order, fingerprint)
        if was is not None:
            refuse_other(self.folder, was.manifest, wanted, self.order.system.model)
            without_leftovers(self.folder)
            if was.complete:
                return was
            with executor("study", self.on, self.threads, self.asked) as workers:
                return self._run(workers, was.manifest, was.parts, told)
        refuse_unfit(self.order.system, ends)
        first = self._first(FIRST)
        with executor("study", self.on, self.threads, self.asked) as workers:
            return self._run(workers, self._begun(workers, wanted, first), {}, told)

    def _first(self, count: int) -> Sweep:
        part = self.order.source.part(0, min(count, len(self.order)))
        return run_all(self.order.of(part), 1, _silent)

    def _begun(self, workers: Executor, wanted: Mapping[str, Any], first: Sweep) -> Manifest:
        """Everything that is known before the first chunk, written."""
        columns = columns_of(first)
        size = self.chunk or chunk_size(workers, self._job(columns), len(self.order), self._first)
        manifest = Manifest(
            name=self.order.system.name,
            asked=wanted,
            count=len(self.order),
            chunk=size,
            columns=columns,
            varied=len(first.varied),
            versions=versions(),
            begun=now(),
        )
        try:
            self.order.system.save(self.folder / MODEL)
        except SystemFormatError:
            # with a function of Python in it; the study has its fingerprint
            (self.folder / MODEL).unlink(missing_ok=True)
        manifest.write(self.folder)
        return manifest

    def _job(self, columns: Any) -> StudyJob:
        return StudyJob(self.order.without_variants, self.folder, columns)

    def _run(
        self, workers: Executor, manifest: Manifest, parts: dict[int, Written], told: Callable[[int], None]
    ) -> Study:
        made = Study(self.folder, manifest, dict(parts))
        chunks = self._chunks(manifest, [number for number in manifest.sizes if number not in parts])
        try:
            with closing(workers.run(work, self._job(manifest.columns), chunks)) as found:
                for number, part in found:
                    refuse_elsewhere(self.folder, number, part)
                    made.parts[number] = part
                    told(len(made))
        except KeyboardInterrupt:
            made = Study(self.folder, manifest, there(self.folder, manifest.sizes))
            message = f"interrupted: {len(made)} of {made.count} variants are in {self.folder}; the same call continues"
            raise StudyInterrupted(message, made) from None
        return made

    def _chunks(self, manifest: Manifest, missing: list[int]) -> Iterator[Chunk]:
        for number in missing:
            first = number * manifest.chunk
            yield Chunk(number, first, self.order.source.part(first, first + manifest.sizes[number]))

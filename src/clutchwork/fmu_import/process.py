"""An FMU in a process of its own: whatever it does there, a run goes on or ends with a sentence."""

from __future__ import annotations

import json
import select
import shutil
import signal
import subprocess
import sys
import weakref
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from tempfile import mkdtemp
from threading import Timer
from typing import BinaryIO

from clutchwork.base import FMUError
from clutchwork.fmu_import.archive import unpack
from clutchwork.fmu_import.library import Assignment
from clutchwork.fmu_import.messages import Answer, Command, Format
from clutchwork.fmu_import.worker import JOB

WORKER = ("-I", "-m", "clutchwork.fmu_import.worker")
# what Python gets to start [s]
START = 60.0
# what it gets to free itself at the end [s]
PATIENCE = 2.0
WORDS = {
    Answer.DISCARD: "refused to go on",
    Answer.ERROR: "reported an error",
    Answer.FATAL: "reported a fatal error",
    Answer.PENDING: "wants to go on in the background, which is not supported",
    Answer.NO_INSTANCE: "gave no instance",
    Answer.NO_LIBRARY: "cannot be loaded",
    Answer.TERMINATED: "asked for the end of the run",
}


class Process:
    """The process of an FMU, from its start to `close`; it goes with this object."""

    def __init__(self, path: Path, assigned: Assignment, time_limit: float) -> None:
        """Unpack an FMU and start its process; `time_limit` [s] for each answer. FMUError says what is wrong."""
        self._form, self._limit = Format(len(assigned.inputs), len(assigned.outputs)), time_limit
        self._none = [0.0] * len(assigned.inputs)
        # of mode 0700
        folder = mkdtemp(prefix="clutchwork-fmu-")
        try:
            unpack(path, Path(folder, "fmu"))
            Path(folder, JOB).write_text(
                json.dumps(assigned._replace(folder=str(Path(folder, "fmu")))._asdict()), "utf-8"
            )
            self._process = subprocess.Popen(  # noqa: S603, this Python
                [sys.executable, *WORKER, folder], stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=folder
            )
        except BaseException:
            shutil.rmtree(folder, ignore_errors=True)
            raise
        self._end = weakref.finalize(self, _ended, self._process, folder)
        if len(self._answer(max(time_limit, START)) or b"") < self._form.reply_size:
            self._end()
            raise FMUError("its process did not start: is clutchwork installed for this Python?")

    def ask(self, order: Command, time: float, size: float, inputs: Sequence[float]) -> tuple[float, ...]:
        """Let the FMU do something; its outputs. FMUError says how it failed."""
        told = self._form.request(order, time, size, inputs)
        try:
            _pipe(self._process.stdin).write(told)
            _pipe(self._process.stdin).flush()
            data = self._answer(self._limit)
        except OSError:
            data = b""
        except BaseException:
            # Ctrl-C: an answer to come would be taken for that of another order
            self._end()
            raise
        if data is None:
            self._end()
            raise FMUError(f"gave no answer within {self._limit:g} s; raise time_limit= if it may take longer")
        if len(data) < self._form.reply_size:
            raise FMUError(self._how_it_ended())
        reply = self._form.read_reply(data)
        if reply.answer is not Answer.DONE:
            raise FMUError(f"{WORDS[reply.answer]} ({reply.text})")
        return reply.outputs

    @property
    def ended(self) -> bool:
        """Whether it was ended."""
        return not self._end.alive

    def close(self) -> None:
        """Let it free itself, end the process and remove its folder."""
        if self._end.alive and self._process.poll() is None:
            # all that it was asked for it has answered: how it ends is of no account
            with suppress(OSError, subprocess.TimeoutExpired):
                _pipe(self._process.stdin).write(self._form.request(Command.END, 0.0, 0.0, self._none))
                _pipe(self._process.stdin).close()
                self._process.wait(PATIENCE)
        self._end()

    def _answer(self, limit: float) -> bytes | None:
        """The bytes of an answer, fewer where the process has ended; None where the time is over."""
        stream = _pipe(self._process.stdout)
        if hasattr(select, "poll"):
            waiting = select.poll()
            waiting.register(stream, select.POLLIN)
            # what follows the first byte of an answer is written already
            return stream.read(self._form.reply_size) if waiting.poll(1000.0 * limit) else None
        late = Timer(limit, self._process.kill)
        late.start()
        data = stream.read(self._form.reply_size)
        late.cancel()
        return data if data or not late.finished.is_set() else None

    def _how_it_ended(self) -> str:
        """How the process ended unexpectedly, in words."""
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(PATIENCE)
        self._end()
        code = self._process.returncode
        if code < 0:
            names = {one.value: one.name for one in signal.Signals}
            return f"crashed ({names.get(-code, f'signal {-code}')})"
        return f"ended its process by itself, with exit code {code}"


def _pipe(stream: object) -> BinaryIO:
    assert stream is not None  # noqa: S101, it was asked for
    return stream  # type: ignore[return-value]


def _ended(process: subprocess.Popen[bytes], folder: str) -> None:
    """End a process, with what it left."""
    process.kill()
    process.wait()
    for stream in (process.stdin, process.stdout):
        # what was not sent any more
        with suppress(OSError):
            _pipe(stream).close()
    shutil.rmtree(folder, ignore_errors=True)

"""The process of an FMU: loads its library and answers a run until that has gone.

    python -I -m clutchwork.fmu_import.worker FOLDER

FOLDER holds the FMU, unpacked, and `job.json`. Requests come by what is the standard input at the start, answers go to
what is the standard output then; neither is that any more when the library is loaded, for FMUs print.
"""

from __future__ import annotations

import ctypes
import json
import os
import signal
import sys
from pathlib import Path
from shutil import rmtree
from threading import Thread
from time import sleep
from typing import BinaryIO

from clutchwork.fmu_import.fmi2 import Instance2
from clutchwork.fmu_import.fmi3 import Instance3
from clutchwork.fmu_import.library import Assignment, FailedCall, Instance
from clutchwork.fmu_import.messages import Answer, Command, Format, Request

JOB = "job.json"


def main(folder: str) -> None:
    """Answer requests; nothing that an FMU prints gets to anybody."""
    requests, answers = _pipes()
    assigned = Assignment(**json.loads(Path(folder, JOB).read_text(encoding="utf-8")))
    # Ctrl-C is for the run
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=_follow, args=(os.getppid(), folder), daemon=True).start()
    form = Format(len(assigned.inputs), len(assigned.outputs))
    instance: Instance | None = None
    # from here on the time is that of the FMU
    _send(answers, form.reply(Answer.DONE, [], ""))
    while (asked := form.read_request(requests)) is not None:
        try:
            instance = instance or _loaded(assigned)
            outputs = _do(instance, asked)
            answer, text = Answer.DONE, ""
        except FailedCall as failed:
            said = instance.said if instance else ""
            outputs, answer, text = [], failed.answer, f"{failed.text}: {said}" if said else failed.text
        _send(answers, form.reply(answer, outputs, text))
        if asked.order is Command.END:
            break
    else:
        # the other end is gone
        rmtree(folder, ignore_errors=True)
    # what an FMU does when its library goes is its own affair
    os._exit(0)


def _pipes() -> tuple[BinaryIO, BinaryIO]:
    """The pipes to the run, on numbers that an FMU does not know; its own go nowhere."""
    requests, answers = os.dup(0), os.dup(1)
    nowhere = os.open(os.devnull, os.O_RDWR)
    for number in (0, 1, 2):
        os.dup2(nowhere, number)
    os.close(nowhere)
    return os.fdopen(requests, "rb"), os.fdopen(answers, "wb")


def _send(answers: BinaryIO, data: bytes) -> None:
    answers.write(data)
    answers.flush()


def _follow(parent: int, folder: str) -> None:
    """End with the process of the run, also while the FMU is busy, and leave nothing."""
    while os.getppid() == parent:
        sleep(1.0)
    rmtree(folder, ignore_errors=True)
    os._exit(1)


def _loaded(assigned: Assignment) -> Instance:
    path = str(Path(assigned.folder, assigned.library))
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        # the path is one of a moment
        raise FailedCall(Answer.NO_LIBRARY, str(error).replace(assigned.folder, "")) from None
    return (Instance3 if assigned.version == "3.0" else Instance2)(library, assigned)


def _do(instance: Instance, asked: Request) -> list[float]:
    """Do what is asked; the outputs then."""
    instance.said = ""
    if asked.order is Command.END:
        instance.end()
        return []
    if asked.order is Command.BEGIN:
        instance.begin(asked.time, asked.inputs)
    else:
        instance.step(asked.time, asked.size, asked.inputs)
    return instance.outputs()


if __name__ == "__main__":
    main(sys.argv[1])

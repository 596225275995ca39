"""`clutchwork fmu`: arguments, report and files."""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path
from typing import Any

from clutchwork.base import shell
from clutchwork.declare.options import OPTIONS
from clutchwork.declare.wording import words_of_files
from clutchwork.run.flags import add_options, given_options

OF_FMU = ("t_end", *(name for name, row in OPTIONS.items() if row.core))
MERGE = "merge"
# names with commas; what is given several times adds up
LIST: dict[str, Any] = {"metavar": "A,B", "action": "append"}

EXAMPLES = (
    ("clutchwork fmu model.toml --inputs c1.pressure", "model.fmu for FMI 2.0, with one signal as its input"),
    ("clutchwork fmu model.toml --version 3.0 --outputs c1.slip,load.speed", "for FMI 3.0, with two outputs"),
    ("clutchwork fmu merge linux.fmu windows.fmu --out both.fmu", "one FMU with the libraries of both platforms"),
)


def add_command(subparsers: Any) -> None:
    """Add `fmu` to the commands of the command line."""
    fmu = shell.add_command(
        subparsers,
        "fmu",
        fmu_command,
        "export a model as an FMU, which other simulators run",
        about="It holds the compiled core and needs neither Python nor a compiler.",
        examples=EXAMPLES,
    )
    shell.add_model(fmu)
    joined = "after `merge`, in place of a model: FMUs to join"
    fmu.add_argument("more", nargs="*", type=Path, metavar="FMU", help=joined)
    fmu.add_argument("--out", type=Path, metavar="FILE", help="the FMU; default: the name of the model file")
    fmu.add_argument("--version", choices=("2.0", "3.0"), default="2.0", help="of FMI; default: 2.0")
    fmu.add_argument("--inputs", **LIST, help="signals that the other simulator sets; default: none")
    fmu.add_argument("--outputs", **LIST, help="results that it reads, such as *.speed; default: all")
    fmu.add_argument("--parameters", **LIST, help="numbers that it may change; default: all that can be")
    fmu.add_argument("--kinds", **LIST, help="co-simulation, model exchange; default: all that the model can be")
    fmu.add_argument("--no-picture", action="store_true", help="leave out the schematic")
    shell.add_json(fmu)
    add_options(fmu, OF_FMU, {"t_end": "that of the model, else 1 s after the start"})


def fmu_command(asked: argparse.Namespace) -> int:
    """Export, or merge, and report; the exit code."""
    if str(asked.model) == MERGE:
        return _merge(asked)
    if asked.more:
        shell_error = f"one model at a time: {asked.more[0]} is too many; `clutchwork fmu merge` joins FMUs"
        raise ValueError(shell_error)
    from clutchwork.base.errors import ModelWarning
    from clutchwork.driveline.driveline import Driveline
    from clutchwork.fmu.export import export_fmu

    out = asked.out or Path(asked.model).with_suffix(".fmu")
    shell.writable([out])
    with warnings.catch_warnings(record=True) as warned, words_of_files():
        warnings.simplefilter("always", ModelWarning)
        path = export_fmu(
            Driveline.load(asked.model),
            out,
            inputs=_names(asked.inputs) or (),
            outputs=_names(asked.outputs),
            parameters=_names(asked.parameters),
            version=asked.version,
            kinds=_names(asked.kinds),
            picture=not asked.no_picture,
            **given_options(asked),
        )
    for warning in warned:
        sys.stderr.write(f"warning: {warning.message}\n")
    _tell(asked, path, [str(w.message) for w in warned])
    return shell.DONE


def _names(given: list[str] | None) -> list[str] | None:
    """Names of all arguments of a kind; None where none was given."""
    return None if given is None else [name for text in given for name in shell.parts(text)]


def _merge(asked: argparse.Namespace) -> int:
    from clutchwork.fmu.archive import merge

    if len(asked.more) < 2 or asked.out is None:
        raise ValueError("give two FMUs or more and --out: clutchwork fmu merge a.fmu b.fmu --out both.fmu")
    shell.writable([asked.out])
    _tell(asked, merge(asked.more, asked.out), [])
    return shell.DONE


def _tell(asked: argparse.Namespace, path: Path, warned: list[str]) -> None:
    from clutchwork.fmu.archive import summary

    if asked.json:
        shell.tell_json({"path": str(path), "content": summary(path), "warnings": warned})
    else:
        shell.tell(f"wrote {path}: {summary(path)}")

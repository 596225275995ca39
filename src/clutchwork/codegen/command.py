"""`clutchwork export`: arguments, report and files."""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path
from typing import Any

from clutchwork.base import shell
from clutchwork.codegen.precision import PRECISIONS
from clutchwork.declare.options import OPTIONS
from clutchwork.declare.wording import words_of_files
from clutchwork.run.flags import DEFAULTS, add_options, given_options

# the grid of an exported run has a spacing
OF_EXPORT = ("t_end", "dt", *(name for name, row in OPTIONS.items() if row.core))

EXAMPLES = (
    ("clutchwork export model.toml --out c", "then build and run it: make -C c && c/model > model.csv"),
    ("clutchwork export model.toml --out c --signals c1.slip,load.speed --dt 1ms", "two signals, each millisecond"),
)


def add_command(subparsers: Any) -> None:
    """Add `export` to the commands of the command line."""
    export = shell.add_command(
        subparsers,
        "export",
        export_command,
        "export a model as C and C++ source code",
        about="It builds and runs without Python, with a C++20 compiler.",
        examples=EXAMPLES,
    )
    shell.add_model(export)
    export.add_argument("--out", type=Path, metavar="DIR", required=True, help="output folder")
    export.add_argument(
        "--signals", metavar="A,B", action="append", help="signals to print, may be given several times; default: all"
    )
    export.add_argument(
        "--whole-core", action="store_true", help="all kinds of elements and laws, for other models too"
    )
    export.add_argument(
        "--precision",
        choices=PRECISIONS,
        default="double",
        help="of steps of one length: single for some processors",
    )
    shell.add_json(export)
    add_options(export, OF_EXPORT, {**DEFAULTS, "dt": "a thousandth of the end time"})


def export_command(asked: argparse.Namespace) -> int:
    """Export and report; the exit code."""
    from clutchwork.base.errors import ModelWarning
    from clutchwork.codegen import export_c
    from clutchwork.driveline.driveline import Driveline

    shell.writable([asked.out / "model.h"])
    names = asked.signals
    signals = None if names is None else [name for text in names for name in shell.parts(text)]
    with warnings.catch_warnings(record=True) as warned, words_of_files():
        warnings.simplefilter("always", ModelWarning)
        given = {"signals": signals, "whole_core": asked.whole_core, "precision": asked.precision}
        folder = export_c(Driveline.load(asked.model), asked.out, **given, **given_options(asked))
    for warning in warned:
        sys.stderr.write(f"warning: {warning.message}\n")
    if asked.json:
        shell.tell_json({"folder": str(folder), "warnings": [str(w.message) for w in warned]})
    else:
        shell.tell(f"wrote {folder}; build and run it: make -C {folder} && {folder / 'model'} > model.csv")
    return shell.DONE

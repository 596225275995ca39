"""`clutchwork export`: arguments, report and files."""

from __future__ import annotations

import argparse
import json
import sys
import warnings
from pathlib import Path
from typing import Any

from clutchwork.declare.options import OPTIONS
from clutchwork.declare.speech import words_of_files
from clutchwork.run.flags import DEFAULTS, add_options, given_options

# the grid of an exported run has a spacing
OF_EXPORT = ("t_end", "dt", *(name for name, row in OPTIONS.items() if row.core))


def add_command(subparsers: Any) -> None:
    """Add `export` to the commands of the command line."""
    export = subparsers.add_parser("export", help="export a model as C and C++ source code that builds without Python")
    export.set_defaults(command=export_command)
    export.add_argument("model", type=Path, help="model file, TOML or JSON")
    export.add_argument("--out", type=Path, metavar="DIR", required=True, help="output folder")
    export.add_argument("--signals", metavar="A,B", help="signals to print; default: all")
    export.add_argument("--json", action="store_true", help="print the result as JSON on standard output")
    add_options(export, OF_EXPORT, {**DEFAULTS, "dt": "a thousandth of the end time"})


def export_command(asked: argparse.Namespace) -> int:
    """Export and report; the exit code."""
    from clutchwork.base.errors import ModelWarning
    from clutchwork.codegen import export_c
    from clutchwork.face.driveline import Driveline

    signals = None if asked.signals is None else [name.strip() for name in asked.signals.split(",")]
    with warnings.catch_warnings(record=True) as warned, words_of_files():
        warnings.simplefilter("always", ModelWarning)
        folder = export_c(Driveline.load(asked.model), asked.out, signals=signals, **given_options(asked))
    for warning in warned:
        sys.stderr.write(f"warning: {warning.message}\n")
    if asked.json:
        sys.stdout.write(
            json.dumps({"folder": str(folder), "warnings": [str(w.message) for w in warned]}, indent=2) + "\n"
        )
    else:
        sys.stdout.write(f"wrote {folder}; build and run it: make -C {folder} && {folder / 'model'} > model.csv\n")
    return 0

"""`clutchwork export`: arguments, report and files."""

from __future__ import annotations

import argparse
import json
import sys
import warnings
from pathlib import Path
from typing import Any

from clutchwork.declare.options import METHODS

SETTINGS = ("rtol", "atol", "method", "dt", "max_step")


def add_command(subparsers: Any) -> None:
    """Add `export` to the commands of the command line."""
    export = subparsers.add_parser("export", help="export a model as C and C++ source code that builds without Python")
    export.set_defaults(command=export_command)
    export.add_argument("model", type=Path, help="model file, TOML or JSON")
    export.add_argument("--out", type=Path, metavar="DIR", required=True, help="output folder")
    export.add_argument(
        "--t-end", type=float, metavar="S", help="end time [s]; default: t_end of the [simulation] table"
    )
    export.add_argument("--dt", type=float, metavar="S", help="spacing of the grid [s]; default: a thousandth of t-end")
    export.add_argument("--rtol", type=float, help="relative tolerance, default 1e-6")
    export.add_argument("--atol", type=float, help="absolute tolerance, default 1e-8")
    export.add_argument("--method", choices=sorted(METHODS), help="default rodas5p")
    export.add_argument("--max-step", type=float, metavar="S", help="longest step of the solver [s]")
    export.add_argument("--signals", metavar="A,B", help="signals to print; default: all")
    export.add_argument("--json", action="store_true", help="print the result as JSON on standard output")


def export_command(asked: argparse.Namespace) -> int:
    """Export and report; the exit code."""
    from clutchwork.base.errors import ModelWarning
    from clutchwork.codegen import export_c
    from clutchwork.face.driveline import Driveline

    given = {name: getattr(asked, name) for name in SETTINGS if getattr(asked, name) is not None}
    signals = None if asked.signals is None else [name.strip() for name in asked.signals.split(",")]
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always", ModelWarning)
        folder = export_c(Driveline.load(asked.model), asked.out, t_end=asked.t_end, signals=signals, **given)
    for warning in warned:
        sys.stderr.write(f"warning: {warning.message}\n")
    if asked.json:
        sys.stdout.write(
            json.dumps({"folder": str(folder), "warnings": [str(w.message) for w in warned]}, indent=2) + "\n"
        )
    else:
        sys.stdout.write(f"wrote {folder}; build and run it: make -C {folder} && {folder / 'model'} > model.csv\n")
    return 0

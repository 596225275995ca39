"""`clutchwork draw`: a model file as a schematic."""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base.errors import ModelWarning
from clutchwork.declare.speech import words_of_files
from clutchwork.files.model_file import load
from clutchwork.schematic.draw import drawn

if TYPE_CHECKING:
    from clutchwork.model.model import Model
    from clutchwork.results.trajectory import Trajectory

DONE = 0


def add_command(subparsers: Any) -> None:
    """Add `draw` to the commands of the command line."""
    parser = subparsers.add_parser("draw", help="draw a model as a schematic")
    parser.set_defaults(command=draw_command)
    parser.add_argument("model", type=Path, help="model file, TOML or JSON")
    parser.add_argument("--out", type=Path, metavar="FILE", help="svg, png or pdf; default: that of the model, as .svg")
    parser.add_argument(
        "--at",
        type=float,
        metavar="T",
        action="append",
        help="run the model and show its state at this time in s; given several times: a picture each",
    )
    parser.add_argument("--power", action="store_true", help="show the power of elements as well, with --at")
    parser.add_argument("--no-values", action="store_true", help="show no inertias, ratios and the like")


def draw_command(asked: argparse.Namespace) -> int:
    """Write the pictures; the exit code."""
    model, times = load(asked.model), asked.at or []
    out = asked.out or Path(asked.model.with_suffix(".svg").name)
    run = _run(model, max(times)) if times else None
    for at in times or [None]:
        path = out if len(times) < 2 else out.with_name(f"{out.stem}_{at:g}{out.suffix}")
        drawn(model, path, run=run, at=at, values=not asked.no_values, power=asked.power)
        sys.stdout.write(f"wrote {path}\n")
    return DONE


def _run(model: Model, last: float) -> Trajectory:
    """A run up to what its file says, at least up to the last picture."""
    from clutchwork.assembly.system import System
    from clutchwork.base.errors import ModelError
    from clutchwork.model.findings import findings
    from clutchwork.run.simulation import simulate

    with words_of_files(), warnings.catch_warnings():
        # the command shows a picture; `clutchwork check` says what is odd
        warnings.simplefilter("ignore", ModelWarning)
        problems = findings(model).problems
        if problems:
            raise ModelError(problems, model.name)
        system = System.of(model)
        end = system.settings.get("t_end")
        return simulate(system, last if end is None else max(float(end), last))

"""`clutchwork draw`: a model file as a schematic."""

from __future__ import annotations

import argparse
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import ModelError, ModelWarning, shell
from clutchwork.declare.quantity import seconds
from clutchwork.declare.wording import words_of_files

if TYPE_CHECKING:
    from clutchwork.model.model import Model
    from clutchwork.run.trajectory import Trajectory

EXAMPLES = (
    ("clutchwork draw model.toml", "its schematic, model.svg"),
    ("clutchwork draw model.toml --out model.png --no-values", "a PNG without inertias, ratios and the like"),
    ("clutchwork draw model.toml --at 0.4 --at 1.5", "run it; its clutches, speeds and torques at two times"),
)


def add_command(subparsers: Any) -> None:
    """Add `draw` to the commands of the command line."""
    draw = shell.add_command(
        subparsers,
        "draw",
        draw_command,
        "draw a model as a schematic",
        about="A model with mistakes is drawn too, except with --at.",
        examples=EXAMPLES,
    )
    shell.add_model(draw)
    draw.add_argument("--out", type=Path, metavar="FILE", help="svg, png or pdf; default: named as the model, .svg")
    draw.add_argument(
        "--at",
        metavar="TIME",
        action="append",
        default=[],
        help="run the model and show its state at this time [s], or with a unit; given several times: a picture each",
    )
    draw.add_argument("--power", action="store_true", help="with --at: show the power of elements as well")
    draw.add_argument("--no-values", action="store_true", help="show no inertias, ratios and the like")
    shell.add_json(draw)


def draw_command(asked: argparse.Namespace) -> int:
    """Write the pictures; the exit code."""
    from clutchwork.files.model_file import load
    from clutchwork.schematic.draw import drawn

    times = [seconds(text) for text in asked.at]
    out = asked.out or Path(asked.model.with_suffix(".svg").name)
    paths = [out] if len(times) < 2 else [out.with_name(f"{out.stem}_{at:g}{out.suffix}") for at in times]
    shell.writable(paths)
    model = load(asked.model)
    run = _run(model, max(times)) if times else None
    instants: list[float | None] = [*times] if times else [None]
    for path, at in zip(paths, instants, strict=True):
        drawn(model, path, run=run, at=at, values=not asked.no_values, power=asked.power)
    if asked.json:
        shell.tell_json({"files": [str(path) for path in paths]})
    else:
        shell.tell("\n".join(shell.wrote(paths)))
    return shell.DONE


def _run(model: Model, last: float) -> Trajectory:
    """A run up to what its file says, at least up to the last picture."""
    from clutchwork.assembly.system import System
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

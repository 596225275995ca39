"""`clutchwork linearise`: arguments and report."""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import shell
from clutchwork.declare.options import SIMULATION
from clutchwork.declare.wording import words_of_files
from clutchwork.run.flags import add_options, given_options

if TYPE_CHECKING:
    from clutchwork.linear.result import Linear

# what a run writes is not asked for
NOT_HERE = ("t_end", "dt", "times", "points", "output")
EXAMPLES = (
    ("clutchwork linearise model.toml", "at the start: states, frequencies, damping, who moves"),
    ("clutchwork linearise model.toml --at 1.2 --plot modes.png", "after a run of 1.2 s, with a picture"),
    (
        'clutchwork linearise model.toml --inputs "*.torque" --outputs "*.speed,c1.torque" --json',
        "matrices for other programs",
    ),
)


def add_command(subparsers: Any) -> None:
    """Add `linearise` to the commands of the command line."""
    parser = shell.add_command(
        subparsers,
        "linearise",
        linearise_command,
        "natural frequencies, damping and the linear system",
        about="Locked contacts are constraints, slipping ones have the slopes of their friction laws.",
        examples=EXAMPLES,
        codes="Exit code 1: the run stopped before the instant.",
    )
    shell.add_model(parser)
    parser.add_argument(
        "--at", type=shell.number_or_text, metavar="T", help="instant [s] up to which it runs; default: the start"
    )
    parser.add_argument("--inputs", metavar="A,B", help="signals or wildcards; default: all that the model is given")
    parser.add_argument("--outputs", metavar="A,B", help="signals or wildcards; default: speeds and other states")
    parser.add_argument("--plot", type=Path, metavar="FILE", help="write a picture of the modes (png, svg or pdf)")
    shell.add_json(parser)
    add_options(parser, [name for name in SIMULATION if name not in NOT_HERE])


def linearise_command(asked: argparse.Namespace) -> int:
    """Linearise and report; the exit code."""
    from clutchwork.run.trajectory import SimulationError

    files = [asked.plot] if asked.plot is not None else []
    shell.writable(files)
    try:
        with words_of_files():
            found = _linearised(asked)
    except SimulationError as error:
        sys.stderr.write(f"clutchwork: {error}\n")
        return shell.STOPPED
    for path in files:
        found.plot(path)
    if asked.json:
        shell.tell_json(found.to_dict() | {"files": [str(path) for path in files]})
    else:
        shell.tell("\n".join([str(found), *(["", *shell.wrote(files)] if files else [])]))
    return shell.DONE


def _linearised(asked: argparse.Namespace) -> Linear:
    from clutchwork.base.errors import ModelWarning
    from clutchwork.driveline.driveline import Driveline
    from clutchwork.linear.linearise import linearise

    driveline = Driveline.load(asked.model)
    driveline.simulation.update(given_options(asked))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        system = driveline.assemble()
    for text in system.warnings:
        sys.stderr.write(f"warning: {text}\n")
    return linearise(system, at=asked.at, inputs=_names(asked.inputs), outputs=_names(asked.outputs))


def _names(text: str | None) -> list[str] | None:
    return None if text is None else shell.parts(text)

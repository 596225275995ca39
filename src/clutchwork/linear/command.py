"""`clutchwork linearise`: arguments and report."""

from __future__ import annotations

import argparse
import json
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.declare.options import SIMULATION
from clutchwork.declare.speech import words_of_files
from clutchwork.run.flags import add_options, given_options

if TYPE_CHECKING:
    from clutchwork.linear.result import Linear

DONE, STOPPED = 0, 1
NOT_HERE = ("t_end", "dt", "times", "points", "output")


def add_command(subparsers: Any) -> None:
    """Add `linearise` to the commands of the command line."""
    parser = subparsers.add_parser(
        "linearise",
        aliases=["linearize"],
        help="natural frequencies, damping and the linear system of a model",
        epilog="Exit code 1: the run stopped before the instant.",
    )
    parser.set_defaults(command=linearise_command)
    parser.add_argument("model", type=Path, help="model file, TOML or JSON")
    parser.add_argument(
        "--at", type=float, metavar="T", default=0.0, help="instant [s] up to which it runs; default: 0"
    )
    parser.add_argument("--inputs", metavar="A,B", help="signals or wildcards; default: all signals of the model")
    parser.add_argument("--outputs", metavar="A,B", help="signals or wildcards; default: speeds and other states")
    parser.add_argument("--plot", type=Path, metavar="FILE", help="write a picture of the modes (png, svg or pdf)")
    parser.add_argument("--json", action="store_true", help="print the system as JSON on standard output")
    add_options(parser, [name for name in SIMULATION if name not in NOT_HERE])


def linearise_command(asked: argparse.Namespace) -> int:
    """Linearise and report; the exit code."""
    from clutchwork.results.trajectory import SimulationError

    try:
        with words_of_files():
            found = _linearised(asked)
    except SimulationError as error:
        sys.stderr.write(f"clutchwork: {error}\n")
        return STOPPED
    if asked.plot is not None:
        found.plot(asked.plot)
    if asked.json:
        sys.stdout.write(json.dumps(found.to_dict(), indent=2) + "\n")
    else:
        sys.stdout.write(f"{found}\n" + (f"\nwrote {asked.plot}\n" if asked.plot is not None else ""))
    return DONE


def _linearised(asked: argparse.Namespace) -> Linear:
    from clutchwork.base.errors import ModelWarning
    from clutchwork.face.driveline import Driveline
    from clutchwork.linear.linearise import linearise

    driveline = Driveline.load(asked.model)
    driveline.simulation.update(given_options(asked))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        system = driveline.assemble()
    for text in system.warnings:
        sys.stderr.write(f"warning: {text}\n")
    names = {what: _names(getattr(asked, what)) for what in ("inputs", "outputs")}
    return linearise(system, at=asked.at, **names)


def _time(text: str) -> float | str:
    """A number of seconds, or what has a unit."""
    try:
        return float(text)
    except ValueError:
        return text


def _names(text: str | None) -> list[str] | None:
    return None if text is None else [name.strip() for name in text.split(",") if name.strip()]

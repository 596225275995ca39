"""A model of the command line: loaded, changed by --set, assembled, its warnings on standard error."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import ModelWarning

if TYPE_CHECKING:
    from clutchwork.assembly.system import System


def add_set(parser: Any) -> None:
    """Add the wish for other values than those of the model file."""
    parser.add_argument(
        "--set",
        metavar="NAME=VALUE",
        action="append",
        default=[],
        help="another value, such as c1.gain=6e-4 or 'c1.pressure=2 bar'; may be given several times; "
        "clutchwork check MODEL --names lists the names",
    )


def add_trust(parser: Any) -> None:
    """Add the leave to run libraries of other programs."""
    parser.add_argument(
        "--trust",
        action="store_true",
        help="the model may have FMUs, [[fmu]], whose libraries run with your permissions",
    )


def system_of(path: Path, settings: Sequence[str] = (), *, trust: bool = False) -> System:
    """The system of a model file with other values; what it is warned of goes to standard error."""
    from clutchwork.declare.wording import words_of_files
    from clutchwork.driveline.driveline import Driveline
    from clutchwork.files.given import given_values

    with warnings.catch_warnings(), words_of_files():
        warnings.simplefilter("ignore", ModelWarning)
        system = Driveline.load(path, trust=trust).assemble()
        if settings and system.source is not None:
            system = system.changed(given_values(system.source, settings))
    for text in system.warnings:
        sys.stderr.write(f"warning: {text}\n")
    return system

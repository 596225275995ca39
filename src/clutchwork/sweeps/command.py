"""`clutchwork sweep`: its arguments."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from clutchwork.base import shell
from clutchwork.declare.options import SIMULATION
from clutchwork.run.flags import add_options
from clutchwork.sweeps.asking import FORMS, ROWS

EXAMPLES = (
    ("clutchwork sweep model.toml --vary c1.gain=4e-4:8e-4:5", "five gains: speeds at the end, and when it locks"),
    (
        "clutchwork sweep model.toml --vary c1.gain=4e-4:8e-4:21 --vary load.inertia=0.6,0.8 --out sweep.csv",
        "all combinations, in a table",
    ),
    (
        "clutchwork sweep model.toml --vary c1.gain=4e-4,8e-4 --outputs 'lock(c1), at(c1.slip, 0.5, 1)'",
        "first lock-up, slip at 0.5 s and at 1 s",
    ),
)
CODES = "Exit code 1: a variant stopped early, 130: interrupted; what was asked for is still written."


def add_command(subparsers: Any) -> None:
    """Add `sweep` to the commands of the command line."""
    parser = shell.add_command(
        subparsers, "sweep", sweep_command, "run a model with many sets of values", examples=EXAMPLES, codes=CODES
    )
    shell.add_model(parser)
    parser.add_argument(
        "--vary",
        metavar="NAME=VALUES",
        action="append",
        default=[],
        help="values: FIRST:LAST:COUNT or A,B,C, in SI or with a unit behind the last one: 'c1.pressure=1,2,3 bar'; "
        "given several times: all combinations; c*.gain*=0.9,1.1 multiplies the numbers in the model of all names "
        "that match; clutchwork check MODEL --names lists the names",
    )
    parser.add_argument(
        "--outputs",
        metavar="A,B",
        help=f"signals at the end, or {', '.join(FORMS)}; default: speeds at the end, and when contacts lock",
    )
    parser.add_argument("--threads", type=int, metavar="N", help="default: as many as there are cores")
    parser.add_argument("--out", type=Path, metavar="FILE", help="table of all variants, .parquet or .csv")
    shell.add_json(parser)
    shell.add_quiet(parser)
    add_options(parser, [name for name in SIMULATION if name not in ROWS])


def sweep_command(asked: argparse.Namespace) -> int:
    """Run, report, write; the exit code."""
    # numpy and all of a sweep are loaded where one is run, not for help
    from clutchwork.sweeps.performed import performed

    return performed(asked)

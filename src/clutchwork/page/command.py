"""`clutchwork page`: a model as one HTML file in which its reader drags pressures and turns numbers."""

from __future__ import annotations

import argparse
import warnings
from pathlib import Path
from typing import Any

from clutchwork.base import ModelWarning, shell
from clutchwork.base.writing import put
from clutchwork.declare.wording import words_of_files

EXAMPLES = (
    ("clutchwork page model.toml", "its page, model.html, with what is usual"),
    ("clutchwork page model.toml --drag F1.pressure --slider c1.gain", "what its reader may change"),
    (
        "clutchwork page model.toml --slider c1.gain=2e-4:8e-4 --show 'F1.*' --out shift.html",
        "ends of a slider, curves",
    ),
)
ABOUT = (
    "The page computes: its reader drags the knots of pressures and moves sliders, and sees speeds, torques, heat"
    " and events follow. It is one file that needs no network and no installation."
)


def add_command(subparsers: Any) -> None:
    """Add `page` to the commands of the command line."""
    page = shell.add_command(
        subparsers, "page", page_command, "write a page that computes, one HTML file", about=ABOUT, examples=EXAMPLES
    )
    shell.add_model(page)
    page.add_argument(
        "--drag",
        metavar="NAME",
        action="append",
        help="signal whose knots are dragged, or a wildcard, such as 'F*.pressure'; default: pressures that vary",
    )
    page.add_argument(
        "--slider",
        metavar="NAME[=LOW:HIGH]",
        action="append",
        help="number that a slider turns, such as c1.gain or 'c1.gain=2e-4:8e-4', or several together, 'F*.gain' or"
        " 'F1.gain, F2.gain'; default: gains of what is dragged",
    )
    page.add_argument(
        "--show",
        metavar="SIGNAL",
        action="append",
        help="curves, such as c1.slip or '*.speed'; default: speeds, slips, torques, heats, temperatures",
    )
    page.add_argument("--t-end", metavar="TIME", help="end of the run [s], or with a unit; default: that of the model")
    page.add_argument("--out", type=Path, metavar="FILE", help="the file; default: named as the model, .html")
    shell.add_json(page)


def page_command(asked: argparse.Namespace) -> int:
    """Write the page; the exit code."""
    from clutchwork.declare.quantity import seconds
    from clutchwork.driveline.driveline import Driveline
    from clutchwork.page.data import PageRequest
    from clutchwork.page.page import page
    from clutchwork.run.settings import merged

    out = asked.out or Path(asked.model.with_suffix(".html").name)
    shell.writable([out])
    with words_of_files(), warnings.catch_warnings():
        # `clutchwork check` says what is odd
        warnings.simplefilter("ignore", ModelWarning)
        system = Driveline.load(asked.model).assemble()
        given = {} if asked.t_end is None else {"t_end": seconds(asked.t_end)}
        t_end, options = merged(system.settings, given)
        made = page(system, t_end, options, PageRequest(asked.drag, asked.slider, asked.show))
    put(out, made)
    if asked.json:
        shell.tell_json({"files": [str(out)], "bytes": len(made.encode())})
    else:
        shell.tell("\n".join(shell.wrote([out])))
    return shell.DONE

"""`clutchwork gearbox`: what follows from the teeth and the shift table of a gearbox, and its pictures."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import shell

if TYPE_CHECKING:
    from clutchwork.gearbox.gearbox import Gearbox

EXAMPLES = (
    ("clutchwork gearbox --list", "the gearboxes that are known"),
    ("clutchwork gearbox zf-8hp70", "ratios, speeds, torques, capacities, shifts, combinations"),
    ("clutchwork gearbox zf-8hp70 --gear 3", "speeds, torques and powers at every wheel in one gear"),
    ("clutchwork gearbox zf-8hp70 --gear 3 --svg third.svg", "its stick diagram with the power flow of that gear"),
    ("clutchwork gearbox ford-10r80 --diagram speeds", "its speed plan, ford-10r80-speeds.svg"),
    ("clutchwork gearbox zf-8hp70 --page box.html", "a page in which a gear is chosen"),
    ("clutchwork gearbox box.toml --table shifts.csv", "a file of your own, with a shift table from a spreadsheet"),
)


def add_command(subparsers: Any) -> None:
    """Add `gearbox` to the commands of the command line."""
    from clutchwork.diagrams.kinds import KINDS

    gearbox = shell.add_command(
        subparsers,
        "gearbox",
        gearbox_command,
        "a gearbox from its teeth and shift table: ratios, speeds, torques, pictures",
        about="Speeds and torques are per speed 1 and torque 1 at the input.",
        examples=EXAMPLES,
    )
    gearbox.add_argument("gearbox", nargs="?", metavar="NAME_OR_FILE", help="one that is known, or a TOML or JSON file")
    gearbox.add_argument("--list", action="store_true", help="print the gearboxes that are known")
    gearbox.add_argument("--gear", metavar="GEAR", help="one gear, or closed elements with commas, such as A,C,E")
    gearbox.add_argument("--table", type=Path, metavar="CSV", help="shift table in place of that of the file")
    gearbox.add_argument("--diagram", choices=list(KINDS), help="kind of the picture; default: stick")
    gearbox.add_argument("--svg", type=Path, metavar="FILE", help="the picture; default: NAME-KIND.svg")
    gearbox.add_argument("--page", type=Path, metavar="FILE", help="a page of HTML in which its reader chooses a gear")
    gearbox.add_argument(
        "--merged", action="store_true", help="with --diagram lever: sets that share two members as one lever"
    )
    shell.add_json(gearbox)


def gearbox_command(asked: argparse.Namespace) -> int:
    """Report or draw; the exit code."""
    from clutchwork.base.errors import UseError

    if asked.list:
        return _listed(asked)
    if asked.gearbox is None:
        raise UseError("gearbox", ["give a gearbox, such as clutchwork gearbox zf-8hp70; --list prints those known"])
    if asked.svg or asked.diagram:
        return _drawn(asked)
    box = _box(asked)
    if asked.page:
        return _paged(box, asked)
    gear = _gear(box, asked.gear)
    if asked.json:
        from clutchwork.diagrams import data

        shell.tell_json(data.everything(box) if gear is None else data.of_gear(box.state(gear)))
    elif gear is None:
        shell.tell(str(box))
    else:
        from clutchwork.gearbox.tables import of_gear

        shell.tell(of_gear(box.state(gear)))
    return shell.DONE


def _box(asked: argparse.Namespace) -> Gearbox:
    from clutchwork.gearbox.gearbox import Gearbox

    if asked.table is None:
        return Gearbox.load(asked.gearbox)
    from clutchwork.gearbox import store

    return Gearbox.import_table(store.content(asked.gearbox), asked.table)


def _gear(box: Gearbox, text: str | None) -> str | Sequence[str] | None:
    """A gear by its name, or closed elements with commas between them."""
    if text is None or text in box.gears or "," not in text:
        return text
    return shell.parts(text)


def _drawn(asked: argparse.Namespace) -> int:
    from clutchwork.diagrams.draw import diagram

    kind = asked.diagram or "stick"
    if asked.svg is not None:
        shell.writable([asked.svg])
    box = _box(asked)
    path = asked.svg or Path(f"{box.name}-{kind}.svg")
    shell.writable([path])
    diagram(box, kind, gear=_gear(box, asked.gear), path=path, merged=asked.merged)
    if asked.json:
        shell.tell_json({"files": [str(path)]})
    else:
        shell.tell("\n".join(shell.wrote([path])))
    return shell.DONE


def _paged(box: Gearbox, asked: argparse.Namespace) -> int:
    shell.writable([asked.page])
    box.page(asked.page)
    if asked.json:
        shell.tell_json({"files": [str(asked.page)]})
    else:
        shell.tell("\n".join(shell.wrote([asked.page])))
    return shell.DONE


def _listed(asked: argparse.Namespace) -> int:
    from clutchwork.base.plural import columns
    from clutchwork.gearbox.gearbox import catalogue

    boxes = catalogue()
    if asked.json:
        shell.tell_json({name: {"title": box.title, "gears": list(box.gears)} for name, box in boxes.items()})
        return shell.DONE
    rows = [
        [name, box.title, str(len(box.sets)), str(len(box.elements)), str(len(box.gears))]
        for name, box in boxes.items()
    ]
    shell.tell(columns([["name", "title", "sets", "elements", "gears"], *rows], right=(2, 3, 4)))
    return shell.DONE

"""Draw the schematics of the documentation."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import clutchwork as cw
from clutchwork.declare.registry import REGISTRY, Role
from clutchwork.declare.schema import specs
from clutchwork.schematic.cells import SymbolCell
from clutchwork.schematic.look import HEAT, SHAFT, VALUE
from clutchwork.schematic.pen import SymbolPen, Text
from clutchwork.schematic.picture import Schematic
from clutchwork.schematic.sheet import Sheet
from clutchwork.schematic.symbols.symbol import LEFT, RIGHT, Drawn
from clutchwork.schematic.symbols.table import OWN

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
COLUMNS, WIDE, TALL = 6, 90.0, 70.0  # pt


def write(folder: Path) -> list[Path]:
    """The examples, the gearbox within its shift, and all symbols."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("launch", "car_launch", "six_speed"):
        cw.Driveline.load(EXAMPLES / name / "model.toml").draw(folder / f"{name}.svg")
    d = cw.Driveline.load(EXAMPLES / "six_speed" / "model.toml")
    d.draw(folder / "six_speed_shift.svg", run=d.simulate(), at=2.4)
    symbols().save(folder / "symbols.svg")
    names = ("launch", "car_launch", "six_speed", "six_speed_shift", "symbols")
    return [folder / f"{name}.svg" for name in names]


def symbols() -> Schematic:
    """The symbol of every element, with the name of its kind."""
    kinds = {
        kind: cls
        for role in Role
        if role not in (Role.LAW, Role.SIGNAL)
        for kind, cls in REGISTRY[role].items()
        if kind in OWN
    }
    made = Sheet()
    for number, kind in enumerate(sorted(kinds)):
        x, y = WIDE * (number % COLUMNS), -TALL * (number // COLUMNS)
        marks = [mark.moved(x, y) for mark in _symbol(kind, kinds[kind])]
        text = Text(x, y - 33.0, kind, VALUE, "", False)._replace(colour="#1A1A1A")
        made.pieces.append(SymbolCell(kind, "element", marks, [text]))
    return Schematic("symbols of elements", made)


def _symbol(kind: str, cls: type) -> list:
    symbol, pen = OWN[kind], SymbolPen()
    ports = [item.name for item, _ in specs(cls, "port")]
    flows = ["hot", "cold"] if REGISTRY[Role.FLOW].get(kind) else []
    # what stands at one shaft against the housing is drawn so
    ports = ports[:1] if "shaft" in ports and "mass" not in ports else ports or flows
    sides = dict(zip(ports, (LEFT, *[RIGHT] * len(ports)), strict=False))
    if kind == "synchroniser":
        sides = {"hub": LEFT, "forward": RIGHT, "backward": RIGHT}
    if "support" in sides:
        del sides["support"]
    line = HEAT if flows else SHAFT
    heights = symbol.heights(None)
    drawn = Drawn(None, sides, line=line, half=symbol.half, pins=heights)
    symbol.draw(pen, drawn)
    return pen.marks

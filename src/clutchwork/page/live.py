"""The schematic of a page: every contact in each of its states, and room for the speeds and torques of a moment."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from html import escape
from typing import Any

from clutchwork.base import dataclass
from clutchwork.model.model import Model
from clutchwork.schematic.cells import SymbolCell
from clutchwork.schematic.diagram import SymbolGraph, Thing, diagram
from clutchwork.schematic.look import OPEN, STATES
from clutchwork.schematic.moment import Snapshot
from clutchwork.schematic.pen import Mark, Stroke, Text
from clutchwork.schematic.sheet import DOT, Sheet, sheet

POINTS, MARGIN = 72.0 / 25.4, 8.0
DASHES = {"dash": "3.2 1.8", "dot": "1.2 1.4"}
# what stands where a number comes, as wide as most are
ROOM = "-8888.8 rad/s"
# colours by the names that the style of the page gives them, for light and for dark
COLOURS = {
    "#1A1A1A": "ink", "#DDE3EA": "body", "#FFFFFF": "paper", "#5A5A5A": "grey", "#0B5D46": "mass",
    "#DCEBE5": "massbody", "#B3261E": "heat", "#6A3D9A": "signal", "#C2185B": "wrong",
    "#00497A": "locked", "#C04A00": "slipping",
    "#8A8A8A": "open", "#CFE6F7": "lockedhalo", "#FCE4D0": "slippinghalo", "#F3F5F8": "pale", "#E6DDF0": "signalbody",
    "#F9DEDC": "heatbody", "#0072B2": "locked",
}  # fmt: skip


class Room(str):
    """Text in whose place a page writes the present value of a signal."""

    __slots__ = ("signal",)
    signal: str

    @classmethod
    def of(cls, signal: str) -> Room:
        """For a signal."""
        made = cls(ROOM)
        made.signal = signal
        return made


@dataclass(frozen=True, eq=False)
class Alike(Snapshot):
    """All contacts in one state."""

    known: frozenset[str]
    contacts: frozenset[str]
    now: str

    def state(self, thing: Thing) -> str:
        """The state of all that may have one."""
        return self.now if str(thing.source.name) in self.contacts else ""

    def node_lines(self, thing: Thing) -> list[str]:
        """Room for a speed or a temperature."""
        return self._rooms(thing, ("speed", "temperature"))[:1]

    def element_lines(self, thing: Thing) -> list[str]:
        """Room for a torque."""
        return self._rooms(thing, ("torque",))

    def _rooms(self, thing: Thing, words: Sequence[str]) -> list[str]:
        name = str(getattr(thing.source, "name", ""))
        return [Room.of(f"{name}.{word}") for word in words if f"{name}.{word}" in self.known]


@dataclass(frozen=True)
class Live:
    """The picture, and the signals whose values are written into it."""

    svg: str
    signals: tuple[str, ...]


def live(model: Model, known: Collection[str], contacts: Collection[str], width: float = 310.0) -> Live:
    """The schematic of a model whose signals and contacts are known by name; width in mm."""
    found, names = diagram(model), frozenset(known)
    sheets = {state: _sheet(found, Alike(names, frozenset(contacts), state), width) for state in STATES}
    first = sheets[STATES[0]]
    box = first.box
    texts = [text for piece in first.pieces for text in piece.text]
    signals = [text.text.signal for text in texts if isinstance(text.text, Room)]
    left, top = box.left - MARGIN, box.high + MARGIN
    wide, tall = box.right - box.left + 2 * MARGIN, box.high - box.low + 2 * MARGIN
    body = "".join(_body(sheets, _Ink(left, top)))
    label = escape(f"schematic of {found.name}")
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide:.1f} {tall:.1f}" role="img" aria-label="{label}"'
    )
    return Live(f'{head} width="{wide:.0f}" height="{tall:.0f}">{body}</svg>', tuple(signals))


def _sheet(found: SymbolGraph, moment: Snapshot, width: float) -> Sheet:
    return sheet(found, moment, values=False, width=width * POINTS)


def _body(sheets: dict[str, Sheet], ink: _Ink) -> Iterator[str]:
    first = next(iter(sheets.values()))
    for wire in first.wires:
        for line in wire.pieces:
            yield ink.mark(Stroke(line, False, wire.look), cap=wire.look.dash == "solid")
        for x, y in wire.dots:
            yield ink.dot(x, y, wire.look.colour)
    yield from (ink.mark(mark) for mark in first.links)
    for number, piece in enumerate(first.pieces):
        alike = {state: made.pieces[number] for state, made in sheets.items() if number < len(made.pieces)}
        yield from _piece(piece, alike, ink)


def _piece(piece: SymbolCell, alike: dict[str, SymbolCell], ink: _Ink) -> Iterator[str]:
    """A symbol; where it differs by state, each once, of which the page shows one."""
    yield f'<g data-name="{escape(piece.name)}"><title>{escape(piece.name)}</title>'
    if len({repr(one.marks) for one in alike.values()}) > 1:
        for state, one in alike.items():
            marks = "".join(map(ink.mark, one.marks))
            hidden = "" if state == OPEN else ' display="none"'
            yield f'<g data-state="{state}"{hidden}>{marks}</g>'
    else:
        yield from map(ink.mark, piece.marks)
    yield from map(ink.mark, piece.text)
    yield "</g>"


@dataclass(frozen=True)
class _Ink:
    """Marks as elements of SVG, with the origin at the upper left [pt]."""

    left: float
    top: float

    def at(self, x: float, y: float) -> str:
        return f"{x - self.left:.1f} {self.top - y:.1f}"

    def mark(self, mark: Mark, cap: bool = False) -> str:
        return self._text(mark) if isinstance(mark, Text) else self._stroke(mark, cap)

    def dot(self, x: float, y: float, colour: str) -> str:
        return f'<circle cx="{x - self.left:.1f}" cy="{self.top - y:.1f}" r="{DOT}" class="f-{_name(colour)}"/>'

    def _text(self, mark: Text) -> str:
        live = f' data-signal="{escape(mark.text.signal)}"' if isinstance(mark.text, Room) else ""
        words = "" if live else escape(mark.text)
        bold = ' font-weight="bold"' if mark.bold else ""
        place = f'x="{mark.x - self.left:.1f}" y="{self.top - mark.y:.1f}" font-size="{mark.size}"'
        return f'<text {place} text-anchor="middle" class="f-{_name(mark.colour)}"{bold}{live}>{words}</text>'

    def _stroke(self, mark: Stroke, cap: bool) -> str:
        look = mark.look
        path = "M" + "L".join(self.at(x, y) for x, y in mark.points) + ("Z" if mark.closed else "")
        fill = f" f-{_name(look.fill)}" if look.fill else ""
        dash = f' stroke-dasharray="{DASHES[look.dash]}"' if look.dash in DASHES else ""
        end = ' stroke-linecap="square"' if cap else ""
        return f'<path d="{path}" class="s-{_name(look.colour)}{fill}" stroke-width="{look.width}"{dash}{end}/>'


def _name(colour: str) -> str:
    return COLOURS.get(colour.upper(), COLOURS.get(colour, "ink"))


def plain(found: Live | None) -> dict[str, Any] | None:
    """As a page has it."""
    return None if found is None else {"svg": found.svg, "signals": list(found.signals)}

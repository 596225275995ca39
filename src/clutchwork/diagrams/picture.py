"""A diagram as SVG text: the same bytes for the same gearbox, on white, for light and dark notebooks."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path

from clutchwork.base.paths import fitting
from clutchwork.base.writing import put
from clutchwork.diagrams.letters import FONT
from clutchwork.diagrams.marks import PAPER, Disc, Label, Mark, Polyline
from clutchwork.schematic.pen import around

MARGIN = 12.0


class Diagram:
    """A diagram of a gearbox: shows itself in notebooks; `svg` is its text, `save` writes a file."""

    def __init__(self, kind: str, title: str, marks: Sequence[Mark]) -> None:
        self.kind = kind
        self.title = title
        self.marks = tuple(marks)

    def __repr__(self) -> str:
        return f"<Diagram {self.kind!r}: {self.title}>"

    @property
    def svg(self) -> str:
        """The picture as SVG."""
        return svg_text(self.title, self.marks)

    def save(self, path: str | Path) -> None:
        """Write the picture as SVG."""
        put(fitting("diagram.save", path, "gearbox.svg", (".svg",)), self.svg)

    def _repr_svg_(self) -> str:
        return self.svg


def svg_text(title: str, marks: Sequence[Mark]) -> str:
    """Marks as SVG."""
    box = around(marks)
    left, top = box.left - MARGIN, box.low - MARGIN
    wide, tall = box.right - box.left + 2 * MARGIN, box.high - box.low + 2 * MARGIN
    size = f'width="{number(wide)}" height="{number(tall)}"'
    view = f'viewBox="{number(left)} {number(top)} {number(wide)} {number(tall)}"'
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} {view} font-family="{FONT}" role="img">',
        f"<title>{clean(title)}</title>",
        f'<rect x="{number(left)}" y="{number(top)}" {size} fill="{PAPER}"/>',
        *map(_mark, marks),
        "</svg>",
    ]
    return "\n".join(lines) + "\n"


def _mark(mark: Mark) -> str:
    if isinstance(mark, Label):
        return _label(mark)
    if isinstance(mark, Disc):
        outline = f' stroke="{mark.colour}" stroke-width="{number(mark.width)}"' if mark.width else ""
        place = f'cx="{number(mark.x)}" cy="{number(mark.y)}" r="{number(mark.radius)}"'
        return f'<circle {place} fill="{mark.fill}"{outline}/>'
    return _line(mark)


def _line(mark: Polyline) -> str:
    way = " L".join(f"{number(x)} {number(y)}" for x, y in mark.points)
    outline = f' stroke="{mark.colour}" stroke-width="{number(mark.width)}"' if mark.width else ""
    dash = f' stroke-dasharray="{mark.dash}"' if mark.dash else ""
    head = f'<path d="M{way}{" Z" if mark.closed else ""}" fill="{mark.fill or "none"}"{outline}{dash}'
    return f"{head}><title>{clean(mark.what)}</title></path>" if mark.what else f"{head}/>"


def _label(mark: Label) -> str:
    bold = ' font-weight="bold"' if mark.bold else ""
    anchor = "" if mark.anchor == "start" else f' text-anchor="{mark.anchor}"'
    place = f'x="{number(mark.x)}" y="{number(mark.y)}" font-size="{number(mark.size)}"'
    return f'<text {place} fill="{mark.colour}"{anchor}{bold}>{clean(mark.text)}</text>'


def clean(text: str) -> str:
    """Text without what XML cannot hold."""
    return escape("".join(letter if letter.isprintable() else " " for letter in text), quote=False)


def number(value: float) -> str:
    """A number with at most two decimals, zero without a sign."""
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text

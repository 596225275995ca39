"""A schematic as SVG, PNG and PDF: one drawing for all formats."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import UseError, quote
from clutchwork.base.extras import need
from clutchwork.base.paths import fitting
from clutchwork.base.writing import put
from clutchwork.declare.calls import explained_methods
from clutchwork.plot.style import RC
from clutchwork.schematic.look import GREY, LOCKED, NAME, OPEN, SLIPPING, VALUE
from clutchwork.schematic.pen import Mark, Rect, Stroke, SymbolPen, Text, width_of
from clutchwork.schematic.sheet import DOT, Sheet
from clutchwork.schematic.symbols.contacts import clutch
from clutchwork.schematic.symbols.symbol import LEFT, RIGHT, Drawn

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MARGIN, INCH = 8.0, 72.0
DASHES: dict[str, Any] = {"solid": "-", "dash": (0, (3.2, 1.8)), "dot": (0, (1.2, 1.4))}
FORMATS = ("svg", "png", "pdf")
# the same bytes for the same picture: no date, and names of parts from this
SAME: Any = {"svg.hashsalt": "clutchwork"}
NO_DATE: dict[str, Any] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}, "png": {"Software": None}}


@explained_methods("schematic")
class Schematic:
    """The schematic of a driveline: shows itself in notebooks, `save` writes a file."""

    def __init__(self, name: str, sheet: Sheet, time: float | None = None) -> None:
        self.name = name
        self.time = time
        self.sheet = sheet

    def __repr__(self) -> str:
        at = "" if self.time is None else f" at {self.time:g} s"
        names = sum(piece.what != "heat" for piece in self.sheet.pieces)
        return f"<Schematic of {self.name}{at}: {names} symbols>"

    @property
    def figure(self) -> Figure:
        """As a figure of matplotlib."""
        with _drawn(self.name, self.time, self.sheet) as figure:
            return figure

    def save(self, path: str | Path, *, dpi: float = 200.0) -> None:
        """Write SVG, PNG or PDF by the ending of the path.

        Parameters: dpi, dots per inch of a PNG.
        """
        path = fitting("save", path, "driveline.svg")
        kind = kind_of(path)
        if not kind:
            raise UseError("save", [f"{quote(str(path))} does not say the format: end it with .svg, .png or .pdf"])
        put(path, self._bytes(kind, dpi))

    def _bytes(self, kind: str, dpi: float = 200.0) -> bytes:
        file = BytesIO()
        with _drawn(self.name, self.time, self.sheet) as figure, warnings.catch_warnings():
            # a letter that the font lacks becomes a box
            warnings.simplefilter("ignore", UserWarning)
            figure.savefig(file, format=kind, dpi=dpi, metadata=NO_DATE[kind])
        return file.getvalue()

    def _repr_svg_(self) -> str:
        return self._bytes("svg").decode("utf-8")


def kind_of(path: str | Path) -> str:
    """The format that the ending of a path asks for; empty for any other."""
    kind = Path(path).suffix.lower().removeprefix(".")
    return kind if kind in FORMATS else ""


@contextmanager
def _drawn(name: str, time: float | None, sheet: Sheet) -> Iterator[Figure]:
    """A figure with everything drawn, and the look that it is to be written with."""
    need("matplotlib", "draw", "a schematic")
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    box = sheet.box
    head = _head(name, time, box)
    wide = max(box.right, *(mark.box.right for mark in head)) - box.left + 2 * MARGIN
    low = min(mark.box.low for mark in [*head, *_legend(time, box)]) if head else box.low
    low = min(low, box.low)
    high = max(mark.box.high for mark in head)
    tall = high - low + 2 * MARGIN
    with rc_context({**RC, **SAME, "text.parse_math": False}):
        figure = Figure(figsize=(wide / INCH, tall / INCH), facecolor="white")
        FigureCanvasAgg(figure)
        draw = _Canvas(figure, Rect(box.left - MARGIN, low - MARGIN, box.left - MARGIN + wide, high + MARGIN))
        for wire in sheet.wires:
            for line in wire.pieces:
                draw.mark(Stroke(line, False, wire.look), cap="projecting" if wire.look.dash == "solid" else "butt")
            for x, y in wire.dots:
                pen = SymbolPen()
                pen.circle(x, y, DOT, look=wire.look._replace(fill=wire.look.colour, width=0.4, dash="solid"))
                draw.mark(pen.marks[0])
        for mark in sheet.links:
            draw.mark(mark)
        for piece in sheet.pieces:
            for mark in (*piece.marks, *piece.text):
                draw.mark(mark)
        for mark in (*head, *_legend(time, box)):
            draw.mark(mark)
        yield figure


def _head(name: str, time: float | None, box: Rect) -> list[Mark]:
    """Name of the driveline and instant, above the picture."""
    text = name if time is None else f"{name}, t = {time:.6g} s"
    half = 0.5 * width_of(text, NAME + 1.5, True)
    return [Text(box.left + half, box.high + 12.0, text, NAME + 1.5, GREY, True)]


def _legend(time: float | None, box: Rect) -> list[Mark]:
    """The three looks of a contact, below the picture of a run."""
    if time is None:
        return []
    pen, x = SymbolPen(), box.left + 16.0
    for state in (LOCKED, SLIPPING, OPEN):
        own = SymbolPen()
        clutch(own, Drawn(None, {"a": LEFT, "b": RIGHT}, state=state))
        pen.take(own.marks, x, box.low - 26.0)
        half = 0.5 * width_of(state, VALUE)
        pen.text(x + 21.0 + half, box.low - 28.4, state, VALUE)
        x += 60.0 + 2.0 * half
    return pen.marks


class _Canvas:
    """Draws marks into a figure whose unit is a point."""

    def __init__(self, figure: Figure, box: Rect) -> None:
        self._axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        self._axes.set_axis_off()
        self._axes.set_xlim(box.left, box.right)
        self._axes.set_ylim(box.low, box.high)
        self._count = 0

    def mark(self, mark: Mark, cap: str = "butt") -> None:
        """One mark over all before it."""
        self._count += 1
        if isinstance(mark, Text):
            self._axes.text(
                mark.x, mark.y, mark.text, fontsize=mark.size, color=mark.colour, ha="center", va="baseline",
                weight="bold" if mark.bold else "normal", zorder=self._count,
            )  # fmt: skip
            return
        from matplotlib.patches import PathPatch
        from matplotlib.path import Path as Course

        codes = [Course.MOVETO, *[Course.LINETO] * (len(mark.points) - 1)]
        points = list(mark.points)
        if mark.closed:
            codes.append(Course.CLOSEPOLY)
            points.append(points[0])
        look = mark.look
        self._axes.add_patch(
            PathPatch(
                Course(points, codes),
                facecolor=look.fill or "none",
                edgecolor=look.colour,
                linewidth=look.width,
                linestyle=DASHES[look.dash],
                zorder=self._count,
                clip_on=False,
                snap=False,
                capstyle=cap,
                joinstyle="miter",
            )
        )

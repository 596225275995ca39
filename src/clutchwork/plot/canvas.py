"""A figure of matplotlib that a notebook shows, and that is written as it was drawn."""

from __future__ import annotations

from io import BytesIO
from os import PathLike
from pathlib import Path
from typing import Any

from matplotlib import rc_context, rcParams
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from clutchwork.base.writing import replaced
from clutchwork.plot.style import settings

# of the screen of a notebook, which may have twice as many
DOTS = 96.0


class Picture(Figure):
    """A figure that is not known to pyplot, so it is shown once: as the last value of a cell, or by `display`."""

    formulas = True

    @classmethod
    def sized(cls, width: float, height: float, formulas: bool) -> Picture:
        """An empty one.

        Parameters: width and height [inch]; formulas, whether text between dollars is one.
        """
        made = cls(figsize=(width, height), layout="constrained")
        made.formulas = formulas
        FigureCanvasAgg(made)
        return made

    @property
    def width(self) -> int:
        """Width in a notebook [px]."""
        return round(self.get_figwidth() * DOTS)

    def savefig(self, fname: Any, **named: Any) -> None:
        """Write it to a path or a stream, in the look in which it was drawn."""
        with rc_context(settings(self.formulas)):
            if not isinstance(fname, str | PathLike):
                super().savefig(fname, **named)
                return
            path = Path(fname)
            # as matplotlib does
            path = path if path.suffix or "format" in named else path.with_suffix(f".{rcParams['savefig.format']}")
            with replaced(path) as new:
                super().savefig(new, **named)

    def png(self) -> bytes:
        """The picture, sharp on a screen with small pixels too."""
        file = BytesIO()
        self.savefig(file, format="png", dpi=2.0 * DOTS)
        return file.getvalue()

    def _repr_mimebundle_(self, **_: Any) -> tuple[dict[str, Any], dict[str, Any]]:
        height = round(self.get_figheight() * DOTS)
        size = {"image/png": {"width": self.width, "height": height}}
        return {"text/plain": repr(self), "image/png": self.png()}, size

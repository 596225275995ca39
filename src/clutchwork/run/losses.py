"""A table of losses that users hold: it draws itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from clutchwork.base.paths import fitting
from clutchwork.base.rich import bundle
from clutchwork.declare.calls import explained
from clutchwork.plot import sankey
from clutchwork.plot.chosen import PICTURES
from clutchwork.results.losses import LossTable

if TYPE_CHECKING:
    from pathlib import Path

    from clutchwork.plot.canvas import Picture


class Losses(LossTable):
    """Where the energy of a window of a run went, element by element; print it to read it.

    With `power` all are mean powers in W in place of energies in J.
    """

    @explained("losses.sankey", path="'sankey.svg'")
    def sankey(self, path: str | Path | None = None) -> Picture:
        """The table as a Sankey picture: sources left, load right, heat down, what is stored up. Needs matplotlib.

        Parameters: path, where it is written: png, svg or pdf by its ending.
        """
        return sankey.draw(self, fitting("losses.sankey", path, "sankey.svg", PICTURES) if path is not None else None)

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        return bundle(self, *sankey.parts(self))

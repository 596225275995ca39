"""An empty figure in the look of this package; with `picture.py` the only place where matplotlib is imported."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from clutchwork.base.extras import need
from clutchwork.plot.style import MILLIMETRE, WIDTH, settings

if TYPE_CHECKING:
    from clutchwork.plot.canvas import Picture


@contextmanager
def figure_of(height: float, *, formulas: bool = True, width: float = WIDTH) -> Iterator[Picture]:
    """A figure as wide as two columns of a journal; what is drawn inside the `with` has the look.

    Parameters: height [mm]; formulas, whether text between dollars is one, as on logarithmic axes; width [inch].
    """
    matplotlib = need("matplotlib", "draw", "a picture")
    # needs matplotlib
    from clutchwork.plot.canvas import Picture

    with matplotlib.rc_context(settings(formulas)):
        yield Picture.sized(width, height * MILLIMETRE, formulas)


def written(figure: Picture, path: Path | None) -> Picture:
    """The same figure, written to a path where there is one; folders are made."""
    if path is not None:
        figure.savefig(path)
    return figure

"""An empty figure in the look of this package; matplotlib is imported here and nowhere else."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from clutchwork.results.plot.style import MILLIMETRE, RC, WIDTH

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@contextmanager
def figure_of(height: float, *, formulas: bool = True) -> Iterator[Figure]:
    """A figure as wide as two columns of a journal; what is drawn inside the `with` has the look.

    Parameters: height [mm]; formulas, whether text between dollars is one, as on logarithmic axes.
    """
    try:
        from matplotlib import rc_context
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError as error:
        raise ImportError('pictures need matplotlib: pip install "clutchwork[plot]"') from error

    with rc_context({**RC, "text.parse_math": formulas}):
        figure = Figure(figsize=(WIDTH, height * MILLIMETRE), layout="constrained")
        FigureCanvasAgg(figure)
        yield figure

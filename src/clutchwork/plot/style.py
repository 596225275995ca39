"""Look of the pictures: sizes for print, colours that stay apart for every eye and in grey."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Any

# Okabe and Ito, doi 10.1080/00031305.2008; yellow left out because it vanishes on paper
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000", "#7F7F7F")
DASHES: tuple[Any, ...] = ("-", (0, (5, 1.5)), (0, (1.5, 1.2)), (0, (6, 1.5, 1.5, 1.5)))

RC = {
    "font.family": "sans-serif",
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "axes.titlesize": 8.5,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#E4E4E4",
    "grid.linewidth": 0.5,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "lines.linewidth": 1.2,
    "lines.solid_capstyle": "round",
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "savefig.dpi": 300,
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
}

MILLIMETRE = 1.0 / 25.4  # inch
WIDTH = 180.0 * MILLIMETRE  # two columns of a journal

EVENT_LINE: dict[str, Any] = {"color": "#9A9A9A", "linewidth": 0.6, "linestyle": (0, (3, 2)), "zorder": 1}


def looks() -> Iterator[dict[str, Any]]:
    """Colour and dashes for one curve after another."""
    for dashes, colour in product(DASHES, COLOURS):
        yield {"color": colour, "linestyle": dashes}
    while True:
        yield {"color": COLOURS[-1], "linestyle": "-"}

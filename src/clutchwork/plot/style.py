"""Look of the pictures: sizes for print, colours that stay apart for every eye and in grey."""

from __future__ import annotations

import sys
from typing import Any

# Okabe and Ito, doi 10.1080/00031305.2008; yellow left out because it vanishes on paper
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000", "#7F7F7F")
DASHES: tuple[Any, ...] = ("-", (0, (4, 2)), (0, (1, 1.5)))

# Any, because matplotlib types the names of its settings
RC: Any = {
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
    "text.usetex": False,
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

# of curves beyond those that colours and DASHES tell apart
MORE_DASHES: tuple[Any, ...] = ((0, (6, 1.5, 1, 1.5)), (0, (3, 1, 1, 1, 1, 1)))

MILLIMETRE = 1.0 / 25.4  # inch
WIDTHS = {"single column": 88.0, "double column": 180.0}  # mm, of a journal
WIDTH = WIDTHS["double column"] * MILLIMETRE
# mm: below NARROW legends stand above their panels
NARROW, NARROWEST = 130.0, 75.0

EVENT_LINE: dict[str, Any] = {"color": "#9A9A9A", "linewidth": 0.6, "linestyle": (0, (3, 2)), "zorder": 1}


def settings(formulas: bool) -> Any:
    """Settings of matplotlib for a picture; whether text between dollars is a formula.

    A setting that the user changed, in rcParams, a style or a matplotlibrc, stays.
    """
    matplotlib = sys.modules["matplotlib"]
    own, default = matplotlib.rcParams, matplotlib.rcParamsDefault
    return {**{name: value for name, value in RC.items() if own[name] == default[name]}, "text.parse_math": formulas}


def colours() -> tuple[Any, ...]:
    """Colours of curves: those of the property cycle where the user has one of their own."""
    # an Any that is there where a picture is drawn; plotly has no such cycle
    matplotlib: Any = sys.modules.get("matplotlib")
    if matplotlib is None:
        return COLOURS
    own = matplotlib.rcParams["axes.prop_cycle"]
    if own == matplotlib.rcParamsDefault["axes.prop_cycle"]:
        return COLOURS
    return tuple(own.by_key().get("color", COLOURS))


def looks(count: int) -> list[dict[str, Any]]:
    """Colours and dashes of `count` curves: later ones have more gaps, so that a curve below stays visible."""
    hues = colours()
    dashes = DASHES if count <= len(hues) * len(DASHES) else DASHES + MORE_DASHES
    return [
        {"color": hues[i % len(hues)], "linestyle": dashes[min(len(dashes) * i // count, len(dashes) - 1)]}
        for i in range(count)
    ]

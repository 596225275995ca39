"""How laws look in the pictures: the same colour everywhere, names as their papers write them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from clutchwork.declare.schema import REGISTRY, Role
from clutchwork.plot.style import COLOURS, DASHES

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# laws that are often compared come first and are drawn solid
ORDER = (
    "mykhalevych", "lugre", "elastoplastic", "gms", "leuven", "dahl", "stribeck", "tanh",
    "regularised_stribeck", "naive_sign", "karnopp", "exponential", "coulomb", "coefficient_table",
)  # fmt: skip

# width of a picture in letters m of the legend
PAGE = 66.0

GUIDE: dict[str, Any] = {"color": "#404040", "linewidth": 0.7, "linestyle": (0, (3, 2)), "zorder": 1}
GREY: dict[str, Any] = {"color": "#D0D0D0", "linewidth": 6.0, "zorder": 1}


def looks(labels: Iterable[str]) -> dict[str, dict[str, Any]]:
    """Colour, dashes and label of the curve of every law; unknown labels take what is left."""
    labels = list(labels)
    free = [i for i in range(len(COLOURS) * len(DASHES)) if i >= len(ORDER) or ORDER[i] not in labels]
    numbers = {label: ORDER.index(label) if label in ORDER else free.pop(0) for label in labels}
    return {
        label: {
            "color": COLOURS[i % len(COLOURS)],
            "linestyle": DASHES[i // len(COLOURS) % len(DASHES)],
            "label": title(label),
        }
        for label, i in numbers.items()
    }


def nested(labels: Iterable[str]) -> dict[str, dict[str, Any]]:
    """Looks for curves that lie on each other: every next one is thinner, so that all of them are seen."""
    every = looks(labels)
    last = max(1, len(every) - 1)
    return {label: {**look, "linewidth": 3.4 - 2.4 * i / last} for i, (label, look) in enumerate(every.items())}


def title(label: str) -> str:
    """Name of a law in a picture: that of its class where the label is a kind."""
    return REGISTRY[Role.LAW][label].__name__ if label in REGISTRY[Role.LAW] else label


def legend_below(axes: Axes) -> None:
    """One legend for the whole picture, below all axes, in as few rows as fit."""
    handles, labels = axes.get_legend_handles_labels()
    figure = axes.get_figure()
    if figure is None or not handles:
        return
    widths = sorted((5.0 + 0.55 * len(str(label)) for label in labels), reverse=True)
    fitting = max(n for n in range(1, len(labels) + 1) if sum(widths[:n]) <= PAGE or n == 1)
    rows = -(-len(labels) // fitting)
    figure.legend(handles, labels, loc="outside lower center", ncols=-(-len(labels) // rows), handlelength=2.6)


def head(axes: Axes, letter: str, words: str) -> None:
    """Title of a panel."""
    axes.set_title(f"{letter})  {words}", loc="left")


def small(unit: str, factor: float) -> str:
    """Unit of values that were multiplied by a factor for the picture: 1e6 makes m to µm."""
    return {1.0: "", 1e3: "m", 1e6: "µ", 1e9: "n"}[factor] + unit

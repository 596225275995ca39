"""What notebooks show in place of a `repr`: a picture and a table.

Who can draw a thing stands above the room in which it is declared, and imports point down only. So that room names who
draws, as `face/names.py` names where a public name lives, and it is imported when a notebook asks.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any, Protocol

# what is shown -> the function that makes its parts, as module:function below clutchwork
SHOWN_BY = {
    "losses": "results.plot.sankey:parts",
    "law": "face.laws:parts",
    "signal": "results.plot.signals:parts",
    "system": "results.overview:parts",
    "trajectory": "results.plot.run:parts",
}


class NotebookPicture(Protocol):
    """A picture of matplotlib that knows its size in a notebook."""

    @property
    def width(self) -> int:
        """Width in a notebook [px]."""

    def png(self) -> bytes:
        """The picture, sharp on a screen with small pixels too."""


def bundle(thing: object, kind: str) -> dict[str, Any]:
    """What a notebook may choose from: plain text, a page with picture and tables, the picture alone.

    A notebook shows the richest alone, the page; what turns one into a PDF takes the picture.
    """
    from clutchwork.base.html import image, page

    module, _, name = SHOWN_BY[kind].partition(":")
    drawn, tables = getattr(import_module(f"clutchwork.{module}"), name)(thing)
    made: dict[str, Any] = {"text/plain": repr(thing)}
    shown = list(tables)
    if drawn is not None:
        png = drawn.png()
        made["image/png"] = png
        shown.append(image(png, drawn.width))
    return made | ({"text/html": page(*shown)} if shown else {})

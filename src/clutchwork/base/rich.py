"""What notebooks show in place of a `repr`: a picture and a table."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol

from clutchwork.base.html import image, page


class NotebookPicture(Protocol):
    """A picture of matplotlib that knows its size in a notebook."""

    @property
    def width(self) -> int:
        """Width in a notebook [px]."""

    def png(self) -> bytes:
        """The picture, sharp on a screen with small pixels too."""


def bundle(thing: object, drawn: NotebookPicture | None, tables: Iterable[str]) -> dict[str, Any]:
    """What a notebook may choose from: plain text, a page with picture and tables, the picture alone.

    A notebook shows the richest alone, the page; what turns one into a PDF takes the picture.
    """
    made: dict[str, Any] = {"text/plain": repr(thing)}
    shown = list(tables)
    if drawn is not None:
        png = drawn.png()
        made["image/png"] = png
        shown.append(image(png, drawn.width))
    return made | ({"text/html": page(*shown)} if shown else {})

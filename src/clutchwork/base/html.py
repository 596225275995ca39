"""Tables and pictures as HTML, for notebooks; whatever a name holds, it is shown as it is."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Collection, Iterable, Sequence
from html import escape

# a notebook would set what stands between two dollars as a formula
PLAIN = "tex2jax_ignore mathjax_ignore"
MOST_ROWS = 40


def text(words: object) -> str:
    """A string without tags or entities of its own."""
    return escape(str(words))


def table(
    head: Sequence[str], lines: Iterable[Sequence[object]], right: Collection[int] = (), most: int = MOST_ROWS
) -> str:
    """A table of cells.

    Parameters: head, of each column; lines, of cells; right, columns that are flush right; most, lines that are shown,
    the rest is counted.
    """
    rows = list(lines)
    made = [_line("th", head, right)] if any(head) else []
    body = [_line("td", row, right) for row in rows[:most]]
    if len(rows) > most:
        body.append(f'<tr><td colspan="{len(head)}" style="text-align:left">... and {len(rows) - most} more</td></tr>')
    top = f"<thead>{''.join(made)}</thead>" if made else ""
    return f'<table class="{PLAIN}">{top}<tbody>{"".join(body)}</tbody></table>'


def _line(tag: str, cells: Sequence[object], right: Collection[int]) -> str:
    made = (
        f'<{tag} style="text-align:{"right" if column in right else "left"}; white-space:pre-wrap">{text(cell)}</{tag}>'
        for column, cell in enumerate(cells)
    )
    return f"<tr>{''.join(made)}</tr>"


def heading(words: object) -> str:
    """A line above a table."""
    return f'<p class="{PLAIN}"><b>{text(words)}</b></p>'


def paragraph(words: object) -> str:
    """A line of words."""
    return f'<p class="{PLAIN}">{text(words)}</p>'


def image(png: bytes, width: int) -> str:
    """A picture inside of the page, so wide [px]."""
    data = b64encode(png).decode("ascii")
    return f'<img alt="" style="width:{width}px; max-width:100%" src="data:image/png;base64,{data}">'


def page(*parts: str) -> str:
    """Stacks parts vertically."""
    return f"<div>{''.join(parts)}</div>"

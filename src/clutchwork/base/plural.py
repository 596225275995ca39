"""Tables and counts of things for the terminal."""

from __future__ import annotations

from collections.abc import Collection, Sequence


def counted(count: int, plural: str) -> str:
    """A number and what it counts: `1 event`, `2 events`, `1 shaft or mass`."""
    return f"{count} {plural if count != 1 else ' '.join(map(_singular, plural.split()))}"


def _singular(word: str) -> str:
    if word == "and":
        return "or"
    return word.removesuffix("es") if word.endswith("sses") else word.removesuffix("s")


def columns(lines: Sequence[Sequence[str]], right: Collection[int] = ()) -> str:
    """Lines of cells as aligned columns; the columns in `right` are flush right."""
    if not lines:
        return ""
    widths = [max(len(line[column]) for line in lines) for column in range(len(lines[0]))]
    return "\n".join(_line(line, widths, right) for line in lines)


def _line(cells: Sequence[str], widths: Sequence[int], right: Collection[int]) -> str:
    padded = [
        cell.rjust(width) if column in right else cell.ljust(width)
        for column, (cell, width) in enumerate(zip(cells, widths, strict=True))
    ]
    return "  ".join(padded).rstrip()

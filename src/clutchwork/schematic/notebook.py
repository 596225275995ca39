"""How a driveline shows itself in a notebook: its schematic, and tables of its shafts and elements."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from clutchwork.base.html import page, table
from clutchwork.model.model import Model
from clutchwork.schematic.diagram import SymbolGraph, Thing, diagram
from clutchwork.schematic.draw import drawn
from clutchwork.schematic.values import element_values, node_values


def html(model: Model) -> str:
    """Schematic and tables; the tables alone where a package for the schematic is missing."""
    found = diagram(model)
    try:
        svg = drawn(model)._repr_svg_()
        # HTML has no heads of XML
        picture = f'<div style="overflow-x:auto">{svg[svg.index("<svg") :]}</div>'
    except ImportError:
        picture = ""
    return page(picture, tables(found))


def tables(found: SymbolGraph) -> str:
    """Shafts and elements of a diagram."""
    nodes = [(node.name, node.what, ", ".join(node_values(node))) for node in found.nodes]
    elements = [
        (thing.name, str(getattr(thing.source, "kind", "")), ", ".join(node.name for node in thing.nodes),
         ", ".join(element_values(thing)))
        for thing in _all(found.elements) if thing.what == "element"
    ]  # fmt: skip
    lists: list[tuple[Sequence[str], Sequence[Sequence[str]]]] = [
        (("node", "sort", "value"), nodes),
        (("element", "kind", "attached to", "values"), elements),
    ]
    return "".join(table(head, lines) for head, lines in lists if lines)


def _all(things: Iterable[Thing]) -> Iterable[Thing]:
    for thing in things:
        yield thing
        yield from _all(thing.helpers)

"""How a driveline shows itself in a notebook: its schematic, and tables of its shafts and elements."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

from clutchwork.model.model import Model
from clutchwork.schematic.diagram import Diagram, Thing, diagram
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
    return picture + tables(found)


def tables(found: Diagram) -> str:
    """Shafts and elements of a diagram."""
    nodes = [(node.name, node.what, ", ".join(node_values(node))) for node in found.nodes]
    elements = [
        (thing.name, str(getattr(thing.source, "kind", "")), ", ".join(node.name for node in thing.nodes),
         ", ".join(element_values(thing)))
        for thing in _all(found.elements) if thing.what == "element"
    ]  # fmt: skip
    return table(("node", "sort", "value"), nodes) + table(("element", "kind", "attached to", "values"), elements)


def _all(things: Iterable[Thing]) -> Iterable[Thing]:
    for thing in things:
        yield thing
        yield from _all(thing.helpers)


def table(head: Sequence[str], lines: Sequence[Sequence[str]]) -> str:
    """A table; nothing where it has no lines."""
    if not lines:
        return ""
    rows = "".join(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in line)}</tr>" for line in lines)
    heads = "".join(f"<th>{escape(cell)}</th>" for cell in head)
    return f"<table><thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table>"

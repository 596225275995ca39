"""What makes a drawing of a gearbox right, asked of its marks and its grid."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations, pairwise
from typing import Any

from clutchwork.diagrams.marks import Label, Polyline
from clutchwork.diagrams.stick.lines import needed
from clutchwork.diagrams.stick.looks import Scene
from clutchwork.gearbox.gear_set import HOUSING


def overlapping_labels(marks: Sequence[Any]) -> list[Any]:
    """Pairs of labels, one over the other."""
    labels = [mark for mark in marks if isinstance(mark, Label)]
    return [(a.text, b.text) for a, b in combinations(labels, 2) if a.box.overlaps(b.box, 0.3)]


def struck_labels(marks: Sequence[Any]) -> list[Any]:
    """Labels with a line through them."""
    labels = [(mark, mark.box) for mark in marks if isinstance(mark, Label)]
    found = []
    for line in (mark for mark in marks if isinstance(mark, Polyline)):
        near = [(label, box) for label, box in labels if box.overlaps(line.box, 0.2)]
        if near:
            bits = list(pieces(line))
            found += [
                (x.text, line.what, line.points) for x, box in near if any(bit.overlaps(box, 0.2) for bit in bits)
            ]
    return found


def pieces(line: Polyline) -> Iterator[Any]:
    """Boxes of the straight parts of a line; a slanted one in short bits."""
    points = [*line.points, line.points[0]] if line.closed else line.points
    for (a, b), (c, d) in pairwise(points):
        count = 1 if a == c or b == d else max(1, int((abs(c - a) + abs(d - b)) / 2.0))
        for n in range(count):
            start = (a + (c - a) * n / count, b + (d - b) * n / count)
            end = (a + (c - a) * (n + 1) / count, b + (d - b) * (n + 1) / count)
            yield Polyline((start, end), width=line.width).box


def touching_members(box: Any, marks: Sequence[Any]) -> list[Any]:
    """Lines of different members that touch as they are drawn."""
    lines = [mark for mark in marks if isinstance(mark, Polyline) and mark.what in box.members]
    pairs = [(a, b) for a, b in combinations(lines, 2) if a.what != b.what and a.box.overlaps(b.box)]
    return [
        (a.what, b.what, a.points, b.points)
        for a, b in pairs
        if any(x.overlaps(y) for x in pieces(a) for y in pieces(b))
    ]


def parts(box: Any, plan: Any, member: str) -> int:
    """Into how many parts the lines of a member fall, with all places that must be joined."""
    edges = needed(Scene(box, plan, None), member)
    wanted = {piece.root for body in plan.bodies for piece in body.pieces.values() if piece.member == member}
    wanted |= {node for name, node in plan.gates.items() if getattr(box, name) == member}
    for element in box.elements:
        symbol = plan.symbols[element.name]
        ends = {symbol.first, symbol.second}
        # one end at each of the two
        assert {plan.ends[end] for end in ends} == set(element.members) - {HOUSING}
        wanted |= {end for end in ends if plan.ends[end] == member}
    groups = [{node} for node in sorted(wanted)]
    for edge in sorted(edges):
        joined = [group for group in groups if group & set(edge)]
        groups = [group for group in groups if group not in joined] + [set(edge).union(*joined)]
    return len(groups)


def faulty_crossings(plan: Any) -> list[Any]:
    """Nodes where lines of two members meet in another way than straight across."""
    at: dict[Any, dict[str, list[str]]] = {}
    for member, edges in plan.lines.items():
        for a, b in edges:
            way = "across" if a[1] == b[1] else "up"
            at.setdefault(a, {}).setdefault(member, []).append(way)
            at.setdefault(b, {}).setdefault(member, []).append(way)
    shared = {node: here for node, here in at.items() if len(here) > 1}
    return [
        node for node, here in shared.items() if sorted(map(tuple, here.values())) != [("across",) * 2, ("up",) * 2]
    ]


def covered(plan: Any) -> list[Any]:
    """Cells of symbols and sets through which a line of somebody else goes."""
    lines = {(member, node) for member, edges in plan.lines.items() for edge in edges for node in edge}
    cells = {cell for symbol in plan.symbols.values() for cell in symbol.cells}
    found: list[Any] = [(member, node) for member, node in lines if node in cells]
    for body in plan.bodies:
        own = {piece.member for piece in body.pieces.values()}
        found += [(member, node) for member, node in lines if node in body.solid and member not in own]
    return found

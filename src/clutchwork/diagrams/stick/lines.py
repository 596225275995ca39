"""The lines of members: chains between joints, broken where another line crosses them, as wide as their power."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from itertools import pairwise

from clutchwork.diagrams.marks import POWER, Pen, Point
from clutchwork.diagrams.stick.board import Edge, edge
from clutchwork.diagrams.stick.bodies import Node
from clutchwork.diagrams.stick.looks import LOST, Scene

MESH = 2.4  # px from the pitch of teeth to the line of a wheel
GAP, DOT, HEAD = 3.2, 2.3, 7.5


def draw_lines(pen: Pen, scene: Scene) -> None:
    """All members with their joints."""
    taken = scene.taken()
    shown = {member: needed(scene, member) for member in scene.box.members}
    flows = {member: powers(some, taken[member]) for member, some in shown.items()}
    across = _across(scene, shown, flows)
    # those with power come last, over the others
    for member in sorted(shown, key=lambda m: max(map(abs, flows[m].values()), default=0.0) > LOST):
        some, flow = shown[member], flows[member]
        stops = {*taken[member], *scene.plan.ends}
        for chain in _chains(some, stops):
            power = flow[edge(chain[0], chain[1])] * (1.0 if chain[0] < chain[1] else -1.0)
            _draw_chain(pen, scene, member, chain, power, across)
        _draw_joints(pen, scene, member, some, flow)


def needed(scene: Scene, member: str) -> set[Edge]:
    """Lines of a member without unconnected ends."""
    keep = {symbol_end for s in scene.plan.symbols.values() for symbol_end in (s.first, s.second)}
    keep |= set(scene.plan.gates.values())
    for body in scene.plan.bodies:
        keep |= {piece.root for piece in body.pieces.values()} | {planet.at for planet in body.planets}
    left = set(scene.plan.lines.get(member, ()))
    while True:
        degree = _degrees(left)
        loose = {one for one in left if any(degree[node] == 1 and node not in keep for node in one)}
        if not loose:
            return left
        left -= loose


def _degrees(some: Collection[Edge]) -> dict[Node, int]:
    degree = dict[Node, int]()
    for one in some:
        for node in one:
            degree[node] = degree.get(node, 0) + 1
    return degree


def _across(scene: Scene, shown: dict[str, set[Edge]], flows: dict[str, dict[Edge, float]]) -> dict[Node, float]:
    """Widths of horizontal lines that cross others, by node."""
    owners = dict[Node, set[str]]()
    for member, some in shown.items():
        for one in some:
            for node in one:
                owners.setdefault(node, set()).add(member)
    found = dict[Node, float]()
    for member, some in shown.items():
        for a, b in some:
            for node in (a, b):
                if a[1] == b[1] and len(owners[node]) > 1:
                    found[node] = scene.width(flows[member][a, b])
    return found


def _chains(some: Collection[Edge], stops: Collection[Node]) -> list[list[Node]]:
    """Ways from joint to joint."""
    beside: dict[Node, list[Node]] = {}
    for a, b in sorted(some):
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    ends = {node for node, others in beside.items() if len(others) != 2 or node in stops}
    made, used = list[list[Node]](), set[Edge]()
    for start in sorted(ends):
        for following in sorted(beside[start]):
            if edge(start, following) in used:
                continue
            chain = [start, following]
            while chain[-1] not in ends:
                chain.append(next(node for node in beside[chain[-1]] if node != chain[-2]))
            used.update(edge(*pair) for pair in pairwise(chain))
            made.append(chain)
    return made


def _draw_chain(
    pen: Pen, scene: Scene, member: str, chain: list[Node], power: float, across: dict[Node, float]
) -> None:
    colour, width = scene.colour(member, power), scene.width(power)
    free = list[list[Point]]()
    for points, gap in _runs(scene, chain, across):
        pen.line(*_straight(points), colour=colour, width=width, what=member)
        free += gap
    if colour == POWER:
        _draw_head(pen, free, power > 0, width, member)


def _runs(
    scene: Scene, chain: list[Node], across: dict[Node, float]
) -> Iterator[tuple[list[Point], list[list[Point]]]]:
    """Parts of a chain that are drawn, cut where a line goes across, and parts of these that cross nothing."""
    points = [place(scene, node) for node in chain]
    part, free, now = [points[0]], list[list[Point]](), [points[0]]
    for number in range(1, len(chain) - 1):
        (x, y), node = points[number], chain[number]
        if node not in across:
            part.append((x, y))
            now.append((x, y))
            continue
        upright, half = chain[number - 1][0] == chain[number + 1][0], GAP + 0.5 * across[node]
        a, b = _sign(chain[number][0] - chain[number - 1][0]), _sign(chain[number - 1][1] - chain[number][1])
        free.append([*now, (x - half * a, y - half * b)])
        now = [(x + half * a, y + half * b)]
        if upright:
            yield [*part, (x, y - half * b)], []
            part = [(x, y + half * b)]
    yield [*part, points[-1]], [*free, [*now, points[-1]]]


def _sign(value: int) -> float:
    return float((value > 0) - (value < 0))


def place(scene: Scene, node: Node) -> Point:
    """Where a node is; that of a wheel a bit off the teeth that it meshes."""
    x, y = scene.at(node)
    return x, y + MESH * scene.plan.wheels.get(node, 0)


def _straight(points: list[Point]) -> list[Point]:
    """Without points in the middle of straight lines."""
    # empty columns and rows have no width
    points = [point for number, point in enumerate(points) if not number or point != points[number - 1]]
    if len(points) < 2:
        return points * 2
    kept = [points[0]]
    for before, here, after in zip(points, points[1:], points[2:], strict=False):
        if not (before[0] == here[0] == after[0] or before[1] == here[1] == after[1]):
            kept.append(here)
    return [*kept, points[-1]]


def _draw_head(pen: Pen, parts: list[list[Point]], forward: bool, width: float, member: str) -> None:
    """An arrow in the middle of the longest straight part, where there is room."""
    straight = [pair for part in parts for pair in pairwise(_straight(part))]
    start, end = max(straight, key=lambda pair: abs(pair[0][0] - pair[1][0]) + abs(pair[0][1] - pair[1][1]))
    (a, b), (c, d) = (start, end) if forward else (end, start)
    long, size = abs(a - c) + abs(b - d), HEAD + width
    if long >= size + 6.0:
        way = ((c - a) / long, (d - b) / long)
        tip = (0.5 * (a + c) + 0.5 * size * way[0], 0.5 * (b + d) + 0.5 * size * way[1])
        pen.arrow(tip, way, size, POWER, member)


def _draw_joints(pen: Pen, scene: Scene, member: str, some: set[Edge], flow: dict[Edge, float]) -> None:
    degree = _degrees(some)
    symbols = [end for s in scene.plan.symbols.values() for end in {s.first, s.second}]
    for node in symbols:
        if node in degree:
            degree[node] += 1
    for node in scene.plan.gates.values():
        if node in degree:
            degree[node] += 1
    for node, count in sorted(degree.items()):
        if count > 2:
            power = max((abs(flow[one]) for one in some if node in one), default=0.0)
            x, y = scene.at(node)
            pen.dot(x, y, DOT + 0.5 * (scene.width(power) - scene.width(0.0)), scene.colour(member, power))


def powers(lines: Collection[Edge], taken: Mapping[Node, float]) -> dict[Edge, float]:
    """Power along each edge, from its lesser to its greater end.

    Parameters: lines, edges of a tree; taken, power that enters at a node.
    """
    beside: dict[Node, list[Node]] = {}
    for a, b in lines:
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    found: dict[Edge, float] = {}
    seen = set[Node]()
    for root in sorted(beside):
        if root in seen:
            continue
        order, parent = [root], dict[Node, Node]()
        seen.add(root)
        for node in order:
            for other in sorted(beside[node]):
                if other not in seen:
                    seen.add(other)
                    parent[other] = node
                    order.append(other)
        total = {node: taken.get(node, 0.0) for node in order}
        for node in reversed(order[1:]):
            above = parent[node]
            total[above] += total[node]
            one = edge(node, above)
            found[one] = total[node] if one[0] == node else -total[node]
    return found

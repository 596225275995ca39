"""Power through each line of a stick diagram: what one side of it takes up, the other gives."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from clutchwork.diagrams.stick.board import Edge, edge
from clutchwork.diagrams.stick.bodies import Node


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

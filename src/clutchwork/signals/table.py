"""Table over time."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from clutchwork.declare import Points, Role, Segment, Signal, component, curve


@component(Role.SIGNAL)
class Table(Signal):
    """Linear between (time, value) points, held outside; two points at one time make a jump."""

    points: Points = curve("s", "*", "times [s] that do not fall, and values", rising="weakly", kw_only=False)

    def segments(self) -> tuple[Segment, ...]:
        """One linear piece between every two times, constant ones outside."""
        return tuple(pieces(self.points))


def pieces(points: Points) -> Iterator[Segment]:
    """Pieces of a table; at a jump the later value holds from that time on."""
    first, last = points[0], points[-1]
    if first[0] > 0.0:
        yield Segment(0.0, first[1])
    for (t, y), (t_next, y_next) in pairwise(points):
        if t_next > t:
            yield Segment(t, y, (y_next - y) / (t_next - t))
    yield Segment(last[0], last[1])

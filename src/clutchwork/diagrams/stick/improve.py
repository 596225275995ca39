"""A gearbox laid out, and each part laid out again while that makes the whole better."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import inf

from clutchwork.diagrams.stick.board import Board
from clutchwork.diagrams.stick.bodies import Body
from clutchwork.diagrams.stick.route import IN, OUT, NoRoomError, Router
from clutchwork.gearbox.definition import Definition

RETRIES, PASSES = 5, 4
SLACK = 8.0  # what a search counts and a finished board does not
# what takes something off the board, and what lays it anew
Change = tuple[Callable[[], None], Callable[[], None]]


def routed(box: Definition, bodies: Sequence[Body], columns: int, rows: int) -> Router | None:
    """All lines on a grid of a size; elements that find no way are laid before the others. None: there is no room."""
    urgent: list[str] = []
    for _ in range(RETRIES):
        router = Router(box, bodies, Board(columns, rows))
        try:
            router.run(urgent)
        except NoRoomError as error:
            if not error.args or error.args[0] in urgent[:1]:
                return None
            urgent = [*error.args, *(name for name in urgent if name not in error.args)]
        else:
            _improve(router)
            return router
    return None


def _improve(router: Router) -> None:
    """Elements, members, input and output once more, one after the other, until nothing gets better."""
    cost = router.cost()
    changes: list[Change] = [(partial(router.lift, one), partial(router.place, one)) for one in router.box.elements]
    changes += [(partial(router.strip, member), partial(router.join, member)) for member in router.order()]
    changes += [(partial(router.close_gate, name), partial(router.open_gate, name)) for name in (IN, OUT)]
    for _ in range(PASSES):
        before = cost
        for change in changes:
            cost = _tried(router, cost, change)
        if cost >= before:
            return


def _tried(router: Router, cost: float, change: Change) -> float:
    """Take something off the board and lay it anew; what was there comes back where that does not make it better."""
    board, symbols, gates = router.board.copy(), dict(router.symbols), dict(router.gates)
    off, on = change
    off()
    # a way that costs more than what was there is not sought to its end
    router.limit = cost - router.cost() + SLACK
    try:
        on()
        better = router.cost()
    except NoRoomError:
        better = cost
    router.limit = inf
    if better < cost - 1e-9:
        return better
    router.board, router.symbols, router.gates = board, symbols, gates
    return cost

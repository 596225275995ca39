"""A gearbox laid out, and each part laid out again while that makes the whole better."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from clutchwork.diagrams.stick.board import Board
from clutchwork.diagrams.stick.bodies import Body
from clutchwork.diagrams.stick.route import IN, OUT, NoRoomError, Router
from clutchwork.gearbox.definition import Definition, ShiftElement

RETRIES, PASSES = 5, 4


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
    changes: list[Callable[[], None]] = [partial(_element, router, one) for one in router.box.elements]
    changes += [partial(_member, router, member) for member in router.order()]
    changes += [partial(_gate, router, name) for name in (IN, OUT)]
    for _ in range(PASSES):
        before = cost
        for change in changes:
            cost = _tried(router, cost, change)
        if cost >= before:
            return


def _element(router: Router, element: ShiftElement) -> None:
    router.lift(element)
    router.place(element)


def _member(router: Router, member: str) -> None:
    router.strip(member)
    router.join(member)


def _gate(router: Router, name: str) -> None:
    router.close_gate(name)
    router.open_gate(name)


def _tried(router: Router, cost: float, change: Callable[[], None]) -> float:
    """Make a change, and take it back where that does not help."""
    board, symbols, gates = router.board.copy(), dict(router.symbols), dict(router.gates)
    try:
        change()
        better = router.cost()
    except NoRoomError:
        better = cost
    if better < cost - 1e-9:
        return better
    router.board, router.symbols, router.gates = board, symbols, gates
    return cost

"""All peers with their times and errors, at the tolerance of the core and at that which gives its error."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.peers import by_c, by_scipy, by_sundae, driver, equations, numba_loop
from benchmarks.peers.compiled import compiled
from benchmarks.report import Row
from benchmarks.timing import cpu, ratio

RTOL = 1e-6
TIGHTER = (1e-7, 1e-8, 1e-9, 1e-10, 1e-11)


@dataclass(frozen=True)
class Peer:
    """Another program for the same run."""

    name: str
    goal: float  # how many times the time of the core it shall take, at the same error
    seconds: Callable[[float], float]  # CPU time of one run at a relative tolerance
    states: Callable[[float], Any]  # speeds on the grid of the reference, and more

    def error(self, rtol: float) -> float:
        """Largest speed error [rad/s]."""
        return driver.error(self.states(rtol)[:, :4])

    def tolerance(self, error: float) -> float | None:
        """The loosest tolerance at which its error is no larger than the given one; None when none is tight enough."""
        return next((rtol for rtol in (RTOL, *TIGHTER) if self.error(rtol) <= error), None)


@dataclass(frozen=True)
class Missing:
    """One that cannot run here."""

    name: str
    why: str
    goal: float


def peers(folder: Path) -> Iterator[Peer | Missing]:
    """Those that can run here, compiled into a folder, and those that cannot."""
    yield from _family("SciPy {}, interpreted", by_scipy.METHODS, 300.0, lambda: by_scipy.solver, lambda: equations)
    yield from _family("SciPy {}, numba right-hand side", by_scipy.METHODS, 100.0, lambda: by_scipy.solver, compiled)
    yield from _family("CVODE {}, interpreted", by_sundae.METHODS, 300.0, by_sundae.available, lambda: equations)
    try:
        program = by_c.cvode(folder)
    except by_c.NotInstalledError as missing:
        yield from (Missing(f"CVODE {method}, all in C", str(missing), 20.0) for method in by_c.METHODS)
    else:
        for method in by_c.METHODS:
            timed, states = partial(by_c.cvode_seconds, program, method), partial(by_c.cvode_states, program, method)
            yield Peer(f"CVODE {method}, all in C", 20.0, timed, states)
    name = "DOPRI5, the whole loop in numba"
    try:
        numba_loop.loop()
    except ImportError:
        yield Missing(name, "not installed: pip install numba", 5.0)
    else:
        grid = driver.reference()[0]
        timed = lambda rtol: cpu(lambda: numba_loop.solve(rtol), 50)  # noqa: E731
        yield Peer(name, 5.0, timed, lambda rtol: numba_loop.solve(rtol, grid)[0])


def _family(
    name: str, methods: tuple[str, ...], goal: float, solver: Callable[[], Any], functions: Callable[[], Any]
) -> Iterator[Peer | Missing]:
    """The methods of one package around the loop over events of `driver`."""
    try:
        make, made = solver(), functions()
    except ImportError as error:
        yield from (Missing(name.format(method), f"not installed: {error.name}", goal) for method in methods)
        return
    for method in methods:
        yield Peer(name.format(method), goal, partial(_timed, make, method, made), partial(_states, make, method, made))


def _timed(make: Any, method: str, made: Any, rtol: float) -> float:
    solve = make(method, made, rtol)
    return cpu(lambda: driver.run(solve), 2)


def _states(make: Any, method: str, made: Any, rtol: float) -> Any:
    return driver.run(make(method, made, rtol), driver.reference()[0])[0]


class Field:
    """The peers that run here, and what is measured of each in every round."""

    def __init__(self, folder: Path, error: float) -> None:
        """`error` is that of the core at the same tolerance [rad/s]."""
        self.all = list(peers(folder))
        self.here = [peer for peer in self.all if isinstance(peer, Peer)]
        self.errors = {peer.name: peer.error(RTOL) for peer in self.here}
        self.alike = {peer.name: peer.tolerance(error) for peer in self.here}

    def contestants(self) -> dict[str, Callable[[], float]]:
        """What is timed, by name: each at the tolerance of the core, and where its error is that of the core."""
        found: dict[str, Callable[[], float]] = {}
        for peer in self.here:
            found[peer.name] = partial(peer.seconds, RTOL)
            tolerance = self.alike[peer.name]
            if tolerance is not None and tolerance != RTOL:
                found[f"{peer.name} alike"] = partial(peer.seconds, tolerance)
        return found

    def rows(self, taken: dict[str, list[float]], ours: str) -> Iterator[Row]:
        """The lines of the table."""
        for peer in self.all:
            name, goal = f"shift: {peer.name}", f">= {peer.goal:g} x"
            if isinstance(peer, Missing):
                yield Row(name, peer.why, goal)
                continue
            times, same = ratio(taken[peer.name], taken[ours]), self.alike[peer.name]
            plain = f"{_short(taken[peer.name])}, {self.errors[peer.name]:.0e} rad/s = {times:.0f} x"
            if same is None:
                yield Row(name, f"{plain}; never as exact", goal)
                continue
            alike = times if same == RTOL else ratio(taken[f"{peer.name} alike"], taken[ours])
            yield Row(name, f"{plain}; as exact {alike:.0f} x", goal, alike >= peer.goal)


def _short(taken: list[float]) -> str:
    middle = sorted(taken)[len(taken) // 2]
    return (
        f"{1e6 * middle:.0f} us"
        if middle < 1e-3
        else f"{1e3 * middle:.1f} ms"
        if middle < 1e-2
        else f"{1e3 * middle:.0f} ms"
    )

"""Freewheels that collide, all at once: the speeds nearest in kinetic energy at which none turns back."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import isotonic_regression, nnls
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

import clutchwork as cw
from support.amount import amount
from support.sweep import log_uniform, simulate, stopped, sweep

# of the largest speed: the work of round-off in a projection
ROUND_OFF = 1e-9


def nearest(
    inertia: np.ndarray, speed: np.ndarray, pushed: list[tuple[int, int]], joined: list[tuple[int, int]]
) -> np.ndarray:
    """Speeds of least distance in kinetic energy; followers of `pushed` not slower than their base, `joined` equal.

    Members that must not be slower than each other turn as one. Between those the dual problem over the impulses has no
    free direction, and nonnegative least squares solves it; index -1 is a member at rest.
    """
    rest = len(inertia)
    ahead = [*pushed, *joined, *((b, a) for a, b in joined)]
    edges = np.array([[rest if end < 0 else end for end in pair] for pair in ahead], dtype=int).reshape(-1, 2)
    graph = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(rest + 1, rest + 1))
    count, group = connected_components(graph, directed=True, connection="strong")
    mass = np.bincount(group[:rest], inertia, count)
    mean = np.bincount(group[:rest], inertia * speed, count) / np.where(mass > 0, mass, 1.0)
    mean[group[rest]] = 0.0
    root = np.where(mass > 0, np.sqrt(np.where(mass > 0, mass, 1.0)), np.inf)
    root[group[rest]] = np.inf
    between = {(int(a), int(b)) for a, b in group[edges] if a != b}
    matrix = np.zeros((count, len(between)))
    for column, (base, follower) in enumerate(sorted(between)):
        matrix[base, column] -= 1 / root[base]
        matrix[follower, column] += 1 / root[follower]
    finite = np.where(np.isfinite(root), root, 0.0)
    impulses = nnls(matrix, -finite * mean, maxiter=1000)[0] if between else np.zeros(0)
    return np.asarray((mean + (matrix @ impulses) / root)[group[:rest]])


def wrong(found: np.ndarray, exact: np.ndarray, scale: float) -> str:
    error = float(np.max(np.abs(found - exact))) / scale
    return "" if error <= ROUND_OFF else f"speeds {found.tolist()}, exact {exact.tolist()} ({error:.1e})"


def speeds(run: Any, count: int, place: int) -> np.ndarray:
    return np.array([run[f"s{i}.speed"][place] for i in range(count)])


def random_masses(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    return np.exp(rng.uniform(np.log(0.01), np.log(10.0), count)), rng.uniform(-100.0, 100.0, count)


def shafts(d: cw.Driveline, inertia: np.ndarray, speed: np.ndarray) -> list[cw.Node]:
    return [
        d.shaft(f"s{i}", inertia=float(j), speed=float(w)) for i, (j, w) in enumerate(zip(inertia, speed, strict=True))
    ]


def chain(seed: int) -> str:
    rng = np.random.default_rng([seed, 5])
    count = int(rng.integers(2, 9))
    inertia, speed = random_masses(rng, count)
    d = cw.Driveline("chain")
    nodes = shafts(d, inertia, speed)
    order = rng.permutation(count - 1)
    for i in order:
        d.add(cw.OneWayClutch(f"f{i}", base=nodes[i], follower=nodes[i + 1]))
    run = simulate(d, 0.1)
    exact = isotonic_regression(speed, weights=inertia).x
    return stopped(run) or wrong(speeds(run, count, -1), exact, 100.0)


def links(rng: np.random.Generator, count: int, *, housing: bool) -> list[tuple[int, int]]:
    """A random tree over the shafts with some links more, which close loops; each directed at random."""
    pairs = [(int(rng.integers(i)), i) for i in range(1, count)]
    for _ in range(int(rng.integers(0, 3))):
        a, b = rng.choice(count, 2, replace=False)
        pairs.append((int(a), int(b)))
    if housing and rng.random() < 0.3:
        pairs.append((-1, int(rng.integers(count))))
    return [pair if rng.random() < 0.5 else pair[::-1] for pair in pairs]


def between(d: cw.Driveline, nodes: list[cw.Node], base: int, follower: int) -> dict[str, Any]:
    """Ports of a link; -1 is the housing."""
    members = [*nodes, d.housing]
    return {"base": members[base], "follower": members[follower]}


def together(seed: int) -> str:
    """Trees and loops, some of their links clutches that are declared locked."""
    rng = np.random.default_rng([seed, 6])
    count = int(rng.integers(3, 8))
    inertia, speed = random_masses(rng, count)
    d = cw.Driveline("net")
    nodes = shafts(d, inertia, speed)
    pushed, joined = [], []
    for i, (base, follower) in enumerate(links(rng, count, housing=True)):
        ends = between(d, nodes, base, follower)
        if rng.random() < 0.25:
            law = cw.Coulomb(static=1.0, kinetic=1.0)
            d.add(cw.Clutch(f"k{i}", **ends, friction=law, gain=1.0, normal_force=1e4, locked=True))
            joined.append((base, follower))
        else:
            d.add(cw.OneWayClutch(f"f{i}", **ends))
            pushed.append((base, follower))
    run = simulate(d, 0.1)
    exact = nearest(inertia, speed, pushed, joined)
    if text := stopped(run) or wrong(speeds(run, count, -1), exact, 100.0):
        return text
    before, after = 0.5 * inertia @ speed**2, 0.5 * inertia @ exact**2
    energy = run.energy
    if abs(energy.residual) <= ROUND_OFF * before and abs(energy.impulses - before + after) <= ROUND_OFF * before:
        return ""
    return f"impulses take {before - after:.9g} J, named {energy.impulses:.9g} J, residual {energy.residual:.3g} J"


def jump(seed: int) -> str:
    """A consistent net at rest or turning together, a prescribed speed in it that jumps."""
    rng = np.random.default_rng([seed, 7])
    count = int(rng.integers(3, 7))
    inertia, speed = random_masses(rng, count)
    pairs = links(rng, count, housing=False)
    driven, before, after = int(rng.integers(count)), *rng.uniform(-100.0, 100.0, 2)
    d = cw.Driveline("jump")
    speed[driven] = before
    nodes = shafts(d, inertia, speed)
    for i, (base, follower) in enumerate(pairs):
        d.add(cw.OneWayClutch(f"f{i}", base=nodes[base], follower=nodes[follower]))
    d.add(cw.PrescribedSpeed("m", shaft=nodes[driven], speed=cw.Step(offset=before, height=after - before, start=0.5)))
    run = simulate(d, 1.0, times=[0.25, 0.75])
    if text := stopped(run):
        return text
    # a prescribed shaft is a member at rest for one who turns with it
    free = [i for i in range(count) if i != driven]
    place = {shaft: number for number, shaft in enumerate(free)} | {driven: -1}
    own = [(place[base], place[follower]) for base, follower in pairs]
    first = before + nearest(inertia[free], speed[free] - before, own, [])
    second = after + nearest(inertia[free], first - after, own, [])
    text = wrong(speeds(run, count, 0)[free], first, 200.0)
    return (text and f"start: {text}") or wrong(speeds(run, count, 1)[free], second, 200.0)


def moving(seed: int) -> str:
    """Freewheels between shafts with springs, torques and clutches: none turns back at any row."""
    rng = np.random.default_rng([seed, 8])
    count = int(rng.integers(3, 6))
    inertia, speed = random_masses(rng, count)
    d = cw.Driveline("moving")
    nodes = shafts(d, inertia, speed)
    wheels = links(rng, count, housing=True)
    for i, (base, follower) in enumerate(wheels):
        ends = between(d, nodes, base, follower)
        d.add(cw.OneWayClutch(f"f{i}", **ends))
    for i, node in enumerate(nodes):
        amplitude = float(inertia[i] * rng.uniform(50.0, 500.0))
        sine = cw.Sine(amplitude=amplitude, frequency=log_uniform(rng, 0.5, 5.0), phase=float(rng.uniform(0, 6)))
        d.add(cw.Torque(f"t{i}", shaft=node, torque=sine))
    d.add(cw.SpringDamper("k", base=nodes[0], follower=nodes[-1], stiffness=log_uniform(rng, 10, 1e4), damping=0.1))
    run = simulate(d, 0.5)
    if text := stopped(run):
        return text
    names = [f"f{i}" for i in range(len(wheels))]
    fast = max(float(np.max(np.abs(run[f"s{i}.speed"]))) for i in range(count))
    strong = max(float(np.max(np.abs(run[f"{name}.torque"]))) for name in names)
    slips, torques = ({name: float(run[f"{name}.{what}"].min()) for name in names} for what in ("slip", "torque"))
    back = [f"{name} slip {x:.3g}" for name, x in slips.items() if x < -ROUND_OFF * fast]
    pulls = [f"{name} torque {x:.3g}" for name, x in torques.items() if x < -ROUND_OFF * strong]
    return ", ".join(back + pulls)


@pytest.mark.random
def test_chain_is_the_isotonic_regression_of_its_speeds() -> None:
    sweep(chain, amount())


@pytest.mark.random
def test_trees_and_loops_with_locked_clutches() -> None:
    sweep(together, amount())


@pytest.mark.random
def test_prescribed_speed_that_jumps() -> None:
    sweep(jump, amount())


@pytest.mark.random
def test_no_freewheel_turns_back_or_pulls() -> None:
    sweep(moving, amount())

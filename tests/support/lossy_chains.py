"""Random chains of lossy gears with brakes and bearings, and their law checked on the rows of a run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

import clutchwork as cw


@dataclass(frozen=True)
class Chain:
    """A driveline, its gears by name with their loss tables, and its plain contacts."""

    driveline: cw.Driveline
    gears: dict[str, list[tuple[float, ...]]]
    ratios: dict[str, float]
    contacts: tuple[str, ...]


def row(rng: np.random.Generator, speed: float = 0.0) -> tuple[float, ...]:
    """One row of a loss table: of efficiencies alone, or with friction of either direction."""
    ahead, back = rng.uniform(0.4, 1.0), rng.uniform(0.3, 1.0)
    friction = rng.uniform(0.0, 2.0, 2) * rng.choice([0.0, 1.0])
    if rng.random() < 0.5:
        friction[1] = friction[0]
    return (speed, ahead, back, *friction.tolist())


def table(rng: np.random.Generator) -> list[tuple[float, ...]]:
    """One row, or several over the speed."""
    if rng.random() < 0.7:
        return [row(rng)]
    # the last row is far away, so that no efficiency leaves its range
    return [row(rng, speed) for speed in (0.0, *np.cumsum(rng.uniform(1.0, 5.0, rng.integers(0, 2))).tolist(), 1e4)]


def chain(seed: int) -> Chain:
    """One to three gears in a row; torques that swing at both ends and in between, brakes and bearings beside."""
    rng = np.random.default_rng(seed)
    d = cw.Driveline(f"chain_{seed}")
    count = int(rng.integers(1, 4))
    speeds = rng.random() < 0.5
    shafts = [d.shaft("s0", inertia=float(10 ** rng.uniform(-1.5, 0.5)), speed=float(rng.normal()) if speeds else None)]
    gears, ratios = dict[str, list[tuple[float, ...]]](), dict[str, float]()
    for k in range(1, count + 1):
        shafts.append(d.shaft(f"s{k}", inertia=float(10 ** rng.uniform(-1.5, 0.5)) if rng.random() < 0.8 else 0.0))
        name, ratio = f"g{k}", float(rng.choice([-1, 1]) * 10 ** rng.uniform(-0.6, 0.6))
        gears[name], ratios[name] = table(rng), ratio
        d.add(cw.Mesh(name, input=shafts[k - 1], output=shafts[k], ratio=ratio, loss_table=gears[name]))
    for k, shaft in enumerate(shafts):
        if k in (0, count) or rng.random() < 0.3:
            swing = cw.Sine(
                amplitude=float(rng.uniform(1, 10)),
                frequency=float(rng.uniform(0.3, 2.0)),
                phase=float(rng.uniform(0, 6)),
                offset=float(rng.normal()),
            )
            d.add(cw.Torque(f"t{k}", shaft=shaft, torque=swing))
    contacts = []
    for k in range(int(rng.integers(0, 3))):
        shaft, name = shafts[int(rng.integers(len(shafts)))], f"b{k}"
        kinetic = float(rng.uniform(0.6, 1.0))
        law = cw.Coulomb(static=1.0, kinetic=kinetic)
        d.add(cw.BearingFriction(name, shaft=shaft, torque=float(rng.uniform(0.2, 4.0)), friction=law))
        contacts.append(name)
    return Chain(d, gears, ratios, tuple(contacts))


def losses(loss_table: list[tuple[float, ...]], speed: np.ndarray) -> np.ndarray:
    """Columns of a loss table at speeds, linear between its rows and beyond them."""
    rows = np.array(loss_table)
    if len(rows) == 1:
        return np.repeat(rows[:, 1:].T, len(speed), axis=1)
    place = np.clip(np.searchsorted(rows[:, 0], speed, side="right") - 1, 0, len(rows) - 2)
    share = (speed - rows[place, 0]) / (rows[place + 1, 0] - rows[place, 0])
    return ((1 - share) * rows[place, 1:].T) + share * rows[place + 1, 1:].T


def bounds(loss_table: list[tuple[float, ...]], speed: np.ndarray, into: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Loss torque forward and backward over the torque into the gear at its input, as in the Modelica library."""
    eta1, eta2, bf1, bf2 = losses(loss_table, np.abs(speed))
    forward = np.maximum((1 - eta1) * into + bf1, (1 - 1 / eta2) * into + bf2)
    backward = np.minimum((1 - 1 / eta2) * into - bf2, (1 - eta1) * into - bf1)
    return forward, backward


def misses(run: Any, made: Chain) -> dict[str, float]:
    """How far the rows of a run are from the law of each gear, over the largest torque."""
    found = {}
    for name, loss_table in made.gears.items():
        # what the gear puts on its input is minus what goes in
        into, loss, mode, slip = (run[f"{name}.{what}"] for what in ("torque_input", "torque", "mode", "slip"))
        into, loss = -into, -loss
        forward, backward = bounds(loss_table, slip, into)
        scale = 1.0 + np.max(np.abs(into)) + np.max(np.abs(loss))
        over = np.maximum(loss - forward, backward - loss)
        error = np.where(mode > 0, np.abs(loss - forward), np.where(mode < 0, np.abs(loss - backward), over))
        found[name] = float(np.max(error) / scale)
    return found

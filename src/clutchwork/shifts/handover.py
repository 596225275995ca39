"""Several elements that open while several close, together, from the statics of the box. docs/theory/shifts.md (13)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.gearbox.gear_set import HOUSING
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.gearbox.motion import speeds
from clutchwork.shifts.exchange import FRICTION, ratio_of, state_of

# torques that miss the wanted ones by less, as a share of these, meet them
MEETS = 1e-9
# how far beside the ratios of both gears that of the gear may be which carries on the way, as a share of the larger one
BESIDE = 0.6


@dataclass(frozen=True)
class Handover:
    """Elements that open and elements that close at the same time, while others stay closed.

    The slips y of the closing elements are the coordinates of the motion besides that of the output:
    docs/theory/shifts.md (13). With one of each it is an `Exchange`.

    Parameters:
        off: elements that open
        on: elements that close
        kept: elements that stay closed
        off_torques: torque of each that opens in the gear before, per torque 1 of the input
        on_torques: torque of each that closes in the gear after
        before: ratio of the gear before, 0 where there is none
        after: ratio of the gear after
        input: change of the speed of the input per y
        rates: change of the slip of each element per y
        offsets: slip of each element in the gear after, per speed 1 of the output
        inertia: of y, kg m2
        coupling: inertia between y and the output, kg m2
    """

    off: tuple[str, ...]
    on: tuple[str, ...]
    kept: tuple[str, ...]
    off_torques: Mapping[str, float]
    on_torques: Mapping[str, float]
    before: float
    after: float
    input: Array
    rates: Mapping[str, Array]
    offsets: Mapping[str, float]
    inertia: Array
    coupling: Array

    @property
    def elements(self) -> tuple[str, ...]:
        """Those that slip."""
        return (*self.on, *self.off)


def handover(
    box: Gearbox, off: Sequence[str], on: Sequence[str], kept: Sequence[str], inertias: Mapping[str, float]
) -> Handover | None:
    """What it takes; None where statics do not say it: teeth, freewheels, elements that share a torque, no gear.

    Parameters: off, elements that open, on, those that close, kept, those that stay closed; inertias, of members
    [kg m2].
    """
    after = (*kept, *on)
    if not ratio_of(box, after) or any(box.element(name).kind not in FRICTION for name in (*off, *on)):
        return None
    old, new = state_of(box, (*kept, *off)) if ratio_of(box, (*kept, *off)) else None, state_of(box, after)
    motion = _motion(box, on, kept)
    if motion is None or any(np.isnan([new.torques[name] for name in on])):
        return None
    off_torques = {name: old.torques.get(name, 0.0) if old else 0.0 for name in off}
    if any(np.isnan(list(off_torques.values()))):
        return None
    free, along = motion
    members = list(free)
    turning, sizes = np.array([free[m] for m in members]), np.array([inertias.get(m, 0.0) for m in members])
    together = np.array([along[m] for m in members])
    slip = {name: box.element(name) for name in (*on, *off)}
    none = np.zeros(len(on))
    return Handover(
        tuple(off),
        tuple(on),
        tuple(kept),
        off_torques,
        {name: new.torques[name] for name in on},
        old.ratio if old else 0.0,
        new.ratio,
        free[box.input],
        {name: free.get(one.follower, none) - free.get(one.base, none) for name, one in slip.items()},
        {name: along.get(one.follower, 0.0) - along.get(one.base, 0.0) for name, one in slip.items()},
        turning.T @ (sizes[:, None] * turning),
        turning.T @ (sizes * together),
    )


def _motion(box: Gearbox, on: Sequence[str], kept: Sequence[str]) -> tuple[dict[str, Array], dict[str, float]] | None:
    """Speed of each member per slip of those that close, and per speed of the output without any of these slips."""
    rows = speeds(box, kept)
    columns = sorted({column for row in rows.values() for column in row})
    if len(columns) != len(on) + 1:
        return None
    speed = {name: np.array([float(row.get(column, 0)) for column in columns]) for name, row in rows.items()}
    speed[HOUSING] = np.zeros(len(columns))
    slips = [speed[box.element(name).follower] - speed[box.element(name).base] for name in on]
    chosen = np.array([speed[box.output], *slips])
    if abs(np.linalg.det(chosen)) < MEETS:
        return None
    back = np.linalg.inv(chosen)
    found = {name: row @ back for name, row in speed.items() if name != HOUSING}
    return {name: row[1:] for name, row in found.items()}, {name: float(row[0]) for name, row in found.items()}


def is_straight(
    box: Gearbox, one: Handover, torque: float, begin: tuple[float, Mapping[str, float]] | None = None
) -> bool:
    """Whether elements that slip can carry the input's torque [N m] on the way, and about as one of both gears does.

    Those that carry make a gear with those that stay closed, and the output has its torque: docs/theory/shifts.md (15).
    Parameters: begin, speed of the input and slips per speed 1 of the output, by default those of the gear before.
    """
    if len(one.on) < 2:
        return True
    now, slips = begin or (one.before, _slips_before(one))
    ends = {name: slips[name] for name in one.on} | {name: one.offsets[name] for name in one.off}
    pulls = {name: -np.sign(slip) * one.rates[name] for name, slip in ends.items()}
    sign = 1.0 if torque >= 0.0 else -1.0
    found, missed = allocation(-sign * one.input, pulls, {name: abs(slip) for name, slip in ends.items()}, one.inertia)
    carrying = tuple(name for name, value in found.items() if value > MEETS)
    low, high = sorted((now, one.after))
    ratio = ratio_of(box, (*one.kept, *carrying))
    return missed <= MEETS and bool(ratio) and max(low - ratio, ratio - high) < BESIDE * high


def _slips_before(one: Handover) -> dict[str, float]:
    """Slips of those that close in the gear before, per speed 1 of the output: those that open have none."""
    rows = np.array([one.rates[name] for name in one.off])
    ahead = np.array([one.offsets[name] for name in one.off])
    return dict(zip(one.on, np.linalg.lstsq(rows, -ahead, rcond=None)[0].tolist(), strict=True))


def allocation(
    wanted: Array, pulls: Mapping[str, Array], costs: Mapping[str, float], weight: Array
) -> tuple[dict[str, float], float]:
    """Torques of elements that slip, none below zero, which together make a wanted one; and the share that they miss.

    Of those that do the ones with the smallest sum of cost times torque: docs/theory/shifts.md (15). Parameters:
    wanted, generalised torque; pulls, what unit torque of each element contributes to it; costs, of torque 1; weight,
    inertia by which what is missed counts.
    """
    names, size = list(pulls), float(wanted @ np.linalg.solve(weight, wanted))
    best, least = dict.fromkeys(names, 0.0), (1.0, 0.0)
    if size <= 0.0:
        return best, 0.0
    root = np.linalg.cholesky(np.linalg.inv(weight)).T
    for count in range(1, len(wanted) + 1):
        for some in combinations(names, count):
            columns = np.array([pulls[name] for name in some]).T
            torques = np.linalg.lstsq(root @ columns, root @ wanted, rcond=None)[0]
            if np.any(torques < 0.0):
                continue
            missed = root @ (columns @ torques - wanted)
            share = float(missed @ missed) / size
            cost = sum(costs[name] * torque for name, torque in zip(some, torques, strict=True))
            score = (share if share > MEETS else 0.0, float(cost))
            if score < least:
                best = dict.fromkeys(names, 0.0) | {n: float(u) for n, u in zip(some, torques, strict=True)}
                least = score
    return best, least[0]

"""All that is wrong with a model: its rows, how it ends, how it follows its tolerance, and its twins."""

from __future__ import annotations

import warnings
from itertools import pairwise
from typing import Any

import numpy as np

import clutchwork as cw
from clutchwork.assembly.wiring import HOUSING
from clutchwork.run.failure import JAMS
from support.any_model import agree, rows
from support.any_model.model import refused
from support.any_model.seen import Fault
from support.any_model.signals import sides
from support.any_model.values import Plain

# how a run may end early where there is a cause, by what must be in the model
CAUSES = {"jammed": "prescribed", "unbalanced": "prescribed", "out_of_table": "", "fault": "", "chatter": ""}
# a speed beside which slips of others count as zero that do not: 1e-10 of it is the tolerance of all
LOST = 1e9
# a speed that is none of a driveline
FAST = 1e4
# kinds of fault that may be no more than the tolerance of a run times how stiff it is, or what its interpolant misses:
# a slip is a difference of speeds that are far larger, and what a spring stores may be less than the tolerance of its
# twist makes
OF_TOLERANCE = ("integral", "balance massless", "creeps", "twist", "energy", "heat", "mode")
# kinds of the faults of this process that a tighter run did not have, until it is emptied
EXCUSED: list[str] = []
# of its largest ratio, one at a dead point: a crank or a cam that starts there and is held stops within a step of it
DEAD = 1e-3
# times its budget, with which a motion that is fast and regular ends: 0.1 s of an oscillation of 20 kHz that nothing
# damps, or of a screw without inertia that jams each time its drive falls
AMPLE = 10
# s before a ratio that loses a speed, within which steps may collapse
SOON = 1e-4
# what a driveline is refused with whose start contradicts a ratio
CONTRADICTED = "at the start, which contradicts"
# of the speed of a shaft that a row loses, what is left in it: the last row is a step short of that
VANISHED = 1e-2


def faults(made: Plain, seed: int, depth: int = 2, only: str = "") -> list[Fault]:
    """What is wrong with a model.

    Parameters: seed, of what is chosen at random; depth, 0 its rows, 1 its tolerances too, 2 its twins too; only, the
    kind of fault that is looked for, which may leave out others.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return _faults(made, seed, depth, only)


def _faults(made: Plain, seed: int, depth: int, only: str) -> list[Fault]:
    try:
        base = agree.run(made)
    except (cw.Interrupted, KeyboardInterrupt):
        raise
    except cw.ClutchworkError as error:
        return [Fault("raises", type(error).__name__, str(error)[:300])]
    except Exception as error:
        return [Fault("raises", type(error).__name__, str(error)[:300])]
    found = [*ending(made, base), *([] if loses(base) else _confirmed(made, rows.faults(base)))]
    if depth and base.status == "done" and not explodes(base):
        try:
            found += agree.faults(made, base, seed, depth, only)
        except cw.ClutchworkError as error:
            found.append(Fault("raises", f"{type(error).__name__} in a twin", str(error)[:300]))
    return found


def _confirmed(made: Plain, found: list[Fault]) -> list[Fault]:
    """Faults of rows, those that may be due to the tolerance only where tight ones leave them."""
    for options in (agree.TIGHT, agree.TIGHTER):
        doubtful = [fault for fault in found if fault.key.startswith(OF_TOLERANCE)]
        if not doubtful:
            break
        tight = {fault.key for fault in rows.faults(agree.run(made, **options))}
        EXCUSED.extend(fault.key for fault in doubtful if fault.key not in tight)
        found = [fault for fault in found if fault not in doubtful or fault.key in tight]
    return found


def ending(made: Plain, base: Any) -> list[Fault]:
    """A run that ends early without a cause."""
    if base.status == "done":
        return []
    if explodes(base):
        return []
    kinds = [one["type"] for one in made["element"]]
    laws = [one["friction"]["type"] for one in made["element"] if isinstance(one.get("friction"), dict)]
    if "naive_sign" in laws and base.status in ("chatter", "too_many_steps", "too_many_events", "zeno"):
        return []
    # an explicit method that was asked for spends its budget where the motion is stiff: the others must not
    if base.status == "too_many_steps" and base.options.method == "dopri5":
        return ending(made, agree.run(made, method="auto"))
    if base.status == "jammed" and not is_told(base):
        return [Fault("status", base.status, f"without its sentence: {base.message[:300]}")]
    if base.status in CAUSES and any(CAUSES[base.status] in kind for kind in kinds):
        return []
    # a ratio that leaves zero against what stands
    grounded = any("ratio" in one and "housing" in (one.get("input"), one.get("output")) for one in made["element"])
    if base.status == "jammed" and (grounded or JAMS["light"][0] in base.message or contradicts(made, base)):
        return []
    # a freewheel, or a gear that locks itself, behind a ratio that passes zero: whatever it held, what turns on the
    # other side would turn it backward
    turned = base.status == "unbalanced" or (base.status == "jammed" and JAMS["turned"][0] in base.message)
    if turned and (passes_zero(base) or (base.status == "jammed" and leaves_no_slip(base))):
        return []
    if base.status in ("jammed", "unbalanced", "too_many_steps") and at_dead_point(base):
        return []
    if base.status == "too_many_steps":
        longer = agree.run(made, max_steps=AMPLE * made["simulation"]["max_steps"])
        if longer.status != base.status:
            return ending(made, longer)
    return [Fault("status", base.status, base.message[:300])]


def is_told(base: Any) -> bool:
    """Whether a jam is told by one of its sentences, and that of a ratio that leaves a shaft without inertia to nothing
    where it is so: the transmission that is named joins such a shaft, and its row has lost the speed of that."""
    if JAMS["light"][0] not in base.message:
        return any(sentence in base.message for sentence, _ in JAMS.values())
    nodes = base.wiring.nodes
    ways = [branch for branch in base.wiring.elements if repr(branch.component.name) in base.message]
    light = {node for branch in ways for node in branch.direction if node != HOUSING and nodes[node].inertia == 0}
    if not light or not len(base.rows):
        return bool(light)
    if len(ways) != 2:
        return False
    speed = base.rows[-1, base.wiring.columns["speed"]]
    front, back = (sum(f * speed[node] for node, f in branch.direction.items() if node != HOUSING) for branch in ways)
    # what is left of the speed of such a shaft in the row, at the ratio of both rates; where that is a signal, also
    # behind a jump of it, and soon
    ratio = getattr(ways[0].component, "ratio", None)
    given = sides(ratio, base.time[-1]) + sides(ratio, base.time[-1] + SOON) if isinstance(ratio, cw.Signal) else ()
    for node in light:
        coming = [_left(ways, node, value, 1.0) for value in given]
        least = min(abs(share) for share in [_left(ways, node, front, back), *coming])
        if least <= VANISHED or (coming and min(coming) < 0.0 < max(coming)):
            return True
    return False


def _left(ways: list[Any], node: int, front: float, back: float) -> float:
    """Share of a speed in the row `back` times the first rate less `front` times the second, of the larger one."""
    first, second = (back * ways[0].direction.get(node, 0.0), front * ways[1].direction.get(node, 0.0))
    size = max(abs(back), abs(front)) * max(abs(way.direction.get(node, 0.0)) for way in ways)
    return (first - second) / size if size else 0.0


def contradicts(made: Plain, base: Any) -> bool:
    """Whether a run jams where it starts as given speeds do not fit the ratio of a transmission there: a driveline that
    has this ratio for good is refused."""
    if base.status != "jammed" or len(base.rows) or JAMS["ratio"][0] not in base.message:
        return False
    known = {branch.component.name: getattr(branch.component, "ratio", None) for branch in base.wiring.elements}
    ratios = {
        name: sides(ratio, base.options.t_start)[1] for name, ratio in known.items() if isinstance(ratio, cw.Signal)
    }
    named = [one["name"] for one in made["element"] if repr(one["name"]) in base.message]
    elements = [{**one, **({"ratio": ratios[one["name"]]} if one["name"] in ratios else {})} for one in made["element"]]
    lines = refused({**made, "element": elements}).splitlines()
    return any(CONTRADICTED in line and name in line for line in lines for name in named)


def passes_zero(base: Any) -> bool:
    """Whether a run ends where a ratio that is a signal passes zero; one without rows ends where it starts."""
    end = base.time[-1] if len(base.time) else base.options.t_start
    for branch in base.wiring.elements:
        ratio = getattr(branch.component, "ratio", None)
        if isinstance(ratio, cw.Signal):
            near = [value for t in (end - SOON, end, end + SOON) for value in sides(ratio, t)]
            if min(near) <= 0.0 <= max(near):
                return True
    return False


def leaves_no_slip(base: Any) -> bool:
    """Whether a freewheel that jams slips with the ratios of transmissions alone, and no longer: as between the shafts
    of a joint whose ratio passes one. Behind it the same motion would turn it backward, and no torque at it has a lever
    that stops that."""
    if not len(base.rows):
        return False
    speed, nodes = base.rows[-1, base.wiring.columns["speed"]], len(base.wiring.nodes)
    ways, contacts = base.wiring.spread(base.wiring.elements), base.wiring.spread(base.wiring.contacts)
    ties = [np.zeros(nodes)]
    for number, branch in enumerate(base.wiring.elements[:-1]):
        if branch.component is base.wiring.elements[number + 1].component and "ratio" in branch.component.hooks:
            one, other = ways[:, number], ways[:, number + 1]
            ties.append(one * (speed @ other) - other * (speed @ one))
    for number, branch in enumerate(base.wiring.contacts):
        if branch.component.one_way and repr(branch.component.name) in base.message:
            own, rows = contacts[:, number], np.array(ties).T
            left = own - rows @ np.linalg.lstsq(rows, own, rcond=1e-9)[0]
            return bool(np.linalg.norm(left) <= VANISHED * np.linalg.norm(own))
    return False


def at_dead_point(base: Any) -> bool:
    """Whether a run ends where a crank or a cam is at a dead point: it turns, and what it joins must start to move or
    turn around; nothing rigid that is held there can. A run without rows ends where it starts."""
    if not len(base.rows):
        parts = [branch.component for branch in base.wiring.elements]
        return any(_largest_ratio(part) is not None and part.start_ratio() == 0.0 for part in parts)
    speed = base.rows[-1, base.wiring.columns["speed"]]
    for branch, turning in pairwise(base.wiring.elements):
        largest = _largest_ratio(branch.component)
        if largest is None or turning.component is not branch.component:
            continue
        out, along = (
            sum(f * speed[node] for node, f in one.direction.items() if node != HOUSING) for one in (branch, turning)
        )
        if abs(out) <= DEAD * largest * abs(along):
            return True
    return False


def _largest_ratio(component: Any) -> float | None:
    """About the largest ratio of what has dead points [m]."""
    if component.kind == "crank_slider":
        return float(component.radius)
    return 0.5 * float(np.ptp([x for _, x in component.lift])) if component.kind == "cam_profile" else None


def explodes(base: Any) -> bool:
    """Whether speeds grow without bound, as those of a torque that rises with the square of the speed do."""
    return _grows(base, FAST, slice(-1, None))


def loses(base: Any) -> bool:
    """Whether a speed grows so that others are lost beside it, be it for an instant, as that of a shaft without inertia
    does where a ratio passes zero."""
    return _grows(base, LOST, slice(None))


def _grows(base: Any, most: float, rows_seen: slice) -> bool:
    speed = np.abs(base.rows[:, base.wiring.columns["speed"]])
    return len(speed) >= 2 and bool(speed[rows_seen].max(initial=0.0) > max(most, 100.0 * speed[0].max(initial=0.0)))

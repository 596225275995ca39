"""Plain data of models that move as another: scaled, mirrored, split, in another order, later, by another method.

A twin is made of the data of a model and random numbers; None where the model has no such twin.
"""

from __future__ import annotations

import copy
from collections.abc import Callable

from clutchwork.declare.schema import REGISTRY, Role, specs
from support.any_model.elements import declared
from support.any_model.model import driveline
from support.any_model.proportions import ODD, SIZES, TURNED, heavier, odd, times
from support.any_model.values import Plain, Rng

Twin = Callable[[Plain, Rng], Plain | None]
MOTION = ("speed", "angle", "position")


def other_method(made: Plain, rng: Rng) -> Plain | None:
    """Another method."""
    used = made["simulation"].get("method", "auto")
    method = str(rng.choice([name for name in ("rodas5p", "dopri5", "auto") if name != used]))
    return made | {"simulation": made["simulation"] | {"method": method, "max_steps": 1_000_000}}


def reordered(made: Plain, rng: Rng) -> Plain:
    """Elements in another order."""
    # speeds that nobody gave may be those of the first shafts
    order = {kind: [made[kind][k] for k in rng.permutation(len(made[kind]))] for kind in ("thermal", "ambient")}
    return made | order | {"element": [made["element"][k] for k in rng.permutation(len(made["element"]))]}


def nothing(made: Plain, rng: Rng) -> Plain:
    """A torque of zero with a knot."""
    nodes = [node["name"] for kind in ("shaft", "mass") for node in made[kind]]
    begin, end = made["simulation"].get("t_start", 0.0), made["simulation"]["t_end"]
    at = float(begin + (end - begin) * rng.uniform(0.05, 0.95))
    zero = {"type": "table", "points": [[at, 0.0], [at + 1e-4 * (end - begin), 0.0]]}
    one = {"name": "nothing", "type": "torque", "shaft": str(rng.choice(nodes)), "torque": zero}
    return made | {"element": [*made["element"], one]}


def split_inertia(made: Plain, rng: Rng) -> Plain | None:
    """A part of an inertia on a shaft of its own, joined rigidly; some elements are moved to it."""
    heavy = [node for node in made["shaft"] if node["inertia"] > 0.0]
    if not heavy:
        return None
    chosen = heavy[int(rng.integers(len(heavy)))]
    share, turned = float(rng.uniform(0.1, 0.9)), float(rng.choice([1.0, -1.0]))
    other = {"name": "half", "inertia": share * chosen["inertia"]} | _angle(chosen, turned)
    shafts = [
        node | {"inertia": node["inertia"] - other["inertia"]} if node is chosen else node for node in made["shaft"]
    ]
    joint: Plain = {"name": "joint", "type": "gear", "input": chosen["name"], "output": "half", "ratio": turned}
    if turned > 0.0 and rng.random() < 0.5:
        joint = {"name": "joint", "type": "torque_sensor", "base": chosen["name"], "follower": "half"}
    moved = [_moved(one, chosen["name"], "half", rng) if turned > 0.0 else one for one in made["element"]]
    return made | {"shaft": [*shafts, other], "element": [*moved, joint]}


def rigid_joint(made: Plain, rng: Rng) -> Plain | None:
    """A shaft without inertia between a shaft and what is on it."""
    chosen = made["shaft"][int(rng.integers(len(made["shaft"])))]
    joint = {"name": "joint", "type": "gear", "input": chosen["name"], "output": "beside", "ratio": 1.0}
    moved = [_moved(one, chosen["name"], "beside", rng) for one in made["element"]]
    return made | {
        "shaft": [*made["shaft"], {"name": "beside", "inertia": 0.0} | _angle(chosen, 1.0)],
        "element": [*moved, joint],
    }


def _angle(node: Plain, ratio: float) -> Plain:
    return {"angle": ratio * node["angle"]} if "angle" in node else {}


def _moved(one: Plain, old: str, new: str, rng: Rng) -> Plain:
    ports = [item.name for item, _ in specs(declared(one["type"]), "port")]
    return {key: new if key in ports and value == old and rng.random() < 0.6 else value for key, value in one.items()}


def split_element(made: Plain, rng: Rng) -> Plain | None:
    """An element as two in parallel whose sizes add up."""
    able = [k for k, one in enumerate(made["element"]) if one["type"] in SIZES and "heat" not in one]
    # what others refer to by its name stays
    if not able:
        return None
    place, share = able[int(rng.integers(len(able)))], float(rng.uniform(0.1, 0.9))
    whole = made["element"][place]
    parts = [_part(whole, part) for part in (share, 1.0 - share)]
    parts[1]["name"] += " twin"
    if any(value is None for part in parts for value in part.values()):
        return None
    return made | {"element": [*made["element"][:place], *parts, *made["element"][place + 1 :]]}


def _part(whole: Plain, share: float) -> Plain:
    return {key: times(value, share) if key in SIZES[whole["type"]] else value for key, value in whole.items()}


def scaled(made: Plain, rng: Rng) -> Plain | None:
    """All that has a mass in its unit times the power of a factor: inertias, torques, stiffnesses, heat."""
    # oil that fills a volume or a pump has a stiffness and a vacuum of its own, a dog clutch of a gearbox a stiffness
    if any(one["type"] in ("pump", "valve_body") for one in made["element"]):
        return None
    boxes = [element for element in driveline(made).elements if element.kind == "transmission"]
    if any(getattr(part, "kind", "") in ("dog_clutch", "synchroniser") for box in boxes for part in box.parts()):
        return None
    factor = float(rng.choice([3.7, 0.21, 11.0]))
    other = dict(made)
    other["shaft"] = [node | {"inertia": factor * node["inertia"]} for node in made["shaft"]]
    other["mass"] = [node | {"mass": factor * node["mass"]} for node in made["mass"]]
    other["thermal"] = [node | {"capacity": factor * node["capacity"]} for node in made["thermal"]]
    return other | {"element": [heavier(one, factor) for one in made["element"]]}


def mirrored(made: Plain, rng: Rng) -> Plain | None:
    """All motion the other way."""
    elements_ = made["element"]
    if any(one["type"] not in ODD or one.get("reversed") or isinstance(one.get("speed"), str) for one in elements_):
        return None
    other = dict(made)
    for kind in ("shaft", "mass"):
        other[kind] = [{key: odd(key, value, MOTION) for key, value in node.items()} for node in made[kind]]
    return other | {"element": [{key: odd(key, one[key], ODD[one["type"]]) for key in one} for one in elements_]}


def swapped(made: Plain, rng: Rng) -> Plain | None:
    """Base and follower of some elements swapped."""
    found = list(made["element"])
    for place, one in enumerate(found):
        # centrifugal friction is that of the base
        able = one["type"] in TURNED and {"base", "follower"} <= one.keys() and "friction_speed" not in one
        if able and rng.random() < 0.7:
            turned = {key: odd(key, value, TURNED[one["type"]]) for key, value in one.items()}
            found[place] = turned | {"base": one["follower"], "follower": one["base"]}
    return made | {"element": found} if found != made["element"] else None


def later(made: Plain, rng: Rng) -> Plain | None:
    """Everything later: signals and the start."""
    # what is filtered has a past, and a place is one at 0 s
    if any("cutoff" in one or one["type"] == "prescribed_position" for one in made["element"]):
        return None
    by = float(rng.choice([0.25, 1.5]))
    other = copy.deepcopy(made)
    if any("fault_time" in one for one in other["element"]):
        return None
    laws = [one["friction"] for one in other["element"] if isinstance(one.get("friction"), dict)]
    for one in (*other["element"], *laws):
        for key, value in one.items():
            if isinstance(value, dict) and value.get("type") in REGISTRY[Role.SIGNAL]:
                one[key] = _delayed(value, by)
    for one in other["ambient"]:
        if isinstance(one["temperature"], dict):
            one["temperature"] = _delayed(one["temperature"], by)
    settings = other["simulation"]
    settings["t_start"] = settings.get("t_start", 0.0) + by
    settings["t_end"] = settings["t_end"] + by
    return other


def _delayed(value: Plain, by: float) -> Plain:
    if value["type"] == "constant":
        return value
    if value["type"] == "table":
        return value | {"points": [[t + by, y] for t, y in value["points"]]}
    return value | {"start": value.get("start", 0.0) + by}


TWINS: dict[str, Twin] = {
    "method": other_method,
    "reordered": reordered,
    "nothing": nothing,
    "split inertia": split_inertia,
    "rigid joint": rigid_joint,
    "split element": split_element,
    "scaled": scaled,
    "mirrored": mirrored,
    "swapped": swapped,
    "later": later,
}

"""Models that must move as another does: scaled, mirrored, split, in another order, continued, at other tolerances.

A twin makes other plain data of a model; None where it has no such twin. Both run at a tight tolerance and must agree
as well as the model itself agrees with a still tighter run, for some motions are sensitive by nature.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator
from dataclasses import MISSING
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

import clutchwork as cw
from clutchwork.declare.layout import STATUSES
from clutchwork.declare.schema import REGISTRY, Role, Spec, specs
from clutchwork.declare.units import parse
from support.any_model import rows
from support.any_model.elements import declared
from support.any_model.model import driveline, refused
from support.any_model.rows import Fault
from support.any_model.values import Plain, Rng

Array = NDArray[np.float64]
Twin = Callable[[Plain, Rng], Plain | None]
TIGHT: Plain = {"rtol": 1e-9, "atol": 1e-11}
TIGHTER: Plain = {"rtol": 1e-10, "atol": 1e-12}
# instants at which twins are compared
GRID = 14
# how far twins may be apart, of the largest speed of a node; and beside what tolerances change
APART, NOISE = 3e-5, 100.0
# what a run at its own tolerance may miss
COARSE = 1e-3


def run(made: Plain, **options: Any) -> Any:
    """A run of plain data."""
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return driveline(made).simulate(**options)


def grid(made: Plain) -> list[float]:
    """Instants of the comparison."""
    begin, end = made["simulation"].get("t_start", 0.0), made["simulation"]["t_end"]
    return [*(float(t) for t in begin + (end - begin) * np.linspace(0.037, 0.97, GRID - 1)), end]


def apart(one: Any, other: Any, names: list[str] | None = None, sign: float = 1.0) -> tuple[float, str]:
    """How far the speeds of two runs are apart, of their size, and whose they are."""
    worst, whose = 0.0, ""
    known = [node.name for node in one.wiring.nodes if names is None or node.name in names]
    sizes = {name: float(np.abs(one[f"{name}.speed"]).max(initial=0.0)) for name in known}
    most = max(sizes.values(), default=0.0)
    for name in known:
        if f"{name}.speed" not in other:
            continue
        a, b = one[f"{name}.speed"], sign * other[f"{name}.speed"]
        error = float(np.abs(a - b).max(initial=0.0)) / (sizes[name] + 1e-3 * most + 1e-6)
        if error > worst:
            worst, whose = error, f"{name}.speed {a[-1]:.9g} and {b[-1]:.9g}"
    return worst, whose


def faults(made: Plain, base: Any, seed: int, depth: int, only: str = "") -> Iterator[Fault]:
    """What twins of a model say; `only`: the kind of fault that is looked for."""
    rng, times = np.random.default_rng([seed, 74]), grid(made)
    alone = next(
        (name for name in TWINS if only in (f"twin {name}", *(f"twin status {name} {s}" for s in STATUSES))), ""
    )
    coarse = base.at(times)
    tight, tighter = (run(made, times=times, **options) for options in (TIGHT, TIGHTER))
    if tight.status != "done" or tighter.status != "done":
        yield from (Fault("tight status", r.status, r.message[:200]) for r in (tight, tighter) if r.status != "done")
        return
    noise, _ = apart(tight, tighter)
    if noise > APART:
        yield Fault("sensitive", "", f"rtol 1e-9 and 1e-10 are {noise:.1e} apart: {apart(tight, tighter)[1]}")
    missed, whose = apart(coarse, tight)
    if missed > max(COARSE, 1e3 * base.options.rtol, NOISE * noise):
        yield Fault("tolerance", "", f"rtol {base.options.rtol:g} and 1e-9 are {missed:.1e} apart: {whose}")
    if alone:
        yield from _compared(
            alone, made, tight, noise, times, np.random.default_rng([seed, 75, list(TWINS).index(alone)])
        )
        return
    yield from _same(made, base, times, rng)
    if depth < 2:
        return
    full = run(made, **TIGHT)
    yield from (Fault("tight " + fault.kind, fault.of, fault.words) for fault in rows.faults(full))
    for number, name in enumerate(TWINS):
        # each by numbers of its own, so that one can be looked at alone
        yield from _compared(name, made, tight, noise, times, np.random.default_rng([seed, 75, number]))


def _compared(name: str, made: Plain, tight: Any, noise: float, times: list[float], rng: Rng) -> Iterator[Fault]:
    before = copy.deepcopy(made)
    other = TWINS[name](copy.deepcopy(made), rng)
    assert made == before
    if other is None or refused(other):
        return
    late = other["simulation"].get("t_start", 0.0) - made["simulation"].get("t_start", 0.0)
    found = run(
        other,
        times=[min(t + late, other["simulation"]["t_end"]) for t in times],
        **{**TIGHT, **({"method": other["simulation"]["method"]} if "method" in other["simulation"] else {})},
    )
    if found.status != "done":
        yield Fault("twin status", f"{name} {found.status}", found.message[:200])
        return
    sign = -1.0 if name == "mirrored" else 1.0
    error, whose = apart(tight, found, sign=sign)
    if error > max(APART, NOISE * noise):
        yield Fault("twin", name, f"{error:.1e} apart (noise {noise:.1e}): {whose}")


def _same(made: Plain, base: Any, times: list[float], rng: Rng) -> Iterator[Fault]:
    """What must be the same to the last bit: other output, no work, saved and loaded, continued."""
    again = base.at(times)
    asked = run(made, times=times)
    if not np.array_equal(again.rows, asked.rows):
        yield Fault("bits", "of a grid", f"{np.abs(again.rows - asked.rows).max():.3g}")
    less = run(made, times=times, work=False, angles=False)
    missed, whose = apart(again, less) if less.status == "done" else (np.inf, less.message)
    if missed > max(COARSE, 1e3 * base.options.rtol):
        yield Fault("bits", "without work and angles", f"{missed:.1e} apart: {whose}")
    with TemporaryDirectory() as folder:
        yield from _saved(made, base, Path(folder), times, again)
    yield from _continued(made, base, rng)


def _saved(made: Plain, base: Any, folder: Path, times: list[float], again: Any) -> Iterator[Fault]:
    try:
        driveline(made).save(folder / "m.toml")
        loaded = cw.Driveline.load(folder / "m.toml").simulate(times=times)
        if not np.array_equal(loaded.rows, again.rows):
            yield Fault("bits", "of a saved model", apart(again, loaded)[1])
    except cw.ClutchworkError as error:
        yield Fault("lost", "model", str(error)[:300])
    try:
        base.save(folder / "r.run")
        read = cw.load_run(folder / "r.run")
        if not np.array_equal(read.rows, base.rows) or not np.array_equal(read.time, base.time):
            yield Fault("bits", "of a saved run", "rows differ")
        if read.status != base.status or list(read.events) != list(base.events):
            yield Fault("bits", "of a saved run", "events or status differ")
    except (cw.ClutchworkError, ValueError) as error:
        yield Fault("lost", "run", str(error)[:300])


def _continued(made: Plain, base: Any, rng: Rng) -> Iterator[Fault]:
    """From a state at a step and from one in between."""
    steps = run(made, output="steps")
    between = float(rng.uniform(base.time[0], base.time[-1]))
    end = base.rows[-1]
    speed = base.wiring.columns["speed"]
    places = np.unique(steps.time)
    for at, exact in ((float(places[int(rng.integers(len(places)))]), True), (between, False)):
        if at >= base.t_end:
            continue
        try:
            state = steps.state(at=at)
            goes_on = run(made, start=state, output="steps", **({"t_start": at} if False else {}))
        except cw.ClutchworkError as error:
            yield Fault("state", "refused", f"at {at!r} s: {str(error)[:200]}")
            continue
        if goes_on.status != "done":
            yield Fault("state", goes_on.status, f"at {at!r} s: {goes_on.message[:200]}")
            continue
        if exact and not np.array_equal(goes_on.rows[-1], steps.rows[-1]):
            missed = np.abs(goes_on.rows[-1][speed] - end[speed]).max(initial=0.0)
            yield Fault(
                "bits",
                "after a state at a step",
                f"at {at!r} s: speeds differ by {missed:.3g}, rows in {int((goes_on.rows[-1] != steps.rows[-1]).sum())} numbers",
            )
        error, whose = apart(_last(steps), _last(goes_on))
        if error > max(COARSE, 1e4 * base.options.rtol):
            yield Fault("state", "other motion", f"at {at!r} s {error:.1e} apart: {whose}")


def _last(found: Any) -> Any:
    """Its last row alone."""
    return found.at([found.t_end])


# ---------------------------------------------------------------------------------------------------------- twins


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


# fields in proportion to the torque of an element that has no other size
SIZES = {
    "clutch": ("gain",), "brake": ("gain",), "spring": ("stiffness",), "spring_damper": ("stiffness", "damping"),
    "damper": ("damping",), "torque_limiter": ("torque",), "bearing_friction": ("torque",), "wet_drag": ("peak",),
    "torque": ("torque",), "linear_torque": ("nominal_torque",), "quadratic_torque": ("nominal_torque",),
    "resisting_torque": ("torque",), "eddy_current_brake": ("nominal_torque",), "band_brake": ("force",),
    "elastic_backlash": ("stiffness", "damping"), "elastic_gap": ("stiffness", "damping"), "jenkins_element": ("stiffness", "limit", "speed_friction"),
    "nonlinear_spring": ("torque", "damping"), "disk_brake": ("normal_force", "pressure"), "grade": ("weight",),
    "rolling_resistance": ("weight",), "sprag_clutch": ("holding", "drag"), "speed_torque": ("torque",), "belt_contact": ("tension", "mass_per_length"),
}  # fmt: skip


def split_element(made: Plain, rng: Rng) -> Plain | None:
    """An element as two in parallel whose sizes add up."""
    able = [k for k, one in enumerate(made["element"]) if one["type"] in SIZES and "heat" not in one]
    # what others refer to by its name stays
    if not able:
        return None
    place, share = able[int(rng.integers(len(able)))], float(rng.uniform(0.1, 0.9))
    whole = made["element"][place]
    cut = SIZES[whole["type"]]
    parts = [
        {key: _times(whole["type"], key, value, part) if key in cut else value for key, value in whole.items()}
        for part in (share, 1.0 - share)
    ]
    parts[1]["name"] += " twin"
    if any(value is None for part in parts for value in part.values()):
        return None
    return made | {"element": [*made["element"][:place], *parts, *made["element"][place + 1 :]]}


def _times(kind: str, key: str, value: Any, factor: float) -> Any:
    """A number, a signal or a curve times a factor; None where it is another's."""
    if isinstance(value, int | float):
        return factor * value
    if isinstance(value, list):
        return [[x, factor * y] for x, y in value]
    return scaled_signal(value, factor) if isinstance(value, dict) and "type" in value else None


def scaled_signal(value: Plain, factor: float) -> Plain:
    """A signal times a factor."""
    made = {key: factor * y if key in ("height", "offset", "amplitude", "value") else y for key, y in value.items()}
    if "points" in made:
        made["points"] = [[t, factor * y] for t, y in made["points"]]
    return made


def scaled(made: Plain, rng: Rng) -> Plain | None:
    """All that has a mass in its unit times the power of a factor: inertias, torques, stiffnesses, heat."""
    # a dog clutch of a gearbox has a stiffness of its own
    boxes = [element for element in driveline(made).elements if element.kind == "transmission"]
    if any(getattr(part, "kind", "") in ("dog_clutch", "synchroniser") for box in boxes for part in box.parts()):
        return None
    factor = float(rng.choice([3.7, 0.21, 11.0]))
    other = dict(made)
    other["shaft"] = [node | {"inertia": factor * node["inertia"]} for node in made["shaft"]]
    other["mass"] = [node | {"mass": factor * node["mass"]} for node in made["mass"]]
    other["thermal"] = [node | {"capacity": factor * node["capacity"]} for node in made["thermal"]]
    elements = [_scaled_element(one, made, factor) for one in made["element"]]
    return None if None in elements else other | {"element": elements}


# fields whose unit is not that of what they hold, by the columns that are torques
ROWS = {"loss_table": (3, 4)}


def _scaled_element(one: Plain, made: Plain, factor: float) -> Plain | None:
    cls = declared(one["type"])
    if one["type"] == "transmission" or "law" in cls.__name__.lower():
        # its shift elements have sizes of their own
        pass
    found = dict(one)
    units = _units(one, made)
    for item, spec in specs(cls):
        value = found.get(item.name, MISSING)
        if (
            value is MISSING
            and item.default not in (MISSING, None)
            and isinstance(item.default, int | float)
            and not isinstance(item.default, bool)
        ):
            value = item.default
        power = (
            parse(units.get(item.name, spec.unit) or "1").powers[0]
            if spec.unit not in ("*",)
            and spec.what not in ("port", "thermal", "law", "text", "data", "named", "elements")
            else 0
        )
        if item.name in ROWS and value is not MISSING:
            found[item.name] = [[x * factor if k in ROWS[item.name] else x for k, x in enumerate(row)] for row in value]
        elif power and value is not MISSING and not isinstance(value, str):
            found[item.name] = _sized(value, spec, factor**power)
    return found


def _units(one: Plain, made: Plain) -> dict[str, str]:
    """Units that follow from what else is given: a gain for a force has no mass in its unit, nor one for a pressure."""
    return {"gain": "1"}


def _sized(value: Any, spec: Spec, factor: float) -> Any:
    if isinstance(value, dict):
        return scaled_signal(value, factor) if "type" in value else value
    if spec.what == "curve":
        return [[x, y * factor] for x, y in value] if isinstance(value, list | tuple) else value * factor
    if isinstance(value, list | tuple):
        return [_sized(x, spec, factor) for x in value]
    return value * factor


# fields that change sign with all motion, of the kinds that have a mirror image; a curve changes on both axes
ODD: dict[str, tuple[str, ...]] = dict.fromkeys(("clutch", "brake", "damper", "torque_limiter", "bearing_friction", "wet_drag", "backlash", "disk_brake", "cone_clutch", "gear", "bevel_gear", "planetary", "double_planetary", "compound_planetary", "open_differential", "ravigneaux", "rolling_wheel", "torque_sensor", "motion_sensor", "variable_gear", "variable_ratio", "lossy_gear", "mesh", "worm_gear", "lossy_planetary", "rack_pinion", "rack_mesh", "leadscrew", "flexible_shaft", "centrifugal_clutch", "fluid_coupling", "rolling_contact", "eddy_current_brake", "retarder", "resisting_torque", "electric_motor", "pressure_actuator", "pressure_valve", "clutch_actuator", "diaphragm_spring", "ratio_actuator", "conduction", "oil_flow", "thermal_plate", "rolling_resistance", "universal_joint", "plate_contact", "jenkins_element", "torsional_damper", "double_shoe_brake_no"), ())  # fmt: skip
ODD |= {
    "torque": ("torque",),
    "spring": ("initial_twist",),
    "spring_damper": ("initial_twist",),
    "backlash": ("initial_twist",),
}
ODD |= {
    "elastic_backlash": ("initial_twist",),
    "nonlinear_spring": ("torque", "initial_twist"),
    "speed_torque": ("torque",),
}
ODD |= {
    "prescribed_speed": ("speed",),
    "prescribed_acceleration": ("acceleration",),
    "prescribed_position": ("position",),
}
ODD |= {"universal_joint": ("phase",)}
ODD |= {
    "displacement": ("initial_position",),
    "jenkins_element": ("initial_twist", "limit_x"),
    "torsional_damper": ("initial_twist", "torque"),
}
ODD |= {"electric_motor": ("command", "initial_request"), "dog_clutch": ("initial_angle",)}


def mirrored(made: Plain, rng: Rng) -> Plain | None:
    """All motion the other way."""
    if any(one["type"] not in ODD or any(one.get(key) for key in ("reversed", "differs")) for one in made["element"]):
        return None
    if any(isinstance(value, str) and key == "speed" for one in made["element"] for key, value in one.items()):
        return None
    other = dict(made)
    for kind in ("shaft", "mass"):
        other[kind] = [
            {key: -value if key in ("speed", "angle", "position") else value for key, value in node.items()}
            for node in made[kind]
        ]
    other["element"] = [
        {key: _odd(key, value, ODD[one["type"]]) for key, value in one.items()} for one in made["element"]
    ]
    return other


def _odd(key: str, value: Any, odd: tuple[str, ...]) -> Any:
    if f"{key}_x" in odd:
        return [[-x, y] for x, y in reversed(value)]
    if key not in odd or isinstance(value, str):
        return value
    if isinstance(value, list):
        return [[-x, -y] for x, y in reversed(value)]
    return scaled_signal(value, -1.0) if isinstance(value, dict) else -value


# fields that change sign where base and follower are swapped
SWAPPED = {
    "clutch": (),
    "damper": (),
    "torque_limiter": (),
    "wet_drag": (),
    "cone_clutch": (),
    "spring": ("initial_twist",),
}
SWAPPED |= {
    "spring_damper": ("initial_twist",),
    "backlash": ("initial_twist",),
    "elastic_backlash": ("initial_twist",),
    "torque_sensor": (),
}
SWAPPED |= {
    "nonlinear_spring": ("torque", "initial_twist"),
    "displacement": ("initial_position",),
    "jenkins_element": ("initial_twist", "limit_x"),
}
SWAPPED |= {"dog_clutch": ("initial_angle",), "torsional_damper": ("torque", "initial_twist"), "plate_contact": ()}


def swapped(made: Plain, rng: Rng) -> Plain | None:
    """Base and follower of some elements swapped."""
    found, some = [], False
    for one in made["element"]:
        # centrifugal friction is that of the base
        if (
            one["type"] in SWAPPED
            and {"base", "follower"} <= one.keys() - {"friction_speed"}
            and "friction_speed" not in one
            and rng.random() < 0.7
        ):
            some = True
            turned = {key: _odd(key, value, SWAPPED[one["type"]]) for key, value in one.items()}
            one = turned | {"base": one["follower"], "follower": one["base"]}
        found.append(one)
    return made | {"element": found} if some else None


def later(made: Plain, rng: Rng) -> Plain | None:
    """Everything later: signals and the start."""
    # what is filtered has a past
    if any("cutoff" in one for one in made["element"]):
        return None
    # what moves by an acceleration has moved from 0 s on
    if any(one["type"] in ("prescribed_acceleration", "prescribed_position") for one in made["element"]):
        return None
    by = float(rng.choice([0.25, 1.5]))
    other = copy.deepcopy(made)
    laws = [one["friction"] for one in other["element"] if isinstance(one.get("friction"), dict)]
    for one in (*other["element"], *laws):
        for key, value in one.items():
            if isinstance(value, dict) and value.get("type") in REGISTRY[Role.SIGNAL]:
                one[key] = _delayed(value, by)
            if key == "fault_time":
                return None
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

"""Random elements of any kind that is declared, as tables of a model file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import numpy as np

from clutchwork.declare.schema import REGISTRY, Role, specs
from clutchwork.gearbox.store import names as catalogue_names
from support.any_model import values
from support.any_model.values import Plain, Rng, log
from support.lossy_chains import table

# what is an element of a model
ROLES = (Role.TORQUE, Role.CONTACT, Role.GEAR, Role.MOTION, Role.FLOW, Role.PROCESS, Role.SENSOR, Role.COMPOSITE)
HOUSING = "housing"
# how much more often a role is drawn than an element of itself would be
OFTEN = {Role.TORQUE: 1.0, Role.CONTACT: 2.0, Role.GEAR: 1.0, Role.MOTION: 1.5, Role.FLOW: 0.3, Role.PROCESS: 0.4}
OFTEN |= {Role.SENSOR: 0.3, Role.COMPOSITE: 1.3}


@cache
def kinds() -> tuple[tuple[str, ...], np.ndarray]:
    """Every kind of element, and how probable it is."""
    found = [(kind, OFTEN[role]) for role in ROLES for kind in REGISTRY[role]]
    weights = np.array([weight for _, weight in found])
    return tuple(kind for kind, _ in found), weights / weights.sum()


@cache
def declared(kind: str) -> Any:
    """The class of a kind."""
    return next(REGISTRY[role][kind] for role in ROLES if kind in REGISTRY[role])


def kind(rng: Rng) -> str:
    """Any kind."""
    known, weights = kinds()
    return str(rng.choice(known, p=weights))


def ports(rng: Rng, cls: type, nodes: Mapping[str, list[str]]) -> Plain | None:
    """Nodes for its ports, each another one; None where there are too few. Now and then one is the housing."""
    found: Plain = {}
    known = specs(cls, "port")
    moving = [spec for _, spec in known if not spec.domain]
    own = "translation" if moving and rng.random() < 0.25 and nodes["translation"] else "rotation"
    left = {domain: list(rng.permutation(nodes[domain])) for domain in ("rotation", "translation")}
    grounded = rng.random() < 0.25
    for item, spec in known:
        if spec.optional and rng.random() < 0.85:
            continue
        domain = spec.domain or own
        # two ends and the housing is one of them
        if grounded and len(known) > 1 and (spec.domain == "" or spec.optional):
            found[item.name], grounded = HOUSING, False
        elif left[domain]:
            found[item.name] = str(left[domain].pop())
        else:
            return None
    return found


def thermal_ports(rng: Rng, cls: type, places: list[str]) -> Plain | None:
    """Thermal nodes for its thermal ports, where it needs some or now and then."""
    left, found = list(rng.permutation(places)), dict[str, Any]()
    for item, spec in specs(cls, "thermal"):
        if spec.optional and (rng.random() < 0.8 or not left):
            continue
        if not left:
            return None
        found[item.name] = str(left.pop())
    return found


def drawn(
    rng: Rng, name: str, of: str, nodes: Mapping[str, list[str]], t_end: float, sources: Mapping[str, list[Any]]
) -> Plain | None:
    """An element of a kind; None where there are too few nodes. Whether it makes sense is for the checks.

    Parameters: nodes, names by domain; sources, what may drive a signal, by its unit.
    """
    cls = declared(of)
    ends, warm = ports(rng, cls, nodes), thermal_ports(rng, cls, nodes["thermal"])
    if ends is None or warm is None:
        return None
    made: Plain = {"name": name, "type": of, **ends, **warm}
    recipe = RECIPES.get(of)
    made |= recipe(rng) if recipe else {}
    factors: dict[str, float] = {}
    for item, spec in values.chosen(rng, cls, made):
        given = sources.get(spec.unit, []) if spec.what in ("signal", "alternative") else []
        if given and rng.random() < 0.5:
            made[item.name] = given[int(rng.integers(len(given)))]
        else:
            made[item.name] = values.value(rng, item, spec, factors, t_end)
    made |= _pressed(rng, cls, made, t_end)
    return {key: given for key, given in made.items() if given is not None}


def _pressed(rng: Rng, cls: type, made: Plain, t_end: float) -> Plain:
    """A gain that fits the load of a contact."""
    if "gain" not in made or "normal_force" not in made:
        return {}
    return {"gain": log(rng, 0.05, 10.0)}


def _losses(rng: Rng) -> Plain:
    kind = int(rng.integers(3))
    if kind == 0:
        return {"loss_table": [list(row) for row in table(rng)]}
    found: Plain = {"efficiency": float(f"{rng.uniform(0.5, 1.0):.3g}")}
    if kind == 2:
        found |= {"backward_efficiency": float(f"{rng.uniform(0.2, 1.0):.3g}"), "bearing_torque": log(rng, 0.1, 5.0)}
    return found


def _mesh(rng: Rng) -> Plain:
    return {"loss_table": [list(row) for row in table(rng)]}


def _lossy_gear(rng: Rng) -> Plain:
    return _losses(rng) | {"ratio": float(rng.choice([-1.0, 1.0])) * log(rng, 0.3, 4.0)}


def _set(*teeth: str, **ratios: tuple[float, float]) -> Callable[[Rng], Plain]:
    """Ratios of a planetary set, or the teeth that give them."""

    def made(rng: Rng) -> Plain:
        return {name: log(rng, *bounds) for name, bounds in ratios.items()}

    return made


def _gear(rng: Rng) -> Plain:
    if rng.random() < 0.3:
        return {"teeth_input": int(rng.integers(12, 60)), "teeth_output": int(rng.integers(12, 60))}
    return {"ratio": float(rng.choice([-1.0, 1.0])) * log(rng, 0.3, 4.0)}


def _differential(rng: Rng) -> Plain:
    choice = int(rng.integers(4))
    made: Plain = {} if choice == 0 else {"bias": log(rng, 1.1, 5.0)} if choice < 3 else {"share": log(rng, 0.02, 0.4)}
    if choice and rng.random() < 0.3:
        made["coast_bias"] = log(rng, 1.0, 4.0)
    return made | ({"preload": log(rng, 0.5, 50.0)} if rng.random() < 0.4 else {})


def _engine(rng: Rng) -> Plain:
    top, speed = log(rng, 20.0, 400.0), log(rng, 10.0, 400.0)
    low = 0.0 if rng.random() < 0.7 else float(f"{0.2 * speed:.3g}")
    if rng.random() < 0.4:
        throttles = [0.0, 0.4, 1.0][:: int(rng.integers(1, 3))]
        speeds = [low, float(f"{0.4 * speed:.3g}"), speed]
        rows = [[float(f"{top * (-0.2 + t * rng.uniform(0.7, 1.2)):.3g}") for t in throttles] for _ in speeds]
        made: Plain = {"speeds": speeds, "throttles": throttles, "torques": rows}
    else:
        made = {"full_load": [[low, top], [speed, float(f"{top * rng.uniform(0.4, 1.3):.3g}")]]}
        if rng.random() < 0.6:
            made["motoring"] = [[0.0, -log(rng, 1.0, 0.2 * top)], [speed, -log(rng, 1.0, 0.3 * top)]]
    if rng.random() < 0.4:
        made |= {"idle_speed": log(rng, 0.05 * speed, 0.5 * speed), "idle_gain": log(rng, 1e-3, 0.1)}
        made |= {"idle_integral": log(rng, 1e-3, 0.5)} if rng.random() < 0.5 else {}
    else:
        made |= {"idle_speed": None, "idle_gain": None, "idle_integral": None, "initial_idle": None}
    if rng.random() < 0.3:
        made |= {"max_speed": speed, "limit_band": float(f"{0.1 * speed:.3g}"), "cut": bool(rng.random() < 0.5)}
    if rng.random() < 0.3:
        count = int(rng.integers(1, 3))
        made |= {"orders": [0.5, 2.0][:count], "amplitudes": [log(rng, 0.05, 2.0) for _ in range(count)]}
    made |= {"naturally_aspirated": None, "orders": made.get("orders"), "amplitudes": made.get("amplitudes")}
    return made | {
        name: made.get(name) for name in ("phases", "speeds", "throttles", "torques", "full_load", "motoring")
    }


def _motor(rng: Rng) -> Plain:
    top, speed = log(rng, 10.0, 300.0), log(rng, 20.0, 500.0)
    made: Plain = {"max_torque": [[0.0, top], [speed, float(f"{0.4 * top:.3g}")]] if rng.random() < 0.7 else top}
    if rng.random() < 0.3:
        made["losses"] = [[10.0, 20.0], [30.0, 60.0]]
        made |= {"speeds": [0.0, speed], "torques": [0.0, top]}
    nothing = (
        "efficiencies",
        "losses",
        "speeds",
        "torques",
        "thermal_mass",
        "derating",
        "initial_temperature",
        "cooling",
    )
    return dict.fromkeys(nothing) | made


def _ring(rng: Rng) -> Plain:
    """A radius, or both diameters."""
    if rng.random() < 0.5:
        return {"radius": log(rng, 0.03, 0.2), "outer_diameter": None, "inner_diameter": None}
    outer = log(rng, 0.08, 0.4)
    return {"radius": None, "outer_diameter": outer, "inner_diameter": float(f"{outer * rng.uniform(0.0, 0.9):.3g}")}


def _disk(rng: Rng) -> Plain:
    return _ring(rng) | {"thermal_mass": None, "temperature_limit": None}


def _stop(rng: Rng) -> Plain:
    low, high = (log(rng, 0.02, 1.5) for _ in "ab")
    made: Plain = {"lower": -low, "upper": high}
    if rng.random() < 0.3:
        made[str(rng.choice(list(made)))] = None
    return made | {"initial_position": None}


def _flexible(rng: Rng) -> Plain:
    made: Plain = {"stiffness": log(rng, 100.0, 3e4), "inertia": log(rng, 1e-3, 0.2)}
    made |= {"length": None, "outer_diameter": None, "inner_diameter": None}
    how = (
        {"modes": int(rng.integers(1, 4)), "segments": None}
        if rng.random() < 0.4
        else {"segments": int(rng.integers(1, 5)), "modes": None}
    )
    return made | how | ({"damping_time": log(rng, 1e-5, 1e-3)} if rng.random() < 0.7 else {})


def _fluid(rng: Rng) -> Plain:
    k = log(rng, 1e-4, 0.02)
    first = float(rng.choice([-0.5, 0.0]))
    return {"speed_ratio": [first, 0.3, 0.8, 1.0], "capacity": [k, 0.9 * k, 0.5 * k, 0.0], "performance_number": None}


def _converter(rng: Rng) -> Plain:
    k = log(rng, 1e-4, 0.02)
    made: Plain = {"speed_ratio": [0.0, 0.4, 0.8, 0.9, 1.0], "torque_ratio": [2.2, 1.6, 1.08, 1.0, 1.0]}
    made |= {"capacity": [k, 0.93 * k, 0.7 * k, 0.5 * k, 0.0], "k_factor": None}
    return made | {"coast_capacity": [0.5 * k, 0.4 * k, 0.3 * k, 0.2 * k, 0.0] if rng.random() < 0.2 else None}


def _dog(rng: Rng) -> Plain:
    teeth = int(rng.integers(3, 40))
    return {
        "teeth": teeth,
        "gap": float(f"{6.28 / teeth * rng.uniform(0.05, 0.9):.3g}"),
        "stiffness": log(rng, 100.0, 1e5),
    }


def _synchroniser(rng: Rng) -> Plain:
    teeth = int(rng.integers(6, 50))
    made = {
        "teeth": teeth,
        "gap": float(f"{6.28 / teeth * rng.uniform(0.05, 0.9):.3g}"),
        "stiffness": log(rng, 100.0, 1e5),
    }
    return made | {"radius": log(rng, 0.03, 0.1), "half_angle": log(rng, 0.1, 1.0), "force": log(rng, 10.0, 2000.0)}


def _gearbox(rng: Rng) -> Plain:
    """A gearbox of the catalogue, in a gear, in neutral or between two."""
    from clutchwork.gearbox.read import read

    name = str(rng.choice(_catalogue()))
    box = read(name).box
    made: Plain = {"gearbox": name, "torque": log(rng, 50.0, 800.0), "inertia": log(rng, 1e-3, 0.1)}
    if box is not None and rng.random() < 0.8:
        made["gear"] = str(rng.choice(list(box.gears)))
    return made | dict.fromkeys(("inertias", "shift", "drag", "speeds", "efficiencies"))


@cache
def _catalogue() -> tuple[str, ...]:
    return tuple(sorted(catalogue_names()))


def _wheel(rng: Rng) -> Plain:
    return {"radius": log(rng, 0.05, 0.5)}


def _rack(rng: Rng) -> Plain:
    return _losses(rng) | {"radius": log(rng, 0.01, 0.2), "teeth": None, "module": None}


def _shoes(rng: Rng) -> Plain:
    return {"radius": 0.15, "hinge": log(rng, 0.08, 0.14), "arm": log(rng, 0.1, 0.3)}


def _profile(rng: Rng) -> Plain:
    """The example of a cam, higher or lower: its curvature follows."""
    factor, known = log(rng, 0.3, 3.0), {item.name: spec.example for item, spec in specs(declared("cam_profile"))}
    lift = [[x, factor * y] for x, y in known["lift"]]
    return {"lift": lift, "curvature": [factor * y for y in known["curvature"]]}


def _screw(rng: Rng) -> Plain:
    return {"lead": log(rng, 1e-3, 0.1), "radius": log(rng, 0.005, 0.1), "friction_coefficient": log(rng, 0.02, 0.3)}


def _jenkins(rng: Rng) -> Plain:
    """A constant limit, or one over the twist."""
    top = log(rng, 0.2, 50.0)
    flat = rng.random() < 0.5
    # a speed that jumps makes energy out of nothing where its friction slides
    return {
        "speed": log(rng, 0.1, 30.0) if rng.random() < 0.3 else None,
        "limit": [[0.0, top]] if flat else [[-0.1, 1.5 * top], [-0.05, top], [0.05, top], [0.1, 1.5 * top]],
        "stiffness": log(rng, 50.0, 5000.0),
    }


# fields whose values depend on each other; None: left out
def _valve_body(rng: Rng) -> Plain:
    """One of the sizes of a passenger car, for one or two elements."""
    names = ["A", "B"][: int(rng.integers(1, 3))]
    return {
        "piston_areas": {name: log(rng, 1e-3, 1e-2) for name in names},
        "pressures": {name: log(rng, 1e4, 1e6) for name in names if rng.random() < 0.5},
        "displacement": log(rng, 5e-7, 5e-6),
        "valve_area": log(rng, 3e-6, 3e-5),
        "orifice_area": log(rng, 1e-6, 1e-5),
        "kiss_stroke": log(rng, 1e-3, 5e-3),
        "density": 850.0,
        "viscosity": log(rng, 3e-6, 1e-4),
    }


RECIPES: dict[str, Callable[[Rng], Plain]] = {
    "valve_body": _valve_body,
    "gear": _gear,
    "bevel_gear": _gear,
    "mesh": _mesh,
    "rack_mesh": lambda rng: _mesh(rng) | {"radius": log(rng, 0.01, 0.2)},
    "lossy_gear": lambda rng: _lossy_gear(rng) | {"teeth_input": None, "teeth_output": None},
    "chain": lambda rng: {
        "teeth_input": int(rng.integers(12, 40)),
        "teeth_output": int(rng.integers(12, 60)),
        **_losses(rng),
    },
    "rack_pinion": _rack,
    "planetary": _set(ratio=(1.3, 4.0)),
    "double_planetary": _set(ratio=(1.3, 4.0)),
    "compound_planetary": _set(ratio=(1.3, 4.0)),
    "lossy_planetary": lambda rng: {"ratio": log(rng, 1.3, 4.0), **_losses(rng), "teeth_sun": None, "teeth_ring": None},
    "ravigneaux": lambda rng: {"ratio_large": log(rng, 1.3, 3.0), "ratio_small": log(rng, 1.3, 4.0)},
    "differential": _differential,
    "engine": _engine,
    "electric_motor": _motor,
    "disk_clutch": _disk,
    "cone_clutch": _ring,
    "end_stop": _stop,
    "flexible_shaft": _flexible,
    "fluid_coupling": _fluid,
    "torque_converter": _converter,
    "dog_clutch": _dog,
    "synchroniser": _synchroniser,
    "transmission": _gearbox,
    "rolling_wheel": _wheel,
    "rolling_contact": _wheel,
    "tyre": _wheel,
    "double_shoe_brake": _shoes,
    "leadscrew": _screw,
    "cam_profile": _profile,
    "jenkins_element": _jenkins,
    # a factor below zero would make it drive
    "wet_drag": lambda rng: {"scale": log(rng, 0.1, 3.0) if rng.random() < 0.5 else None},
    # one that drives with the square of the speed has no end
    "quadratic_torque": lambda rng: {"nominal_torque": -log(rng, 0.3, 300.0), "nominal_speed": log(rng, 1.0, 200.0)},
    "retarder": lambda rng: {"max_torque": log(rng, 1.0, 300.0), "max_power": log(rng, 50.0, 3e4)},
    "road": lambda rng: {"elevation": [[0.0, 0.0], [log(rng, 0.5, 10.0), log(rng, 0.01, 0.5)], [20.0, 0.3]]},
}

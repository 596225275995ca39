"""Plain data of models in proportion: signals, curves and elements times a factor, or with the other sign."""

from __future__ import annotations

from dataclasses import MISSING
from typing import Any

from clutchwork.declare.schema import Spec, specs
from clutchwork.declare.units import parse
from support.any_model.elements import declared
from support.any_model.values import Plain

# fields that are proportional to the torque of an element that has no other size
SIZES: dict[str, tuple[str, ...]] = {
    "clutch": ("gain",),
    "brake": ("gain",),
    "spring": ("stiffness",),
    "spring_damper": ("stiffness", "damping"),
    "damper": ("damping",),
    "torque_limiter": ("torque",),
    "bearing_friction": ("torque",),
    "wet_drag": ("peak",),
    "torque": ("torque",),
    "linear_torque": ("nominal_torque",),
    "quadratic_torque": ("nominal_torque",),
    "resisting_torque": ("torque",),
    "eddy_current_brake": ("nominal_torque",),
    "band_brake": ("force",),
    "elastic_backlash": ("stiffness", "damping"),
    "elastic_gap": ("stiffness", "damping"),
    "jenkins_element": ("stiffness", "limit", "speed_friction"),
    "nonlinear_spring": ("torque", "damping"),
    "disk_brake": ("normal_force", "pressure"),
    "grade": ("weight",),
    "rolling_resistance": ("weight",),
    "sprag_clutch": ("holding", "drag"),
    "speed_torque": ("torque",),
    "belt_contact": ("tension", "mass_per_length"),
}
# fields that change sign with all motion, of the kinds that have a mirror image; those named `_x` along x alone
ODD: dict[str, tuple[str, ...]] = dict.fromkeys(
    [
        "clutch",
        "brake",
        "damper",
        "torque_limiter",
        "bearing_friction",
        "wet_drag",
        "disk_brake",
        "cone_clutch",
        "gear",
        "bevel_gear",
        "planetary",
        "double_planetary",
        "compound_planetary",
        "open_differential",
        "ravigneaux",
        "rolling_wheel",
        "torque_sensor",
        "motion_sensor",
        "variable_gear",
        "variable_ratio",
        "lossy_gear",
        "mesh",
        "worm_gear",
        "lossy_planetary",
        "rack_pinion",
        "rack_mesh",
        "leadscrew",
        "flexible_shaft",
        "centrifugal_clutch",
        "fluid_coupling",
        "rolling_contact",
        "eddy_current_brake",
        "retarder",
        "resisting_torque",
        "pressure_actuator",
        "pressure_valve",
        "clutch_actuator",
        "diaphragm_spring",
        "ratio_actuator",
        "conduction",
        "oil_flow",
        "thermal_plate",
        "rolling_resistance",
        "plate_contact",
    ],
    (),
)
ODD |= {"torque": ("torque",), "spring": ("initial_twist",), "spring_damper": ("initial_twist",)}
ODD |= {"backlash": ("initial_twist",), "elastic_backlash": ("initial_twist",), "speed_torque": ("torque",)}
ODD |= {"nonlinear_spring": ("torque", "initial_twist"), "torsional_damper": ("torque", "initial_twist")}
ODD |= {"prescribed_speed": ("speed",), "prescribed_acceleration": ("acceleration",)}
ODD |= {"prescribed_position": ("position",), "displacement": ("initial_position",), "universal_joint": ("phase",)}
ODD |= {"jenkins_element": ("initial_twist", "limit_x"), "dog_clutch": ("initial_angle",)}
ODD |= {"electric_motor": ("command", "initial_request")}
# fields that change sign where base and follower are swapped
TURNED: dict[str, tuple[str, ...]] = {
    kind: ODD[kind]
    for kind in (
        "clutch",
        "damper",
        "torque_limiter",
        "wet_drag",
        "cone_clutch",
        "spring",
        "spring_damper",
        "backlash",
        "elastic_backlash",
        "torque_sensor",
        "nonlinear_spring",
        "displacement",
        "jenkins_element",
        "dog_clutch",
        "torsional_damper",
        "plate_contact",
    )
}
# fields without a unit that hold torques, by their columns
COLUMNS = {"loss_table": (3, 4)}


def signal(value: Plain, factor: float) -> Plain:
    """A signal times a factor."""
    made = {key: factor * y if key in ("height", "offset", "amplitude", "value") else y for key, y in value.items()}
    return made | ({"points": [[t, factor * y] for t, y in made["points"]]} if "points" in made else {})


def times(value: Any, factor: float) -> Any:
    """A number, a signal or a curve times a factor; None where it is another's."""
    if isinstance(value, int | float):
        return factor * value
    if isinstance(value, list):
        return [[x, factor * y] for x, y in value]
    return signal(value, factor) if isinstance(value, dict) and "type" in value else None


def odd(key: str, value: Any, fields: tuple[str, ...]) -> Any:
    """A field with the other sign where it is one of those that change it."""
    if f"{key}_x" in fields:
        return [[-x, y] for x, y in reversed(value)]
    if key not in fields or isinstance(value, str):
        return value
    if isinstance(value, list):
        return [[-x, -y] for x, y in reversed(value)]
    return signal(value, -1.0) if isinstance(value, dict) else -value


def heavier(one: Plain, factor: float) -> Plain:
    """An element, its defaults too, with every quantity times the factor to the power of the mass in its unit."""
    found = dict(one)
    for item, spec in specs(declared(one["type"])):
        default = item.default if type(item.default) in (int, float) else MISSING
        value = found.get(item.name, default)
        # a gain per load of one unit gives another torque where the load has grown
        power = 0 if item.name == "gain" else _power(spec)
        if value is MISSING or isinstance(value, str):
            continue
        if item.name in COLUMNS:
            places = COLUMNS[item.name]
            found[item.name] = [[x * factor if k in places else x for k, x in enumerate(row)] for row in value]
        elif power:
            found[item.name] = _sized(value, spec, factor**power)
    return found


def _power(spec: Spec) -> int:
    """Power of the kilogram in the unit of a field."""
    numbers = ("param", "option", "signal", "alternative", "curve", "numbers")
    return int(parse(spec.unit or "1").powers[0]) if spec.what in numbers and spec.unit != "*" else 0


def _sized(value: Any, spec: Spec, factor: float) -> Any:
    if isinstance(value, dict):
        return signal(value, factor) if "type" in value else value
    if isinstance(value, list | tuple):
        return [[x[0], x[1] * factor] if spec.what == "curve" else _sized(x, spec, factor) for x in value]
    return value * factor

"""Random models of everything, from a seed, as the plain data of a model file; all of them pass the package's checks.

Two to six shafts and up to two masses, some without inertia or at a given speed, thermal nodes beside; two to nine
elements of any kind between them, a drive, often a prescribed motion of any signal. What is refused is drawn again.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

import clutchwork as cw
from clutchwork.declare.schema import REGISTRY, Role
from support.any_model import elements, values
from support.any_model.values import Plain, Rng, log

# draws of one element until it is left out
TRIES = 12
# units of signals that take the speed of a node, or the slip or heat of an element
SPEEDS = {"rotation": "rad/s", "translation": "m/s"}

# models on which the checks failed with an error that is none of the package
CRASHES: list[tuple[str, Plain]] = []


def model(seed: int) -> Plain:
    """The model of a seed, with its end time and options in `simulation`."""
    rng = np.random.default_rng([seed, 73])
    t_end = log(rng, 0.03, 0.6)
    made = _bodies(rng, seed)
    nodes = {"rotation": [n["name"] for n in made["shaft"]], "translation": [n["name"] for n in made["mass"]]}
    nodes["thermal"] = [n["name"] for kind in ("thermal", "ambient") for n in made[kind]]
    wanted = int(rng.integers(2, 10))
    made["element"].append(_drive(rng, nodes, t_end))
    for number in range(wanted):
        _add(rng, made, f"e{number}", elements.kind(rng), nodes, t_end)
    if rng.random() < 0.3:
        _add(rng, made, "motion", str(rng.choice(list(REGISTRY[Role.MOTION]))), nodes, t_end)
    _light(rng, made)
    made["simulation"] = _settings(rng, t_end)
    return made


def small(seed: int) -> Plain:
    """One to three elements between few nodes, over a longer time: of many models what is wrong with one element."""
    rng = np.random.default_rng([seed, 991])
    t_end = log(rng, 0.1, 3.0)
    made: Plain = {"name": f"small {seed}", "shaft": [], "mass": [], "thermal": [], "ambient": [], "element": []}
    for number in range(int(rng.integers(1, 4))):
        start = _moving(rng, 50.0) if rng.random() < 0.6 else {"speed": 0.0}
        made["shaft"].append({"name": f"s{number}", "inertia": log(rng, 0.01, 1.0)} | start)
    for number in range(int(rng.choice([0, 0, 1]))):
        start = _moving(rng, 5.0) if rng.random() < 0.6 else {"speed": 0.0}
        made["mass"].append({"name": f"m{number}", "mass": log(rng, 1.0, 100.0)} | start)
    nodes = {"rotation": [n["name"] for n in made["shaft"]], "translation": [n["name"] for n in made["mass"]]}
    nodes["thermal"] = []
    if rng.random() < 0.8:
        made["element"].append(_drive(rng, nodes, t_end))
    for number in range(int(rng.integers(1, 4))):
        _add(rng, made, f"e{number}", elements.kind(rng), nodes, t_end)
    if rng.random() < 0.35:
        _add(rng, made, "motion", str(rng.choice(list(REGISTRY[Role.MOTION]))), nodes, t_end)
    if rng.random() < 0.3:
        _light(rng, made)
    made["simulation"] = _settings(rng, t_end)
    return made


def _drive(rng: Rng, nodes: dict[str, list[str]], t_end: float) -> Plain:
    """A torque of any signal at one of the nodes."""
    shaft = str(rng.choice([*nodes["rotation"], *nodes["translation"]]))
    return {
        "name": "drive",
        "type": "torque",
        "shaft": shaft,
        "torque": values.signal(rng, _torque_spec(), "torque", t_end),
    }


def driveline(made: Plain) -> cw.Driveline:
    """The driveline of plain data."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return cw.Driveline.from_dict(made)


def refused(made: Plain) -> str:
    """What the checks of the package refuse; "" where they take the model."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            # checks of what depends on the whole come with the assembly
            cw.Driveline.from_dict(made).assemble()
    except cw.ModelError as error:
        return str(error)
    # an error of another sort is a finding: the checks are to say what is wrong
    except Exception as error:
        CRASHES.append((f"{type(error).__name__}: {error}", made))
        return "crash"
    return ""


def _torque_spec() -> Any:
    return next(spec for item, spec in elements.specs(elements.declared("torque")) if item.name == "torque")


def _bodies(rng: Rng, seed: int) -> Plain:
    made: Plain = {"name": f"any {seed}", "shaft": [], "mass": [], "thermal": [], "ambient": [], "element": []}
    for number in range(int(rng.integers(2, 7))):
        one: Plain = {"name": f"s{number}", "inertia": log(rng, 0.003, 2.0)}
        made["shaft"].append(one | _moving(rng, 200.0) | ({"angle": log(rng, 0.01, 2.0)} if rng.random() < 0.1 else {}))
    for number in range(int(rng.choice([0, 0, 1, 2]))):
        made["mass"].append({"name": f"m{number}", "mass": log(rng, 0.3, 500.0)} | _moving(rng, 20.0))
    if rng.random() < 0.3:
        made["thermal"].append(
            {"name": "plates", "capacity": log(rng, 10.0, 3000.0), "temperature": log(rng, 270.0, 420.0)}
        )
        made["ambient"].append({"name": "air", "temperature": log(rng, 270.0, 320.0)})
    return made


def _moving(rng: Rng, most: float) -> Plain:
    """Its speed at the start: none given, zero, or of either sign."""
    chance = rng.random()
    if chance < 0.4:
        return {}
    return {"speed": 0.0 if chance < 0.55 else float(rng.choice([-1.0, 1.0])) * log(rng, 0.005 * most, most)}


def _add(rng: Rng, made: Plain, name: str, kind: str, nodes: dict[str, list[str]], t_end: float) -> None:
    """An element that the checks take, if one is found."""
    for _ in range(TRIES):
        one = elements.drawn(rng, name, kind, nodes, t_end, dict(_sources(made)))
        if one is None:
            return
        trial = {**made, "element": [*made["element"], one]}
        text = refused(trial)
        if "speed" in text and (freed := _without_speeds(rng, trial, one)):
            trial, text = freed, refused(freed)
        if not text:
            made.update(trial)
            return


def _without_speeds(rng: Rng, trial: Plain, one: Plain) -> Plain | None:
    """The same where a node at the element starts as the others say."""
    ends = (
        set(one.values())
        if all(isinstance(v, str | int | float) for v in one.values())
        else {v for v in one.values() if isinstance(v, str)}
    )
    kinds = {
        kind: [n | ({} if n["name"] not in ends else {"speed": None}) for n in trial[kind]]
        for kind in ("shaft", "mass")
    }
    free = {kind: [{k: v for k, v in n.items() if v is not None} for n in some] for kind, some in kinds.items()}
    return trial | free


def _sources(made: Plain) -> Iterator[tuple[str, list[Any]]]:
    """What may drive a signal, by unit: processes by their first state, thermal nodes."""
    found: dict[str, list[Any]] = {}
    for one in made["element"]:
        cls = elements.declared(one["type"])
        if cls.role is Role.PROCESS:
            found.setdefault(cls.states[0].unit, []).append(one["name"])
    found["K"] = [one["name"] for kind in ("thermal", "ambient") for one in made[kind]]
    yield from found.items()


def _light(rng: Rng, made: Plain) -> None:
    """Takes the inertia of one or two shafts where what joins them determines their motion."""
    for one in rng.permutation(made["shaft"]) if rng.random() < 0.4 else ():
        trial = {**made, "shaft": [{**n, "inertia": 0.0} if n["name"] == one["name"] else n for n in made["shaft"]]}
        text = refused(trial)
        if text and "speed" in text:
            trial["shaft"] = [
                {k: v for k, v in n.items() if k != "speed" or n["name"] != one["name"]} for n in trial["shaft"]
            ]
            text = refused(trial)
        if not text:
            made.update(trial)
            if rng.random() < 0.6:
                return


def _settings(rng: Rng, t_end: float) -> Plain:
    made: Plain = {"t_end": t_end, "max_steps": 100_000}
    if rng.random() < 0.25:
        made["t_start"] = float(f"{t_end * rng.uniform(0.05, 0.6):.3g}")
    if rng.random() < 0.25:
        made["rtol"] = log(rng, 1e-9, 1e-4)
    if rng.random() < 0.2:
        made["method"] = str(rng.choice(["rodas5p", "dopri5"]))
    return made

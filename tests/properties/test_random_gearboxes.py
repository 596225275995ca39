"""Random gearboxes of 1 to 5 sets: each assembles with the speeds that are free, or is refused and told why."""

from __future__ import annotations

import re

import numpy as np
import pytest

import clutchwork as cw
from support.amount import amount
from support.random_gearboxes import HOUSING, PORTS, freedom, members_of, random_box, rows_of
from support.sweep import sweep

# powers of some twenty parts, each rounded a few times, against the largest of them
BALANCE = 1e-12
NAMED = re.compile(r'^(set|element|gear|published) ".+"|^gearbox')
SAMPLES = 3


def driveline(box, gear: str, rng: np.random.Generator) -> tuple[cw.Driveline, dict[str, float]]:
    """The gearbox between two shafts with random inertias and torques."""
    d = cw.Driveline("random")
    values = {name: float(rng.uniform(0.02, 2.0)) for name in ("a", "b", *members_of(box))}
    a, b = d.shaft("a", inertia=values["a"], speed=float(rng.uniform(50.0, 200.0))), d.shaft("b", inertia=values["b"])
    inner = {name: values[name] for name in members_of(box)}
    # capacity enough for any torque of this test
    d.add(cw.Transmission("box", gearbox=box, input=a, output=b, gear=gear, inertias=inner, torque=1e6))
    d.add(cw.Torque("drive", shaft=a, torque=float(rng.uniform(20.0, 200.0))))
    d.add(cw.Torque("load", shaft=b, torque=float(rng.uniform(-100.0, 100.0))))
    return d, values


def refusal(box) -> str:
    """What is wrong with the refusal of a gearbox, "" where it is not refused or names its reasons."""
    try:
        cw.Gearbox.from_dict(box)
    except cw.ModelError as error:
        vague = [str(problem) for problem in error.problems if not NAMED.match(problem.path) or not problem.remedy]
        d = cw.Driveline("refused")
        a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
        d.add(cw.Transmission("box", gearbox=box, input=a, output=b))
        told = "\n".join(map(str, d.check()))
        missing = [str(problem) for problem in error.problems if problem.message not in told]
        return f"vague: {vague}" if vague else f"not told by the element: {missing} in {told}" if missing else "refused"
    return ""


def power_fault(run, box, values: dict[str, float]) -> str:
    """Power that any gear set makes, or that the whole loses, over the largest power there is."""
    for place in np.linspace(0, len(run) - 1, SAMPLES).astype(int):

        def at(name: str, place: int = int(place)) -> float:
            return float(run[name][place])

        ends = [at(f"{of}.torque") * at(f"{node}.speed") for of, node in (("drive", "a"), ("load", "b"))]
        stored = [J * at(f"{_node(name)}.acceleration") * at(f"{_node(name)}.speed") for name, J in values.items()]
        heat = [at(f"box.{name}.power") for name in box["elements"]]
        inner = [list(_powers(one, name, at)) for name, one in box["sets"].items()]
        largest = max(abs(p) for p in (*ends, *stored, *(p for powers in inner for p in powers)))
        largest *= cancelled(run, int(place))
        parts = {name: sum(powers) for name, powers in zip(box["sets"], inner, strict=True)}
        parts["the whole"] = sum(ends) - sum(stored) + sum(heat)
        for name, lost in parts.items():
            if abs(lost) > BALANCE * largest:
                return f"{name} makes {lost:.3g} W of {largest:.3g} W at {run.time[place]:g} s"
    return ""


def cancelled(run, place: int) -> float:
    """How much larger the terms are than the speeds that they add up to, where ratios are extreme; 1 mostly."""
    system = run.system
    free = np.array([run[f"{name}.speed"][place] for name in system.independent])
    speeds = np.array([run[f"{node.name}.speed"][place] for node in system.nodes])
    return max(1.0, float(np.max(np.abs(system.basis) @ np.abs(free)) / np.max(np.abs(speeds))))


def _node(name: str) -> str:
    return name if name in ("a", "b") else f"box.{name}"


def _powers(one, name: str, at):
    for part, ports in _parts(one, name):
        for signal, port in ports.items():
            member = one.get(port, HOUSING)
            if member != HOUSING:
                yield at(f"box.{part}.torque_{signal}") * at(f"box.{member}.speed")


def _parts(one, name: str):
    """The gear elements of a set, with the port of the set at each of theirs."""
    if one["type"] in ("two_suns", "two_rings"):
        first, second, _ = PORTS[one["type"]]
        return [(name, {"input": first, "output": second, "support": "carrier"})]
    if one["type"] == "gear":
        return [(name, {"input": "first", "output": "second"})]
    return [(name, {port: port for port in PORTS[one["type"]]})]


def check(seed: int) -> str:
    """What is wrong with a case, "" where nothing is."""
    rng = np.random.default_rng(seed)
    box = random_box(rng)
    found = refusal(box)
    if found:
        return "" if found == "refused" else found
    gear = str(rng.choice(list(box["gears"])))
    d, values = driveline(box, gear, rng)
    system = d.assemble()
    wanted = freedom(members_of(box), rows_of(box))
    if len(system.independent) != wanted:
        return f"{len(system.independent)} speeds are free, not {wanted}"
    run = cw.simulate(system, 0.02)
    state = cw.Gearbox.from_dict(box).state(gear)
    ratio = run["a.speed"][-1] / run["b.speed"][-1]
    # another row may be this one and a freewheel that holds
    row = {f"box.{name}" for name in box["gears"][gear]}
    held = all(row <= set(one.closed) for one in run.gears())
    # torques are random, so that a freewheel may overrun
    if not held and not any(isinstance(box["elements"][name], dict) for name in box["gears"][gear]):
        return f"gear {gear} is not in: {run.gears()}"
    if held and abs(ratio / state.ratio - 1.0) > 1e-9:
        return f"gear {gear} has the ratio {ratio!r}, not {state.ratio!r}"
    return power_fault(run, box, values)


@pytest.mark.random
def test_random_gearboxes() -> None:
    sweep(check, amount())


def test_both_kinds_are_drawn() -> None:
    """Neither are all of them right, nor none."""
    boxes = [random_box(np.random.default_rng(seed)) for seed in range(60)]
    refused = sum(refusal(box) == "refused" for box in boxes)
    assert 10 <= refused <= 50

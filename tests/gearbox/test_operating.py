"""Operating points of power splits against closed forms, written apart from the package."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

import clutchwork as cw
from support.catalogue import SPLITS, Box, data

# exact fractions are rounded once to floats, and the closed forms a few times
ROUNDING = {"rel": 1e-12, "abs": 1e-10}

# ring over sun of the power split, reduction from the ring to the axle, speed of MG2 over the ring
PRIUS = {
    "toyota-p410": (78 / 30, 55 / 54 * 77 / 24, -58 / 22),
    "toyota-p112": (78 / 30, 35 / 36 * 44 / 30 * 75 / 26, 1.0),
}


@pytest.mark.parametrize("name", PRIUS)
@pytest.mark.parametrize("engine", [(120.0, 80.0), (350.0, -20.0), (0.0, 0.0)])
@pytest.mark.parametrize("output", [-20.0, 35.0, 140.0])
@pytest.mark.parametrize("battery", [-8000.0, 0.0, 12000.0])
def test_one_mode(name: str, engine: tuple[float, float], output: float, battery: float) -> None:
    rho, reduction, second = PRIUS[name]
    (speed, torque), ring = engine, output * reduction
    found = cw.Gearbox.load(name).operating_point(
        "split", speed=speed, torque=torque, output_speed=output, battery_power=battery
    )
    first = (1 + rho) * speed - rho * ring
    on_first = -torque / (1 + rho)
    on_second = (battery - on_first * first) / (second * ring)
    assert found.speeds["MG1"] == pytest.approx(first, **ROUNDING)
    assert found.machine_torques["MG1"] == pytest.approx(on_first, **ROUNDING)
    assert found.machine_torques["MG2"] == pytest.approx(on_second, **ROUNDING)
    wanted = reduction * (torque * rho / (1 + rho) + second * on_second)
    assert found.output_torque == pytest.approx(wanted, **ROUNDING)
    assert found.output_power == pytest.approx(speed * torque + battery, rel=1e-12, abs=1e-9)
    # what goes electrically is what machines drive with, or what they generate and do not store
    powers = found.machine_powers.values()
    driving = sum(power for power in powers if power > 0)
    assert found.electric_power == pytest.approx(max(driving, driving - battery), rel=1e-12, abs=1e-9)


# sizes of the sets, and the compound lever of the first two: place of each member, B at 1 and X at 0
R1, R3 = 1.96, 2.69
LEVER = {"B": 1.0, "X": 0.0, "A": -1 / R1, "in": 1 / R1**2}


@pytest.mark.parametrize(("mode", "speed", "output"), [*product(("EVT1", "EVT2"), (90.0, 310.0), (40.0, 180.0))])
def test_two_modes(mode: str, speed: float, output: float) -> None:
    """Speeds along the compound lever; torques from the balance of the lever and of the electric power."""
    box, torque, battery = cw.Gearbox.load("gm-2ml70"), 150.0, 4000.0
    found = box.operating_point(mode, speed=speed, torque=torque, output_speed=output, battery_power=battery)
    # the output is at the end B over the third set, or at X
    at, over = (LEVER["B"], 1 + R3) if mode == "EVT1" else (LEVER["X"], 1.0)
    known = np.array([[1.0, LEVER["in"]], [1.0, at]])
    foot, rise = np.linalg.solve(known, [speed, over * output])
    turning = {member: foot + rise * place for member, place in LEVER.items()}
    for member, value in turning.items():
        assert found.speeds[member] == pytest.approx(value, rel=1e-12, abs=1e-10)
    # forces and moments on the lever, power of machines
    balance = np.array([[1.0, 1.0, 1.0], [LEVER["A"], LEVER["B"], at], [turning["A"], turning["B"], 0.0]])
    on_a, on_b, on_end = np.linalg.solve(balance, [-torque, -torque * LEVER["in"], battery])
    assert found.machine_torques == pytest.approx({"MGA": on_a, "MGB": on_b}, rel=1e-10)
    assert found.output_torque == pytest.approx(-on_end * over, rel=1e-10)
    assert found.output_power == pytest.approx(torque * speed + battery, rel=1e-12)


def test_mechanical_points() -> None:
    box = cw.Gearbox.load("gm-2ml70")
    first, second = box.mechanical_points("EVT1"), box.mechanical_points("EVT2")
    assert [one.machine for one in (*first, *second)] == ["MGB", "MGA", "MGA", "MGB"]
    # A stands: X over B is 1/(1 + r); B stands: the fourth gear
    assert [one.ratio for one in second] == pytest.approx([1 + 1 / R1, 1 - 1 / R1**2], rel=1e-15)
    assert first[1].ratio == pytest.approx((1 + R3) * (1 + 1 / R1) / (1 + R1), rel=1e-15)
    assert second[1].ratio == pytest.approx(box.ratios["4"], rel=1e-15)
    for mode, point in (("EVT1", first[1]), *(("EVT2", one) for one in second)):
        found = box.operating_point(mode, speed=200.0, torque=100.0, output_speed=200.0 / point.ratio)
        # the ratio is rounded once
        assert found.electric_power == pytest.approx(0.0, abs=1e-9)
    # published relations: MG1 and MG2 over the ring with the engine at rest
    prius = cw.Gearbox.load("toyota-p410")
    found = prius.operating_point(
        "split", speed=0.0, torque=0.0, output_speed=30.0, battery_power=None, output_torque=50.0
    )
    assert found.speeds["MG1"] / found.speeds["ring"] == pytest.approx(-2.6, rel=1e-12)
    assert found.speeds["MG2"] / found.speeds["ring"] == pytest.approx(-2.636, abs=5e-4)
    assert prius.operating_point("split", speed=1.0, torque=1.0, output_speed=0.5).speeds[
        "ring"
    ] / 0.5 == pytest.approx(3.267, abs=1e-3)


def test_hybrid_in_a_gear() -> None:
    """One speed is free; machines add to the engine by the ratios of their members."""
    box = cw.Gearbox.load("gm-2ml70")
    found = box.operating_point(
        "2", speed=200.0, torque=100.0, machines={"MGA": 30.0, "MGB": -10.0}, battery_power=None
    )
    wanted = 100.0 * 200.0 + 30.0 * found.speeds["A"] - 10.0 * found.speeds["B"]
    assert found.output_power == pytest.approx(wanted, rel=1e-12)
    assert found.battery_power == pytest.approx(wanted - 100.0 * 200.0, rel=1e-12)
    assert found.ratio == pytest.approx(box.ratios["2"], rel=1e-12)
    assert set(found.torques) == {"C1", "C2"}


@pytest.mark.parametrize("name", SPLITS)
def test_every_combination(name: str) -> None:
    """The kind from null spaces: two free speeds, and a machine that turns with both ends."""
    box, ours = Box(data(name)), cw.Gearbox.load(name)
    for one in ours.combinations():
        kind, dof, redundant, ratio = box.classified(list(one.closed))
        if kind == "neutral" and dof == 2:
            free = box.motions(list(one.closed))
            ends = np.linalg.inv(free[:2])
            machines = [free[box.members.index(member)] @ ends for member in ours.machines.values()]
            kind = "split" if any((np.abs(row) > 1e-9).all() for row in machines) else kind
        assert (one.kind, one.dof, one.redundant) == (kind, dof, redundant), one.closed
        assert (one.ratio is None) == (ratio is None)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"speed": 100.0}, "give output_speed too"),
        ({"output_speed": 100.0, "speeds": {"MG1": 0.0, "ring": 3.0}}, "do not fit each other"),
        ({"output_speed": 0.0, "speed": 100.0}, "has nowhere to go"),
        ({"output_speed": 50.0, "speed": 100.0, "battery_power": None}, "torques are left free"),
        ({"output_speed": 50.0, "speed": 100.0, "output_torque": 1.0}, "do not balance"),
        ({"output_speed": 50.0, "speeds": {"MG3": 1.0}}, "'MG3' is not a member"),
        ({"output_speed": 50.0, "speed": 100.0, "machines": {"MG3": 1.0}}, "'MG3' is not a machine"),
    ],
)
def test_too_little_and_too_much_is_told(values: dict[str, object], words: str) -> None:
    with pytest.raises(cw.UseError, match=words):
        cw.Gearbox.load("toyota-p410").operating_point("split", torque=50.0, **values)  # type: ignore[arg-type]
    with pytest.raises(cw.UseError, match="is not a split; choose from"):
        cw.Gearbox.load("gm-2ml70").mechanical_points("2")


def test_drawn() -> None:
    """The power of each machine is on its line; a gear of the same box is drawn without it."""
    box = cw.Gearbox.load("toyota-p410")
    point = box.operating_point("split", speed=200.0, torque=100.0, output_speed=60.0)
    for kind in ("stick", "lever"):
        text = cw.diagram(box, kind, point=point).svg
        assert "5.8 kW electrically" in text
        assert text.count(">M</text>") == 2
    for wrong in ({"kind": "chart"}, {"gear": "split"}, {"point": 3}):
        with pytest.raises(cw.UseError):
            cw.diagram(box, **{"point": point, **wrong})  # type: ignore[arg-type]

"""Power splits in motion against their mass matrix, which follows from null spaces of the rows of their sets."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support.catalogue import Box, data

MODES = (
    ("toyota-p112", "split"),
    ("toyota-p410", "split"),
    ("gm-2ml70", "EVT1"),
    ("gm-2ml70", "EVT2"),
    ("gm-2ml70", "2"),
)


@pytest.mark.parametrize(("name", "mode"), MODES)
def test_constant_torques(name: str, mode: str) -> None:
    """Every member gets an acceleration M^-1 Q of its own, constant; the battery has what the machines do."""
    own, box = Box(data(name)), cw.Gearbox.load(name)
    free = own.motions(list(box.gears[mode]))
    inertia = np.full(len(own.members), 0.02)
    inertia[0] += 0.3
    inertia[1] += 40.0
    rng = np.random.default_rng(len(name + mode))
    torque = {box.input: 90.0, box.output: -60.0, **{m: rng.uniform(-20, 20) for m in box.machines.values()}}
    acting = np.array([torque.get(member, 0.0) for member in own.members])
    change = free @ np.linalg.solve(free.T @ (inertia[:, None] * free), free.T @ acting)

    d = cw.Driveline("split")
    upper, lower = d.shaft("upper", inertia=0.3, speed=0.0), d.shaft("lower", inertia=40.0, speed=0.0)
    gearbox = cw.Transmission("box", gearbox=name, input=upper, output=lower, gear=mode, inertia=0.02)
    d.add(gearbox)
    d.add(cw.Torque("burning", shaft=upper, torque=90.0))
    d.add(cw.Torque("load", shaft=lower, torque=-60.0))
    loads = []
    for machine, member in box.machines.items():
        motor = cw.ElectricMotor(
            machine, shaft=gearbox.part(member), command=torque[member], max_torque=50.0, copper_loss=0.1
        )
        loads.append(cw.SupplyPower(d.add(motor)))
    flat = {"charges": (0.0, 1.0), "voltages": (300.0, 300.0), "resistances": (0.0, 0.0), "capacity": 1e4}
    d.add(cw.Battery("battery", **flat, load=loads[0], second_load=loads[1]))  # type: ignore[arg-type]
    run = d.simulate(2.0)
    for member, rate in zip(own.members, change, strict=True):
        # linear courses: round-off of the reduction, and of a hundred steps
        assert run[f"box.{member}.speed"] == pytest.approx(rate * run.time, rel=1e-10, abs=1e-10), member
    turned = {member: rate * 2.0**2 / 2 for member, rate in zip(own.members, change, strict=True)}
    work = sum(torque[member] * turned[member] for member in box.machines.values())
    heat = sum(0.1 * torque[member] ** 2 * 2.0 for member in box.machines.values())
    assert run["battery.energy"][-1] == pytest.approx(work + heat, rel=1e-9, abs=1e-9)
    assert run["battery.charge"][-1] == pytest.approx(0.5 - (work + heat) / 300.0 / 1e4, rel=1e-12)

"""The full form: every element gives there what it gives in its own, and elements of several ways agree with SciPy."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from clutchwork.declare.schema import Role
from support import samples
from support.full import full

KINDS = {cls.kind: cls for cls in samples.declared(Role.TORQUE, Role.CONTACT, Role.FLOW, Role.PROCESS, Role.COMPOSITE)}
EXAMPLES = sorted(Path(__file__).parents[2].glob("examples/*/model.toml"))

# steps of one length, whatever their error: both forms take the same ones, and differ by round-off alone
SAME_STEPS: dict[str, Any] = {"rtol": 0.1, "atol": 1e3, "first_step": 2e-4, "max_step": 2e-4, "dt": 1e-3}


def worst(a: cw.Trajectory, b: cw.Trajectory, least: float = 1e-6) -> float:
    """Largest difference of two runs, each number of a row relative to its own full scale, or to a least one in SI."""
    scale = np.maximum(np.max(np.abs(a.rows), axis=0, initial=0.0, where=np.isfinite(a.rows)), least)
    with np.errstate(invalid="ignore"):
        return float(np.nanmax(np.abs(a.rows - b.rows) / scale))


@pytest.mark.parametrize("method", ["rodas5p", "dopri5"])
@pytest.mark.parametrize("kind", KINDS)
def test_every_element_moves_as_in_its_own_form(kind: str, method: str) -> None:
    system = samples.driveline(KINDS[kind]).assemble()
    if method == "dopri5" and np.any(system.massless):
        pytest.skip("a shaft without inertia")
    options = {**SAME_STEPS, "method": method}
    own = cw.simulate(system, 0.02, **options)
    whole = cw.simulate(full(system), 0.02, **options)
    assert own.finished == whole.finished
    assert own.statistics["steps"] == whole.statistics["steps"]
    # round-off over a hundred steps, and over an event where there is one
    assert worst(own, whole) <= 1e-9


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.parent.name)
def test_examples_move_as_in_their_own_form(path: Path) -> None:
    system = cw.Driveline.load(path).assemble()
    options: dict[str, Any] = {"rtol": 1e-9, "atol": 1e-9, "dt": 0.02, "method": "rodas5p"}
    own, whole = (cw.simulate(each, 1.0, **options) for each in (system, full(system)))
    assert [(e.element, e.after) for e in own.events] == [(e.element, e.after) for e in whole.events]
    # at this tolerance the steps may differ: thirty times of it, of each full scale, accelerations
    # among them; a shaft that is held has round-off
    assert worst(own, whole, 1e-3) <= 3e-8


def line(seed: int) -> tuple[cw.Driveline, Any, np.ndarray]:
    """Shafts in a row with couplings and springs between them, the slope of the same motion, and its start."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(3, 7))
    inertia, start = rng.uniform(0.05, 2.0, n), rng.uniform(-100.0, 100.0, n)
    d = cw.Driveline(f"line {seed}")
    shafts = [d.shaft(f"s{i}", inertia=inertia[i], speed=start[i]) for i in range(n)]
    oily = rng.random(n - 1) < 0.6
    oily[0] = True
    k = rng.uniform(1e-4, 5e-3, n - 1)
    stiffness, damping = rng.uniform(50.0, 500.0, n - 1), rng.uniform(0.1, 2.0, n - 1)
    for i in range(n - 1):
        a, b = shafts[i], shafts[i + 1]
        if oily[i]:
            table = (0.0, 0.5, 0.9, 1.0), (k[i], 0.9 * k[i], 0.5 * k[i], 0.0)
            d.add(cw.FluidCoupling(f"c{i}", base=a, follower=b, speed_ratio=table[0], capacity=table[1]))
        else:
            d.add(cw.SpringDamper(f"k{i}", base=a, follower=b, stiffness=stiffness[i], damping=damping[i]))
    d.add(cw.QuadraticTorque("load", shaft=shafts[-1], nominal_torque=-20.0, nominal_speed=60.0))
    d.add(cw.Torque("drive", shaft=shafts[0], torque=30.0))

    def coupled(i: int, a: float, b: float) -> float:
        fast, slow, sign = (a, b, 1.0) if abs(a) >= abs(b) else (b, a, -1.0)
        factor = np.interp(slow / fast if fast else 0.0, (0.0, 0.5, 0.9, 1.0), k[i] * np.array([1.0, 0.9, 0.5, 0.0]))
        return sign * float(factor) * fast * abs(fast)

    def slope(_: float, y: np.ndarray) -> np.ndarray:
        w, twist = y[:n], y[n:]
        torque, turned = np.zeros(n), np.zeros(n - 1)
        torque[0] += 30.0
        torque[-1] -= 20.0 * w[-1] * abs(w[-1]) / 3600.0
        for i in range(n - 1):
            between = coupled(i, w[i], w[i + 1])
            if not oily[i]:
                turned[i] = w[i + 1] - w[i]
                between = -(stiffness[i] * twist[i] + damping[i] * turned[i])
            torque[i + 1] += between
            torque[i] -= between
        return np.concatenate([torque / inertia, turned])

    return d, slope, np.concatenate([start, np.zeros(n - 1)])


@pytest.mark.parametrize("method", ["rodas5p", "dopri5"])
@pytest.mark.parametrize("seed", range(12))
def test_random_lines_of_couplings_agree_with_scipy(seed: int, method: str) -> None:
    d, slope, start = line(seed)
    run = d.simulate(1.5, rtol=1e-9, atol=1e-9, method=method)
    # kinks of the tables cost it accuracy: short steps
    found = solve_ivp(slope, (0.0, 1.5), start, method="DOP853", rtol=1e-11, atol=1e-11, max_step=2e-3)
    n = len(d.nodes)
    last = np.array([run[f"s{i}.speed"][-1] for i in range(n)])
    # 1e-7 of the fastest speed: the kinks that SciPy steps over
    assert np.max(np.abs(last - found.y[:n, -1])) <= 1e-7 * np.max(np.abs(start[:n]))
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_dopri5_and_rodas5p_meet_at_the_events_of_a_clutch_beside_a_coupling() -> None:
    times = []
    for method in ("rodas5p", "dopri5"):
        d, _, _ = line(3)
        a, b = d.nodes[0], d.nodes[-1]
        d.add(
            cw.Clutch(
                "c", base=a, follower=b, friction=cw.Coulomb(static=0.3, kinetic=0.2), gain=1.0, normal_force=500.0
            )
        )
        run = d.simulate(2.0, rtol=1e-10, atol=1e-10, method=method)
        assert run.finished
        times.append([event.time for event in run.events])
    assert times[0]
    assert times[0] == pytest.approx(times[1], abs=1e-7)


def test_a_saved_state_goes_on_with_the_same_bits() -> None:
    d, _, _ = line(5)
    system = d.assemble()
    sim, again = cw.Simulator(system), cw.Simulator(system)
    sim.advance_to(0.4)
    again.restore(sim.save())
    sim.advance_to(1.0)
    again.advance_to(1.0)
    assert np.array_equal(sim.run.rows[-1], again.run.rows[-1])
    assert sim.run.events == again.run.events


def test_heat_of_an_element_of_several_ways_goes_to_its_thermal_node() -> None:
    d = cw.Driveline("warm")
    oil = d.thermal("oil", capacity=2000.0, temperature=300.0)
    a, b = d.shaft("a", inertia=0.5, speed=200.0), d.shaft("b", inertia=1.0)
    d.add(cw.FluidCoupling("c", base=a, follower=b, speed_ratio=(0.0, 1.0), capacity=(2e-3, 0.0), heat=oil))
    run = d.simulate(30.0, rtol=1e-9, atol=1e-9)
    # all that is lost on the way to one speed
    loss = 0.5 * 0.5 * 1.0 / 1.5 * (200.0**2 - (run["b.speed"][-1] - run["a.speed"][-1]) ** 2)
    assert run["oil.heat"][-1] == pytest.approx(loss, rel=1e-7)
    assert run.energy.heat["c"] == pytest.approx(loss, rel=1e-7)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_numbers_that_change_give_the_bits_of_a_new_driveline() -> None:
    d, _, _ = line(1)
    system = d.assemble()
    table = (4e-3, 3e-3, 1e-3, 0.0)
    changed = cw.simulate(system.changed({"c0.capacity": table}), 0.5)
    assert not np.array_equal(changed.rows[-1], cw.simulate(system, 0.5).rows[-1])
    other = cw.simulate(system.changed({"c0.capacity": table, "s0.inertia": 0.3}), 0.5)
    assert not np.array_equal(other.rows[-1], changed.rows[-1])


def test_a_sweep_gives_the_bits_of_single_runs() -> None:
    d, _, _ = line(2)
    found = cw.sweep(d, 0.5, vary={"s0.inertia": [0.2, 0.4, 0.8]}, outputs=["s1.speed"])
    for inertia, speed in zip([0.2, 0.4, 0.8], found["s1.speed"], strict=True):
        one = cw.simulate(d.assemble().changed({"s0.inertia": inertia}), 0.5)
        assert speed == one["s1.speed"][-1]


def test_the_linear_system_is_the_derivative_of_the_motion() -> None:
    d = cw.Driveline("pair")
    a, b = d.shaft("a", inertia=0.5, speed=120.0), d.shaft("b", inertia=1.0, speed=80.0)
    d.add(cw.FluidCoupling("c", base=a, follower=b, speed_ratio=(0.0, 1.0), capacity=(2e-3, 0.0)))
    k, wa, wb = 2e-3, 120.0, 80.0
    # T = k (1 - wb/wa) wa^2 = k wa (wa - wb)
    by_a, by_b = k * (2 * wa - wb), -k * wa
    found = cw.linearise(d, inputs=[], outputs=["c.torque", "c.power"])
    assert pytest.approx(np.array([[-by_a, -by_b], [by_a, by_b]]) / [[0.5], [1.0]], rel=1e-12) == found.A
    torque = k * wa * (wa - wb)
    assert found.C[0] == pytest.approx([by_a, by_b], rel=1e-12)
    assert found.C[1] == pytest.approx([by_a * (wb - wa) - torque, by_b * (wb - wa) + torque], rel=1e-12)

"""Reduction and multipliers of the six-speed gearbox against the closed forms of the paper (table 1, eq. 5-8)."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support import six_speed
from support.runs import TIGHT

INDEPENDENT = ("w1", "w2", "w4", "w8")

# the paper's k = -z_ring/z_sun
k1, k2, k3, k4 = -six_speed.K1, -six_speed.K2, -six_speed.K3, -six_speed.K4
J = six_speed.INERTIA


def parameters() -> dict[str, float]:
    """Ja ... Jf, equations 5 to 8, from w6 = (w4 - (1 - k3) w8)/k3 and so on."""
    w5 = np.array([(k2 + k3 - 1) / (k2 * k3), (1 - k2) * (1 - k3) / (k2 * k3)])
    w6 = np.array([1 / k3, -(1 - k3) / k3])
    w7 = np.array([1 / (k3 * k4), -((1 - k3) / k3 + 1 - k4) / k4])
    block = J["w5"] * np.outer(w5, w5) + J["w6"] * np.outer(w6, w6) + J["w7"] * np.outer(w7, w7)
    block += np.diag([J["w4"], J["w8"]])
    return {
        "Ja": J["w1"] + J["w3"] * k1**2,
        "Jb": J["w3"] * k1 * (1 - k1),
        "Jc": J["w2"] + J["w3"] * (1 - k1) ** 2,
        "Jd": block[0, 0],
        "Je": block[0, 1],
        "Jf": block[1, 1],
    }


def expected_mass() -> np.ndarray:
    p = parameters()
    M = np.zeros((4, 4))
    M[:2, :2] = [[p["Ja"], p["Jb"]], [p["Jb"], p["Jc"]]]
    M[2:, 2:] = [[p["Jd"], p["Je"]], [p["Je"], p["Jf"]]]
    return M


def test_mass_matrix() -> None:
    d, _ = six_speed.members({})
    M = d.assemble(independent=INDEPENDENT).mass
    # round-off of sums of eight products
    assert np.allclose(M, expected_mass(), rtol=1e-14, atol=1e-13)
    # printed check values, nine digits; the page prints Ja with two digits swapped: 19.37 + 1.89 2.78^2 = 33.976676
    printed = [33.9766760, -19.8608760, 29.7350760, 9.56162586, -19.8460521, 71.1604783]
    assert [M[0, 0], M[0, 1], M[1, 1], M[2, 2], M[2, 3], M[3, 3]] == pytest.approx(printed, rel=1e-8)
    # no coupling between divider and base gearbox, exactly
    assert np.all(M[:2, 2:] == 0.0)


def test_any_choice_of_independent_speeds_gives_the_same_inertia() -> None:
    d, _ = six_speed.members({})
    automatic, chosen = d.assemble(), d.assemble(independent=INDEPENDENT)
    for one, two in ((automatic, chosen), (chosen, automatic)):
        # speeds of the second choice in terms of the first: T = N1 [rows]^-1 ...; kinetic energy must agree
        T = np.linalg.lstsq(one.basis, two.basis, rcond=None)[0]
        assert np.allclose(one.basis @ T, two.basis, atol=1e-12)
        assert np.allclose(T.T @ one.mass @ T, two.mass, rtol=1e-12, atol=1e-11)


def table_1(clutch: str, Q: np.ndarray) -> float:
    """Multipliers of the paper, scaled to the slip of the clutch (row 3: -k2 k3 times the printed one)."""
    p = parameters()
    Ja, Jb, Jc, Jd, Je, Jf = (p[name] for name in ("Ja", "Jb", "Jc", "Jd", "Je", "Jf"))
    Q1, Q2, Q4, Q8 = Q
    if clutch == "F1":
        return ((Ja + Jb) * Q2 - (Jb + Jc) * Q1) / (Ja + 2 * Jb + Jc)
    if clutch == "F2":
        q = 1 - k1
        return ((Jb * Q1 - Ja * Q2) * q + (Jb * Q2 - Jc * Q1) * k1) / (Ja * q**2 - 2 * Jb * k1 * q + Jc * k1**2)
    D2, D3 = 1 - k2 - k3, (1 - k2) * (1 - k3)
    printed = ((D2 * Je + D3 * Jd) * Q8 - (D2 * Jf + D3 * Je) * Q4) / (D2**2 * Jf + 2 * D2 * D3 * Je + D3**2 * Jd)
    return -k2 * k3 * printed


@pytest.mark.parametrize("clutch", ["F1", "F2", "F4"])
@pytest.mark.parametrize("seed", range(5))
def test_multipliers_equal_table_1(clutch: str, seed: int) -> None:
    """One clutch locked, the others open, random torques on w1, w2, w4, w8."""
    Q = np.random.default_rng(seed).uniform(-1000, 1000, 4)
    d, w = six_speed.members({})
    for name, torque in zip(INDEPENDENT, Q, strict=True):
        d.add(cw.Torque(f"Q_{name}", shaft=w[name], torque=float(torque)))
    for name, (base, follower) in six_speed.CLUTCHES.items():
        pressure = 1e7 if name == clutch else 0.0
        law = cw.Exponential(**six_speed.LAW)
        d.add(
            cw.Clutch(
                name, base=w[base], follower=w[follower], friction=law, gain=six_speed.GAIN[name], pressure=pressure
            )
        )
    run = d.simulate(1e-6, times=[0.0], **TIGHT)
    assert run[f"{clutch}.state"][0] == "locked"
    # 1e-12 relative: asked for; against the largest torque, as the closed form itself cancels
    assert run[f"{clutch}.torque"][0] == pytest.approx(table_1(clutch, Q), rel=1e-12, abs=1e-12 * np.max(np.abs(Q)))


GEARS = {
    # closed elements and ratio w1/w8; F3 joins w4 and w8, F5 and F6 hold w7 and w6
    1: ("F2 F6", 4.5550), 2: ("F1 F6", 3.3500), 3: ("F2 F4", 2.4886), 4: ("F1 F4", 1.8302),
    5: ("F2 F3", 1.3597), 6: ("F1 F3", 1.0000), -1: ("F2 F5", -5.0309),
}  # fmt: skip


@pytest.mark.parametrize("gear", GEARS)
def test_ratio_of_every_gear(gear: int) -> None:
    """Two elements locked, torque on w1: all members turn in the ratios of the gear table."""
    closed, ratio = GEARS[gear]
    d, w = six_speed.members({})
    places = {**six_speed.CLUTCHES, "F3": ("w8", "w4"), "F5": ("housing", "w7"), "F6": ("housing", "w6")}
    for name in closed.split():
        base, follower = places[name]
        law = cw.Exponential(**six_speed.LAW)
        d.add(cw.Clutch(name, base=w[base], follower=w[follower], friction=law, gain=0.1789, pressure=1e8))
    d.add(cw.Torque("drive", shaft=w["w1"], torque=500.0))
    run = d.simulate(0.5, dt=0.1, rtol=1e-10, atol=1e-10)
    elastic = run["w2.speed"] - run["w4.speed"]
    # printed with five digits; the elastic shaft may twist, so the divider and the base gearbox are compared apart
    divider, base = run["w1.speed"][-1] / run["w2.speed"][-1], run["w4.speed"][-1] / run["w8.speed"][-1]
    assert divider * base == pytest.approx(ratio, rel=2e-5)
    assert abs(elastic[-1]) < 0.05 * abs(run["w2.speed"][-1])

"""Losses of a whole gearbox: each part against its formula, meshes against the efficiency of statics, and their sum."""

from __future__ import annotations

from math import log10, pi
from typing import Any

import numpy as np
import pytest

import clutchwork as cw

OIL = cw.Oil(viscosity_40=29e-6, viscosity_100=6e-6)
COLD, WARM = 293.15, 353.15


def table(box: cw.Gearbox, gear: str, *parts: Any, temperatures: tuple[float, ...] = (COLD, WARM)) -> Any:
    return box.loss_map(
        gear, speeds=(0.0, 50.0, 300.0), torques=(-80.0, 0.0, 200.0), temperatures=temperatures, oil=OIL, parts=parts
    )


def test_viscosity() -> None:
    assert OIL.viscosity(313.15) == pytest.approx(29e-6, rel=1e-12)
    assert OIL.viscosity(373.15) == pytest.approx(6e-6, rel=1e-12)
    # a straight line in the coordinates of the standard
    at = [log10(log10(1e6 * OIL.viscosity(t) + 0.7)) for t in (280.0, 280.0 * 1.1, 280.0 * 1.21)]
    assert at[0] - at[1] == pytest.approx(at[1] - at[2], rel=1e-9)


@pytest.mark.parametrize("gear", ["1", "4", "6", "R"])
def test_meshes(gear: str) -> None:
    box = cw.Gearbox.load("zf-8hp70").with_efficiency(0.98)
    found = table(box, gear)
    efficiency = box.state(gear).efficiency
    for i, _ in enumerate(found.temperatures):
        for j, speed in enumerate(found.speeds):
            assert found.shares["meshes"][i][j][2] == pytest.approx(200.0 * speed * (1 - efficiency), rel=1e-12)
            # power that comes back loses another share; a direct gear loses nothing
            back = found.shares["meshes"][i][j][0]
            assert (back > 0.0) == (speed > 0.0 and gear != "6")
            if back:
                assert back == pytest.approx(80.0 * speed * (1 - efficiency), rel=0.1)
            assert found.shares["meshes"][i][j][1] == 0.0


def test_back_and_forth_of_one_mesh() -> None:
    """One pair of gears: of the power that goes in either way the same share stays."""
    pair = {"type": "gear", "first": "in", "second": "out", "teeth_first": 20, "teeth_second": 50, "efficiency": 0.97}
    clutch = {"C": ["in", "x"]}
    box = cw.Gearbox.from_dict(
        {"name": "pair", "input": "in", "output": "out", "sets": {"G": pair}, "elements": clutch, "shafts": ["x"],
         "gears": {"1": []}}
    )  # fmt: skip
    found = table(box, "1")
    # at the input comes what the output has lost already: power out is 0.97 of power in
    assert found.shares["meshes"][0][1][2] == pytest.approx(50.0 * 200.0 * 0.03, rel=1e-12)
    assert found.shares["meshes"][0][1][0] == pytest.approx(50.0 * 80.0 * (1 / 0.97 - 1), rel=1e-12)


def test_parts() -> None:
    box = cw.Gearbox.load("zf-8hp70")
    state = box.state("3")
    parts = (
        cw.Bearing("out", mean_diameter=0.08, factor=3.0, count=2, friction=0.002, force=20.0),
        cw.Seal("in", diameter=0.04),
        cw.OpenPlates("A", surfaces=8, inner=0.06, outer=0.075, gap=2e-4),
        cw.Churning("out", torque_at=0.6, speed=200.0, exponent=0.25),
        cw.OilPump("in", displacement=15e-6, pressure=8e5, efficiency=0.8),
    )
    found = table(box, "3", *parts)
    for i, temperature in enumerate(found.temperatures):
        nu = OIL.viscosity(temperature)
        for j, speed in enumerate(found.speeds):
            out, slip = speed / state.ratio, state.slips["A"] * speed
            for k, torque in enumerate(found.torques):
                per_minute = nu * 1e6 * out * 60 / (2 * pi)
                free = 3.0 * 80.0**3 * 1e-7 * (per_minute ** (2 / 3) if per_minute >= 2000 else 160.0) * 1e-3
                loaded = 0.002 * 20.0 * abs(torque) * 0.04
                wanted = {
                    "meshes": 0.0,
                    "bearings": 2 * out * (free + loaded),
                    "seals": speed * 2.429e-3 * 40.0,
                    "open elements": 8 * 850.0 * nu * slip**2 * pi * (0.075**4 - 0.06**4) / 2 / 2e-4,
                    "churning": out * 0.6 * (out / 200.0) ** 2 * (nu / 29e-6) ** 0.25,
                    "pump": speed * 15e-6 * 8e5 / (2 * pi * 0.8),
                }
                assert {name: of[i][j][k] for name, of in found.shares.items()} == pytest.approx(wanted, rel=1e-12)
                assert found.power[i][j][k] == pytest.approx(sum(wanted.values()), rel=1e-12)
                power = speed * torque
                lost = found.power[i][j][k]
                # what comes back has to overcome the losses first
                share = (
                    0.0 if power == 0 else abs(power) / (abs(power) + lost) if power < 0 else max(0.0, 1 - lost / power)
                )
                assert found.efficiency[i][j][k] == pytest.approx(share, rel=1e-12)
    assert np.shape(found.power) == (2, 3, 3)
    assert "open elements W" in str(found)
    # tables are as long as their axes say
    assert [axis.unit for axis in found.axes] == ["K", "rad/s", "N m"]
    sizes = [len(axis.values) for axis in found.axes]
    assert [len(found.power), len(found.power[0]), len(found.power[0][0])] == sizes


def test_closed_plates_have_no_drag_and_mistakes_are_told() -> None:
    box = cw.Gearbox.load("zf-8hp70")
    closed = box.gears["1"][0]
    plates = cw.OpenPlates(closed, surfaces=8, inner=0.06, outer=0.075, gap=2e-4)
    assert np.max(table(box, "1", plates).power) == 0.0
    with pytest.raises(cw.UseError, match=r"(?s)'X' is not an element.*'axle' is not a member.*3 is not a part"):
        table(box, "1", cw.OpenPlates("X", 8, 0.06, 0.07, 2e-4), cw.Seal("axle", 0.04), 3)

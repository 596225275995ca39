"""FMUs that several tests share."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from support.fmus import Fmu
from support.project import ROOT

SIX_SPEED = ROOT / "examples" / "six_speed" / "model.toml"
# none of them is computed from inertias
OUTPUTS = ("w*.speed", "F*.torque", "F*.slip", "F*.heat", "F*.mode", "shaft.torque")
INPUTS = ("F1.pressure", "F2.pressure", "F4.pressure", "load.torque")


@pytest.fixture(scope="session", params=["2.0", "3.0"])
def six_speed(request: Any, tmp_path_factory: pytest.TempPathFactory) -> Fmu:
    """The six-speed gearbox with three pressures and a load as inputs."""
    folder = tmp_path_factory.mktemp("fmu")
    path = cw.Driveline.load(SIX_SPEED).to_fmu(
        folder / "six.fmu", inputs=INPUTS, outputs=OUTPUTS, version=request.param, picture=False
    )
    return Fmu(path, folder / "unpacked")


@pytest.fixture
def made(tmp_path: Path) -> Any:
    """Makes the FMU of a driveline and unpacks it."""

    def make(driveline: Any, **how: Any) -> Fmu:
        path = driveline.to_fmu(tmp_path / f"{driveline.name or 'one'}.fmu", **{"picture": False, **how})
        return Fmu(path, tmp_path / "unpacked")

    return make

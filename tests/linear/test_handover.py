"""What a linear system is handed on as: modes as a table, python-control, scipy, plain data, a picture, a report."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.command.main import main


@pytest.fixture(scope="module")
def chain() -> cw.Driveline:
    d = cw.Driveline("half shafts")
    engine, wheels, body = d.shaft("engine", inertia=0.3), d.shaft("wheels", inertia=2.0), d.shaft("body", inertia=90.0)
    d.add(cw.Torque("drive", shaft=engine, torque=0.0))
    d.add(cw.SpringDamper("shafts", base=engine, follower=wheels, stiffness=8000.0, damping=6.0))
    d.add(cw.SpringDamper("tyres", base=wheels, follower=body, stiffness=60_000.0, damping=250.0))
    plates, air = d.thermal("plates", capacity=500.0), d.ambient("air", temperature=300.0)
    d.add(cw.Conduction("cooling", hot=plates, cold=air, conductance=2.0))
    return d


def test_modes_are_a_table_with_the_shafts_that_move(chain):
    lin = cw.linearise(chain)
    kinds = [mode.kind for mode in lin.modes]
    assert kinds[0] == "free"
    assert kinds.count("oscillates") == 2
    assert lin.modes[0].shape == pytest.approx({"engine": 1.0, "wheels": 1.0, "body": 1.0})
    (heat,) = [mode for mode in lin.modes if not mode.shape]
    assert heat.time_constant == pytest.approx(250.0)
    assert heat.states["plates.temperature"] == 1.0
    for mode in lin.modes:
        # A x = lambda x, of the states that the shape is made of
        assert abs(mode.natural_frequency - abs(mode.eigenvalue) / (2 * math.pi)) == 0.0
        assert max(map(abs, mode.shape.values()), default=1.0) == pytest.approx(1.0)
    table = str(lin.modes)
    assert "engine 1.00" in table
    assert "free" in table
    assert "plates.temperature 1.00" in table
    assert repr(lin.modes[0]).startswith("<NaturalMode free")


def test_eigenvalues_and_vectors_belong_to_the_matrix(chain):
    lin = cw.linearise(chain)
    for mode in lin.modes.swinging:
        values = np.linalg.eigvals(lin.A)
        assert np.abs(values - mode.eigenvalue).min() < 1e-6 * abs(mode.eigenvalue)
        shape = np.array([mode.shape[name] for name in lin.shafts])
        nearest = int(np.argmin(np.abs(values - mode.eigenvalue)))
        vector = lin.shaft_speeds @ np.linalg.eig(lin.A)[1][:, nearest]
        assert vector / vector[np.argmax(np.abs(vector))] == pytest.approx(
            shape / shape[np.argmax(np.abs(shape))], abs=1e-6
        )
    assert lin.eigenvalues.shape == (6,)


def test_python_control_has_names_and_the_same_response(chain):
    control = pytest.importorskip("control")
    lin = cw.linearise(chain, inputs="drive.torque", outputs=["shafts.torque", "body.speed"])
    made = lin.to_control()
    assert made.state_labels[0] == "engine_speed"
    assert made.input_labels == ["drive_torque"]
    assert made.output_labels == ["shafts_torque", "body_speed"]
    f = np.array([0.3, 5.0, 40.0])
    response = control.frequency_response(made, 2 * np.pi * f)
    assert pytest.approx(lin.frequency_response(f)[:, :, 0], rel=1e-9) == np.asarray(response.complex).reshape(2, 3).T


def test_scipy_has_the_same_matrices(chain):
    lin = cw.linearise(chain)
    made = lin.to_scipy()
    assert np.array_equal(made.A, lin.A)
    assert np.array_equal(made.D, lin.D)


def test_plain_data_can_be_read_again(chain):
    lin = cw.linearise(chain)
    data = json.loads(json.dumps(lin.to_dict(), allow_nan=False))
    assert np.array_equal(np.array(data["A"]), lin.A)
    assert [state["name"] for state in data["states"]] == list(lin.states)
    assert len(data["modes"]) == len(lin.modes)


def test_the_report_says_what_it_is(chain):
    text = str(cw.linearise(chain))
    assert text.startswith("half shafts at 0 s: 6 states, 2 inputs, 9 outputs".replace("9 outputs", "6 outputs"))
    assert "wheels.speed" in text
    assert repr(cw.linearise(chain)) == "<Linear 'half shafts' at 0 s: 6 states, 2 inputs, 6 outputs>"


def test_the_picture_is_written(chain, tmp_path: Path):
    pytest.importorskip("matplotlib").use("agg")
    figure = cw.linearise(chain).plot(tmp_path / "modes.png")
    assert (tmp_path / "modes.png").stat().st_size > 5000
    # eigenvalues, and a panel for each mode that swings
    assert len(figure.axes) == 3
    still = cw.Driveline("still")
    still.shaft("a", inertia=1.0)
    cw.linearise(still).plot(tmp_path / "still.svg")


@pytest.fixture
def file(chain, tmp_path: Path) -> str:
    chain.save(tmp_path / "model.toml")
    return str(tmp_path / "model.toml")


def test_the_command_reports_and_prints_json(file, capsys, tmp_path):
    assert main(["linearise", file, "--at", "0.1", "--outputs", "*.speed"]) == 0
    out = capsys.readouterr().out
    assert "half shafts at 0.1 s: 6 states, 2 inputs, 3 outputs" in out
    assert main(["linearise", file, "--json", "--inputs", "drive.torque", "--plot", str(tmp_path / "m.svg")]) == 0
    data = json.loads(capsys.readouterr().out)
    assert [item["name"] for item in data["inputs"]] == ["drive.torque"]
    assert (tmp_path / "m.svg").exists()


def test_the_command_says_what_is_wrong(file, capsys):
    assert main(["linearise", file, "--outputs", "engine.sped"]) == 2
    assert "did you mean 'engine.speed'" in capsys.readouterr().err
    assert main(["linearise", file, "--at", "-1"]) == 2
    assert "zero or later" in capsys.readouterr().err

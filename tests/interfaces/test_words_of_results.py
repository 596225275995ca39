"""What messages about results call things, in Python and in the shell; units of times and frequencies."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.command.main import main
from support.two_discs import MODEL


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """A model file."""
    path = tmp_path / "model.toml"
    path.write_text(MODEL)
    return path


@pytest.fixture(scope="module")
def run() -> cw.Trajectory:
    """Two discs that a clutch joins."""
    d = cw.Driveline("two")
    a, b = d.shaft("a", inertia=1.0, speed=20.0), d.shaft("b", inertia=1.0)
    d.add(cw.SpringDamper("s", base=a, follower=b, stiffness=100.0, damping=1.0))
    d.add(cw.Clutch("c", base=a, follower=b, friction=cw.Coulomb(static=0.3, kinetic=0.2), gain=1.0, normal_force=50.0))
    return d.simulate(1.5)


def test_python_says_where_names_stand(run: cw.Trajectory) -> None:
    for call in (
        lambda: run["z"],
        lambda: run.units["z"],
        lambda: run.in_units("z", "rpm"),
        lambda: run.plot("z*", path="x.png"),
        lambda: run.to_pandas(units={"z*": "rpm"}),
    ):
        with pytest.raises(cw.UnknownName, match=r"`run\.names` lists all signals"):
            call()


def test_the_shell_says_where_names_stand(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    stored = tmp_path / "a.run"
    assert main(["run", str(model), "--save", str(stored), "--quiet"]) == 0
    for line in (
        ["plot", str(stored), "z.speed"],
        ["plot", str(stored), "z*"],
        ["run", str(model), "--units", "z=rpm"],
    ):
        assert main([*line]) == 2
        assert "clutchwork check MODEL --signals lists all" in capsys.readouterr().err


def test_what_plot_asks_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["plot"])
    assert "required: run\n" in capsys.readouterr().err
    (tmp_path / "p.png").write_bytes(b"x")
    (tmp_path / "p.run").write_bytes(b"x")
    assert main(["plot", str(tmp_path / "p.png")]) == 4
    assert "is a picture; give the run first: clutchwork plot first.run --out" in capsys.readouterr().err
    assert main(["plot", str(tmp_path / "p.run")]) == 4
    assert "write the file with clutchwork run MODEL --save FILE" in capsys.readouterr().err
    with pytest.raises(cw.ClutchworkError, match=r"write the file with run\.save"):
        cw.load_run(tmp_path / "p.run")


def test_rig_without_an_experiment_says_what_lists_them(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rig"]) == 2
    assert "clutchwork rig list prints them all" in capsys.readouterr().err


def test_options_without_effect_are_told(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(model), "--signals", "*.speed", "--units", "*.speed=rpm"]) == 0
    told = capsys.readouterr().err
    assert "--signals has no effect, for no signals are asked for; give --csv FILE" in told
    assert "--units has no effect" in told
    for more in (["--csv", str(tmp_path / "x.csv")], ["--json"]):
        assert main(["run", str(model), "--signals", "*.speed", *more]) == 0
        assert "no effect" not in capsys.readouterr().err


def test_a_unit_that_does_not_fit_is_not_taken_for_the_value(run: cw.Trajectory) -> None:
    with pytest.raises(cw.UseError, match=r"a\.speed in 'bar': the unit does not fit; the signal is in \[rad/s\]"):
        run.to_pandas(units={"a.speed": "bar"})


def test_times_that_fall_and_files_without_an_ending(run: cw.Trajectory, tmp_path: Path) -> None:
    d = cw.Driveline("falls")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=cw.Table([(0, 0), (1, 1), (1, 2), (0.5, 3)])))
    with pytest.raises(cw.ModelError, match=r"x must not fall; two points at one x are a jump"):
        d.assemble()
    with pytest.raises(cw.ClutchworkError, match=r"x' has no ending; give one of \.csv"):
        run.write(tmp_path / "x")


def test_units_of_times_and_frequencies(run: cw.Trajectory) -> None:
    assert run.state(at="500 ms").time == run.state(at=0.5).time == 0.5
    with pytest.raises(cw.UseError, match=r"at is '1 bar': has a unit that does not fit"):
        run.state(at="1 bar")
    shown = [run.plot(zoom=zoom).axes[0].get_xlim() for zoom in ((0.5, 1.0), ("500 ms", "1 s"))]
    assert shown[0] == shown[1]
    with pytest.raises(cw.UseError, match="give two times in s"):
        run.plot(zoom=("1 bar", "2 s"))
    lin = cw.linearise(run.system)
    for given, plain in (("2 Hz", [2.0]), (["2 Hz", "120 1/min", 3.0], [2.0, 2.0, 3.0])):
        np.testing.assert_array_equal(lin.frequency_response(given), lin.frequency_response(plain))
    with pytest.raises(cw.UseError, match=r"frequencies: '2 bar': has a unit that does not fit; give it in \[Hz\]"):
        lin.frequency_response("2 bar")

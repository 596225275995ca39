"""`clutchwork fit`, and the measurement in the examples."""

from __future__ import annotations

import json
import runpy
from pathlib import Path

import pytest

from clutchwork.command.main import main
from clutchwork.fit import fit_csv
from clutchwork.fit.command import law_from_text

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "fit"
FILE = str(EXAMPLE / "measured.csv")
COLUMNS = ["--slip", "slip", "--torque", "torque", "--load", "load"]
START = "static=0.2,kinetic=0.1,speed=1,viscous=1e-4"
LINE = ["fit", FILE, "--law", "stribeck", *COLUMNS, "--start", START]


@pytest.fixture(autouse=True)
def pictures_and_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)


def test_the_example_is_what_its_script_writes(tmp_path: Path) -> None:
    script = runpy.run_path(str(EXAMPLE / "make_data.py"))
    assert script["write"](tmp_path).read_text() == (EXAMPLE / "measured.csv").read_text()


def test_the_example_is_fitted(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(LINE) == 0
    told = capsys.readouterr().out
    assert 'friction = {type = "stribeck", static = 0.13' in told
    assert sorted(path.name for path in (tmp_path / "out" / "fit").iterdir()) == ["fit.json", "fit.png", "samples.csv"]
    found = json.loads((tmp_path / "out" / "fit" / "fit.json").read_text())
    truth = runpy.run_path(str(EXAMPLE / "make_data.py"))["TRUE"]
    for parameter in found["parameters"]:
        assert parameter["lower"] <= truth[parameter["name"]] <= parameter["upper"], parameter


def test_json_and_folder(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert (
        main(
            [
                *LINE,
                "--json",
                "--out",
                str(tmp_path / "there"),
                "--free",
                "static, kinetic, speed",
                "--confidence",
                "0.99",
            ]
        )
        == 0
    )
    told = json.loads(capsys.readouterr().out)
    assert [p["name"] for p in told["parameters"]] == ["static", "kinetic", "speed"]
    assert told["friction"]["viscous"] == 1e-4
    assert told["confidence"] == 0.99
    assert len(told["files"]) == 3


def test_what_is_open_has_its_own_exit_code(capsys: pytest.CaptureFixture[str]) -> None:
    line = ["fit", FILE, "--law", "karnopp", *COLUMNS, "--start", f"{START},band=0.01"]
    assert main(line) == 1
    assert "band is not determined" in capsys.readouterr().out
    assert main([*line, "--json"]) == 1
    told = json.loads(capsys.readouterr().out)
    assert [p["name"] for p in told["parameters"] if not p["determined"]] == ["band"]


def test_start_values_of_all_sorts() -> None:
    table = law_from_text("coefficient_table", "static=0.2,kinetic=0:0.1/5:0.05")
    assert [tuple(point) for point in table.kinetic] == [(0.0, 0.1), (5.0, 0.05)]  # type: ignore[attr-defined]
    curve = law_from_text("stribeck", "static=0.2,kinetic=0.1,speed=30 rpm,shape=tustin")
    assert curve.speed == pytest.approx(3.14159, rel=1e-5)  # type: ignore[attr-defined]
    assert curve.shape == "tustin"  # type: ignore[attr-defined]
    assert law_from_text("mykhalevych", "static=0.2,kinetic=0.1,elastic=1e-4,speed=1,viscous=1,passive=true").passive  # type: ignore[attr-defined]


def test_start_values_of_tables() -> None:
    start = "temperatures=280/400,speeds=0/50/1e2,static=.3/.25,kinetic=0.2/0.19/0.18//0.15/0.14/0.13"
    law = law_from_text("friction_map", start)
    assert [tuple(row) for row in law.kinetic] == [(0.2, 0.19, 0.18), (0.15, 0.14, 0.13)]  # type: ignore[attr-defined]
    assert tuple(law.speeds) == (0.0, 50.0, 100.0)  # type: ignore[attr-defined]
    assert law.temperature is None  # type: ignore[attr-defined]
    with pytest.raises(ValueError, match="'e' is not a number"):
        law_from_text("friction_map", "speeds=0/e")


def test_a_temperature(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    start = "static=280:0.2/400:0.15,kinetic=280:0.12/400:0.1"
    line = ["fit", FILE, "--law", "temperature_table", *COLUMNS, "--start", start]
    assert main(line) == 2
    assert "temperature is missing" in capsys.readouterr().err
    assert main([*line, "--temperature", "280", "--json"]) == 1
    told = json.loads(capsys.readouterr().out)
    assert [p["name"] for p in told["parameters"] if p["determined"]] == ["kinetic[1]"]
    head = (tmp_path / "out" / "fit" / "samples.csv").read_text().splitlines()[0]
    assert head.endswith(",temperature [K]")


@pytest.mark.parametrize(
    ("changes", "code", "words"),
    [
        ({"--law": "stribek"}, 3, "did you mean 'stribeck'"),
        ({"--start": "static=0.2,kinetic=0.1,speeds=1"}, 3, "did you mean 'speed'"),
        ({"--start": "static"}, 2, "is not name=value"),
        ({"--start": "static=0.2,kinetic=0.3,speed=1"}, 3, "below the kinetic"),
        ({"--free": "sped"}, 2, "did you mean 'speed'"),
        ({"--slip": "slop"}, 2, "did you mean 'slip"),
        ({"--load": "force"}, 2, "no column 'force'"),
        ({"--bounds": "speed=1"}, 2, "is not low:high"),
        ({"--bounds": "speed=2:a"}, 2, "'a' is not a number"),
        ({"--rest": "1e9"}, 2, "lower `rest`"),
        ({"--loss": "soft"}, 2, "did you mean 'soft_l1'"),
    ],
)
def test_mistakes(changes: dict[str, str], code: int, words: str, capsys: pytest.CaptureFixture[str]) -> None:
    options = dict(zip(LINE[2::2], LINE[3::2], strict=True)) | changes
    assert main(["fit", FILE, *(word for pair in options.items() for word in pair)]) == code
    assert words in capsys.readouterr().err


def test_a_file_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["fit", "none.csv", *LINE[2:]]) in (2, 4)
    assert "none.csv" in capsys.readouterr().err


def test_bounds_reach_the_fit(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*LINE, "--bounds", "speed=:2,kinetic=0.05:"]) == 1
    assert "speed is not determined: it lies on its bound" in capsys.readouterr().out


def test_a_loss(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*LINE, "--loss", "soft_l1", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert "(loss 'soft_l1')" in told["notes"]
    # a spoilt Stribeck speed leaves a pattern
    assert main([*LINE, "--free", "static,kinetic"]) == 1
    assert "the residuals are not noise" in capsys.readouterr().out


def test_files_and_python_say_the_same(capsys: pytest.CaptureFixture[str]) -> None:
    main([*LINE, "--json"])
    told = json.loads(capsys.readouterr().out)
    result = fit_csv(FILE, law_from_text("stribeck", START), slip="slip", torque="torque", load="load")
    assert [p["value"] for p in told["parameters"]] == [p.value for p in result.parameters]

"""`clutchwork gearbox`: what it prints, writes and says of wrong names and tables."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

import clutchwork as cw
from clutchwork.base.shell import DONE, FILE, MODEL, USAGE
from clutchwork.command.main import main
from clutchwork.diagrams.kinds import KINDS

OWN = """
name = "two-speed"
input = "sun"
output = "carrier"

[sets.P]
type = "single"
sun = "sun"
ring = "ring"
carrier = "carrier"
teeth_sun = 30
teeth_ring = 70

[elements]
B = ["ring", "housing"]
K = ["sun", "carrier"]

[gears]
1 = ["B"]
2 = ["K"]
"""


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A gearbox file in an empty working folder."""
    monkeypatch.chdir(tmp_path)
    Path("box.toml").write_text(OWN)
    return Path("box.toml")


def test_it_prints_all_of_a_box(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gearbox", "zf-8hp70"]) == DONE
    assert capsys.readouterr().out == str(cw.Gearbox.load("zf-8hp70")) + "\n"


def test_json_has_the_same_numbers(capsys: pytest.CaptureFixture[str]) -> None:
    box = cw.Gearbox.load("zf-8hp70")
    assert main(["gearbox", "zf-8hp70", "--json"]) == DONE
    data = json.loads(capsys.readouterr().out)
    assert data["ratios"] == box.ratios
    assert data["gears"]["3"]["torques"] == box.state("3").torques
    assert data["capacities"]["B"]["torque"] == box.capacities()["B"].torque
    assert len(data["combinations"]) == 2**5
    assert len(data["shifts"]) == len(box.swaps())
    assert cw.Gearbox.from_dict(data["gearbox"]).ratios == box.ratios
    assert main(["gearbox", "zf-8hp70", "--gear", "3", "--json"]) == DONE
    assert json.loads(capsys.readouterr().out) == data["gears"]["3"]


def test_one_gear_by_its_name_and_by_its_elements(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gearbox", "zf-8hp70", "--gear", "3"]) == DONE
    named = capsys.readouterr().out
    assert "ratio 2.1039" in named
    assert main(["gearbox", "zf-8hp70", "--gear", "B,C,E"]) == DONE
    assert capsys.readouterr().out == named


def test_the_list_has_the_whole_catalogue(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gearbox", "--list"]) == DONE
    out = capsys.readouterr().out
    assert all(name in out for name in cw.catalogue())
    assert main(["gearbox", "--list", "--json"]) == DONE
    assert sorted(json.loads(capsys.readouterr().out)) == sorted(cw.catalogue())


# parallel axes are those of gear pairs alone
@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "axes"])
def test_pictures_are_those_of_python(kind: str, own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gearbox", str(own), "--diagram", kind, "--gear", "1"]) == DONE
    path = Path(f"two-speed-{kind}.svg")
    assert capsys.readouterr().out == f"wrote {path}\n"
    text = path.read_text(encoding="utf-8")
    assert text == cw.diagram(own, kind, gear="1").svg
    ElementTree.fromstring(text)


def test_a_path_of_ones_own(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gearbox", str(own), "--svg", "out/box.svg", "--json"]) == DONE
    assert json.loads(capsys.readouterr().out) == {"files": [str(Path("out/box.svg"))]}
    assert Path("out/box.svg").read_text(encoding="utf-8") == cw.diagram(own).svg


def test_a_shift_table_from_a_spreadsheet(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("table.csv").write_text("gear;B;K\nlow;x;\nhigh;;x\n")
    assert main(["gearbox", str(own), "--table", "table.csv", "--json"]) == DONE
    assert json.loads(capsys.readouterr().out)["ratios"] == pytest.approx({"low": 10 / 3, "high": 1.0})


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["ford-model-tt"], FILE, "did you mean 'ford-model-t'"),
        (["nowhere.toml"], FILE, "does not exist"),
        (["zf-8hp70", "--gear", "11"], USAGE, "choose from 1, 2"),
        (["zf-8hp70", "--gear", "A,B"], USAGE, "A, B closed make neutral"),
        (["zf-8hp70", "--svg", "box.png"], USAGE, "such as 'gearbox.svg'"),
        ([], USAGE, "--list"),
    ],
)
def test_what_is_wrong_is_said(words: list[str], code: int, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gearbox", *words]) == code
    told = capsys.readouterr()
    assert said in told.err
    assert told.out == ""


def test_a_wrong_row_is_named(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    own.write_text(OWN.replace('2 = ["K"]', '2 = ["B", "K"]'))
    assert main(["gearbox", str(own)]) == MODEL
    err = capsys.readouterr().err
    assert 'gear "2"' in err
    assert "B" in err
    assert "box.toml" in err

"""Files, notebooks, the command line, models with mistakes, odd names."""

from __future__ import annotations

import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

import clutchwork as cw
from clutchwork.base import extras
from clutchwork.command.main import main
from support import schematics

ROOT = Path(__file__).resolve().parents[2]
LAUNCH = ROOT / "examples" / "launch" / "model.toml"
SVG = "{http://www.w3.org/2000/svg}"


def odd() -> cw.Driveline:
    d = cw.Driveline('<odd> & $x_1$ "quoted"')
    a, b = d.shaft("a<b & c", inertia=1.0), d.shaft("$\\omega$ Welle_ä", inertia=2.0)
    d.add(cw.Torque("--> drive", shaft=a, torque=3.0))
    d.add(cw.Spring("пружина 衝", base=a, follower=b, stiffness=10.0))
    return d


def words(svg: str) -> list[str]:
    return ["".join(item.itertext()) for item in ET.fromstring(svg).iter(f"{SVG}text")]


def test_names_are_what_they_are() -> None:
    d = odd()
    found = words(d.draw()._repr_svg_())
    for thing in (d, *d.nodes, *d.elements):
        assert thing.name in found
    for kind in ("png", "pdf"):
        assert len(d.draw()._bytes(kind)) > 1000


@pytest.mark.parametrize(("ending", "start"), [("svg", b"<?xml"), ("png", b"\x89PNG"), ("pdf", b"%PDF")])
def test_files_by_ending(ending: str, start: bytes, tmp_path: Path) -> None:
    d = cw.Driveline.load(LAUNCH)
    path = tmp_path / "deep" / f"model.{ending}"
    made = d.draw(path)
    assert path.read_bytes().startswith(start)
    again = tmp_path / f"again.{ending.upper()}"
    made.save(str(again))
    assert again.read_bytes() == path.read_bytes()


def test_a_png_is_as_fine_as_asked(tmp_path: Path) -> None:
    made = cw.Driveline.load(LAUNCH).draw()
    made.save(tmp_path / "a.png", dpi=100)
    made.save(tmp_path / "b.png", dpi=200)
    wide = [int.from_bytes((tmp_path / name).read_bytes()[16:20], "big") for name in ("a.png", "b.png")]
    assert abs(wide[1] - 2 * wide[0]) <= 2


def test_the_same_model_gives_the_same_bytes_in_any_process(tmp_path: Path) -> None:
    path = ROOT / "examples" / "six_speed" / "model.toml"
    code = f"import clutchwork as cw; cw.Driveline.load({str(path)!r}).draw({str(tmp_path / 'there.svg')!r})"
    subprocess.run([sys.executable, "-c", code], check=True, env={"PYTHONHASHSEED": "7", "PATH": ""})
    cw.Driveline.load(path).draw(tmp_path / "here.svg")
    assert (tmp_path / "here.svg").read_bytes() == (tmp_path / "there.svg").read_bytes()


def broken() -> cw.Driveline:
    d, other = cw.Driveline("broken"), cw.Driveline("other")
    a = d.shaft("a", inertia=-1.0)
    d.shaft("a", inertia="heavy")
    elsewhere = other.shaft("elsewhere", inertia=1.0)
    d.add(cw.Clutch("c", base=a, follower=elsewhere, friction=None, gain="big", pressure="high"))
    d.add(cw.Spring("s", base=a, follower="b", stiffness=float("nan")))
    d.add(cw.Gear("g", input=a, output=None, ratio=0.0))
    d.add(cw.Gear("loop", input=a, output=a, ratio=2.0))
    d.add(cw.Brake("held", shaft=d.housing, friction=schematics.LINING, gain=1.0, pressure=1.0))
    d.add(cw.Conduction("heat", hot=cw.ThermalNode("lost", 1.0), cold="air", conductance=1.0))
    d.add(cw.SpeedTorque("table", shaft=a, torque=[(0.0, "x")]))
    d.add(cw.Torque("t", shaft=a, torque=cw.PressureActuator("not there", command=1.0, lag=0.1)))
    return d


def test_a_model_with_mistakes_is_drawn_and_what_is_missing_is_marked() -> None:
    d = broken()
    assert len(d.check()) > 5
    made = d.draw()
    assert schematics.overlaps(made.sheet) == []
    names = [piece.name for piece in made.sheet.pieces]
    for element in d.elements:
        assert names.count(element.name) == 1
    marked = {piece.name for piece in made.sheet.pieces if piece.what == "missing"}
    assert {"elsewhere", "b", "lost", "air"} <= marked
    assert schematics.texts(made.sheet).count("missing") == len(marked)


def test_nothing_yet() -> None:
    made = cw.Driveline("empty").draw()
    assert "empty" in words(made._repr_svg_())
    d = cw.Driveline("one")
    d.shaft("alone", inertia=1.0)
    assert "alone" in words(d.draw()._repr_svg_())


def test_a_notebook_shows_schematic_and_tables() -> None:
    d = odd()
    html = d._repr_html_()
    tree = ET.fromstring(f"<div>{html}</div>")
    cells = ["".join(cell.itertext()) for cell in tree.iter("td")]
    for thing in (*d.nodes, *d.elements):
        assert thing.name in cells
    assert tree.find(f".//{SVG}svg") is not None
    assert repr(d).startswith("<Driveline")
    assert repr(d.draw()).startswith("<Schematic of")


def test_a_notebook_without_the_packages_shows_tables(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(module: str) -> None:
        raise ImportError(module)

    monkeypatch.setattr(extras, "import_module", missing)
    d = cw.Driveline.load(LAUNCH)
    html = d._repr_html_()
    assert "<table " in html
    assert "<svg" not in html
    assert "halfshaft" in html
    with pytest.raises(ImportError, match=r"clutchwork\[draw\]"):
        d.draw()


def test_a_notebook_shows_a_model_with_mistakes() -> None:
    assert "elsewhere" in broken()._repr_html_()


def test_command_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["draw", str(LAUNCH)]) == 0
    assert Path("model.svg").read_text() == cw.Driveline.load(LAUNCH).draw()._repr_svg_()
    assert main(["draw", str(LAUNCH), "--out", "states.png", "--at", "0.2", "--at", "1.5", "--power"]) == 0
    assert capsys.readouterr().out.split() == [
        "wrote",
        "model.svg",
        "wrote",
        "states_0.2.png",
        "wrote",
        "states_1.5.png",
    ]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["model.svg", "states_0.2.png", "states_1.5.png"]


def test_command_line_says_what_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["draw", str(tmp_path / "none.toml")]) == 4
    assert main(["draw", str(LAUNCH), "--out", str(tmp_path / "a.jpg")]) == 2
    assert main(["draw", str(LAUNCH), "--out", str(tmp_path / "a.svg"), "--at", "-1"]) == 2
    assert ".svg, .png or .pdf" in capsys.readouterr().err

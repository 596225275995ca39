"""Pages: one file each for every example, small, with a policy, names escaped; what cannot be on one is said."""

from __future__ import annotations

import importlib
import json
import re
import subprocess
from base64 import b64decode, b64encode
from gzip import decompress
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.command.main import main
from clutchwork.page import html, static
from clutchwork.page.data import PageRequest, data_of
from support.project import ROOT
from support.transmissions import in_gear

MODELS = sorted((ROOT / "examples").rglob("model.toml"))
NASTY = "</script><img src=x onerror=alert(1)>\"'&<!--"


def braked(name: str = "braked", shaft: str = "disc", pressure: Any = 2e5) -> cw.Driveline:
    """A disc that is braked by a pressure."""
    d = cw.Driveline(name)
    disc = d.shaft(shaft, inertia=1.0, speed=10.0)
    d.add(cw.Brake("b", shaft=disc, friction=cw.Coulomb(static=0.3, kinetic=0.2), gain=1e-4, pressure=pressure))
    return d


def content(text: str) -> dict[str, Any]:
    """The data inside of a page."""
    found = re.search(r'id="data">([^<]*)</script>', text)
    assert found
    made: dict[str, Any] = json.loads(decompress(b64decode(found[1])))
    return made


@pytest.mark.parametrize("model", MODELS, ids=[model.parent.name for model in MODELS])
@pytest.mark.usefixtures("built")
def test_every_example_has_a_page(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "shift.html"
    assert main(["page", str(model), "--out", str(out)]) == 0
    assert capsys.readouterr().out == f"wrote {out}\n"
    text = out.read_text(encoding="utf-8")
    data = content(text)
    assert len(text.encode()) <= html.LONGEST
    assert data["panels"]
    assert data["schematic"]
    assert not re.search(r"https?://(?!www\.w3\.org)", re.sub(r'id="(data|core)">[^<]*', "", text))


@pytest.mark.usefixtures("built")
def test_a_page_runs_nothing_but_its_own_script() -> None:
    run = braked().simulate(1.0)
    text = html.html(data_of(run.system, 1.0, run.options, PageRequest()), "braked")
    (policy,) = re.findall(r'Content-Security-Policy" content="([^"]*)"', text)
    assert policy.startswith("default-src 'none'; script-src 'sha256-")
    assert "unsafe-inline" not in policy
    assert "'unsafe-eval'" not in policy
    for tag in ("script", "style"):
        (body,) = re.findall(rf"<{tag}>(.*?)</{tag}>", text, re.DOTALL)
        assert b64encode(sha256(body.encode()).digest()).decode() in policy
        assert not re.search(r"\beval\(|new Function\(", body)
    assert not re.search(
        r"\son\w+=|javascript:| style=", re.sub(r"<(script|style)[ >].*?</\1>", "", text, flags=re.DOTALL)
    )


@pytest.mark.usefixtures("built")
def test_names_are_words_whatever_they_hold(tmp_path: Path) -> None:
    path = braked(NASTY, f"disc {NASTY}".replace(".", "")).simulate(1.0).page(tmp_path / "x.html")
    text = path.read_text(encoding="utf-8")
    assert "<img" not in text
    assert text.count("<script") == text.count("</script>") == 3
    assert "<img" not in content(text)["schematic"]["svg"]
    assert content(text)["name"] == NASTY


def test_numbers_of_a_table_are_those_that_are_dragged() -> None:
    system = braked(pressure=cw.Table([(0.0, 0.0), (0.5, 2e5)])).assemble()
    data = data_of(system, 1.0, cw.Options(), PageRequest())
    (table,) = data["tables"]
    assert (table["name"], table["unit"], table["points"]) == ("b.pressure", "Pa", [[0.0, 0.0], [0.5, 2e5]])
    assert [slider["name"] for slider in data["sliders"]] == ["b.gain", "b.friction.kinetic", "b.friction.static"]
    assert data["paths"]["b.pressure"] == [["element", 0, "pressure", "points"]]
    assert data["paths"]["b.friction.static"] == [["element", 0, "friction", "static"]]


def test_numbers_of_a_gearbox_have_their_place_in_the_model_file() -> None:
    """What the file does not say is put where it would say it."""
    system = in_gear(cw.Gearbox.load("ford-aode"), "1").assemble()
    paths = data_of(system, 0.5, cw.Options(), PageRequest())["paths"]
    assert paths["gearbox.FWD.pressure"] == [["element", 0, "shift", "FWD", "pressure", "points"]]
    assert paths["gearbox.FWD.gain"] == [["element", 0, "shift", "FWD", "gain"]]


@pytest.mark.parametrize(
    ("pressure", "points"),
    [
        (cw.Ramp(height=2e5, duration=0.4, start=0.1), [[0.0, 0.0], [0.1, 0.0], [0.5, 2e5]]),
        (cw.Step(height=2e5, start=0.1), [[0.0, 0.0], [0.1, 0.0], [0.1, 2e5]]),
        (2e5, [[0.0, 2e5], [1.0, 2e5]]),
    ],
)
def test_what_is_straight_between_knots_is_dragged(pressure: Any, points: Any) -> None:
    data = data_of(braked(pressure=pressure).assemble(), 1.0, cw.Options(), PageRequest(["b.pressure"]))
    found = np.array(data["tables"][0]["points"])
    # the first knot may be before the run
    assert found[:, 1] == pytest.approx([value for _, value in points])
    assert found[1:, 0] == pytest.approx([time for time, _ in points[1:]])


def test_a_column_of_a_file_is_dragged(tmp_path: Path) -> None:
    (tmp_path / "record.csv").write_text("time,p\n0,0\n0.5,2e5\n1,1e5\n", encoding="utf-8")
    column = cw.Column(str(tmp_path / "record.csv"), "p")
    data = data_of(braked(pressure=column).assemble(), 1.0, cw.Options(), PageRequest(["b.pressure"]))
    assert data["tables"][0]["points"] == [[0.0, 0.0], [0.5, 2e5], [1.0, 1e5]]


def test_ends_of_a_slider_have_units() -> None:
    data = data_of(braked().assemble(), 1.0, cw.Options(), PageRequest([], ["b.pressure=1 bar:5 bar", "b.gain"]))
    assert [(one["values"][0], one["values"][-1]) for one in data["sliders"]] == [(1e5, 5e5), (0.5e-4, 2e-4)]


def test_a_page_says_that_python_goes_on() -> None:
    data = data_of(braked().assemble(), 1.0, cw.Options(max_steps=10**6), PageRequest())
    assert data["options"]["max_steps"] == 30_000
    assert ["too_many_steps", "a page ends after 30000 steps", "Python goes on"] in data["statuses"]


def test_a_constant_pressure_has_two_knots() -> None:
    data = data_of(braked().assemble(), 1.0, cw.Options(), PageRequest())
    assert data["tables"][0]["points"] == [[0.0, 2e5], [1.0, 2e5]]


@pytest.mark.parametrize(
    ("wanted", "said"),
    [
        ({"drag": ["b.pressur"]}, "drag: 'b.pressur' cannot be dragged"),
        ({"sliders": ["b.gainn"]}, "slider: .*gainn"),
        ({"sliders": ["b.gain=3:1"]}, "b.gain: '3:1' are not two ends"),
        (
            {"sliders": ["disc.inertia", "disc.inertia=1:2"]},
            "disc.inertia has two sliders, 'disc.inertia' and 'disc.iner",
        ),
        ({"sliders": ["b.*tic, disc.inertia"]}, "different units, .*disc.inertia in kg m2; give a slider for each"),
        ({"sliders": ["*.gainn"]}, "'\\*.gainn' fits no number of this driveline"),
        ({"show": ["nothing.*"]}, "nothing"),
    ],
)
def test_what_cannot_be_on_a_page_is_said(wanted: dict[str, Any], said: str) -> None:
    with pytest.raises((cw.UseError, cw.UnknownName), match=said):
        data_of(braked().assemble(), 1.0, cw.Options(), PageRequest(**wanted))


FEELS = ["Acceleration of the output", "Jerk of the output"]


@pytest.mark.parametrize(
    ("drag", "show", "titles"),
    [
        (None, None, ["Speed", "Slip", "Torque", "Heat", *FEELS]),
        (None, ["disc.speed"], ["Speed", *FEELS]),
        (None, ["disc.jerk", "disc.acceleration"], FEELS),
        ([], None, ["Speed", "Slip", "Torque", "Heat"]),
        ([], ["disc.speed"], ["Speed"]),
        ([], ["disc.jerk"], ["Jerk"]),
        ([], ["disc.acceleration", "disc.jerk"], ["Acceleration", "Jerk"]),
    ],
)
def test_how_the_output_feels_is_there_where_it_is_moved_or_asked_for(drag: Any, show: Any, titles: list[str]) -> None:
    """A pressure is dragged, or nothing is; the jerk over the heat follows the jerk."""
    data = data_of(braked().assemble(), 1.0, cw.Options(), PageRequest(drag, ["b.gain"], show))
    assert [panel["title"] for panel in data["panels"]] == titles
    assert ("disc.jerk" in data["signals"]) == any(title.startswith("Jerk") for title in titles)
    # what is felt follows from the acceleration
    assert "disc.jerk" not in data["signals"] or "disc.acceleration" in data["signals"]


@pytest.mark.usefixtures("built")
@pytest.mark.parametrize("name", ["stick_slip", "hysteresis"])
def test_pages_of_friction_show_no_jerk(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "docs" / "figures")
    live = importlib.import_module("live")
    live.PAGES[name](tmp_path / "x.html")
    data = content((tmp_path / "x.html").read_text(encoding="utf-8"))
    assert data["loops"]
    assert not [signal for signal in data["signals"] if signal.endswith((".jerk", ".acceleration"))]


def test_names_may_have_the_word_of_a_loop() -> None:
    data = data_of(braked(shaft="a over b").assemble(), 1.0, cw.Options(), PageRequest([], [], ["a over b.speed"]))
    assert (data["loops"], data["panels"][0]["names"]) == ([], ["a over b.speed"])
    over = ["b.torque over a over b.speed", "a over b.speed over b.torque"]
    data = data_of(braked(shaft="a over b").assemble(), 1.0, cw.Options(), PageRequest([], [], over))
    assert data["loops"] == [{"y": "b.torque", "x": "a over b.speed"}, {"y": "a over b.speed", "x": "b.torque"}]


def test_a_controller_in_python_has_no_page() -> None:
    from clutchwork.page.knots import refuse_controllers

    system = braked(pressure=cw.Sampled(lambda t, now: 1e5, 0.1)).assemble()
    with pytest.raises(cw.UseError, match="no page can call"):
        refuse_controllers(system)


def test_without_the_built_files_it_says_what_to_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(static, "FOLDER", tmp_path)
    with pytest.raises(static.PageError, match="make wasm page"):
        braked().simulate(1.0).page(tmp_path / "x.html")


@pytest.mark.usefixtures("built")
@pytest.mark.parametrize("given", [str, Path], ids=["str", "Path"])
def test_a_path_may_be_a_string(given: Any, tmp_path: Path) -> None:
    """As the guides write it, also where its folder is not there yet."""
    run, box = braked().simulate(1.0), cw.Gearbox.load("zf-6hp26")
    for door, name in ((run.page, "run"), (box.page, "box")):
        made = door(given(tmp_path / given.__name__ / f"{name}.html"))
        assert made == tmp_path / given.__name__ / f"{name}.html"
        assert made.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_a_path_must_be_one_of_html() -> None:
    with pytest.raises(cw.UseError, match="html"):
        braked().simulate(1.0).page("x.pdf")


def test_the_licence_of_what_is_inside_is_there() -> None:
    command = ["git", "-C", str(ROOT), "ls-files", "interfaces/page/package-lock.json"]
    lock = subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()
    if lock:
        assert "resolved" not in (ROOT / lock).read_text(encoding="utf-8")


@pytest.mark.usefixtures("built")
def test_a_page_without_a_schematic_says_why(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(*_: Any) -> None:
        raise ImportError('pip install "clutchwork[draw]"')

    monkeypatch.setattr("clutchwork.page.data.live", missing)
    with pytest.warns(UserWarning, match=r'the page has no schematic: pip install "clutchwork\[draw\]"'):
        path = braked().simulate(1.0).page(tmp_path / "plain.html")
    assert content(path.read_text(encoding="utf-8"))["schematic"] is None

"""Pages in headless browsers, with real mouse and keys: no error, no request, and the curves follow."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from clutchwork.command.main import main
from clutchwork.page.data import PageRequest
from clutchwork.page.page import page
from clutchwork.run.settings import merged
from support import example_models
from support.amount import seeds
from support.project import ROOT
from support.transmissions import in_gear

MODELS = sorted((ROOT / "examples").rglob("model.toml"))
# of the catalogue; all of them where many cases are asked for
BOXES = ("zf-8hp70", "ford-aode")
# models whose pages a second browser opens: a shift, a launch, one that stops early or never locks
FEW = ("six_speed", "launch")
READY = 10_000.0  # ms, on a machine that does much else; docs/benchmarks.md has times
NASTY = "</script><img src=x onerror=alert(1)>\"'&"


def box_page(name: str, path: Path) -> Path:
    """The page of a gearbox of the catalogue in its first gear."""
    box = cw.Gearbox.load(name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        system = in_gear(box, next(iter(box.ratios)), torque=300.0).assemble()
    path.write_text(page(system, 0.5, cw.Options(), PageRequest()), encoding="utf-8")
    return path


def example_page(name: str, path: Path) -> Path:
    """The page of an example that is a program."""
    system, t_end = example_models.model(name)
    _, options = merged(system.settings, {"t_end": t_end})
    path.write_text(page(system, t_end, options, PageRequest()), encoding="utf-8")
    return path


@pytest.fixture(scope="module", params=["chromium", "firefox"])
def looked(request: pytest.FixtureRequest, browse: Any, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What a browser made of each page, by name."""
    folder = tmp_path_factory.mktemp("pages")
    first = request.param == "chromium"
    models = [model for model in MODELS if first or model.parent.name in FEW]
    files = {model.parent.name: folder / f"{model.parent.name}.html" for model in models}
    for model, path in zip(models, files.values(), strict=True):
        assert main(["page", str(model), "--out", str(path)]) == 0
    programs = [name for name in example_models.MODELS if name not in files] if first else []
    files |= {name: example_page(name, folder / f"{name}.html") for name in programs}
    boxes = cw.catalogue() if first and len(seeds()) > 1000 else BOXES if first else ()
    files |= {name: box_page(name, folder / f"{name}.html") for name in boxes}
    files["nasty"] = nasty(folder / "nasty.html")
    return dict(zip(files, browse("browser.mjs", request.param, *files.values()), strict=True))


def nasty(path: Path) -> Path:
    """A page whose names would be elements and programs if they were not escaped."""
    d = cw.Driveline(NASTY)
    disc = d.shaft(f"disc {NASTY}", inertia=1.0, speed=10.0)
    table = cw.Table([(0.0, 0.0), (0.5, 2e5), (1.0, 2e5)])
    d.add(cw.Brake("b", shaft=disc, friction=cw.Coulomb(static=0.3, kinetic=0.2), gain=1e-4, pressure=table))
    return d.simulate(1.0).page(path)


def test_no_page_has_an_error_or_asks_for_anything(looked: dict[str, Any]) -> None:
    assert {name: one["errors"] for name, one in looked.items() if one["errors"]} == {}
    assert {name: one["requests"] for name, one in looked.items() if one["requests"]} == {}
    assert max(one["ready"] for one in looked.values()) < READY


def test_what_is_dragged_moves_the_curves(looked: dict[str, Any]) -> None:
    for name, one in looked.items():
        before, after, typed = (one[key] for key in ("before", "after", "typed"))
        assert one["dragged"], name
        assert before["knots"] != after["knots"] != typed["knots"], name
        assert after["runs"] > 0, name
        assert before["sum"] != after["sum"] != typed["sum"], name
        assert before["picture"] != after["picture"], name


def test_a_hand_takes_the_nearest_of_knots_that_overlap(looked: dict[str, Any]) -> None:
    taken = [one["taken"] for one in looked.values() if one["taken"]]
    assert taken
    assert [pair for pair in taken if pair[0] != pair[1]] == []


def test_what_is_turned_moves_the_curves(looked: dict[str, Any]) -> None:
    with_sliders = {name: one for name, one in looked.items() if one["turned"]}
    assert len(with_sliders) > len(MODELS) / 2
    for name, one in with_sliders.items():
        assert one["typed"]["sum"] != one["turned"]["sum"], name


def test_knots_are_made_and_taken_away_and_all_is_taken_back(looked: dict[str, Any]) -> None:
    for name, one in looked.items():
        there, more, fewer = one["made"]
        assert (more, fewer) == (there + 1, there), name
        assert one["reset"], name


def test_names_are_shown_as_they_are(looked: dict[str, Any]) -> None:
    assert NASTY in looked["nasty"]["words"]


def test_it_says_what_happens(looked: dict[str, Any]) -> None:
    words = looked["launch"]["words"]
    assert "clutch locks" in words
    assert "Heat of clutch" in words

"""Pages of gearboxes: what they hold, that they are safe, and what is asked for wrongly."""

from __future__ import annotations

import json

import pytest

import clutchwork as cw
from clutchwork.command.main import main
from clutchwork.page import gearbox as pages
from clutchwork.page.static import missing

needs_page = pytest.mark.skipif(bool(missing()), reason="make wasm page was not run here")


@pytest.fixture
def no_pictures(monkeypatch):
    monkeypatch.setattr(pages, "PICTURES", ())


@pytest.mark.parametrize("name", cw.catalogue())
def test_every_gearbox_of_the_catalogue_has_its_numbers(name, no_pictures):
    box = cw.Gearbox.load(name)
    data = pages.gearbox_data(box)
    # JSON has no word for what is not a number
    json.dumps(data, allow_nan=False)
    # a split is shown where a machine stands
    assert dict.fromkeys(gear["name"].partition(",")[0] for gear in data["gears"]) == dict.fromkeys(box.gears)
    for gear in data["gears"]:
        assert gear["name"] not in box.gears or gear["ratio"] == box.ratios[gear["name"]]
        # power in is power out, without losses
        assert gear["speeds"][box.input] == pytest.approx(1.0)
        assert gear["speeds"][box.output] * gear["ratio"] == pytest.approx(1.0)
        assert set(gear["torques"]) <= {element["name"] for element in data["elements"]}


@needs_page
def test_a_page_is_written_by_both_doors(tmp_path, capsys):
    box = cw.Gearbox.load("zf-6hp26")
    made = box.page(tmp_path / "box.html").read_text(encoding="utf-8")
    assert main(["gearbox", "zf-6hp26", "--page", str(tmp_path / "other.html")]) == 0
    assert (tmp_path / "other.html").read_text(encoding="utf-8") == made
    assert "default-src 'none'" in made
    assert 'id="core"' not in made
    assert len(made) < 200_000
    assert set(pages.gearbox_data(box)["gears"][0]["pictures"]) == {"stick", "lever"}


@needs_page
def test_names_of_a_gearbox_are_escaped(tmp_path):
    nasty = "</script><script>alert(1)</script>"
    box = cw.Gearbox.from_dict({**cw.Gearbox.load("zf-6hp26").to_dict(), "title": nasty})
    made = box.page(tmp_path / "box.html").read_text(encoding="utf-8")
    assert "<script>alert" not in made


def test_a_path_that_is_no_page_is_refused(tmp_path):
    with pytest.raises(cw.UseError, match="html"):
        cw.Gearbox.load("zf-6hp26").page(tmp_path / "box.pdf")


def test_signals_over_others_are_drawn_where_both_are_known(tmp_path):
    from clutchwork.page.signals import loops
    from clutchwork.results.channels import channels

    d = cw.Driveline("two")
    a, b = d.shaft("a", inertia=1.0, speed=10.0), d.shaft("b", inertia=1.0)
    law = cw.Coulomb(static=0.12, kinetic=0.1)
    d.add(cw.Clutch("c1", base=a, follower=b, friction=law, gain=1.0, normal_force=10.0))
    known = channels(d.assemble(), True, True)
    assert loops(known, ["c1.torque over c1.slip", "a.speed"]) == [("c1.torque", "c1.slip")]
    with pytest.raises(cw.ClutchworkError, match="did you mean"):
        loops(known, ["c1.torque over c1.slipp"])

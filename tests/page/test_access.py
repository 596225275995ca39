"""Who reads a page by screen reader, keyboard, finger or with weak eyes: names, what is told, sizes, contrasts."""

from __future__ import annotations

import re
from itertools import product
from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from clutchwork.command.main import main
from support.project import ROOT

STYLE = (ROOT / "interfaces" / "page" / "src" / "page.css").read_text(encoding="utf-8")
# what letters stand on what: 4.5 to 1, WCAG 2.2, 1.4.3
LETTERS = [
    *product(("text", "soft"), ("ground", "panel")),
    ("bad", "badground"),
    ("bad", "panel"),
    ("panel", "accent"),
    *product(("ink", "grey", "mass", "heat", "signal", "locked", "wrong"), ("paper",)),
    ("locked", "lockedhalo"),
]
# lines, bars and handles: 3 to 1, WCAG 2.2, 1.4.11
MARKS = [
    *product([f"curve-{i}" for i in range(8)], ("panel",)),
    *product(("locked", "slipping", "open", "accent"), ("panel",)),
]


def palettes() -> dict[str, dict[str, str]]:
    """Colours by name, in light and dark; what the dark does not change is as in light."""
    found = re.findall(r":root \{(.*?)\}", STYLE, re.DOTALL)
    light, dark = (dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6});", block)) for block in found)
    return {"light": light, "dark": {**light, **dark}}


def luminance(colour: str) -> float:
    """Relative luminance of sRGB, WCAG 2.2."""
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def test_contrast_is_that_of_the_standard() -> None:
    assert contrast("#ffffff", "#000000") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.005)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize(("pairs", "least"), [(LETTERS, 4.5), (MARKS, 3.0)], ids=["letters", "marks"])
def test_colours_can_be_told_from_their_ground(scheme: str, pairs: list[tuple[str, str]], least: float) -> None:
    colours = palettes()[scheme]
    weak = {pair: round(found, 2) for pair in pairs if (found := contrast(*(colours[name] for name in pair))) < least}
    assert weak == {}


@pytest.fixture(scope="module")
def looked(browse: Any, tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, Any]]:
    """A shift, and a gearbox."""
    folder: Path = tmp_path_factory.mktemp("access")
    shift, box = folder / "shift.html", folder / "box.html"
    assert main(["page", str(ROOT / "examples" / "six_speed" / "model.toml"), "--out", str(shift)]) == 0
    cw.Gearbox.load("zf-6hp26").page(box)
    found: list[dict[str, Any]] = browse("access.mjs", "chromium", shift, box)
    assert [one["errors"] for one in found] == [[], []]
    return found


def test_every_control_has_a_name_and_every_slider_words(looked: list[dict[str, Any]]) -> None:
    for one in looked:
        assert one["unnamed"] == []
        assert [text for text in one["texts"] if not text] == []
    names = [(control["role"], control["name"]) for control in looked[0]["controls"]]
    assert ("slider", "F1.pressure, knot 1") in names
    assert ("slider", "F1.gain") in names
    assert ("button", "Copy as Python") in names
    assert any(text.endswith(" bar") for text in looked[0]["texts"])


def test_the_keyboard_reaches_every_control_and_is_seen(looked: list[dict[str, Any]]) -> None:
    for one in looked:
        # what scrolls is reached too
        assert len(one["stops"]) >= len(one["controls"])
        assert [stop["what"] for stop in one["stops"] if not stop["ring"]] == []


def test_a_finger_meets_every_control(looked: list[dict[str, Any]]) -> None:
    assert [one["small"] for one in looked] == [[], []]


def test_what_is_moved_is_told_once_and_not_at_every_step(looked: list[dict[str, Any]]) -> None:
    for one in looked:
        typed = one["typed"]
        assert typed["before"] != typed["after"]
        assert typed["during"] == 0
        # one region, or two where a run ends early as well
        assert 1 <= typed["told"] <= 2

"""Pages for people who come from other tools name what is there."""

from __future__ import annotations

import re
from dataclasses import fields, is_dataclass

import pytest

import clutchwork as cw
from support.project import ROOT

PAGES = ["from-simscape", "from-modelica"]
# a cell such as `cw.Torque(..., base=)` or `d.shaft(..., inertia=)`
CALL = re.compile(r"`(cw|d)\.(\w+)(?:\(([^`]*)\))?`")


def calls(page: str) -> list[tuple[str, str, list[str]]]:
    """Owner, name and keywords of all that a page names in running text and tables."""
    text = re.sub(r"```.*?```", "", (ROOT / "docs" / "guide" / f"{page}.md").read_text(), flags=re.DOTALL)
    return [(owner, name, re.findall(r"(\w+)=", inside or "")) for owner, name, inside in CALL.findall(text)]


@pytest.mark.parametrize("page", PAGES)
def test_what_a_page_names_is_there(page: str) -> None:
    found = calls(page)
    assert len(found) > 20
    for owner, name, keywords in found:
        thing = getattr(cw if owner == "cw" else cw.Driveline("d"), name)
        known = [item.name for item in fields(thing)] if is_dataclass(thing) else thing.__kwdefaults__ or {}
        assert set(keywords) <= {*known, *getattr(thing, "__annotations__", {})}, (name, keywords)


def test_the_fields_of_a_disk_clutch() -> None:
    text = (ROOT / "docs" / "guide" / "from-simscape.md").read_text()
    table = text.partition("field by field")[2].partition("## ")[0]
    words = {word for cell in re.findall(r"\| ([^|]*) \|\n", table) for word in re.findall(r"`(\w+)=?[`.\"]?", cell)}
    known = {item.name for item in fields(cw.DiskClutch)}
    named = words & known
    assert {"radius", "surfaces", "area", "derating", "threshold", "pressure", "heat", "thermal_mass"} <= named
    assert words - known <= {"cannot_unlock", "run"}

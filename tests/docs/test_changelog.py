"""The changelog: the version of the package, ten headlines, what breaks; a user can read it."""

from __future__ import annotations

import re

import clutchwork as cw
from support.project import ROOT

TEXT = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
SECTIONS = dict(re.findall(r"^## \[(.+?)\].*?\n(.*?)(?=^## |\Z)", TEXT, re.MULTILINE | re.DOTALL))
PARTS = dict(re.findall(r"^### (.+?)\n(.*?)(?=^### |\Z)", SECTIONS[cw.__version__], re.MULTILINE | re.DOTALL))


def test_the_version_of_the_package_has_ten_headlines_and_what_breaks() -> None:
    assert re.findall(r"^(\d+)\. \*\*", PARTS["Ten headlines"], re.MULTILINE) == [str(n) for n in range(1, 11)]
    rows = PARTS["What breaks, and how to follow"].count("\n| ")
    assert rows > 5


def test_what_is_not_released_is_short() -> None:
    assert next(iter(SECTIONS)) == "Unreleased"
    assert len(SECTIONS["Unreleased"].splitlines()) < 40


def test_names_are_public_and_links_lead_somewhere() -> None:
    named = {*re.findall(r"`cw\.(\w+)`", TEXT), *re.findall(r"`([A-Z]\w+)`", TEXT)}
    assert named - set(cw.__all__) == set()
    links = re.findall(r"\]\(([^)#:]+)\)", TEXT)
    assert [link for link in links if not (ROOT / link).exists()] == []

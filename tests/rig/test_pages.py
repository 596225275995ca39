"""The figures in the guide are those of the rig."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from clutchwork import rig


def test_the_creep_in_the_guide(root: Path) -> None:
    page = (root / "docs" / "guide" / "choose-a-friction-law.md").read_text(encoding="utf-8")
    lines = re.findall(r"^\| `(\w+)` \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", page, re.MULTILINE)
    laws = [law for law, *_ in lines]
    assert len(laws) == 9
    tables = [rig.drift(laws).table, *(rig.drift(laws, preset="second", swing=swing).table for swing in (0.1, 0.3))]
    for law, *cells in lines:
        for cell, table in zip(cells, tables, strict=True):
            # the last digit of a cell is rounded
            digit = 10.0 ** -len(cell.partition(".")[2])
            assert abs(1e6 * table.value(law, "creep")) == pytest.approx(float(cell), abs=max(0.51 * digit, 2e-3)), law


def test_every_experiment_has_its_place_in_the_guide(root: Path) -> None:
    page = (root / "docs" / "guide" / "rig.md").read_text(encoding="utf-8")
    for name in rig.EXPERIMENTS:
        assert f"\n### {name}\n" in page
        assert f"(../pictures/rig/{name}.png)" in page
    for name in rig.PRESETS:
        assert f"| `{name}` |" in page

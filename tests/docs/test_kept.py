"""What the documentation keeps between builds is made anew only when something has changed that it depends on."""

from __future__ import annotations

import sys
from pathlib import Path

from support.project import ROOT

sys.path.append(str(ROOT / "docs" / "figures"))

import kept


def made(name: str, path: Path) -> None:
    """Write a file, longer each time."""
    path.write_text(name + (path.read_text() if path.exists() else ""))


def test_what_has_not_changed_is_kept(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(kept, "each", lambda calls: [call(*given) for call, *given in calls])
    source, paths = tmp_path / "source.py", [tmp_path / "made" / f"{name}.html" for name in "ab"]
    source.write_text("x = 1")
    for _ in range(2):
        kept.write(made, paths, [source])
        assert [path.read_text() for path in paths] == ["a", "b"]
    # what is missing alone
    paths[1].unlink()
    kept.write(made, paths, [source])
    assert [path.read_text() for path in paths] == ["a", "b"]
    source.write_text("x = 2")
    kept.write(made, paths, [source])
    assert [path.read_text() for path in paths] == ["aa", "bb"]


def test_an_error_leaves_nothing_that_counts_as_kept(tmp_path: Path, monkeypatch) -> None:
    def fails(name: str, path: Path) -> None:
        path.write_text(name)
        raise ValueError(name)

    monkeypatch.setattr(kept, "each", lambda calls: [call(*given) for call, *given in calls])
    for _ in range(2):
        try:
            kept.write(fails, [tmp_path / "made" / "a.html"], [])
        except ValueError:
            continue
        raise AssertionError("it was kept")

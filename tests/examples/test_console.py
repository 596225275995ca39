"""Sessions in the guide to the command line: every line is typed, and prints what the page shows."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from clutchwork.command.main import main
from support.project import ROOT

PAGE = ROOT / "docs" / "guide" / "command-line.md"


def sessions() -> list[tuple[str, str]]:
    """Lines that are typed, and what the page shows below each."""
    blocks = re.findall(r"^```console\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    typed = "".join(blocks)
    return re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", typed, re.MULTILINE)


def as_shown(shown: str, printed: str) -> bool:
    """Whether a page shows what is printed; dots stand for anything."""
    parts = [re.escape(part) for part in shown.split("...")]
    return re.fullmatch(".*".join(parts), printed, re.DOTALL) is not None


def test_the_guide_shows_what_is_printed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("matplotlib").use("agg")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    lines = sessions()
    assert len(lines) > 15
    for line, shown in lines:
        words = shlex.split(line)
        assert words[0] == "clutchwork"
        code = main(words[1:])
        told = capsys.readouterr()
        assert as_shown(shown, told.out + told.err), f"$ {line}\n{told.out}{told.err}"
        assert bool(code) == ("clutchwork: " in shown), line
    heads = re.search(r"^```text\n(time .*)\n```", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert heads
    assert Path("out.csv").read_text().startswith(f"{heads[1]}\n")
    assert len(Path("out.csv").read_text().splitlines()) >= 6

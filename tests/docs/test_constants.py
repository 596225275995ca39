"""Limits and exit codes on the pages are those of the code."""

from __future__ import annotations

import re

import pytest

from clutchwork.base import archive
from clutchwork.command import main
from clutchwork.command.main import EXIT_CODES
from clutchwork.files import model_file
from clutchwork.model.problems import LONGEST_NAME
from clutchwork.model.temperatures import COLDEST
from clutchwork.signals.bases import column_file
from support.pages import page, plain, table
from support.project import ROOT

MODEL_FILES = page("guide/model-files.md")
SENTENCES = {
    "model files": (MODEL_FILES, f"{model_file.MOST_BYTES / 1e6:g} MB for a model file"),
    "CSV files": (MODEL_FILES, f"{column_file.MOST_BYTES / 1e6:g} MB and two million lines for a CSV file"),
    "archives": (MODEL_FILES, f"{archive.MOST_BYTES / 1e6:g} MB packed and unpacked"),
    "names": (MODEL_FILES, f"of at most {LONGEST_NAME} characters"),
    "temperatures": (MODEL_FILES, f"temperature below {COLDEST:g} K"),
    "temperatures in the changelog": ((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), f"below {COLDEST:g} K"),
    "interrupts": (page("guide/results.md"), f"exits with {main.INTERRUPTED}"),
    "early ends": (page("guide/results.md"), f"the exit code is {main.STOPPED}"),
}


@pytest.mark.parametrize("name", SENTENCES)
def test_a_limit_is_that_of_the_code(name: str) -> None:
    text, words = SENTENCES[name]
    assert words in re.sub(r"\[(.*?)\]\(.*?\)", r"\1", plain(text))


def test_lines_of_a_csv_file() -> None:
    assert column_file.MOST_LINES == 2_000_000


def test_exit_codes() -> None:
    for text in (MODEL_FILES, page("guide/command-line.md")):
        assert {int(code): words for code, words in table(text, "exit code")} == EXIT_CODES


def test_the_speed_that_the_readme_claims_is_measured() -> None:
    """Simulating a gear shift takes a fraction of a millisecond."""
    assert "Simulating a gear shift takes a fraction of a millisecond" in plain(
        (ROOT / "README.md").read_text(encoding="utf-8")
    )
    (shift,) = [row[1] for row in table(page("benchmarks.md"), "what") if row[0].startswith("shift: Rodas5P, core")]
    assert float(shift.partition(" us")[0]) < 500.0

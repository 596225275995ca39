"""Help of the command line: of every command with examples that are right, what is said of misspelt words."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from clutchwork.base.shell import DONE, EXIT_CODES, USAGE, paragraphs
from clutchwork.command.main import main, parser
from support.project import ROOT
from support.shell import commands, options


def said(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> tuple[Any, str, str]:
    """Exit code, output and errors of a command line."""
    try:
        code: Any = main(arguments)
    except SystemExit as stop:
        code = stop.code
    told = capsys.readouterr()
    return code, told.out, told.err


def test_without_arguments_it_prints_its_help(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = said([], capsys)
    assert (code, err) == (DONE, "")
    assert all(name in out for name in commands())
    assert all(str(code) in out.partition("Exit codes: ")[2] for code in EXIT_CODES)


@pytest.mark.parametrize("name", commands())
def test_every_help_has_examples_that_are_right(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = said([name, "--help"], capsys)
    assert (code, err) == (DONE, "")
    examples = re.findall(r"^  (clutchwork .*)$", out.partition("examples:\n")[2], re.MULTILINE)
    assert examples
    for line in examples:
        words = shlex.split(line.partition(" > ")[0], comments=True)
        _, unknown = parser().parse_known_args(words[1:])
        assert unknown == [], line


def test_help_is_found_as_in_other_programs(capsys: pytest.CaptureFixture[str]) -> None:
    assert said(["help"], capsys)[:2] == (DONE, said([], capsys)[1])
    assert said(["help", "run"], capsys) == said(["run", "--help"], capsys)
    assert said(["help", "rnu"], capsys) == said(["rnu"], capsys)


@pytest.mark.parametrize("name", commands())
def test_every_argument_is_explained(name: str) -> None:
    for option in options(name):
        assert option.help, option.dest
        assert option.help[0].islower() or option.help.startswith("CSV"), option.help


@pytest.mark.parametrize("columns", ["60", "80", "300"])
def test_help_fits_the_terminal(
    columns: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", columns)
    for line in said(["elements"], capsys)[1].splitlines():
        assert len(line) <= min(int(columns), 120)
    # examples stay as they are, to be copied
    text = said(["run", "--help"], capsys)[1].partition("examples:")[0]
    assert max(len(line) for line in text.splitlines()) <= min(int(columns), 120)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["rnu"], "command 'rnu' is unknown; did you mean 'run'?"),
        (["run"], "required: model"),
        (["run", "m.toml", "--methd", "x"], "no option --methd; did you mean '--method'?"),
        (["run", "m.toml", "--method", "dopri"], "--method 'dopri' is unknown; did you mean 'dopri5'?"),
        (["run", "m.toml", "more"], "too many arguments: more"),
        (["run", "m.toml", "--t-end", "3 foo"], "argument --t-end: "),
        (["completion", "ksh"], "shell 'ksh' is unknown"),
        (["new", "--kind", "gear"], "--kind 'gear' is unknown; did you mean 'gearbox'?"),
        (["sweep", "m.toml", "--varry", "x"], "no option --varry; did you mean '--vary'?"),
        (["--versoin"], "no option --versoin; did you mean '--version'?"),
    ],
)
def test_misspelt_words(arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = said(arguments, capsys)
    assert (code, out) == (USAGE, "")
    assert words in err
    assert "help, with examples: clutchwork" in err
    assert "usage:" not in err


def test_outputs_of_a_sweep_are_explained_as_they_are_written(capsys: pytest.CaptureFixture[str]) -> None:
    text = re.sub(r"\s+", " ", said(["sweep", "--help"], capsys)[1])
    assert "at(SIGNAL, INSTANT[, INSTANT ...])" in text
    assert "lock(CONTACT[, NUMBER])" in text


def test_paragraphs_leave_lines_that_begin_with_spaces() -> None:
    assert paragraphs("a b c d\n\n  kept as it is", 5) == "a b c\nd\n\n  kept as it is"


def test_a_short_output_that_nobody_reads_ends_quietly() -> None:
    command = [sys.executable, "-m", "clutchwork", "units"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as run:
        assert run.stdout is not None
        run.stdout.close()
        assert run.stderr is not None
        assert run.stderr.read() == b""
        assert run.wait() == 0


def test_the_guide_names_every_command_and_option() -> None:
    text = (ROOT / "docs" / "guide" / "command-line.md").read_text(encoding="utf-8")
    missing = [name for name in commands() if f"clutchwork {name}" not in text]
    # options of a run have a page of their own
    from clutchwork.declare.options import SIMULATION

    own = {
        name: [flag for one in options(name) for flag in one.option_strings if flag.startswith("--")]
        for name in commands()
    }
    of_runs = {f"--{name.replace('_', '-')}" for name in SIMULATION} | {"--no-angles", "--no-work", "--help"}
    missing += [
        f"{name} {flag}"
        for name, flags in own.items()
        for flag in flags
        if flag not in of_runs and f"`{flag}" not in text
    ]
    assert missing == []


def test_the_page_of_the_reference_has_every_command(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "tools")
    monkeypatch.setenv("COLUMNS", "100")
    import gen_lists

    page = "\n".join(gen_lists.commands())
    assert re.findall(r"^## clutchwork (\w+)$", page, re.MULTILINE) == commands()


def test_no_colour_is_printed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for line in ([], ["run", "--help"], ["elements", "clutch"], ["nothing"]):
        _, out, err = said(line, capsys)
        assert "\x1b" not in out + err

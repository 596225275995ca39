"""Completion in a shell: the script is run by bash, which is asked what follows a beginning."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from clutchwork.command.completion import SHELLS
from clutchwork.command.main import main
from clutchwork.command.new import KINDS
from clutchwork.command.reference import kinds
from support.shell import commands

shtab = pytest.importorskip("shtab")


@pytest.fixture(scope="module")
def script(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The script for bash."""
    import contextlib
    import io

    with contextlib.redirect_stdout(io.StringIO()) as out:
        assert main(["completion", "bash"]) == 0
    path = tmp_path_factory.mktemp("bash") / "clutchwork.bash"
    path.write_text(out.getvalue())
    return path


def completed(script: Path, line: str, folder: Path) -> set[str]:
    """What bash offers at the end of a line."""
    bash = shutil.which("bash")
    assert bash
    ask = (
        f'source {script}; COMP_WORDS=({line}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); COMP_LINE="{line}"; '
        "COMP_POINT=${#COMP_LINE}; f=$(complete -p clutchwork | sed 's/.*-F \\([^ ]*\\).*/\\1/'); "
        '$f clutchwork "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD-1]}"; printf "%s\\n" "${COMPREPLY[@]}"'
    )
    run = subprocess.run([bash, "--norc", "-c", ask], capture_output=True, text=True, check=True, cwd=folder)
    return {word.strip() for word in run.stdout.split("\n") if word.strip()}


def test_bash_completes_commands_options_files_and_names(script: Path, tmp_path: Path) -> None:
    (tmp_path / "model.toml").touch()
    assert completed(script, "clutchwork ''", tmp_path) >= set(commands())
    assert completed(script, "clutchwork ru", tmp_path) == {"run"}
    assert {"--set", "--signals", "--max-step"} <= completed(script, "clutchwork run --", tmp_path)
    assert "model.toml" in completed(script, "clutchwork run mod", tmp_path)
    assert completed(script, "clutchwork new --kind ''", tmp_path) == set(KINDS)
    assert completed(script, "clutchwork run model.toml --method ''", tmp_path) == {
        "auto",
        "rodas5p",
        "dopri5",
        "fixed",
    }
    offered = completed(script, "clutchwork elements disk_", tmp_path)
    assert offered == {kind for kind in kinds("elements") if kind.startswith("disk_")}


@pytest.mark.parametrize("shell", SHELLS)
def test_every_shell_that_is_named_has_a_script(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", shell]) == 0
    out = capsys.readouterr().out
    assert all(name in out for name in commands())


def test_without_shtab_it_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "shtab", None)
    assert main(["completion", "bash"]) == 4
    assert 'completion needs shtab: pip install "clutchwork[completion]"' in capsys.readouterr().err


def test_an_old_shtab_that_does_not_know_the_shell(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(shtab, "SUPPORTED_SHELLS", ["bash", "zsh", "tcsh"])
    assert main(["completion", "fish"]) == 4
    assert "pip install --upgrade shtab" in capsys.readouterr().err

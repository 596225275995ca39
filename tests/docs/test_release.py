"""What the release builds, tries and publishes: workflow, pyproject.toml and README say the same."""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

import clutchwork as cw
from support.pages import plain
from support.project import ROOT

sys.path.append(str(ROOT / "tools"))
import try_installed
import try_release

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
WHEELS = PROJECT["tool"]["cibuildwheel"]
README = (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.fixture
def jobs() -> dict[str, Any]:
    """The jobs of the workflow."""
    return yaml.safe_load((ROOT / ".github/workflows/release.yml").read_text(encoding="utf-8"))["jobs"]


def test_wheels_are_built_for_every_python_that_is_promised() -> None:
    built = [int(minor) for minor in re.findall(r"cp3(\d+)-\*", WHEELS["build"])]
    assert built == list(range(built[0], built[-1] + 1))
    assert PROJECT["project"]["requires-python"] == f">=3.{built[0]}"
    assert f"wheels for Linux, macOS and Windows and Python 3.{built[0]} to 3.{built[-1]}" in plain(README)


def test_wheels_are_built_for_every_system_that_is_promised(jobs: dict[str, Any]) -> None:
    names = {row["name"]: row["os"] for row in jobs["wheels"]["strategy"]["matrix"]["include"]}
    assert set(names) == {"linux-x86_64", "linux-aarch64", "macos-x86_64", "macos-arm64", "windows-x86_64"}
    assert all({"linux": "ubuntu"}.get(name.split("-")[0], name.split("-")[0]) in os for name, os in names.items())
    classifiers = " ".join(PROJECT["project"]["classifiers"])
    assert all(system in classifiers for system in ("Linux", "MacOS", "Windows"))


def test_the_core_is_not_given_to_a_compiler_that_it_refuses() -> None:
    told = re.search(r"set (CMAKE_\w+)=(\w+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))
    assert told
    assert WHEELS["windows"]["environment"][told[1]] == told[2]


def test_libraries_of_fmus_for_all_platforms_are_in_every_wheel(jobs: dict[str, Any]) -> None:
    """Built once, by the command of the guide, before wheels and sdist."""
    assert {"run": "make fmu-libraries"} in jobs["fmu-libraries"]["steps"]
    where = next(step["with"]["path"] for step in jobs["fmu-libraries"]["steps"] if "upload" in step.get("uses", ""))
    for job in ("wheels", "sdist"):
        assert "fmu-libraries" in jobs[job]["needs"]
        assert {"name": "fmu-libraries", "path": where} in [step.get("with") for step in jobs[job]["steps"]]
    assert f"{where}/*" in PROJECT["tool"]["scikit-build"]["sdist"]["include"]
    assert f"/{where}/" in (ROOT / ".gitignore").read_text(encoding="utf-8")


def test_every_wheel_and_the_sdist_are_tried(jobs: dict[str, Any]) -> None:
    command = WHEELS["test-command"].split()
    assert command == ["python", "{project}/tools/try_installed.py"]
    assert WHEELS["test-extras"] == ["draw"]
    assert "tools/try_installed.py" in str(jobs["sdist"])
    assert "[draw]" in str(jobs["sdist"])
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    # by name from an index, with the line of the README, and the same programs then
    assert "tools/try_release.py build/wheel/good/*.whl" in makefile
    assert try_release.install_line(README) == ["install", "clutchwork[draw]"]
    assert 'pip install --find-links dist "clutchwork[draw]"' in README
    with pytest.raises(SystemExit, match="no line"):
        try_release.install_line("# clutchwork")


def test_the_version_stands_in_one_place() -> None:
    packed = [ROOT / name for name in ("pyproject.toml", "CMakeLists.txt", "README.md", "Makefile")]
    packed += [*(ROOT / "src").rglob("*.py"), *(ROOT / "interfaces").glob("*/package.json")]
    version = f'"{cw.__version__}"'
    assert [path.name for path in packed if version in path.read_text(encoding="utf-8")] == ["__init__.py"]


def test_files_are_laid_out_as_an_index(tmp_path: Path) -> None:
    (tmp_path / "files").mkdir()
    for name in ("clutchwork-0.1.0-cp311-cp311-linux_x86_64.whl", "python_dateutil-2.9.0-py2.py3-none-any.whl"):
        (tmp_path / "files" / name).write_bytes(b"")
    try_release.index(tmp_path / "files", tmp_path / "simple")
    assert sorted(path.name for path in (tmp_path / "simple").iterdir()) == ["clutchwork", "python-dateutil"]
    page = (tmp_path / "simple" / "python-dateutil" / "index.html").read_text("utf-8")
    assert '<a href="python_dateutil-2.9.0-py2.py3-none-any.whl">' in page


def test_only_a_tag_whose_files_are_all_built_is_published(jobs: dict[str, Any]) -> None:
    publish = jobs["publish"]
    assert set(publish["needs"]) == {"wheels", "sdist"}
    assert publish["if"] == "startsWith(github.ref, 'refs/tags/v')"
    # trusted publishing: a token of the job, no secret
    assert publish["permissions"] == {"id-token": "write"}
    assert "secrets." not in str(jobs)


def test_what_is_tried_is_the_program_of_the_readme() -> None:
    program = try_installed.first_program(README)
    assert program.startswith("import clutchwork as cw")
    assert 'path="shift.png"' in program
    assert "shift.png" in try_installed.WRITTEN
    with pytest.raises(SystemExit, match="no first program"):
        try_installed.first_program("# clutchwork")


def test_a_wheel_holds_what_pages_are_made_of() -> None:
    from clutchwork.page import static

    # git ignores them; a wheel has them by this line, and the program that tries it makes pages of both kinds
    assert f"{static.FOLDER.relative_to(ROOT).as_posix()}/*" in PROJECT["tool"]["scikit-build"]["sdist"]["include"]
    assert {"shift.html", "gearbox.html"} <= set(try_installed.WRITTEN)
    assert all(f"static.{name}" in try_installed.STATIC for name in ("CORE", "SCRIPT", "GEARBOX", "WIDGET", "STYLE"))
    # `make wheel` builds them first
    rule = re.search(r"^wheel: (.*)$", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)
    assert rule is not None
    assert {"$(WASM)", "build/page/stamp"} <= set(rule[1].split())


def test_it_is_tried_without_compiler_and_without_the_checkout(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(ROOT / "src"))
    used = try_installed.environment()
    assert "PYTHONPATH" not in used
    assert not [name for name in ("c++", "g++", "cc", "cmake.exe") if (Path(used["PATH"]) / name).exists()]

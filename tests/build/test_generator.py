"""What the registry generator and the compiler refuse, each with a message that names the file."""

from __future__ import annotations

from pathlib import Path

import pytest

from support import project

ELEMENTS, LAWS = "src/clutchwork/elements", "src/clutchwork/laws"
HEADERS = "cpp/include/clutchwork"


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    return project.copy(tmp_path)


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text, f"{path} has changed: the test has to follow"
    path.write_text(text.replace(old, new, 1))


def refused_by_generator(copy: Path, *words: str) -> None:
    result = project.generate(copy)
    assert result.returncode != 0
    for word in words:
        assert word in result.stderr


def refused_by_compiler(copy: Path, *words: str) -> None:
    result = project.generate(copy)
    assert result.returncode == 0, result.stderr
    result = project.compile_registry(copy)
    assert result.returncode != 0
    for word in words:
        assert word in result.stderr


def test_the_untouched_project_passes(copy: Path) -> None:
    assert project.generate(copy).returncode == 0
    result = project.compile_registry(copy)
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize("stem", ["elements/damper", "laws/coulomb"])
def test_missing_header(copy: Path, stem: str) -> None:
    (copy / f"{HEADERS}/{stem}.hpp").unlink()
    refused_by_generator(copy, f"src/clutchwork/{stem}.py", f"{HEADERS}/{stem}.hpp")


@pytest.mark.parametrize("stem", ["elements/quadratic_torque", "laws/exponential"])
def test_missing_declaration(copy: Path, stem: str) -> None:
    (copy / f"src/clutchwork/{stem}.py").unlink()
    refused_by_generator(copy, f"{HEADERS}/{stem}.hpp", f"src/clutchwork/{stem}.py")


def test_other_unit_in_the_header(copy: Path) -> None:
    edit(copy / f"{HEADERS}/elements/damper.hpp", "[N m s/rad]", "[N mm s/rad]")
    refused_by_generator(copy, "damper.hpp", "damping", "N mm s/rad")


def test_swapped_parameters(copy: Path) -> None:
    header = copy / f"{HEADERS}/laws/exponential.hpp"
    lines = header.read_text().splitlines(keepends=True)
    slow, fast = (next(i for i, line in enumerate(lines) if f" {name};" in line) for name in ("slow", "fast"))
    lines[slow], lines[fast] = lines[fast], lines[slow]
    header.write_text("".join(lines))
    refused_by_compiler(copy, "exponential.hpp", "slow", f"{LAWS}/exponential.py")


def test_renamed_parameter(copy: Path) -> None:
    header = copy / f"{HEADERS}/elements/damper.hpp"
    header.write_text(header.read_text().replace("damping", "dumping"))
    refused_by_compiler(copy, "damping")


def test_parameter_that_the_declaration_does_not_have(copy: Path) -> None:
    edit(copy / f"{HEADERS}/elements/damper.hpp", "    T damping;", "    T damping;\n    T extra;\n    //")
    refused_by_compiler(copy, "damper.hpp", "does not declare")


def test_parameter_that_the_header_does_not_have(copy: Path) -> None:
    path = copy / f"{ELEMENTS}/damper.py"
    path.write_text(path.read_text() + '    extra: float = param("1", "nothing")\n')
    refused_by_compiler(copy, "extra")


def test_missing_function(copy: Path) -> None:
    header = copy / f"{HEADERS}/laws/coulomb.hpp"
    header.write_text(header.read_text().replace("slide(", "glide("))
    refused_by_compiler(copy, "coulomb.hpp", "FrictionLaw")


def test_other_number_of_states(copy: Path) -> None:
    edit(copy / f"{HEADERS}/elements/damper.hpp", "states = 0", "states = 1")
    refused_by_compiler(copy, "damper.hpp", "states")


def test_an_edited_declaration_changes_the_hash(copy: Path) -> None:
    """A compiled core that is older than the declarations is recognised."""
    header = copy / "gen/registry.gen.hpp"
    project.generate(copy)
    before = next(line for line in header.read_text().splitlines() if "schema_hash =" in line)
    path = copy / f"{ELEMENTS}/damper.py"
    path.write_text(path.read_text().replace("damping: float", "dumping: float"))
    project.generate(copy)
    after = next(line for line in header.read_text().splitlines() if "schema_hash =" in line)
    assert before != after


def test_generated_files_are_not_in_the_repository() -> None:
    import subprocess

    listed = subprocess.run(["git", "ls-files"], cwd=project.ROOT, capture_output=True, text=True, check=False)
    # outside a repository, as in an unpacked archive, nothing is listed
    assert not [name for name in listed.stdout.splitlines() if ".gen." in name]

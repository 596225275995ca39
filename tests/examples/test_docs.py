"""Documentation is run: every Python block in order, every model file, every link and every cited equation."""

from __future__ import annotations

import importlib
import re
import shutil
import sys
from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw

ROOT = Path(__file__).resolve().parents[2]
GUIDE = sorted((ROOT / "docs" / "guide").glob("*.md"))
THEORY = sorted((ROOT / "docs" / "theory").glob("*.md"))
SOURCES = [
    path
    for folder in ("src", "cpp", "tests", "interfaces")
    for path in (ROOT / folder).rglob("*")
    if path.is_file() and not {"node_modules", "static"} & set(path.parts)
]


def blocks(path: Path, language: str) -> list[str]:
    """The fenced blocks of a page in one language."""
    return re.findall(rf"^```{language}\n(.*?)^```", path.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


def named(path: Path) -> str:
    """Path below the root, as the name of a test."""
    return str(path.relative_to(ROOT))


@pytest.fixture
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with the examples alone, as the root of a clone has them, and pictures without a screen."""
    pytest.importorskip("matplotlib").use("agg")
    shutil.copytree(ROOT / "examples", tmp_path / "examples", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.chdir(tmp_path)
    # pages may add folders of examples
    monkeypatch.setattr(sys, "path", list(sys.path))
    return tmp_path


def run_blocks(path: Path) -> dict[str, Any]:
    """Run the Python blocks of a page one after the other and return what they define."""
    names: dict[str, Any] = {}
    for number, source in enumerate(blocks(path, "python"), 1):
        exec(compile(source, f"{path.name}, block {number}", "exec"), names)
    return names


def test_the_program_in_the_readme(elsewhere: Path) -> None:
    page = ROOT / "README.md"
    (source,) = blocks(page, "python")
    assert len(source.replace("\n\n", "\n").splitlines()) <= 12
    run = run_blocks(page)["run"]
    assert [(event.element, event.after) for event in run.events] == [("box.C", "backward"), ("box.D", "locked")]
    first, last = (event.time for event in run.events)
    assert f"C breaks away at {first:.3f} s and D locks at {last:.3f} s" in page.read_text(encoding="utf-8")
    # fourth gear
    ratio = run["turbine.speed"][-1] / run["wheels.speed"][-1]
    assert ratio == pytest.approx(cw.Gearbox.load("zf-8hp70").ratios["4"], rel=1e-9)
    assert (elsewhere / "shift.png").stat().st_size > 1000


def test_the_program_of_the_first_page(elsewhere: Path) -> None:
    run = run_blocks(ROOT / "docs" / "index.md")["run"]
    # 1 N m s of impulse while the pressure rises, 16 N m s are needed at 0.16 kg m2 and 100 rad/s
    assert run.events[-1].time == pytest.approx(0.2 + 15.0 / 10.0, abs=1e-6)
    assert run["load.speed"][-1] == pytest.approx(20.0, rel=1e-6)
    assert run["c1.heat"][-1] == pytest.approx(800.0, rel=1e-5)
    assert (elsewhere / "engagement.png").stat().st_size > 1000


# what stories do with the results of their programs is more
STORIES = re.findall(
    r'told\("([\w-]+)"\)', (ROOT / "tests" / "examples" / "test_stories.py").read_text(encoding="utf-8")
)


@pytest.mark.always
@pytest.mark.parametrize("path", [p for p in GUIDE if blocks(p, "python") and p.stem not in STORIES], ids=named)
def test_the_programs_of_the_guide(path: Path, elsewhere: Path) -> None:
    run_blocks(path)


def test_the_model_files_of_the_guide(elsewhere: Path) -> None:
    page = ROOT / "docs" / "guide" / "model-files.md"
    (elsewhere / "pressures.csv").write_text("time,c1\n0.0,0.0\n1.0,2e5\n")
    models = [text for text in blocks(page, "toml") if "[[shaft]]" in text]
    assert models
    for number, text in enumerate(models):
        (elsewhere / f"model{number}.toml").write_text(text)
        driveline = cw.Driveline.load(elsewhere / f"model{number}.toml")
        assert driveline.check() == []
        assert driveline.simulate(0.1).status == "done"


def test_every_option_has_a_line_on_its_page(monkeypatch: pytest.MonkeyPatch) -> None:
    from clutchwork.declare.options import SIMULATION

    monkeypatch.syspath_prepend(ROOT / "tools")
    lines = importlib.import_module("option_page").page().split("\n")
    for name, row in SIMULATION.items():
        (line,) = (line for line in lines if line.startswith(f"| `{name}` | {row.unit.strip()} |"))
        assert row.spec.doc in line
        assert line.count(" | ") == 5
    assert "declare/options.py)" in (ROOT / "docs" / "index.md").read_text(encoding="utf-8")


def test_every_hook_is_explained() -> None:
    from clutchwork.declare.hooks import HOOKS

    page = (ROOT / "docs" / "extend.md").read_text(encoding="utf-8")
    names = [name for hook in HOOKS for name in hook.names]
    assert [name for name in names if f'"{name}"' not in page and f"`{name}`" not in page] == []


def labels(path: Path) -> list[str]:
    """Labels of the numbered equations of a page, in order."""
    return re.findall(r"^ *\$\$ \(([a-z-]+-\d+)\)$", path.read_text(encoding="utf-8"), re.MULTILINE)


@pytest.mark.parametrize("path", [path for path in THEORY if path.stem != "index"], ids=named)
def test_labels_of_equations_are_their_numbers(path: Path) -> None:
    assert labels(path) == [f"{path.stem}-{number}" for number in range(1, len(labels(path)) + 1)]


def test_cited_equations_exist() -> None:
    known = {path.name: len(labels(path)) for path in THEORY}
    missing = []
    for path in SOURCES:
        if path.suffix not in {".py", ".hpp", ".cpp", ".h"}:
            continue
        text = path.read_text(encoding="utf-8")
        for page, numbers in re.findall(r"docs/theory/([\w-]+\.md)(?:[ ,]*\(([\d, ]+)\))?", text):
            cited = [int(number) for number in re.findall(r"\d+", numbers)]
            if page not in known or any(number > known[page] for number in cited):
                missing.append(f"{path.name}: {page} {numbers}")
    assert missing == []


@pytest.mark.parametrize("name", ["contacts.md", "events.md"])
def test_every_rule_has_its_number_and_the_code_that_follows_it(name: str) -> None:
    text = (ROOT / "docs" / "theory" / name).read_text(encoding="utf-8")
    rules = [int(number) for number in re.findall(r"^\*\*Rule (\d+)\.\*\*", text, re.MULTILINE)]
    assert rules == list(range(1, len(rules) + 1))
    core = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "cpp").rglob("*.hpp"))
    cited = re.findall(rf"docs/theory/{re.escape(name)}, rules? ([\d, ]+)", core)
    assert {int(number) for numbers in cited for number in re.findall(r"\d+", numbers)} == set(rules)


def test_contributing_lists_the_rooms_that_are_enforced(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "tools")
    import rooms

    floors, text = rooms.floors(), rooms.PAGE.read_text(encoding="utf-8")
    assert sum(map(len, floors)) == len(re.findall(r"^ {6}\w+/ +\d+  \w", text, re.MULTILINE)) > 20
    assert rooms.page() == text, "run make format"


def test_the_rooms_that_contributing_names_are_there() -> None:
    page = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    rooms = page.partition("## Find the room")[2].partition("\n## House rules")[0]
    roots = (ROOT, ROOT / "src" / "clutchwork", ROOT / "cpp" / "include" / "clutchwork")
    paths = re.findall(r"`([\w./]+/(?:[\w.]+)?)`", rooms)
    assert len(paths) > 15
    assert [path for path in paths if not any((root / path).exists() for root in roots)] == []
    # `NAME` of `path`: what it names stands there
    named_in = re.findall(r"`(\w+)` of `([\w./]+)`", rooms)
    texts = {
        path: next(r / path for r in roots if (r / path).exists()).read_text(encoding="utf-8") for _, path in named_in
    }
    assert [name for name, path in named_in if not re.search(rf"\b{name}\b", texts[path])] == []
    assert {"Guards", "CAUSES", "ROW", "METHODS", "Options"} <= {name for name, _ in named_in}

"""Tiers of tests: the rules by small cases; the first tier touches every element, law, door, guide and reference."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from clutchwork.declare.schema import Role
from support import cases, samples, tiers
from support.amount import amount
from support.pages import code, page, table
from support.project import ROOT
from support.tiers import Case, first_tier

TESTS = ROOT / "tests"
SLOW = 2.0 * tiers.HELD


@pytest.fixture(scope="module")
def first(request: pytest.FixtureRequest) -> list[str]:
    """Names of all cases of the first tier, of a run of all tests."""
    if [Path(path).resolve() for path in request.config.args] != [TESTS]:
        pytest.skip("asks for a run of all folders")
    collected = request.config.stash[tiers.COLLECTED]
    return sorted(tiers.first_tier(collected, tiers.measured()))


def test_what_is_quick_or_new_is_in_the_first_tier() -> None:
    found = first_tier([Case("a::x[1]"), Case("a::x[2]"), Case("a::new")], {"a::x[1]": 0.4, "a::x[2]": 0.6})
    assert found == {"a::x[1]", "a::new"}


def test_of_a_test_without_a_quick_case_the_cheapest_is_there() -> None:
    some = [Case("a::x[1]"), Case("a::x[2]"), Case("a::builds")]
    assert first_tier(some, {"a::x[1]": 0.9, "a::x[2]": 0.8, "a::builds": SLOW}) == {"a::x[2]"}


def test_of_seeds_and_samples_a_part_is_there_spread_evenly_and_two_at_least() -> None:
    for count, wanted in ((20, (0, 4, 8, 12, 16)), (5, (0, 2)), (1, (0,))):
        some = [Case(f"a::x[{seed}]", part_of="a::x") for seed in range(count)]
        assert first_tier(some, {}) == {f"a::x[{seed}]" for seed in wanted}


def test_a_random_test_is_there_with_a_part_of_its_cases() -> None:
    some = [Case("a::x", random=True), Case("a::y", random=True), Case("a::z", always=True)]
    most = tiers.DRAWN * tiers.PART
    assert first_tier(some, {"a::x": 0.9 * most, "a::y": 1.1 * most, "a::z": most}) == {"a::x", "a::z"}


def test_random_cases_are_thinned_in_the_first_tier_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CLUTCHWORK_CASES", raising=False)
    found = []
    for tier in tiers.TIERS:
        monkeypatch.setenv("CLUTCHWORK_TIER", tier)
        found.append(amount(300))
    assert found == [75, 300, 300]
    monkeypatch.setenv("CLUTCHWORK_CASES", "20000")
    assert amount(300) == 20_000


def _draws(path: Path) -> Iterator[tuple[ast.FunctionDef, bool]]:
    """Test functions of a file that draw random cases, and whether they are marked."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    numbers = [ast.unparse(node.targets[0]) for node in tree.body if isinstance(node, ast.Assign) and _counts(node)]
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
            words = [ast.unparse(item) for item in node.decorator_list]
            inside = ast.Module(body=node.body, type_ignores=[])
            names = {item.id for item in ast.walk(inside) if isinstance(item, ast.Name)}
            if _counts(inside) or names & set(numbers):
                yield node, any(word.startswith(("pytest.mark.random", "given")) for word in words)


def _counts(tree: ast.AST) -> bool:
    calls = (node.func for node in ast.walk(tree) if isinstance(node, ast.Call))
    return any(isinstance(name, ast.Name) and name.id in ("amount", "part") for name in calls)


def test_what_draws_random_cases_says_so() -> None:
    """The last tier would leave out most of them otherwise."""
    users = [path for path in TESTS.rglob("test_*.py") if "support.amount" in path.read_text(encoding="utf-8")]
    assert len(users) > 30
    here = Path(__file__).name
    unmarked = [
        f"{path.name}: {test.name}" for path in users if path.name != here for test, said in _draws(path) if not said
    ]
    assert unmarked == []


def test_what_was_measured_is_there() -> None:
    """`pytest --measure` drops what is gone from the files that it runs."""
    tests = {name.partition("[")[0] for name in tiers.measured()}
    texts = {path: (ROOT / path).read_text(encoding="utf-8") for path in {name.partition("::")[0] for name in tests}}
    assert [
        name for name in sorted(tests) if f"def {name.rpartition('::')[2]}(" not in texts[name.partition("::")[0]]
    ] == []


def _names(some: list[str]) -> str:
    """What stands in the names of cases, kinds and classes alike."""
    return "\n".join(some).lower().replace("_", "").replace(" ", "")


@pytest.mark.parametrize("role", ["elements", "laws", "signals"])
def test_every_declaration_is_touched(role: str, first: list[str]) -> None:
    roles = {"laws": [Role.LAW], "signals": [Role.SIGNAL], "elements": samples.ELEMENT_ROLES}[role]
    words = re.findall(
        r"[a-z0-9]+", _names([name.partition("[")[2].replace("-", " - ") for name in first]).replace("-", " ")
    )
    kinds = [cls.__name__.lower() for cls in samples.declared(*roles)]
    assert [kind for kind in kinds if words.count(kind) < 5] == []


def test_every_guide_is_touched(first: list[str]) -> None:
    guides = sorted((ROOT / "docs" / "guide").glob("*.md"))
    assert [path.name for path in guides if not any(f"docs/guide/{path.name}]" in name for name in first)] == []


def test_every_reference_is_touched(first: list[str]) -> None:
    references = [path.parent.name for path in cases.OWN.glob("msl/*/case.yaml")]
    assert len(references) > 10
    found = [name for name in first if name.startswith("tests/reference/test_msl.py")]
    assert [kind for kind in references if not any(kind in name for name in found)] == []


def test_every_door_is_touched(first: list[str]) -> None:
    """Each folder of interfaces, command and way out of a run, by tests whose name has it."""
    doors = {"interfaces/test_all_doors.py", "interfaces/test_cli", "interfaces/test_export_c.py", "page/", "wasm/"}
    doors |= {"exchange/", "stepping/", "sweeps/", "studies/", "frameworks/", "learn/", "linear/", "fit/", "display/"}
    assert [door for door in sorted(doors) if not any(name.startswith(f"tests/{door}") for name in first)] == []


def test_what_is_left_out_as_a_whole_is_named(first: list[str], request: pytest.FixtureRequest) -> None:
    touched = {name.partition("[")[0] for name in first}
    left = {case.test.partition("::")[0] for case in request.config.stash[tiers.COLLECTED] if case.test not in touched}
    assert left == {word for row in table(page("validation.md"), "left out of `make test`") for word in code(row[-1])}

"""Rules that tools/break_rules.py breaks on purpose: each can be broken, and the test that has seen it is named."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tools"))
import break_rules  # noqa: E402

RULES = break_rules.rules()


def test_there_are_rules_of_the_core_and_of_all_else() -> None:
    core = [rule for rule in RULES.values() if rule.file.startswith("cpp/")]
    assert len(core) >= 16
    assert len(RULES) - len(core) >= 8


@pytest.mark.parametrize("name", RULES)
def test_a_rule_stands_once_in_its_file_and_its_tests_are_there(name: str) -> None:
    assert list(RULES[name].problems()) == []


def test_a_rule_that_is_not_there_is_named() -> None:
    lost = break_rules.Rule("lost", "words", "README.md", "no such text", "no such text", ("physics/test_none.py",))
    assert len(list(lost.problems())) == 3


def test_a_rule_is_broken_and_restored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a copy in which two tests fail, the one counts that passes where nothing is broken."""
    rule = break_rules.Rule("sum", "words", "a.py", "1 + 1", "1 - 1")
    for name in ("broken", "sound"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "a.py").write_text("two = 1 + 1\n", encoding="utf-8")
    seen = []

    def fails(copy: break_rules.Copy, tier: str, paths: list[str]) -> str:
        seen.append((copy.folder / "a.py").read_text(encoding="utf-8"))
        unfit = "tests/t.py::always"
        if unfit in paths or (copy.folder.name == "broken" and unfit not in copy.unfit):
            return unfit
        return "tests/t.py::sum" if copy.folder.name == "broken" else ""

    monkeypatch.setattr(break_rules.Copy, "build", lambda copy, *targets: True)
    monkeypatch.setattr(break_rules.Copy, "first_failure", fails)
    broken, sound = (break_rules.Copy(tmp_path / name) for name in ("broken", "sound"))
    assert break_rules.seen_by(rule, "first", broken, sound) == "tests/t.py::sum"
    assert seen == ["two = 1 - 1\n", "two = 1 + 1\n", "two = 1 - 1\n", "two = 1 + 1\n"]
    assert (tmp_path / "broken/a.py").read_text(encoding="utf-8") == "two = 1 + 1\n"

"""Hints where users meet them: the page, the command line, JSON, copies; and the examples, of which there are none."""

from __future__ import annotations

import copy
import json
import pickle
import re
import sys
from pathlib import Path

import pytest

import clutchwork as cw
from clutchwork.command.main import main
from clutchwork.hints.hint import more_than
from clutchwork.hints.registry import rules
from support.hint_models import CASES, launch, lonely

ROOT = Path(__file__).resolve().parents[2]
MODELS = sorted(ROOT.glob("examples/*/model.toml"))
PAGE = (ROOT / "docs" / "guide" / "hints.md").read_text(encoding="utf-8")


def test_the_page_has_a_section_for_every_rule_where_it_belongs() -> None:
    of_model, _, of_run = PAGE.partition("## Of a model")[2].partition("## Of a run")
    found = [set(re.findall(r"^### (.*)$", part, re.MULTILINE)) for part in (of_model, of_run)]
    assert found[0] == {rule.name for rule in rules() if rule.of_model}
    assert found[1] == {rule.name for rule in rules() if rule.of_run}
    assert all(rule.doc.strip() for rule in rules())


def test_the_page_shows_what_is_printed() -> None:
    d = launch(60.0)
    shown = " ".join(PAGE.split("It prints")[1].split("\n\n")[1].split())
    printed = str(d.simulate(2.0).hints)
    assert shown.replace("] c1:", "] c:") == printed


@pytest.mark.parametrize("limit", ["SHARE", "FEWEST", "SINTERED"])
def test_the_limits_of_the_page_are_those_of_the_rules(limit: str) -> None:
    from clutchwork.hints.rules import stiff, tie_up, too_hot

    words = {
        "SHARE": (tie_up.SHARE, 0.1, "a tenth of the heat"),
        "FEWEST": (stiff.FEWEST, 3000, "at least 3000 steps"),
        "SINTERED": (too_hot.SINTERED, 773.0, "773 K"),
    }
    value, expected, text = words[limit]
    assert value == expected
    assert text in PAGE


def test_the_temperatures_of_the_rule_are_those_of_the_linings() -> None:
    from clutchwork.hints.rules import too_hot

    table = (ROOT / "docs" / "elements" / "_linings.md").read_text(encoding="utf-8")
    brief = {float(number) for number in re.findall(r"\| (\d{3}), \d{3} \|", table)}
    assert sorted(brief)[-2:] == [too_hot.OTHERS, too_hot.SINTERED]


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.parent.name)
def test_examples_have_no_hints(path: Path) -> None:
    d = cw.Driveline.load(path)
    assert d.hints() == ()
    assert d.simulate().hints == ()


def test_hill_starts_with_controllers_have_no_hints(monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in ("hill_starts", "car_launch"):
        monkeypatch.syspath_prepend(ROOT / "examples" / folder)
    import hill_starts

    try:
        assert hill_starts.starts(hill_starts.Driver(), 12.0).hints == ()
    finally:
        for name in ("hill_starts", "car", "pictures"):
            sys.modules.pop(name, None)


def test_the_command_line_prints_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    d = launch(60.0)
    d.simulation = {"t_end": 2.0}
    d.save(tmp_path / "model.toml")
    (hint,) = d.simulate().hints
    assert main(["run", str(tmp_path / "model.toml"), "--quiet"]) == 0
    assert capsys.readouterr().out == ""
    assert main(["run", str(tmp_path / "model.toml")]) == 0
    assert f"hints\n  {hint}" in capsys.readouterr().out
    assert main(["run", str(tmp_path / "model.toml"), "--json"]) == 0
    (data,) = json.loads(capsys.readouterr().out)["hints"]
    assert data == hint.to_dict()


def test_the_check_prints_those_of_a_model(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    d = lonely(False)
    d.save(tmp_path / "model.toml")
    (hint,) = d.hints()
    assert main(["check", str(tmp_path / "model.toml")]) == 0
    assert f"hints\n  {hint}" in capsys.readouterr().out
    assert main(["check", str(tmp_path / "model.toml"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["hints"] == [hint.to_dict()]


def test_a_model_without_hints_prints_none(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(MODELS[-1])]) == 0
    assert "hints" not in capsys.readouterr().out


def test_mistakes_of_a_model_come_before_its_hints() -> None:
    d = lonely(False)
    d.shaft("", inertia=-1.0)
    with pytest.raises(cw.ModelError) as caught:
        d.hints()
    assert list(caught.value.problems) == d.check()


def test_hints_can_be_copied_chosen_and_told_apart() -> None:
    case = CASES["too fast to mesh"]
    hints = case.wrong().hints()
    for other in (pickle.loads(pickle.dumps(hints)), copy.deepcopy(hints)):
        assert other == hints
        assert isinstance(other, cw.Hints)
    assert hints.of("dog") == hints
    assert hints.of("base") == ()
    assert len({*hints, *case.wrong().hints()}) == 1
    assert repr(hints) == str(hints)
    assert str(cw.Hints()) == "no hints"


def test_signals_of_what_is_not_used_are_not_there() -> None:
    d = cw.Driveline("plain")
    base, follower = d.shaft("base", inertia=0.2, speed=50.0), d.shaft("follower", inertia=0.2)
    d.add(cw.DiskClutch("c", base=base, follower=follower, radius=0.1, pressure=4e5, area=0.01))
    d.add(cw.OneWayClutch("f", base=d.housing, follower=follower))
    run = d.simulate(0.5)
    inputs = {name for name in run.names if name.split(".")[0] in "cf"}
    kept = {"torque", "slip", "power", "work", "heat", "mode", "state", "capacity"}
    assert inputs == {f"{name}.{word}" for name in "cf" for word in kept} | {"c.pressure"}
    with pytest.raises(cw.UnknownName):
        run["c.wear"]
    # what is given later is there
    other = d.assemble().changed({"f.pressure": 1e3})
    assert (cw.simulate(other, 0.1)["f.pressure"] == 1e3).all()


def test_a_run_from_a_file_that_cannot_be_repeated_has_hints(tmp_path: Path) -> None:
    case = CASES["never locks"]
    system = case.wrong().assemble()
    torque = next(item.name for item in system.inputs if item.name.endswith(".torque"))
    value = float(cw.simulate(system, 0.01)[torque][0])
    run = cw.simulate(system.changed({torque: cw.Sampled(lambda *_: value, period=0.1)}), case.t_end, output="steps")
    run.save(tmp_path / "a.run")
    assert cw.load_run(tmp_path / "a.run").hints.rules == run.hints.rules == ("never locks",)


@pytest.mark.parametrize("needed", [1.6111, 1.001, 9.999, 14.04, 136.2, 1.5])
def test_a_factor_is_never_told_too_small(needed: float) -> None:
    """What a remedy tells is enough: three digits, rounded up."""
    told = float(more_than(needed))
    assert needed <= told <= 1.01 * needed
    assert more_than(1.5) == "1.5"
    assert more_than(96.66666 / 60.0) == "1.62"

"""`clutchwork elements`, `laws`, `signals`, `units`: all that is declared, with examples that run."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from clutchwork.command.main import main
from clutchwork.command.reference import ROLES, kinds
from clutchwork.command.toml_example import toml_example
from clutchwork.declare.schema import specs

EVERY = [(topic, kind, cls) for topic in ROLES for kind, cls in kinds(topic).items()]
NAMES = [f"{topic} {kind}" for topic, kind, _ in EVERY]

# what the examples join
AROUND = """
name = "example"
[[shaft]]
name = "engine"
inertia = 0.2
speed = 100.0
[[shaft]]
name = "load"
inertia = 0.8
[[shaft]]
name = "output"
inertia = 0.5
[[mass]]
name = "car"
mass = 10.0
[[thermal]]
name = "plates"
capacity = 500.0
temperature = 350.0
[[ambient]]
name = "air"
temperature = 293.0
"""
CLUTCH = """
[[element]]
name = "x1"
type = "clutch"
base = "engine"
follower = "load"
gain = 5e-4
"""


def printed(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """What a command prints that succeeds."""
    assert main([*words]) == 0
    told = capsys.readouterr()
    assert told.err == ""
    return told.out


def plain(text: str) -> str:
    """Text on one line."""
    return " ".join(text.split())


@pytest.mark.parametrize("topic", ROLES)
def test_a_list_has_everything_once_below_a_purpose(topic: str, capsys: pytest.CaptureFixture[str]) -> None:
    lines = printed(capsys, topic).splitlines()
    listed = [line.split()[0] for line in lines if line.startswith("  ") and line[2] != " "]
    assert sorted(listed) == sorted(kinds(topic))
    data = json.loads(printed(capsys, topic, "--json"))[topic]
    assert [entry["type"] for entry in data] == listed
    assert all(entry["summary"] and entry["purpose"] in lines for entry in data)


@pytest.mark.parametrize(("topic", "kind", "cls"), EVERY, ids=NAMES)
def test_a_page_has_every_field(topic: str, kind: str, cls: Any, capsys: pytest.CaptureFixture[str]) -> None:
    text = plain(printed(capsys, topic, kind))
    for item, spec in specs(cls):
        assert f" {item.name} " in text
        assert plain(spec.doc) in text
    assert printed(capsys, topic, cls.__name__) == printed(capsys, topic, kind)
    data = json.loads(printed(capsys, topic, kind, "--json"))
    assert [field["name"] for field in data["fields"]] == [item.name for item, _ in specs(cls)]
    assert data["class"] == cls.__name__


@pytest.mark.parametrize(("topic", "kind", "cls"), EVERY, ids=NAMES)
def test_the_example_can_be_copied_into_a_model(topic: str, kind: str, cls: Any, tmp_path: Path) -> None:
    example = toml_example(cls)
    if specs(cls, "function"):
        assert example == ""
        return
    if topic == "elements":
        text = f"{AROUND}{example}"
    elif topic == "laws":
        text = f"{AROUND}{CLUTCH}pressure = 2e5\n{example}"
    else:
        text = f'{AROUND}{CLUTCH}friction = {{type = "coulomb", static = 0.1, kinetic = 0.1}}\n{example}'
    (tmp_path / "pressures.csv").write_text("time,c1\n0,0\n1,2e5\n")
    path = tmp_path / "model.toml"
    path.write_text(text)
    with warnings.catch_warnings():
        # the naive law is there to be warned of
        warnings.simplefilter("ignore" if kind == "naive_sign" else "error", cw.ModelWarning)
        d = cw.Driveline.load(path)
        assert d.check() == []
        assert d.simulate(0.01).status == "done"


def test_words_find_what_has_them(capsys: pytest.CaptureFixture[str]) -> None:
    told = printed(capsys, "laws", "temperature")
    assert "temperature_table" in told
    assert "friction_map" in told
    assert "coulomb" not in told
    assert "see also: nonlinear_spring, spring_damper, diaphragm_spring" in printed(capsys, "elements", "spring")


def test_units(capsys: pytest.CaptureFixture[str]) -> None:
    assert printed(capsys, "units", "bar") == printed(capsys, "units", "pressure")
    data = {row["name"]: row for row in json.loads(printed(capsys, "units", "--json"))["units"]}
    assert data["bar"]["quantity"] == "pressure"
    assert data["rpm"]["factor"] == pytest.approx(0.10471975512, rel=1e-11)
    assert "degF  0.5555555556 K, 0 is 255.372 K" in printed(capsys, "units", "temperature")
    lines = printed(capsys, "units").splitlines()
    assert all(any(line.split()[-3:-1] or unit in line for line in lines) for unit in data)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["elements", "cluch"], "no element 'cluch', and no description holds this word; did you mean 'clutch'?"),
        (["elements", "DiskCluch"], "did you mean 'disk_clutch'?"),
        (["elements", "stribeck"], "one of the laws: clutchwork laws stribeck"),
        (["laws", "disk_clutch"], "one of the elements: clutchwork elements disk_clutch"),
        (["laws", "strybeck"], "did you mean 'stribeck'?"),
        (["signals", "tabel"], "did you mean 'table'?"),
        (["units", "presure"], "did you mean 'pressure'?"),
    ],
)
def test_misspelt_names(words: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 2
    err = capsys.readouterr().err
    assert told in err
    assert main([*words, "--json"]) == 2
    assert json.loads(capsys.readouterr().out)["exit_code"] == 2

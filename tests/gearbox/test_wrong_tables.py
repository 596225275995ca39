"""What is wrong with a gearbox is said at once: which row, which elements and members, and what to do."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from support.gearboxes import EIGHT_SPEED, REDUCTION, changed

# two of them with other teeth hold what they join
LOCKS = {"type": "single", "sun": "C3", "ring": "out", "carrier": "housing", "teeth_sun": 30}
# a change of the eight-speed box -> words of the message
WRONG: dict[str, tuple[dict[str, Any], tuple[str, ...]]] = {
    "too few": (
        {"gears__3": ["B", "E"]},
        ('gear "3"', "closing B and E leaves 2 speeds free", "in does not drive out"),
    ),
    "too many": ({"gears__3": ["A", "B", "C", "E"]}, ('gear "3"', "ties the box up", "leave one of them open")),
    "input held": ({"gears__3": ["A", "C", "E"]}, ('gear "3"', "holds the input in")),
    "unknown element": ({"gears__3": ["B", "C", "F"]}, ('gear "3"', "'F'", "known elements: A, B, C, D, E")),
    "misspelt member": ({"elements__A": ["S13", "housing"]}, ('element "A"', "did you mean 'S12'")),
    # it makes every gear wrong; the first line names the likely typo
    "misspelt once": ({"sets__P4__ring": "outt"}, ("1 more", "ring is 'outt', which nothing else")),
    "brake on nothing": ({"elements__A": ["C1R4", "out"], "sets__P1__sun": "S1"}, ('gear "',)),
    "same row twice": ({"gears__9": ["D", "A", "E"]}, ('gear "9"', 'the same as gear "8"')),
    "element twice": ({"gears__3": ["B", "B", "E"]}, ('gear "3"', "names B twice")),
    "published missed": ({"published__1": 4.7}, ('published "1" = 4.7', "4.7143 by its teeth", "tolerance 0.001")),
    "published unknown": ({"published__11": 4.7}, ('published "11"', "is not a gear")),
    "ring too small": ({"sets__P1__teeth_ring": 48}, ('set "P1"', "teeth_ring", "cannot mesh")),
    "teeth of a fraction": ({"sets__P1__teeth_ring": 96.5}, ('set "P1"', "a whole number", "96.5")),
    "teeth below zero": ({"sets__P1__teeth_sun": -48}, ('set "P1"', "> 0", "-48")),
    "not assembled": ({"sets__P1__planets": 7}, ("cannot be assembled", "144", "divided by 7", "take")),
    "no room": ({"sets__P4__planets": 66, "sets__P4__equally_spaced": False}, ("touch each other", "no more than")),
    "planet does not fit": ({"sets__P1__teeth_planet": 30}, ("teeth_planet = 30", "about 24")),
    "unknown set": ({"sets__P1__type": "singel"}, ('set "P1"', "did you mean 'single'")),
    "missing wheel": ({"sets__P1__ring": None}, ('set "P1"', "ring is missing")),
    "missing teeth": ({"sets__P1__teeth_ring": None}, ("teeth_ring is missing", "or ratio")),
    "teeth and ratio": ({"sets__P1__ratio": 2.0}, ("ratio is given beside teeth",)),
    "unknown key": ({"sets__P1__teeth_son": 48}, ("teeth_son", "did you mean 'teeth_sun'")),
    "brake between members": ({"elements__C": {"type": "brake", "members": ["in", "R3S4"]}}, ("a brake between two",)),
    "three members": ({"elements__C": ["in", "R3S4", "out"]}, ('element "C"', "3 members")),
    "input unknown": ({"input": "inn"}, ("input", "'inn'", "did you mean 'in'")),
    "input is output": ({"output": "in"}, ("output", "is the input too")),
    "one name twice": ({"elements__out": ["C3", "out"]}, ("'out' names two things",)),
    "no sets": ({"sets": {}}, ("sets", "missing")),
    "park that drives": ({"gears__P": ["A", "B", "C"], "gears__1": None, "published__1": None}, ("is not park",)),
    "neutral that drives": (
        {"gears__N": ["B", "C", "E"], "gears__3": None},
        ("is not neutral", "a gear of ratio 2.106"),
    ),
    "sets that lock": (
        {"sets__P5": {**LOCKS, "teeth_ring": 60}, "sets__P6": {**LOCKS, "teeth_ring": 70}},
        (
            "sets",
            "hold out, C3 without any element",
        ),
    ),
    "set of two types": ({"sets__P1__type": ["single"]}, ('set "P1"', "unknown type")),
    "element of two types": ({"elements__A": {"type": ["brake"], "members": ["S12", "housing"]}}, ("unknown type",)),
    "teeth without end": ({"sets__P1__teeth_ring": 10**400}, ("teeth_ring", "<= 1e+06")),
    "housing written large": ({"elements__A": ["S12", "Housing"]}, ("'Housing' is not the name", "write 'housing'")),
    "element without name": ({"elements__": ["C3", "out"]}, ("'' cannot name a set, an element",)),
    "shaft that turns freely": (
        {"elements__P": ["in", "pump"], "shafts": []},
        ('element "P"', "'pump'", "under `shafts`"),
    ),
    "set twice": ({"sets__P5": EIGHT_SPEED["sets"]["P4"]}, ('set "P5"', "repeats what other sets")),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_table_says_which_row_and_why(name: str) -> None:
    changes, words = WRONG[name]
    with pytest.raises(cw.ModelError) as raised:
        cw.Gearbox.from_dict(changed(EIGHT_SPEED, **changes))
    for word in words:
        assert word in str(raised.value), str(raised.value)


def test_all_mistakes_at_once() -> None:
    wrong = changed(EIGHT_SPEED, gears__3=["B", "E"], gears__4=["A", "B", "C", "D"], published__8=0.7)
    with pytest.raises(cw.ModelError) as raised:
        cw.Gearbox.from_dict(wrong)
    assert [problem.path for problem in raised.value.problems] == ['gear "3"', 'gear "4"', 'published "8"']


def test_a_row_of_a_file_has_its_line(tmp_path: Path) -> None:
    path = tmp_path / "box.toml"
    cw.Gearbox.from_dict(EIGHT_SPEED).save(path)
    text = path.read_text().replace('3 = ["B", "C", "E"]', '3 = ["B", "E"]')
    path.write_text(text)
    with pytest.raises(cw.ModelError) as raised:
        cw.Gearbox.load(path)
    line = text.split("\n").index('3 = ["B", "E"]') + 1
    assert f"line {line}: " in str(raised.value)


def test_a_freewheel_the_wrong_way_round() -> None:
    held = {"type": "freewheel", "members": ["housing", "ring"]}
    # under torque from the sun the ring would turn backwards, which this freewheel holds
    assert cw.Gearbox.from_dict(changed(REDUCTION, elements__B=held)).ratios["1"] == pytest.approx(1 + 70 / 30)
    held["members"].reverse()
    with pytest.raises(cw.ModelError, match="freewheel B would overrun under torque from sun"):
        cw.Gearbox.from_dict(changed(REDUCTION, elements__B=held))


def test_unknown_gearbox_of_the_catalogue() -> None:
    with pytest.raises(cw.ModelError, match="zf-8hp70"):
        cw.Gearbox.load("zf-8hp-70")


def test_file_and_data_come_back(tmp_path: Path) -> None:
    box = cw.Gearbox.from_dict(EIGHT_SPEED)
    box.save(tmp_path / "box.toml")
    assert cw.Gearbox.load(tmp_path / "box.toml") == box == cw.Gearbox.from_dict(box.to_dict())


TABLE = "Gear;A;B;C;D;E;ratio\n1;x;x;x;;;4,714\n2;x;x;;;x;3,143\n\nR;x;x;;x;;-3,317\n"


@pytest.mark.parametrize("separator", [";", ",", "\t"])
def test_a_shift_table_from_a_spreadsheet(tmp_path: Path, separator: str) -> None:
    text = TABLE.replace(",", ".").replace(";", separator) if separator == "," else TABLE.replace(";", separator)
    (tmp_path / "table.csv").write_text("\ufeff" + text, encoding="utf-8")
    data = {key: value for key, value in EIGHT_SPEED.items() if key not in ("gears", "published")}
    box = cw.Gearbox.import_table(data, tmp_path / "table.csv")
    assert dict(box.gears) == {"1": ("A", "B", "C"), "2": ("A", "B", "E"), "R": ("A", "B", "D")}
    assert box.published == {"1": 4.714, "2": 3.143, "R": -3.317}


def test_a_wrong_shift_table_of_a_spreadsheet(tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text("gear,A,B,ratio\n1,x,?,4.7\n1,x,x\n2,,,abc\n")
    with pytest.raises(cw.ModelError) as raised:
        cw.Gearbox.import_table(EIGHT_SPEED, tmp_path / "table.csv")
    text = str(raised.value)
    assert all(words in text for words in ("is not a mark", "appears twice", "3 cells for 4 columns", "'abc'"))


def test_neutral_and_park_may_open_the_same_elements() -> None:
    box = cw.Gearbox.from_dict(changed(EIGHT_SPEED, gears__N=[], gears__P=[]))
    assert box.combination(box.closed_in("P")).kind == "neutral"


def test_what_is_listed_under_shafts_may_turn_freely() -> None:
    box = cw.Gearbox.from_dict(changed(EIGHT_SPEED, elements__P=["in", "pump"], shafts=["pump"]))
    assert box.combination(box.closed_in("3")).idle
    assert box.state("3").ratio == cw.Gearbox.from_dict(EIGHT_SPEED).state("3").ratio


def test_numbers_as_names_of_gears() -> None:
    rows = {int(gear): row for gear, row in EIGHT_SPEED["gears"].items() if gear.isdigit()}
    assert "3" in cw.Gearbox.from_dict(changed(EIGHT_SPEED, gears=rows, published={})).ratios


@pytest.mark.parametrize("ask", ["state", "combination"])
@pytest.mark.parametrize("closed", [["A", "Z"], 3, None])
def test_elements_that_the_box_does_not_have(ask: str, closed: Any) -> None:
    with pytest.raises(cw.UseError, match=f"box.{ask}"):
        getattr(cw.Gearbox.from_dict(EIGHT_SPEED), ask)(closed)


def test_the_large_sun_of_a_ravigneaux_set() -> None:
    suns = {"large_sun": "low", "small_sun": "in", "teeth_large_sun": 23, "teeth_small_sun": 28}
    sets = {"P": {"type": "ravigneaux", "ring": "R", "carrier": "out", "teeth_ring": 79, **suns}}
    data = {"name": "two", "input": "in", "output": "out", "sets": sets, "elements": {"L": ["low", "housing"]}}
    data["gears"] = {"1": ["L"]}
    with pytest.raises(cw.ModelError, match="the ring meshes the short planets"):
        cw.Gearbox.from_dict(data)
    # so such a set is written as the two that it is
    own = {"single": {"sun": "low", "teeth_sun": 23}, "double": {"sun": "in", "teeth_sun": 28}}
    data["sets"] = {
        kind: {"type": kind, "ring": "R", "carrier": "out", "teeth_ring": 79, **sun} for kind, sun in own.items()
    }
    assert cw.Gearbox.from_dict(data).ratios["1"] == pytest.approx(1 + 23 / 28)


@pytest.mark.parametrize("ending", ["toml", "json"])
def test_a_file_without_bottom(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"deep.{ending}"
    path.write_text(("a = " if ending == "toml" else "") + "[" * 100_000)
    with pytest.raises(cw.ModelError, match="nested too deeply"):
        cw.Gearbox.load(path)

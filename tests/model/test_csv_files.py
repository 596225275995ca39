"""CSV files: read fast, refused in words, and never told of."""

from __future__ import annotations

import os

import pytest

import clutchwork as cw
from clutchwork.command.main import main
from clutchwork.signals.bases import column_file


def _column(tmp_path, text, **more):
    data = text if isinstance(text, bytes) else text.encode()
    (tmp_path / "p.csv").write_bytes(data)
    return cw.Column("p.csv", more.pop("column", "p"), folder=str(tmp_path), **more)


@pytest.mark.parametrize("quote", ["", '"'])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("last", ["", "\n", "\n\n\n"])
def test_both_ways_of_reading_agree(tmp_path, quote, end, last):
    rows = [(0.1 * k, 3.7 * k**2) for k in range(500)]
    text = "\n".join(["time, p ,note", *(f"{quote}{t!r}{quote}, {y!r} ,x" for t, y in rows)]) + last
    assert _column(tmp_path, text.replace("\n", end)).points == tuple(rows)


def test_plain_files_are_read_at_once(tmp_path, monkeypatch):
    monkeypatch.setattr(column_file, "_by_cells", None)
    text = "time,p\n" + "".join(f"{k},{k}\n" for k in range(300_000))
    assert len(_column(tmp_path, text).points) == 300_000


def test_the_first_few_bad_cells_are_named(tmp_path):
    text = "time,p,q\n" + "".join(f"{k},{'x' if k > 3 else k},1\n" for k in range(100))
    found = _column(tmp_path, text).problems()
    assert len(found) == column_file.MOST_FAULTS
    assert [words for _, words, _ in found][:2] == [
        "line 6 of 'p.csv': the cell in column 'p' is not a finite number",
        "line 7 of 'p.csv': the cell in column 'p' is not a finite number",
    ]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("time,p,p\n0,1,5\n", "has 2 columns 'p'"),
        ("time,time,p\n0,1,5\n", "has 2 columns 'time'"),
        ("time,p\n0,0\n1,2,5\n", "line 3 of 'p.csv' has 3 cells, the first line names 2 columns"),
        ('time,p\n0,0\n1,"2",5\n', "line 3 of 'p.csv' has 3 cells"),
        ("time,p\n0,0\n2,1\n1,1\n", "line 4 of 'p.csv': its time is before that of line 3"),
        ("time,p\n0,0\n1,1_0\n", "is not a finite number"),
        ("time,p\n0,0\n1,1e999\n", "is not a finite number"),
        ("time,p\n0,0\n1\n", "is empty"),
        ("time,p\n0,0\n1e-320,1e300\n", "change too fast"),
        ("time,p\n0,0\n1\0,1\n", "not text"),
        (b"time,p\n0,\xff\n", "not UTF-8 text"),
        ("time,p\n" + "1" * 2_000_000, "has a line of more than"),
        ("time,p\n0," + "1" * 200_000 + "\n", "cannot be read"),
        ("\n0,1\n", "is empty"),
    ],
)
def test_what_is_wrong_with_a_csv_file(tmp_path, text, words):
    assert any(words in message for _, message, _ in _column(tmp_path, text).problems())


def test_a_million_and_more_lines(tmp_path, monkeypatch):
    monkeypatch.setattr(column_file, "MOST_LINES", 1000)
    text = "time,p\n" + "".join(f"{k},{k}\n" for k in range(1000))
    assert _column(tmp_path, text).problems() == []
    assert "more than 1000 lines" in _column(tmp_path, text + "1001,1\n").problems()[0][1]


@pytest.mark.parametrize("path", ["/dev/zero", "/dev/stdin", "pipe", ".", "a\0b", "x" * 5000, "\ud800"])
def test_columns_are_of_regular_files(tmp_path, path):
    os.mkfifo(tmp_path / "pipe")
    (problem,) = cw.Column(path, "p", folder=str(tmp_path)).problems()
    assert "cannot be read" in problem[1]


@pytest.mark.parametrize(
    "content",
    [
        "secret one\nsecret two\n",
        "secret,time\nsecret,secret\n",
        "time,p\n1,secret\nsecret,1\n",
        "secret;secret\n1;2\n",
    ],
)
def test_errors_never_tell_the_content_of_other_files(tmp_path, content, capsys):
    (tmp_path / "other").write_text(content)
    for column, time in (("p", "time"), ("q", "t"), ("time", "time")):
        signal = f'{{type = "column", path = "other", column = "{column}", time = "{time}"}}'
        element = f'[[element]]\nname = "t"\ntype = "torque"\nshaft = "a"\ntorque = {signal}\n'
        (tmp_path / "model.toml").write_text(f'[[shaft]]\nname = "a"\ninertia = 1\n{element}')
        assert main(["check", str(tmp_path / "model.toml")]) in (0, 3)
        # names of columns are told where one that was asked for is there
        said = capsys.readouterr().err
        is_asked = {"p", "time"} & set(content.partition("\n")[0].split(","))
        assert "secret" not in said or ("the columns are" in said and is_asked)


@pytest.mark.parametrize(
    ("head", "names", "points"),
    [
        ("time [s],c1 [bar]", {"column": "c1"}, (2.0, 3e5)),
        ("time [ms],c1 [bar]", {"column": "c1 [bar]"}, (0.002, 3e5)),
        ("time [ms],c1 [kPa]", {"column": "c1", "time": "time [ms]"}, (0.002, 3e3)),
        ("t [min],c1", {"column": "c1 [bar]", "time": "t"}, (120.0, 3e5)),
        ("time,c1 [-]", {"column": "c1"}, (2.0, 3.0)),
        ("time,c1 [bar],c1", {"column": "c1"}, (2.0, 3e5 / 1e5)),
        ("time,c1 [bar]", {"column": "c1", "scale": -2.0}, (2.0, -6e5)),
        ("time [ms],c1 [degC]", {"column": "c1"}, (0.002, 276.15)),
        ("time [ms],c1 [°F]", {"column": "c1 [°F]"}, (0.002, (3.0 + 459.67) / 1.8)),
    ],
)
def test_heads_with_units_are_converted(tmp_path, head, names, points):
    cells = ",".join("2333"[: head.count(",") + 1])
    found = _column(tmp_path, f"{head}\n{cells}\n", **names).points
    assert found == (pytest.approx(points),)


@pytest.mark.parametrize(
    ("head", "more", "words"),
    [
        ("time,c1 [baar]", {}, "has the unknown unit 'baar'; did you mean 'bar'?; write one such as [bar]"),
        ("time,c1 [J/degC]", {}, "is in degC, which has another zero"),
        ("time [bar],c1", {}, "has a unit that does not fit; give it in [s]"),
        ("time,c1 [bar],c1 [kPa]", {}, "has 2 columns 'c1'; name one of them: c1 [bar], c1 [kPa]"),
        ("time,c1 [bar]", {"scale": 1e5}, "repeats the unit of column 'c1 [bar]' of 'p.csv'; remove scale"),
        ("time,c1 [bar]", {"column": "c1 [kPa]"}, "has no column 'c1 [kPa]'; the columns are time, c1 [bar]"),
    ],
)
def test_units_of_heads_that_are_refused(tmp_path, head, more, words):
    found = _column(
        tmp_path, head + "\n1,2,3\n"[: 2 * head.count(",") + 3] + "\n", **{"column": "c1", **more}
    ).problems()
    assert any(words in f"{message}; {remedy}" for _, message, remedy in found)


def _braked(torque):
    d = cw.Driveline()
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=torque))
    return d


def test_the_driven_quantity_decides_which_unit_fits(tmp_path):
    assert _braked(_column(tmp_path, "time,p [kNm]\n0,2\n")).check() == []
    (problem,) = _braked(_column(tmp_path, "time,p [bar]\n0,2\n")).check()
    assert str(problem) == (
        "cw.Torque(\"t\"): torque.column 'p [bar]' has a unit that does not fit; give it in [N m], such as '150 N m'"
    )
    (problem,) = _braked(_column(tmp_path, "time,p [degC]\n0,2\n")).check()
    assert "torque.column 'p [degC]' is in degC" in str(problem)


def test_what_a_run_writes_drives_another(tmp_path):
    _braked(3.0).simulate(1.0).to_csv(tmp_path / "run.csv")
    run = _braked(cw.Column("run.csv", "t.torque", folder=str(tmp_path))).simulate(1.0)
    assert run["a.speed"][-1] == pytest.approx(3.0)


def test_a_unit_beside_that_of_the_head_is_refused(tmp_path):
    (tmp_path / "p.csv").write_text("time,p [kNm]\n0,2\n")
    model = tmp_path / "model.toml"
    model.write_text(
        '[[shaft]]\nname = "a"\ninertia = 1.0\n[[element]]\nname = "t"\ntype = "torque"\nshaft = "a"\n'
        'torque = {type = "column", path = "p.csv", column = "p", unit = "kNm"}\n'
    )
    with pytest.raises(cw.ModelError, match=r"the head of the column has the unit \[kNm\]; remove unit"):
        cw.Driveline.load(model)

"""Studies on disk: the bits of a sweep, goes on where it was ended, refuses to mix, needs little memory."""

from __future__ import annotations

import json
import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.base.paths import WriteError
from clutchwork.studies import fingerprints
from clutchwork.studies.parts import there
from support import scattered
from support.full_disk import full_disk

pytest.importorskip("pyarrow")
pytest.importorskip("scipy")


TIMES = [0.25 * number for number in range(8)]


def run(folder: Path, count: int = 300, **how: Any) -> cw.Study:
    """A study of two discs, in files of 40 variants."""
    given = {"vary": scattered.design(count, seed=5), "outputs": scattered.OUTPUTS, "chunk": 40, **how}
    return cw.study(given.pop("model", scattered.discs()), given.pop("t_end", 3.0), folder=folder, **given)


def swept(count: int = 300) -> cw.Sweep:
    """The same in memory."""
    return cw.sweep(scattered.discs(), 3.0, vary=scattered.design(count, seed=5), outputs=scattered.OUTPUTS)


def stamps(folder: Path) -> dict[str, tuple[int, int]]:
    """When each file was written, and which it is."""
    return {path.name: (path.stat().st_mtime_ns, path.stat().st_ino) for path in (folder / "data").iterdir()}


def test_columns_are_those_of_a_sweep_to_the_last_bit(tmp_path: Path) -> None:
    found, expected = run(tmp_path, threads=2), swept()
    for name, values in expected.columns():
        assert np.asarray(found[name]).tobytes() == values.tobytes() or name == "status"
    assert found["status"].tolist() == ["done"] * 300
    assert found["variant"].tolist() == list(range(300))
    assert found.names == expected.names
    assert found.varied == expected.varied
    assert found.units == expected.column_units()
    assert (found.complete, len(found), found.count, found.ends) == (True, 300, 300, {"done": 300})
    again = found.run(123)
    assert again["c1.heat"][-1] == found["c1.heat"][123]


@pytest.mark.parametrize(
    "vary",
    [
        {"c1.gain": [4e-4, 5e-4, 6e-4], "c1.pressure": {"low": 1e5, "ramp": cw.Ramp(height=2e5, duration=1.0)}},
        [{"c1.gain": 4e-4}, {"c1.gain": 5e-4}, {"c1.gain": 5e-4}],
        cw.variants({"engine.inertia": [0.1, 0.2, 0.3], "c1.gain": [1, 2.5, 3]}),
        {"*.inertia": cw.times(0.9, 1.1), "c1.gain": cw.times(0.8, 1.0)},
        cw.design({"*.inertia": cw.times(cw.normal(1.0, 0.02)), "c1.gain": (4e-4, 5e-4)}, 5),
    ],
    ids=["grid", "list", "table", "factors", "design of factors"],
)
def test_anything_that_a_sweep_varies(tmp_path: Path, vary: Any) -> None:
    outputs = [cw.at("load.speed", [0.5, 1.0]), "c1.state", cw.peak("c1.slip"), lambda found: found.t_end]
    found = run(tmp_path, vary=vary, outputs=outputs, chunk=2)
    expected = cw.sweep(scattered.discs(), 3.0, vary=vary, outputs=outputs).to_pandas()
    assert found.to_pandas().drop(columns="variant").equals(expected)


def test_a_study_goes_on_and_keeps_what_is_there(tmp_path: Path) -> None:
    def until(done: int, _: int) -> None:
        if done >= 120:
            raise KeyboardInterrupt

    with pytest.raises(cw.StudyInterrupted, match=r"of 300 variants are in .*; the same call continues") as stop:
        run(tmp_path, threads=1, progress=until)
    kept, before = stop.value.study, stamps(tmp_path)
    assert 120 <= len(kept) < 300
    assert kept["c1.heat"].tolist() == swept()["c1.heat"][kept["variant"]].tolist()
    assert repr(cw.Study.load(tmp_path)) == repr(kept)
    seen = list[int]()
    found = run(tmp_path, threads=1, progress=lambda done, _: seen.append(done))
    assert found["c1.heat"].tobytes() == swept()["c1.heat"].tobytes()
    assert {name: stamp for name, stamp in stamps(tmp_path).items() if name in before} == before
    # what was there counts, and only the rest was run
    assert seen[0] == len(before) * 40 + 40
    after = stamps(tmp_path)
    assert run(tmp_path, progress=lambda *_: pytest.fail("nothing is left to run")).complete
    assert stamps(tmp_path) == after


def test_damaged_and_unfinished_files_are_run_again(tmp_path: Path) -> None:
    run(tmp_path)
    (tmp_path / "data" / "part-000001.parquet").write_bytes(b"PAR1 and no more")
    (tmp_path / "data" / "part-000003.parquet").unlink()
    (tmp_path / "data" / ".0123456789abcdef.new.parquet").write_bytes(b"half")
    (tmp_path / "data" / "part-000007.parquet").replace(tmp_path / "data" / "part-000005.parquet")
    assert sorted(there(tmp_path, cw.Study.load(tmp_path).manifest.sizes)) == [0, 2, 4, 6]
    assert run(tmp_path)["c1.heat"].tobytes() == swept()["c1.heat"].tobytes()
    assert not list((tmp_path / "data").glob(".*"))


@pytest.mark.parametrize("how", [{"threads": 1}, {"threads": 2}])
def test_a_full_disk_is_named_and_the_same_call_goes_on(tmp_path: Path, how: dict[str, Any]) -> None:
    run(tmp_path / "whole", **how)
    sizes = [path.stat().st_size for path in (tmp_path / "whole").glob("**/*.*") if path.is_file()]
    folder = tmp_path / "study"
    # at the first file, and where one is larger than those before
    for room in (10, max(sizes) // 2):
        with full_disk(room), pytest.raises(WriteError, match=r"cannot be written: .*; make room on the disk") as told:
            run(folder, **how)
        assert str(folder) in str(told.value)
        assert not list(folder.glob("**/.*.new*"))
    assert run(folder, **how).complete


def gained(gain: float) -> cw.System:
    return scattered.discs().changed({"c1.gain": gain, "engine.inertia": 0.25})


OTHERS: dict[str, tuple[dict[str, Any], tuple[str, ...]]] = {
    "model": (
        {"model": gained(6e-4)},
        ("model: ", "c1.gain was 0.0005 and is 0.0006", "engine.inertia was 0.2 and is 0.25"),
    ),
    "seed": ({"vary": scattered.design(300, seed=6)}, ("design.seed was 5 and is 6",)),
    "count": ({"vary": scattered.design(301, seed=5)}, ("design.count was 300 and is 301",)),
    "method": ({"vary": scattered.design(300, seed=5, method="sobol")}, ("design.method was 'latin' and is 'sobol'",)),
    "distribution": (
        {"vary": cw.design({**scattered.VARY, "c1.gain": (4e-4, 9e-4)}, 300, seed=5)},
        ("design.vary.c1.gain was 'uniform(0.0004, 0.0008)' and is 'uniform(0.0004, 0.0009)'",),
    ),
    "last digit": (
        {"vary": cw.design({**scattered.VARY, "c1.gain": (4e-4, 8.0000000001e-4)}, 300, seed=5)},
        ("design: other values",),
    ),
    "outputs": ({"outputs": ["load.speed"]}, ("outputs.lock(c1) is missing", "outputs.c1.heat is missing")),
    "end": ({"t_end": 4.0}, ("options.t_end was 3.0 and is 4.0",)),
    "options": ({"rtol": 1e-7}, ("options.rtol was 1e-06 and is 1e-07",)),
}


@pytest.mark.parametrize("name", OTHERS)
def test_nothing_else_is_added_to_a_study(tmp_path: Path, name: str) -> None:
    run(tmp_path)
    other, texts = OTHERS[name]
    with pytest.raises(cw.StudyError) as error:
        run(tmp_path, **other)
    assert "holds another study, so nothing can be added to it" in str(error.value)
    assert "give another folder, or the definition that it was started with" in str(error.value)
    assert [text for text in texts if text not in str(error.value)] == []


def test_another_function_is_another_output(tmp_path: Path) -> None:
    def energy(scale: float) -> Any:
        return {"energy": lambda found: 0.5 * found["load.speed"][-1] ** 2 * 0.8}, scale

    run(tmp_path, 3, outputs=energy(1.0)[0])
    run(tmp_path, 3, outputs=energy(2.0)[0])
    with pytest.raises(cw.StudyError, match=r"outputs\.energy was"):
        run(tmp_path, 3, outputs={"energy": lambda found: 0.5 * found["load.speed"][-1] ** 2 * 0.9})


def test_another_version_goes_into_another_folder(tmp_path: Path) -> None:
    run(tmp_path)
    told = json.loads((tmp_path / "study.json").read_text())
    told["versions"]["clutchwork"] = "0.0.1"
    (tmp_path / "study.json").write_text(json.dumps(told))
    with pytest.raises(cw.StudyError, match=r"clutchwork: 0\.0\.1 there"):
        run(tmp_path)


def test_one_process_at_a_time(tmp_path: Path) -> None:
    pytest.importorskip("fcntl")
    with pytest.raises(cw.StudyError, match="another process is running this study"):
        run(tmp_path, progress=lambda *_: run(tmp_path))


def test_wrong_values_are_named_before_the_first_run(tmp_path: Path) -> None:
    wrong = cw.design({"c1.gain": cw.normal(5e-4, 2e-4), "c1.presure": (0.0, 1.0)}, 5000)
    with pytest.raises(cw.ModelError) as error:
        run(tmp_path, vary=wrong)
    assert "c1.presure" in str(error.value)
    assert 'cw.Clutch("c1"): gain = -' in str(error.value)
    with pytest.raises(cw.UseError, match="no contact 'c2'"):
        run(tmp_path, outputs=[cw.lock("c2")])
    assert not (tmp_path / "data").exists()
    for given, text in (({"chunk": 0}, "chunk is 0"), ({"dt": 0.1}, "without effect"), ({"on": "rai"}, "on is 'rai'")):
        with pytest.raises(cw.UseError, match=text):
            run(tmp_path, **given)
    with pytest.raises(cw.StudyError, match=r"holds no study: study\.json is missing"):
        cw.Study.load(tmp_path)


def test_functions_that_raise_are_counted(tmp_path: Path) -> None:
    def odd(found: cw.Trajectory) -> float:
        speed = float(found["load.speed"][-1])
        if speed > 19.0:
            raise ValueError
        return speed

    with pytest.warns(cw.OutputWarning, match="functions of outputs raised 10 times"):
        found = run(tmp_path, 10, outputs={"odd": odd})
    assert np.isnan(found["odd"]).all()


def test_memory_does_not_grow_with_the_study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # the design is looked through in parts too
    monkeypatch.setattr(fingerprints, "TOGETHER", 512)

    def most(count: int, again: str = "") -> int:
        vary = cw.design({"c1.gain": (4e-4, 8e-4)}, count, method="sobol")
        tracemalloc.start()
        run(tmp_path / f"{count}{again}", count, chunk=128, threads=1, vary=vary, outputs=cw.at("load.speed", TIMES))
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return peak

    # imports and the list of what is installed take memory too
    most(256)
    # what is known of a part takes some hundred bytes; the outputs alone would be 920 kB more
    allowed = most(2048) + 150_000
    # a thread that an earlier test left may take memory meanwhile, but not twice
    assert most(16384) < allowed or most(16384, "again") < allowed


def test_queries_and_pictures(tmp_path: Path) -> None:
    found = run(tmp_path)
    if pytest.importorskip("duckdb"):
        query = 'SELECT count(*), max("c1.heat") FROM study WHERE "lock(c1)" < 1.5'
        expected = found["c1.heat"][found["lock(c1)"] < 1.5]
        assert found.query(query).fetchall() == [(len(expected), expected.max())]
        for plain, name in (("c1.gain", "c1.gain"), ("lock(c1)", "lock(c1)")):
            with pytest.raises(cw.UseError) as caught:
                found.query(f"SELECT avg({plain}) FROM study")
            assert f'put names of columns into double quotes: "{name}"' in str(caught.value)
    pytest.importorskip("matplotlib").use("agg")
    found.plot(tmp_path / "x.png", names=["c1.*", "lock(c1)"])
    assert (tmp_path / "x.png").stat().st_size > 10_000
    assert "lock(c1)" in str(found)
    assert "<table" in found._repr_html_()
    with pytest.raises(cw.UnknownName, match=r"no column 'c1\.het'; did you mean 'c1\.heat'"):
        found["c1.het"]
    with pytest.raises(cw.UseError, match="there is no variant 300; give a whole number from 0 to 299"):
        found.run(300)

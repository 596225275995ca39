"""What a sweep is asked, how its variants end, and what it gives to other programs."""

from __future__ import annotations

import csv
import importlib
import pickle
import signal
import sys
import threading

import numpy as np
import pytest

import clutchwork as cw
from support import six_speed


def discs(friction: cw.Law | None = None) -> cw.Driveline:
    """Two discs that a clutch joins: equal speeds at 20 rad/s, 800 J of heat with a constant torque."""
    d = cw.Driveline("two discs")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    law = friction or cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=law, gain=1.0, normal_force=100.0))
    return d


# ------------------------------------------------------------------------------------------------------------- variants


def test_a_grid_against_closed_forms():
    gains, inertias = np.array([0.5, 1.0, 2.0]), np.array([0.1, 0.2])
    asked = ["load.speed", cw.lock("c1"), "c1.heat", cw.peak("c1.torque"), cw.integral("engine.speed")]
    found = cw.sweep(discs(), 4.0, vary={"c1.gain": gains, "engine.inertia": inertias}, outputs=asked)
    torque, J = 10.0 * gains[:, None], inertias[None, :]
    end = 100.0 * J / (J + 0.8)
    lock = 100.0 / (torque * (1 / J + 1 / 0.8))
    np.testing.assert_allclose(found["load.speed"], np.broadcast_to(end, (3, 2)), rtol=1e-12)
    np.testing.assert_allclose(found["lock(c1)"], lock, rtol=1e-9)
    # half of the reduced inertia times the slip squared
    heat = np.broadcast_to(0.5 * 100.0**2 / (1 / J + 1 / 0.8), (3, 2))
    np.testing.assert_allclose(found["c1.heat"], heat, rtol=1e-9)
    np.testing.assert_allclose(found["peak(c1.torque)"], np.broadcast_to(torque, (3, 2)), rtol=1e-12)
    turned = 0.5 * (100.0 + end) * lock + end * (4.0 - lock)
    np.testing.assert_allclose(found["integral(engine.speed)"], turned, rtol=1e-9)
    assert found.shape == (3, 2)
    assert len(found) == 6
    assert found.variant(3) == {"c1.gain": 1.0, "engine.inertia": 0.2}
    assert found.units["lock(c1)"] == "s"
    assert found.units["integral(engine.speed)"] == "rad"


def test_a_list_a_table_and_a_frame_are_the_same():
    pandas = pytest.importorskip("pandas")
    rows = [{"c1.gain": 0.5, "engine.inertia": 0.1}, {"c1.gain": 2.0, "engine.inertia": 0.3}]
    columns = {name: [row[name] for row in rows] for name in rows[0]}
    ways = [rows, cw.variants(columns), pandas.DataFrame(columns)]
    found = [cw.sweep(discs(), 3.0, vary=way, outputs=["load.speed", cw.lock("c1")]) for way in ways]
    for one in found:
        assert one["lock(c1)"].tolist() == found[0]["lock(c1)"].tolist()
        assert one.shape == (2,)
        assert [one.variant(number) for number in range(2)] == rows


def test_values_with_labels():
    linings = {"paper": cw.Coulomb(static=0.12, kinetic=0.1), "sinter": cw.Coulomb(static=0.1, kinetic=0.06)}
    found = cw.sweep(discs(), 4.0, vary={"c1.friction": linings}, outputs=cw.lock("c1"))
    assert found.to_xarray()["lock(c1)"].sel({"c1.friction": "paper"}).item() == pytest.approx(1.6, rel=1e-9)
    assert found["lock(c1)"][0] < found["lock(c1)"][1]


def test_nothing_varies_or_no_variant():
    assert cw.sweep(discs(), 3.0, vary={}, outputs="load.speed")["load.speed"].tolist() == pytest.approx(20.0)
    for nothing in ({"c1.gain": []}, {"c1.gain": [1.0], "load.inertia": []}, []):
        with pytest.raises(cw.UseError, match="empty"):
            cw.sweep(discs(), 3.0, vary=nothing, outputs="load.speed")
    with pytest.raises(cw.UseError, match=r"c1\.gain: the list of values is empty; give at least one"):
        cw.variants({"c1.gain": []})


@pytest.mark.parametrize(
    ("vary", "words"),
    [
        (3, "give values by name, a list of variants, cw.variants"),
        ({"c1.gain": 3.0}, r"c1\.gain: 3\.0 is not a list of values"),
        ([{"c1.gain": 1.0}, {"load.speed": 2.0}], "variant 0 has no 'load.speed'"),
    ],
)
def test_what_is_no_set_of_variants(vary, words):
    with pytest.raises(cw.UseError, match=words):
        cw.sweep(discs(), 3.0, vary=vary, outputs="load.speed")


def test_columns_of_different_length():
    with pytest.raises(cw.UseError, match=r"'c1\.gain' has 2, 'load\.inertia' has 1"):
        cw.variants({"c1.gain": [1.0, 2.0], "load.inertia": [1.0]})


def test_all_mistakes_of_values_at_once():
    vary = {"c1.gain": [1.0, -1.0], "c1.friction.static": [0.1, 0.05], "load.inertia": [0.8, -0.8]}
    with pytest.raises(cw.ModelError) as caught:
        cw.sweep(discs(), 3.0, vary=vary, outputs="load.speed")
    text = str(caught.value)
    assert "gain = -1.0 m3: must be > 0 m3" in text
    with pytest.raises(cw.ModelError, match=r"did you mean 'c1\.gain'"):
        cw.sweep(discs(), 3.0, vary={"c1.gian": [1.0]}, outputs="load.speed")


@pytest.mark.parametrize("wrong", [0.0, -1.0, np.nan, np.inf, -np.inf, "much", None, True])
def test_one_wrong_value_among_many(wrong):
    """Values are judged by their least and their most, and each alone where that does not tell."""
    gains = [*np.linspace(0.2, 0.3, 20).tolist(), wrong, *np.linspace(0.3, 0.2, 20).tolist()]
    with pytest.raises(cw.ClutchworkError, match=r"gain"):
        cw.sweep(six_speed.gearbox(six_speed.SHIFT), 4.0, vary={"F1.gain": gains}, outputs="w8.speed")


def test_values_that_are_wrong_together():
    vary = {"c1.friction.static": [0.1, 0.2], "c1.friction.kinetic": [0.05, 0.15]}
    with pytest.raises(
        cw.ModelError, match=r"static = 0\.1: is below the kinetic coefficient at vanishing slip, 0\.15"
    ):
        cw.sweep(discs(), 3.0, vary=vary, outputs="load.speed")


# -------------------------------------------------------------------------------------------------------------- outputs


@pytest.mark.parametrize(
    ("outputs", "words"),
    [
        ([], "outputs are missing"),
        ([3], "3 is not an output"),
        (["laod.speed"], "did you mean 'load.speed'"),
        ([cw.lock("c2")], "no contact 'c2'; did you mean 'c1'"),
        ([cw.integral("c1.torque")], "has no exact integral: give a power of an element, a speed"),
        (
            [cw.jerk("load", 2.0)],
            r"jerk\(load\): two windows of 2 s take 4 s, there are 3 s of the run; give a window=",
        ),
        ([cw.jerk("load", between=(4.0, 5.0))], "there are 0 s of the run"),
        ([cw.at("load.speed", [1.0, 9.0])], r"9 s is after t_end = 3 s"),
        ([cw.at("load.speed", 1.0), cw.at("load.speed", 2.0)], "two outputs are called 'load.speed at'"),
    ],
)
def test_what_is_no_output(outputs, words):
    with pytest.raises(cw.UseError, match=words):
        cw.sweep(discs(), 3.0, vary={"c1.gain": [1.0]}, outputs=outputs)


def test_what_a_motor_draws_has_an_integral_and_its_loss_says_from_what_it_follows():
    d = cw.Driveline("motor")
    rotor = d.shaft("rotor", inertia=0.5)
    d.add(cw.ElectricMotor("m", shaft=rotor, max_torque=100.0, command=20.0, no_load_loss=300.0))
    asked = [cw.integral("m.electric_power"), "m.electric_energy", "m.work"]
    found = cw.sweep(d, 2.0, vary=[{}], outputs=asked)
    assert found["integral(m.electric_power)"][0] == found["m.electric_energy"][0]
    # 300 W over 2 s
    assert found["m.electric_energy"][0] - found["m.work"][0] == pytest.approx(600.0, rel=1e-9)
    with pytest.raises(cw.UseError, match=r"it is what m.electric_energy grows by, less what m.work does; take both"):
        cw.sweep(d, 2.0, vary=[{}], outputs=cw.integral("m.loss"))


def test_calls_of_outputs():
    with pytest.raises(cw.UseError, match="give 1 for the first"):
        cw.lock("c1", 0)
    with pytest.raises(cw.UseError, match="instants"):
        cw.at("load.speed", [2.0, 1.0])
    with pytest.raises(cw.UseError, match="not a name"):
        cw.maximum(3)


def test_names_for_outputs_and_functions_of_the_run():
    asked = {
        "when": cw.lock("c1"),
        "mean": lambda run: float(np.mean(run["load.speed"])),
        "kind": lambda run: run.status,
    }
    found = cw.sweep(discs(), 3.0, vary={"c1.gain": [0.5, 1.0]}, outputs=asked)
    run = cw.simulate(discs().assemble().changed({"c1.gain": 0.5}), 3.0)
    assert found.names == ("when", "mean", "kind")
    assert found["mean"][0] == float(np.mean(run["load.speed"]))
    assert found["kind"].tolist() == ["done", "done"]
    assert found.run(0)["load.speed"].tobytes() == run["load.speed"].tobytes()
    with pytest.raises(cw.UnknownName, match="did you mean 'when'"):
        found["wenn"]


def test_a_function_that_fails_loses_its_value_alone():
    def fussy(run):
        return 1.0 / (run.t_end - 3.0) if run["load.speed"][-1] > 15.0 else 7.0

    with pytest.warns(cw.OutputWarning, match=r"output 'fussy' of variant \d: ZeroDivisionError: .*missing"):
        found = cw.sweep(discs(), 3.0, vary={"c1.gain": [0.01, 2.0, 0.02]}, outputs=[fussy, "load.speed"])
    assert found.finished.all()
    assert np.isnan(found["fussy"]).tolist() == (found["load.speed"] > 15.0).tolist() == [False, True, False]
    assert [(one.variant, one.output) for one in found.problems] == [(1, "fussy")]
    assert found.problems[0].reason.startswith("ZeroDivisionError: ")
    assert not cw.sweep(discs(), 3.0, vary={"c1.gain": [0.5]}, outputs="load.speed").problems


@pytest.mark.parametrize("many", [lambda run: run["load.speed"], lambda run: [1.0, 2.0], lambda run: {"a": 1.0}])
def test_a_function_gives_one_value(many):
    with pytest.raises(cw.UseError, match=r"the output .* gave .*: give one number for each variant; cw\.at"):
        cw.sweep(discs(), 3.0, vary={"c1.gain": [0.5]}, outputs={"many": many})
    found = cw.sweep(discs(), 3.0, vary={"c1.gain": [0.5]}, outputs=lambda run: np.array(2.5))
    assert found["<lambda>"].tolist() == [2.5]


def test_what_is_no_number_name_or_variant():
    with pytest.raises(cw.UseError, match=r"options is 5: it must be cw\.Options"):
        cw.sweep(discs(), 3.0, vary={"c1.gain": [0.5]}, outputs="load.speed", options=5)
    with pytest.raises(cw.UseError, match="changes is 5: give values by name"):
        discs().assemble().changed(5)
    with pytest.raises(cw.UseError, match="times is missing"):
        cw.at(object())
    with pytest.raises(cw.UseError, match="is not a name"):
        cw.at(object(), 1.0)
    for times in (object(), "soon", [[1.0, 2.0], [3.0]], None):
        with pytest.raises(cw.ClutchworkError):
            cw.at("load.speed", times)
    found = cw.sweep(discs(), 3.0, vary={"c1.gain": [0.5, 0.6]}, outputs="load.speed")
    for number in (99, -3, 0.5, "first", None, True):
        for ask in (found.run, found.variant, found.message):
            with pytest.raises(cw.UseError, match=r"there is no variant .*; give a whole number from 0 to 1"):
                ask(number)
    assert found.variant(-1) == {"c1.gain": 0.6}


def test_wrong_values_of_all_names_at_once():
    vary = {"c1.normal_force": ["two", "3 bar", 3.0], "c1.gain": [-1.0, 2.0], "load.inertia": [-0.8, 1.0]}
    with pytest.raises(cw.ModelError) as caught:
        cw.sweep(discs(), 3.0, vary=vary, outputs="load.speed")
    text = str(caught.value)
    for words in ("'two'", "'3 bar'", "gain = -1.0", "inertia = -0.8"):
        assert words in text


def test_controllers():
    def pressed(t, readings):
        return 50.0 if readings["load.speed"] < 5.0 else 100.0

    d = discs()
    vary = {"c1.normal_force": [cw.Sampled(pressed, 0.01)], "c1.gain": [1.0, 2.0]}
    found = cw.sweep(
        d, 3.0, vary=vary, outputs=["load.speed", cw.lock("c1"), cw.peak("c1.torque"), cw.at("c1.slip", [0, 1])]
    )
    run = cw.simulate(d.assemble().changed(found.variant(1)), 3.0)
    assert found["lock(c1)"][0, 1] == run.events[-1].time
    assert found["peak(c1.torque)"][0].tolist() == pytest.approx([10.0, 20.0])
    assert found.finished.all()


def test_options_that_are_without_effect():
    with pytest.raises(cw.UseError, match=r"dt would be without effect: say when in the outputs"):
        cw.sweep(discs(), 3.0, vary={}, outputs="load.speed", dt=0.1)
    with pytest.raises(cw.UseError, match="threads is 0"):
        cw.sweep(discs(), 3.0, vary={}, outputs="load.speed", threads=0)
    with pytest.raises(cw.UseError, match="is not a model"):
        cw.sweep("model.toml", 3.0, vary={}, outputs="load.speed")
    with pytest.raises(cw.OptionError, match="t_end is missing"):
        cw.sweep(discs(), vary={}, outputs="load.speed")


def test_signals_that_were_not_computed():
    with pytest.raises(cw.UseError, match="was not computed: run with work=True"):
        cw.sweep(discs(), 3.0, vary={}, outputs=["c1.heat"], work=False)


# ------------------------------------------------------------------------------------------------------------- failures


def test_a_variant_that_stops_early_hurts_no_other():
    d = discs(cw.FrictionTable(static=0.12, kinetic=[(0.0, 0.1), (150.0, 0.1)], extrapolation="error"))
    asked = ["load.speed", "c1.state", cw.lock("c1"), cw.maximum("load.speed"), cw.at("load.speed", [0.0, 1.0])]
    found = cw.sweep(d, 3.0, vary={"engine.speed": [100.0, 200.0, 120.0]}, outputs=asked)
    assert found.status.tolist() == ["done", "out_of_table", "done"]
    assert found.finished.tolist() == [True, False, True]
    assert np.isnan(found["load.speed"]).tolist() == [False, True, False]
    assert found["c1.state"].tolist() == ["locked", "", "locked"]
    with pytest.warns(cw.StoppedEarly) as told:
        cw.simulate(d.assemble().changed({"engine.speed": 200.0}), 3.0)
    assert found.message(1) == str(told[0].message)
    assert "the table covers 0 to 150 rad/s" in found.message(1)
    assert found.message(0) == ""
    assert "2 done, 1 out_of_table" in repr(found)


def test_a_budget_of_steps():
    found = cw.sweep(discs(), 3.0, vary={"c1.gain": [1.0, 2.0]}, outputs="load.speed", max_steps=2)
    assert set(found.status.tolist()) == {"too_many_steps"}
    assert "raise max_steps" in found.message(0)


def test_numbers_that_overflow():
    d = cw.Driveline("x")
    a = d.shaft("a", inertia=1e-3, speed=1.0)
    d.add(cw.QuadraticTorque("q", shaft=a, nominal_torque=1.0, nominal_speed=1.0))
    system = d.assemble()
    vary = {"q.nominal_torque": [-1.0, 1.0, 1e300]}
    found = cw.sweep(system, 50.0, vary=vary, outputs=["a.speed", cw.maximum("a.speed")])
    for number in range(3):
        run = found.run(number)
        assert found.status[number] == run.status
        assert found.message(number) == run.message


def test_states_that_are_not_there_otherwise():
    four, five = ([(1e-5 * (k + 1), 1.0 / n) for k in range(n)] for n in (4, 5))
    d = discs(cw.GMS(static=0.12, kinetic=0.1, speed=1.0, elements=four))
    with pytest.raises(cw.UseError, match="give the driveline other states"):
        cw.sweep(d, 0.1, vary={"c1.friction.elements": [four, five]}, outputs="load.speed")


# ---------------------------------------------------------------------------------------------------- progress, Ctrl-C


def test_progress():
    said = []
    vary = {"F1.gain": np.linspace(0.2, 0.3, 3000)}
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    cw.sweep(system, 0.5, vary=vary, outputs="w8.speed", progress=lambda done, total: said.append((done, total)))
    assert said[-1] == (3000, 3000)
    assert [done for done, _ in said] == sorted(done for done, _ in said)
    with pytest.raises(cw.UseError, match="progress is 3"):
        cw.sweep(system, 0.5, vary=vary, outputs="w8.speed", progress=3)


def test_a_bar_of_tqdm(capsys):
    pytest.importorskip("tqdm")
    cw.sweep(discs(), 3.0, vary={"c1.gain": [1.0, 2.0]}, outputs="load.speed", progress=True)
    assert "2/2" in capsys.readouterr().err


def test_packages_that_are_missing(monkeypatch, tmp_path):
    found = cw.sweep(discs(), 3.0, vary={"c1.gain": [1.0]}, outputs="load.speed")
    for name in ("tqdm.auto", "pyarrow"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(ImportError, match=r'pip install "clutchwork\[exchange\]"'):
        found.to_parquet(tmp_path / "x.parquet")
    with pytest.raises(ImportError, match=r'progress=True needs tqdm: pip install "clutchwork\[notebook\]"'):
        cw.sweep(discs(), 3.0, vary={"c1.gain": [1.0]}, outputs="load.speed", progress=True)


def test_a_progress_that_raises_ends_the_sweep():
    def refuse(done, total):
        raise RuntimeError("enough")

    vary = {"F1.gain": np.linspace(0.2, 0.3, 4000)}
    with pytest.raises(RuntimeError, match="enough"):
        cw.sweep(six_speed.gearbox(six_speed.SHIFT), 4.0, vary=vary, outputs="w8.speed", progress=refuse)


@pytest.mark.parametrize("between", [False, True], ids=["in the core", "in Python"])
def test_ctrl_c_keeps_what_is_done(between):
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    main = threading.main_thread().ident
    assert main is not None
    asked = threading.Timer(0.02, lambda: signal.pthread_kill(main, signal.SIGINT))
    said = []

    def stop(done, total):
        if done >= 100 and not said:
            said.append(done)
            signal.raise_signal(signal.SIGINT) if between else asked.start()

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    grid = {"F1.gain": np.linspace(0.2, 0.3, 1000), "F2.gain": np.linspace(0.06, 0.07, 1000)}
    try:
        with pytest.raises(cw.SweepInterrupted) as caught:
            cw.sweep(system, 4.0, vary=grid, outputs=["w8.speed", cw.lock("F1")], progress=stop)
    finally:
        asked.cancel()
        signal.signal(signal.SIGINT, before)
    found = caught.value.sweep
    done = found.finished
    assert 100 <= done.sum() < 10**6
    assert not np.isnan(found["w8.speed"][done]).any()
    assert np.isnan(found["w8.speed"][~done]).all()
    assert set(found.status.reshape(-1).tolist()) == {"done", "interrupted"}
    assert isinstance(caught.value, KeyboardInterrupt)
    assert "variants are done; what they gave is kept in .sweep" in str(caught.value)


# --------------------------------------------------------------------------------------------------------------- tables


def table() -> cw.Sweep:
    """Outputs of all shapes over a grid."""
    asked = ["load.speed", cw.at("c1.slip", [0.5, 1.0]), cw.lock("c1"), "c1.state"]
    return cw.sweep(discs(), 3.0, vary={"c1.gain": [0.5, 1.0, 2.0], "load.inertia": [0.8, 1.6]}, outputs=asked)


def test_pandas():
    pytest.importorskip("pandas")
    found = table()
    frame = found.to_pandas()
    assert list(frame.columns)[:2] == ["c1.gain", "load.inertia"]
    assert list(frame.columns)[2:] == [
        "load.speed",
        "c1.slip at 0.5 s",
        "c1.slip at 1 s",
        "lock(c1)",
        "c1.state",
        "status",
    ]
    assert frame["c1.gain"].tolist() == [0.5, 0.5, 1.0, 1.0, 2.0, 2.0]
    assert frame["lock(c1)"].to_numpy().tobytes() == found.flat("lock(c1)").tobytes()
    assert frame.attrs["units"]["load.speed"] == "rad/s"


def test_xarray():
    pytest.importorskip("xarray")
    found = table()
    data = found.to_xarray()
    assert data["load.speed"].dims == ("c1.gain", "load.inertia")
    assert data["c1.slip at"].dims == ("c1.gain", "load.inertia", "c1.slip at time")
    one = data["lock(c1)"].sel({"c1.gain": 1.0, "load.inertia": 1.6})
    assert one.item() == found["lock(c1)"][1, 1]
    assert one.attrs["units"] == "s"
    rows = cw.sweep(discs(), 3.0, vary=[{"c1.gain": 1.0}, {"c1.gain": 2.0}], outputs="load.speed").to_xarray()
    assert rows["load.speed"].dims == ("variant",)
    assert rows["c1.gain"].values.tolist() == [1.0, 2.0]


def test_parquet(tmp_path):
    pytest.importorskip("pyarrow")
    parquet = importlib.import_module("pyarrow.parquet")
    found = table()
    found.to_parquet(tmp_path / "x.parquet")
    read = parquet.read_table(tmp_path / "x.parquet")
    assert np.array(read["lock(c1)"]).tobytes() == found.flat("lock(c1)").tobytes()
    assert read["status"].to_pylist() == ["done"] * 6
    assert read.schema.metadata[b"unit load.speed"] == b"rad/s"


def test_csv(tmp_path):
    found = table()
    found.to_csv(tmp_path / "x.csv")
    with (tmp_path / "x.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    np.testing.assert_array_equal([float(row["lock(c1) [s]"]) for row in rows], found.flat("lock(c1)"))
    assert [row["c1.state"] for row in rows] == found.flat("c1.state").tolist()


def test_a_sweep_is_copied_with_its_results():
    found = table()
    again = pickle.loads(pickle.dumps(found))
    assert again["lock(c1)"].tobytes() == found["lock(c1)"].tobytes()
    assert again.run(1).status == "done"


def test_a_name_that_varies_and_is_an_output():
    """The speed at the start and at the end have columns of their own; the status keeps its own."""
    d = cw.Driveline("disc")
    s = d.shaft("s", inertia=2.0, speed=1.0)
    d.add(cw.Torque("pull", shaft=s, torque=3.0))
    found = cw.sweep(d, 1.0, vary={"s.speed": [1.0, 2.0]}, outputs=["s.speed"])
    table = found.to_pandas()
    assert list(table["s.speed given"]) == [1.0, 2.0]
    assert list(table["s.speed"]) == pytest.approx([2.5, 3.5], rel=1e-9)
    assert found.to_xarray()["s.speed"].dims == ("s.speed given",)
    with pytest.raises(cw.UseError, match="an output is called 'status'"):
        cw.sweep(d, 1.0, vary={"s.speed": [1.0]}, outputs={"status": "s.speed"})


def test_tables_take_names_and_wildcards(tmp_path):
    found = table()
    both = ["c1.gain", "load.inertia"]
    assert list(found.to_pandas("c1.*").columns) == [*both, "c1.slip at 0.5 s", "c1.slip at 1 s", "c1.state", "status"]
    assert list(found.to_xarray(["load.*"]).data_vars) == ["load.speed", "status"]
    found.to_parquet(tmp_path / "x.parquet", names="load.*")
    frame = pytest.importorskip("pandas").read_parquet(tmp_path / "x.parquet")
    assert list(frame.columns) == [*both, "load.speed", "status"]
    assert frame.attrs["units"] == {"c1.gain": "m", "load.inertia": "kg m2", "load.speed": "rad/s"}
    found.to_csv(tmp_path / "x.csv", names="load.speed")
    assert (tmp_path / "x.csv").read_text().splitlines()[0].endswith("load.speed [rad/s],status")
    with pytest.raises(KeyError, match=r"(?s)no output 'load.sped'; did you mean 'load.speed'.*no output 'x.\*'"):
        found.to_csv(tmp_path / "y.csv", names=["load.sped", "x.*"])


def test_values_that_vary_have_their_unit_beside_the_outputs(tmp_path):
    found = cw.sweep(
        discs(), 3.0, vary={"c1.gain": [1e-6, 1.0], "load.speed": ["0 rpm", "60 rpm"]},
        outputs=[cw.lock("c1"), "load.speed", cw.at("c1.slip", [0.5])],
    )  # fmt: skip
    found.to_csv(tmp_path / "x.csv")
    heads = ["c1.gain [m]", "load.speed given [rad/s]", "lock(c1) [s]", "load.speed [rad/s]"]
    heads += ["c1.slip at 0.5 s [rad/s]", "status"]
    assert (tmp_path / "x.csv").read_text().splitlines()[0] == ",".join(heads)
    assert found.units["c1.gain"] == found.to_pandas().attrs["units"]["c1.gain"] == "m"
    assert found.to_xarray()["load.speed given"].attrs["units"] == "rad/s"
    told = str(found)
    for head in heads:
        assert head in told
    assert "6.28319" in told
    assert "lock(c1): no value in 2 of 4 variants" in told
    assert "lock(c1): no value in 2 of 4 variants" in found._repr_html_()
    assert "c1.gain, m" in found._repr_html_()


def test_a_number_beside_a_signal_is_called_as_it_was_given():
    ramp = cw.Ramp(height=200.0, duration=0.5)
    found = cw.sweep(discs(), 1.0, vary={"c1.normal_force": ["200 N", 150.0, ramp]}, outputs="load.speed")
    assert found.coords["c1.normal_force"].tolist() == ["200 N", "150 N", "Ramp 2"]
    assert not found.units.get("c1.normal_force")

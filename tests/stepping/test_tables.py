"""Signals that get another table in a run: the bits of a model that has it, in saved states and groups too."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.core import core
from support.amount import seeds
from support.random_drivelines import T_END, describe
from support.wasm import Job, Stretch, grid, here, set_segments

CASES = max(6, len(seeds()) // 10)


def pressures(seed: int) -> tuple[cw.System, str, int, cw.Table]:
    """A random driveline, the name and number of a pressure of it, and the table that it has."""
    system = describe(seed).driveline().assemble()
    name = next(item.name for item in system.inputs if item.name.endswith(".pressure"))
    number = [item.name for item in system.inputs].index(name)
    return system, name, number, system.inputs[number].signal


def moved(table: cw.Table, rng: np.random.Generator) -> cw.Table:
    """The table with knots that stand and are elsewhere, in the same number of pieces."""
    times, values = np.array(table.points).T
    inner = np.sort(rng.uniform(times[0] + 0.02, T_END, len(times) - 1))
    made = zip([float(times[0]), *inner.tolist()], (values * rng.uniform(0.3, 1.5, len(values))).tolist(), strict=True)
    return cw.Table(tuple(made))


def joined(before: cw.Table, after: cw.Table, at: float) -> cw.Table:
    """The first table up to a time, the second one from there on."""

    def value(table: cw.Table) -> float:
        return float(np.interp(at, *np.array(table.points).T))

    left = [point for point in before.points if point[0] < at]
    right = [point for point in after.points if point[0] > at]
    return cw.Table([*left, (at, value(before)), (at, value(after)), *right])


def same(one: Any, other: Any) -> None:
    assert one.status == other.status
    assert one.rows.tobytes() == other.rows.tobytes()
    assert one.events.tobytes() == other.events.tobytes()


@pytest.mark.parametrize("seed", range(CASES))
def test_set_at_the_start_it_is_the_model_with_that_table(seed: int) -> None:
    system, name, number, table = pressures(seed)
    other = moved(table, np.random.default_rng(seed))
    one = here([Job(system, [Stretch(grid(T_END), number, other.segments())])])[0]
    assert one.set == [1.0]
    same(one, here([Job(system.changed({name: other}), [Stretch(grid(T_END))])])[0])


@pytest.mark.parametrize("seed", range(CASES))
def test_set_in_mid_run_it_is_the_model_with_both_parts(seed: int) -> None:
    """The next knot of the new table comes before that of the old one, and after it."""
    rng = np.random.default_rng(seed)
    system, name, number, table = pressures(seed)
    at, other = float(rng.uniform(0.2, 1.5)), moved(table, rng)
    both = system.changed({name: joined(table, other, at)})
    begin, later = Stretch(np.array([at])), Stretch(grid(T_END, 21, at)[1:])
    one = here([Job(system, [begin, later._replace(signal=number, segments=other.segments())])])[0]
    model = here([Job(both, [begin, later])])[0]
    scale = np.max(np.abs(model.rows), axis=0)
    assert np.all(np.abs(one.rows[1:] - model.rows[1:]) <= 1e-9 * scale + 1e-300)
    assert np.array_equal(one.events[:, 1:5], model.events[:, 1:5])
    assert np.allclose(one.events[:, 0], model.events[:, 0], rtol=0.0, atol=1e-9)


def run_of(system: cw.System) -> Any:
    run = core().Run(system.to_bytes())
    for name, value in {"rtol": 1e-7, "angles": 1.0, "work": 1.0}.items():
        run.set_option(name, value)
    return run


def rest(run: Any, times: np.ndarray) -> tuple[bytes, bytes]:
    """Rows and events of what is left of a run."""
    rows = np.empty((len(times), run.row_size))
    status, filled, _ = run.advance(float(times[-1]), times.copy(), rows, 0, 0)
    assert (status, filled) == (0, len(times))
    return rows.tobytes(), np.array(run.events()).tobytes()


@pytest.mark.parametrize("seed", range(CASES))
def test_saved_and_restored_around_it_the_bits_stay(seed: int) -> None:
    """Saved before, right after and later; a knot may move before the one that the run expects."""
    rng = np.random.default_rng(seed)
    system, _, number, table = pressures(seed)
    at, late = float(rng.uniform(0.2, 1.0)), float(rng.uniform(1.1, 1.7))
    first, second = (Stretch(grid(1.0), number, moved(table, rng).segments()) for _ in range(2))
    times = grid(T_END, 21, late)
    whole = run_of(system)
    rest(whole, np.array([at]))
    before = whole.save()
    assert set_segments(whole, first)
    after = whole.save()
    way = rest(whole, np.array([late]))
    later = whole.save()
    assert set_segments(whole, second)
    last = whole.save()
    expected = rest(whole, times)
    for state in (before, after, later, last):
        other = run_of(system)
        other.restore(state)
        if state is before:
            assert set_segments(other, first)
            assert other.save() == after
        if state in (before, after):
            assert rest(other, np.array([late])) == way
            assert other.save() == later
        if state is not last:
            assert set_segments(other, second)
            assert other.save() == last
        assert rest(other, times) == expected
    # to look does not change what follows
    whole.restore(last)
    whole.row()
    whole.restore(last)
    assert rest(whole, times) == expected


def test_damaged_states_are_refused() -> None:
    system, _, number, table = pressures(0)
    run = run_of(system)
    rest(run, np.array([0.5]))
    plain = run.save()
    assert set_segments(run, Stretch(grid(1.0), number, moved(table, np.random.default_rng(1)).segments()))
    state = run.save()
    assert len(state) == len(plain) + 8 * 13 * len(table.segments())
    for bad in (state[:-8], state + bytes(8), state[:-8] + b"\0\0\0\0\0\0\xf8\x7f", plain + state[len(plain) :]):
        with pytest.raises(ValueError, match="the saved state is damaged"):
            run.restore(bad)
        assert run.save() == state


def test_the_core_refuses_what_is_no_signal() -> None:
    system, _, number, table = pressures(0)
    run, good = run_of(system), [list(piece) for piece in table.segments()]
    rest(run, np.array([0.5]))
    state = run.save()
    falling = [good[-1], *good[:-1]]
    endless = [[*good[0][:3], np.inf, *good[0][4:]], *good[1:]]
    nowhere = [[np.nan, *good[0][1:]], *good[1:]]
    for signal, segments in (
        (-1, good), (len(system.inputs), good), (number, [*good, good[-1]]), (number, falling), (number, endless),
        (number, nowhere), (number, []),
    ):  # fmt: skip
        assert set_segments(run, Stretch(grid(1.0), signal, segments)) == 0.0
        assert run.save() == state
    # what it follows already is no knot
    assert set_segments(run, Stretch(grid(1.0), number, good)) == 1.0
    assert run.save() == state


def test_runs_of_a_group_have_the_bits_of_each_alone() -> None:
    system, _, number, table = pressures(3)
    tables = [moved(table, np.random.default_rng(seed)) for seed in range(8)]
    group, alone = [run_of(system) for _ in tables], [run_of(system) for _ in tables]
    for runs in (group, alone):
        for k, (run, other) in enumerate(zip(runs, tables, strict=True)):
            # some from the start, some on the way
            if k < 4:
                assert set_segments(run, Stretch(grid(1.0), number, other.segments()))
    core().advance_group(group, 0.6)
    for run in alone:
        run.advance(0.6, np.empty(0), np.empty((0, run.row_size)), 0, 0)
    for runs in (group, alone):
        for run, other in zip(runs, reversed(tables), strict=True):
            assert set_segments(run, Stretch(grid(1.0), number, other.segments()))
    core().advance_group(group, T_END)
    for run in alone:
        run.advance(T_END, np.empty(0), np.empty((0, run.row_size)), 0, 0)
    for one, other in zip(group, alone, strict=True):
        assert one.row().tobytes() == other.row().tobytes()
        assert np.array(one.events()).tobytes() == np.array(other.events()).tobytes()
        assert one.statistics() == other.statistics()


# -------------------------------------------------------------------------------------------------------- in Python


def test_a_simulator_follows_a_table_until_it_is_released(tmp_path: Path) -> None:
    system, name, _, table = pressures(5)
    other = moved(table, np.random.default_rng(5))
    sim, model = cw.Simulator(system), cw.Simulator(system.changed({name: other}))
    sim.set(name, other)
    assert sim.held == {name: other}
    for one in (sim, model):
        one.advance(0.7)
    assert sim.save().row == model.save().row
    state = sim.save()
    sim.release(name)
    sim.advance(0.3)
    assert sim[name] == pytest.approx(np.interp(1.0, *np.array(table.points).T))
    # wherever it is continued
    state.save(tmp_path / "a.cwstate")
    again = cw.Simulator(system, start=cw.State.load(tmp_path / "a.cwstate"))
    sim.restore(state)
    for one in (sim, again, model):
        one.advance_to(1.5)
    assert again.held == {name: other}
    assert sim.save().row == again.save().row == model.save().row
    run = sim.run
    assert run.rows[-1].tobytes() == sim.save().row
    run.save(tmp_path / "a.cwrun")
    loaded = cw.load_run(tmp_path / "a.cwrun")
    assert loaded.state(at=1.2).core == run.state(at=1.2).core
    sim.reset()
    assert sim.held == {}


def test_what_is_past_needs_no_room() -> None:
    system, name, _, table = pressures(2)
    sim = cw.Simulator(system)
    sim.advance(1.0)
    points = [(0.0, 1e5), (0.2, 2e5), (0.4, 1e5), (0.6, 2e5), *((t, 1e5 * t) for t in np.linspace(1.1, 1.9, 3))]
    assert len(points) > len(table.points) - 1
    sim.set(name, cw.Table(points))
    sim.advance(0.5)
    assert sim[name] == pytest.approx(1.5e5)


@pytest.mark.parametrize(
    ("table", "said"),
    [
        (cw.Table([(t, 1e5) for t in range(30)]), "30 segments ahead: has room for"),
        (cw.Table([(0.0, np.inf), (1.0, 1e5)]), "must be finite"),
        (cw.Table([(1.0, 1.0), (0.0, 1e5)]), "point 2 = 0 s: comes after 1 s"),
        (cw.Ramp(height=1e5, duration=0.1), "must be a number"),
    ],
)
def test_errors_say_what_to_do(table: Any, said: str) -> None:
    system, name, _, _ = pressures(2)
    sim = cw.Simulator(system)
    with pytest.raises(cw.ModelError) as caught:
        sim.set(name, table)
    assert said in str(caught.value)
    assert sim.held == {}


def test_points_may_have_units() -> None:
    system, name, _, _ = pressures(2)
    sim = cw.Simulator(system)
    sim.set(name, cw.Table([("0 s", "1 bar"), ("1000 ms", "2 bar")]))
    sim.advance(0.5)
    assert sim[name] == pytest.approx(1.5e5)


def test_a_signal_that_repeats_or_has_a_controller_takes_no_table() -> None:
    d = cw.Driveline("two signals")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.Torque("engine", shaft=a, torque=cw.Pulse(height=10.0, period=0.5, width=0.2)))
    d.add(cw.Torque("load", shaft=a, torque=cw.Sampled(lambda t, s: -1.0, 0.1)))
    sim = cw.Simulator(d)
    with pytest.raises(cw.ModelError, match=r"repeats every 0\.5 s") as caught:
        sim.set({"engine.torque": cw.Table([(0.0, 1.0)]), "load.torque": cw.Table([(0.0, 1.0)])})
    assert "is set by a controller and has no room for a table" in str(caught.value)


@pytest.mark.parametrize("again", [False, True])
def test_a_prescribed_speed_leaves_its_slope_at_the_instant(again: bool) -> None:
    """What happens there is decided with both limits, as at a knot of the model, also where a state lies between."""
    d = cw.Driveline("drum")
    drum, shaft = d.shaft("drum", inertia=1.0), d.shaft("shaft", inertia=0.1, speed=10.0)
    before, after = cw.Table(((0.0, 10.0), (1.0, 20.0), (2.0, 20.0))), cw.Table(((0.5, 15.5), (0.7, 40.0), (2.0, 0.0)))
    d.add(cw.PrescribedSpeed("motor", shaft=drum, speed=before))
    d.add(
        cw.Clutch(
            "c", base=drum, follower=shaft, friction=cw.Coulomb(static=0.4, kinetic=0.3), gain=1.0, normal_force=9.0
        )
    )
    d.add(cw.Damper("load", base=d.housing, follower=shaft, damping=0.02))
    system = d.assemble()
    number = [item.name for item in system.inputs].index("motor.speed")
    run, model = run_of(system), run_of(system.changed({"motor.speed": joined(before, after, 0.5)}))
    for one in (run, model):
        one.expect_inputs(True)
        rest(one, np.array([0.5]))
    assert set_segments(run, Stretch(grid(1.0), number, after.segments()[1:]))
    if again:
        state = run.save()
        run = run_of(system)
        run.restore(state)
    times, rows, found = grid(2.0, 31, 0.5)[1:], [], []
    for one in (run, model):
        made = np.empty((len(times), one.row_size))
        assert one.advance(2.0, times.copy(), made, 0, 0)[:2] == (0, len(times))
        rows.append(made)
        found.append(np.array(one.events()))
    assert np.allclose(rows[0], rows[1], rtol=1e-9, atol=1e-9 * np.max(np.abs(rows[1])))
    assert len(found[0]) >= 2
    assert found[0][:, 1:5].tolist() == found[1][:, 1:5].tolist()
    assert np.allclose(found[0], found[1], rtol=1e-8, atol=1e-8)

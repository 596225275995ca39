"""Saved runs that were stepped or began at a state are repeated bit for bit; damaged ones are refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.base import archive
from clutchwork.run.save import RUN_PARTS, RunFormatError
from support.continued import brake, same


def test_a_saved_run_that_was_stepped_or_began_at_a_state_is_repeated_bit_for_bit(tmp_path: Path) -> None:
    sim = cw.Simulator(brake())
    sim.advance(0.3)
    sim.set({"b.pressure": 5e4, "b.friction.kinetic": 0.2})
    sim.advance(0.3)
    state = sim.save()
    sim.release("b.pressure")
    sim.advance(0.2)
    on = cw.Simulator(brake(), start=state)
    on.advance(0.1)
    on.set("b.pressure", 2e4)
    on.advance(0.1)
    runs = [sim.run, on.run, brake().simulate(1.0, start=state), cw.Simulator(brake(), start=state).run]
    for run in runs:
        run.save(tmp_path / "run")
        loaded = cw.load_run(tmp_path / "run")
        same(loaded, run)
        assert loaded.energy.residual == run.energy.residual
        loaded.save(tmp_path / "again")
        times = np.linspace(run.options.t_start, run.t_end, 7)
        middle = 0.5 * (run.options.t_start + run.t_end)
        for one in (loaded, cw.load_run(tmp_path / "again")):
            same(one.at(times), run.at(times))
            there, wanted = one.state(middle), run.state(middle)
            assert (there.core, there.row) == (wanted.core, wanted.row)
            assert (dict(there.held), dict(there.changed)) == (dict(wanted.held), dict(wanted.changed))
            assert one.state().core == run.state().core
    late = brake().simulate(1.0, t_start=0.5)
    late.save(tmp_path / "late")
    assert cw.load_run(tmp_path / "late").state(0.7).row == late.state(0.7).row
    assert late.to_pandas(dt=0.2).index.tolist() == pytest.approx([0.5, 0.7, 0.9, 1.0])


@pytest.mark.parametrize(
    ("part", "old", "new"),
    [
        ("tape", b'"input"', b'"other"'),
        ("tape", b'"ends": [', b'"ends": [9.0, '),
        ("tape", b'"noted": [[', b'"noted": [["x", '),
        ("tape", b'"held": {}', b'"held": []'),
        ("tape", b"{", b""),
        ("start_head", b'"fingerprint": "', b'"fingerprint": "0'),
        ("start_head", b"{", b""),
    ],
)
def test_damaged_steps_of_a_saved_run_are_refused(tmp_path: Path, part: str, old: bytes, new: bytes) -> None:
    sim = cw.Simulator(brake())
    sim.advance(0.3)
    on = cw.Simulator(brake(), start=sim.save())
    on.advance(0.1)
    on.set("b.pressure", 5e4)
    on.advance(0.3)
    on.run.save(tmp_path / "run")
    parts = dict(zip(RUN_PARTS, archive.read(tmp_path / "run", RUN_PARTS), strict=True))
    assert old in parts[part]
    archive.write(tmp_path / "bad", {**parts, part: parts[part].replace(old, new, 1)})
    with pytest.raises(RunFormatError, match="cannot read a run"):
        cw.load_run(tmp_path / "bad")

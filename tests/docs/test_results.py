"""docs/guide/results.md lists the causes, statuses, modes, statistics and signals that the code emits, no others."""

from __future__ import annotations

import re
import warnings
from functools import cache

import clutchwork as cw
from clutchwork.assembly.wiring import wiring
from clutchwork.declare.layout import CAUSES, MODES, ROW, STATISTICS, STATUS
from clutchwork.declare.schema import REGISTRY, inputs, specs
from clutchwork.results.channels import Channels
from support import samples
from support.pages import code, page, plain, table
from support.project import ROOT

PAGE = page("guide/results.md")
CORE = "\n".join(path.read_text(encoding="utf-8") for path in sorted((ROOT / "cpp").rglob("*.hpp")))
# a run that returns has none of these: it continues with a new buffer, or was refused when it was loaded
INTERNAL = {"done", "rows_full", "events_full", "bad_system"}


def test_causes() -> None:
    rows = {code(row[0])[0]: row[1] for row in table(PAGE, "cause")}
    assert rows == dict(CAUSES.values())


def test_the_core_emits_every_cause() -> None:
    emitted = set(re.findall(r"Cause::(\w+)", CORE))
    assert [word for word, _ in CAUSES.values() if word.replace(" ", "_") not in emitted] == []


def test_statuses() -> None:
    rows = [code(row[0])[0] for row in table(PAGE, "status")]
    assert sorted(rows) == sorted(name for name, *_ in STATUS if name not in INTERNAL)


def test_modes() -> None:
    assert ", ".join(f"{number} {word}" for number, word in MODES.items()) in plain(PAGE)


def test_statistics() -> None:
    rows = {code(row[0])[0]: row[1] for row in table(PAGE, "statistic")}
    assert rows == dict(STATISTICS)
    d = cw.Driveline()
    d.shaft("a", inertia=1.0)
    section = PAGE.partition("## Statistics")[2].partition("\n## ")[0]
    assert set(code(section)) == {"run.statistics", *d.simulate(0.1).statistics}


@cache
def emitted() -> set[str]:
    """Last part of the names of all signals of every element."""
    found = set()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for cls in samples.declared(*samples.ELEMENT_ROLES):
            found |= {name.rpartition(".")[2] for name in Channels(wiring(samples.driveline(cls).assemble()))}
    return found


def declared() -> set[str]:
    """Names of signals that declarations give: inputs, states, ports of gears."""
    classes = [cls for known in REGISTRY.values() for cls in known.values()]
    names = {name for cls in classes for group, _ in inputs(cls) for name in group}
    names |= {f"{name}_signal" for name in names}
    names |= {f"torque_{item.name}" for cls in classes for item, _ in specs(cls, "port")}
    return names | {state.name for cls in classes for state in getattr(cls, "states", ())}


def test_signals() -> None:
    rows = table(PAGE, "of")
    listed = {name for row in rows for name in re.findall(r"(?:`|housing)\.(\w+)`", row[1])}
    assert sorted(listed - emitted() - declared()) == []
    assert sorted(emitted() - listed - declared()) == []


def test_rows_of_an_export() -> None:
    """The parts of an output row, by the name that the header of an exported model gives them."""
    rows = {code(row[0])[0] for row in table(page("guide/export.md"), "part of a row")}
    assert rows == {name for name, _ in ROW}


def test_a_slip_acceleration_is_that_before_a_lock_up_and_after_a_break_away() -> None:
    """100 rad/s of slip that 50 N m stop between 0.2 and 0.8 kg m2, then 80 N m that pull it apart again at 2 s."""
    d = cw.Driveline()
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    lining = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=1e-3, normal_force=5e5))
    d.add(cw.Torque("pull", shaft=load, torque=cw.Table([(0.0, 0.0), (2.0, 0.0), (2.0, 400.0)])))
    lock, away = d.simulate(3.0).events
    assert abs(lock.slip_acceleration - 50.0 * (1.0 / 0.2 + 1.0 / 0.8)) < 1e-6
    assert abs(away.slip_acceleration - (350.0 / 0.8 - 50.0 / 0.2)) < 1e-6
    (row,) = [row for row in table(PAGE, "field") if "slip_acceleration" in row[0]]
    assert "before the event where the contact is `locked` after it" in row[1]
    assert "else after the event" in row[1]

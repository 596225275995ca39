"""The matrices of many speeds leave zeros out, those of few are whole: the same motion either way."""

from __future__ import annotations

import struct

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.core import core
from clutchwork.declare.layout import COUNTS, FEW_SPEEDS, STATUS
from support import many_contacts, random_large
from support.random_contacts import T_END, driveline

LAW = cw.Coulomb(static=0.2, kinetic=0.1)
# errors of both runs, with a share of the tolerances that an event may add to
ROOM = 2e-5


def widened(seed: int, *, held: bool) -> cw.Driveline:
    """A random driveline beside shafts that do nothing: they turn freely, or brakes hold them."""
    d = driveline(seed)
    for i in range(FEW_SPEEDS):
        idle = d.shaft(f"idle{i}", inertia=0.5, speed=0.0 if held else 40.0)
        if held:
            d.add(cw.Brake(f"hold{i}", shaft=idle, friction=LAW, gain=1.0, normal_force=50.0, locked=True))
    return d


@pytest.mark.parametrize("held", [False, True])
@pytest.mark.parametrize("seed", range(24))
def test_idle_shafts_change_nothing(seed: int, held: bool) -> None:
    """Loops, parallel clutches and freewheels; held brakes leave few of many speeds."""
    options = {"rtol": 1e-9, "atol": 1e-11, "dt": T_END / 20}
    alone, beside = driveline(seed).simulate(T_END, **options), widened(seed, held=held).simulate(T_END, **options)
    assert beside.system.counts["speeds"] > FEW_SPEEDS >= alone.system.counts["speeds"]
    assert beside.status == alone.status
    own = [event for event in beside.events if not event.element.startswith("hold")]
    assert [(e.element, e.after) for e in own] == [(e.element, e.after) for e in alone.events]
    assert [e.time for e in own] == pytest.approx([e.time for e in alone.events], abs=1e-6 * T_END)
    for node in alone.system.nodes:
        speed = alone[f"{node.name}.speed"]
        np.testing.assert_allclose(beside[f"{node.name}.speed"], speed, atol=ROOM * (1 + np.abs(speed).max()))
    for contact in alone.system.contacts:
        torque = alone[f"{contact.name}.torque"]
        np.testing.assert_allclose(
            beside[f"{contact.name}.torque"], torque, atol=ROOM * (1 + np.abs(torque).max()), err_msg=contact.name
        )


@pytest.mark.parametrize("seed", range(12))
def test_rooms_hold_what_random_modes_need(seed: int) -> None:
    """Gears, planetary gears, loops and prescribed speeds: a run that has no room ends."""
    d = random_large.driveline(seed)
    run = d.simulate(random_large.T_END)
    run.raise_for_status()
    assert run.system.counts["speeds"] > FEW_SPEEDS
    # a hundred times the tolerance: steps, events and quadrature add up
    assert abs(run.energy.residual) <= 1e-4 * run.energy.turnover


def train(brake: bool) -> cw.Driveline:
    """Planetary gears one behind the other, so that the last carrier depends on all speeds; a brake may hold it."""
    d = cw.Driveline("train")
    first = d.shaft("x0", inertia=1.0)
    for i in range(1, FEW_SPEEDS + 6):
        ring, carrier = d.shaft(f"x{i}", inertia=0.5 + 0.1 * i), d.shaft(f"y{i}", inertia=0.3)
        d.add(cw.Planetary(f"row{i}", sun=first, ring=ring, carrier=carrier, ratio=1.5 + 0.1 * i))
        d.add(cw.Torque(f"t{i}", shaft=ring, torque=5.0 + i))
        first = carrier
    if brake:
        d.add(cw.Brake("b", shaft=first, friction=LAW, gain=1.0, normal_force=1e4, locked=True))
    return d


@pytest.mark.parametrize("brake", [False, True])
def test_gears_that_tie_all_speeds(brake: bool) -> None:
    """Nothing is sparse: accelerations are those of the whole matrices, the brake a multiplier."""
    system = train(brake).assemble()
    run = cw.simulate(system, 0.1, dt=0.1)
    speeds = system.counts["speeds"]
    assert speeds > FEW_SPEEDS
    assert np.count_nonzero(system.mass) == speeds**2
    forces = system.element_rate.T @ np.array([float(element.torque) for element in system.elements])
    matrix = np.block([[system.mass, system.contact_rate.T], [system.contact_rate, np.zeros((int(brake), int(brake)))]])
    solved = np.linalg.solve(matrix, np.concatenate([forces, np.zeros(int(brake))]))
    for name, wanted in zip((n.name for n in system.nodes), system.basis @ solved[:speeds], strict=True):
        np.testing.assert_allclose(run[f"{name}.acceleration"], wanted, rtol=1e-9, atol=1e-9)
    if brake:
        np.testing.assert_allclose(run["b.torque"], -solved[-1], rtol=1e-9)


def line(n: int) -> cw.System:
    """Shafts in a row with clutches between them and a brake in the middle."""
    d = cw.Driveline(f"line of {n}")
    shafts = [d.shaft(f"s{i}", inertia=1.0, speed=float(n - i)) for i in range(n)]
    for i in range(n - 1):
        d.add(cw.Clutch(f"c{i}", base=shafts[i], follower=shafts[i + 1], friction=LAW, gain=1.0, normal_force=50.0))
    d.add(cw.Brake("b", shaft=shafts[n // 2], friction=LAW, gain=1.0, normal_force=50.0))
    return d.assemble()


def test_memory_grows_with_the_couplings() -> None:
    """Twice the shafts and clutches, twice the bytes: of a System, of a run, of a saved state."""
    sizes = []
    for n in (200, 400, 800):
        data = line(n).to_bytes()
        run = core().Run(data)
        sizes.append((len(data), run.memory_size, len(run.save())))
    for one, two, four in zip(*sizes, strict=True):
        # rows that start on 8 or 16 bytes
        assert four - two == pytest.approx(2 * (two - one), abs=2000)
        assert four < 2.1 * two


def test_what_depends_is_all_that_is_kept_whole() -> None:
    """One clutch beside another in a long row: a set of two."""
    d = cw.Driveline("pair")
    shafts = [d.shaft(f"s{i}", inertia=1.0) for i in range(100)]
    for i in range(99):
        d.add(cw.Clutch(f"c{i}", base=shafts[i], follower=shafts[i + 1], friction=LAW, gain=1.0, normal_force=50.0))
    d.add(cw.Clutch("twin", base=shafts[40], follower=shafts[41], friction=LAW, gain=1.0, normal_force=25.0))
    d.add(cw.Torque("t", shaft=shafts[0], torque=6.0))
    system = d.assemble()
    assert (system.counts["spares"], system.counts["set_size"]) == (1, 2)
    run = cw.simulate(system, 0.1, dt=0.1)
    # the row turns as one; the twins share in proportion to capacity what the shafts behind them need
    need = 6.0 / 100 * 59
    assert run["s99.acceleration"][-1] == pytest.approx(0.06, rel=1e-9)
    assert run["c40.torque"][-1] == pytest.approx(need * 2 / 3, rel=1e-9)
    assert run["twin.torque"][-1] == pytest.approx(need / 3, rel=1e-9)


ROOMS = [name for name, _ in COUNTS if name.endswith("_room")]


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_that_is_too_small_ends_the_run(room: str) -> None:
    """Bytes that say less than a run needs are refused where it is needed; nothing is written elsewhere."""
    data = bytearray(random_large.driveline(1).assemble().to_bytes())
    place = 16 + 8 * [name for name, _ in COUNTS].index(room)
    (needed,) = struct.unpack_from("<q", data, place)
    assert needed > 10
    struct.pack_into("<q", data, place, 1)
    run = core().Run(bytes(data))
    with np.errstate(all="ignore"):
        status = run.advance(0.1, np.zeros(0), np.zeros((0, len(run.row()))), 0, False)[0]
    assert STATUS[status][0] in ("no_mode", "bad_system")


def test_memory_of_a_chain_is_linear() -> None:
    """Of a System and of its run: whatever is kept whole would grow with the square."""
    sizes = [_memory(n) for n in (100, 200, 400)]
    for small, middle, large in zip(*sizes, strict=True):
        assert large - middle <= 2.02 * (middle - small)


def _memory(n: int) -> tuple[int, int]:
    """Bytes of a chain of n shafts and n - 1 clutches, and of a run of it."""
    data = many_contacts.row(n - 1).assemble().to_bytes()
    return len(data), core().Run(data).memory_size

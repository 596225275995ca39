"""Many contacts at one instant, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from support import many_contacts as many


@pytest.mark.parametrize("n", [14, 64, 256])
def test_a_row_of_contacts_locks_at_one_instant(n: int) -> None:
    """Every slip falls at the same rate; then the row turns as one, and carries a parabola of torques."""
    run = many.row(n).simulate(3.0, times=[0.25, 0.75, 3.0])
    assert [(event.element, event.after) for event in run.events] == [(f"c{i}", "locked") for i in range(1, n + 1)]
    # the time of the one that is found first is that of all
    assert np.ptp([event.time for event in run.events]) == 0.0
    assert run.events[0].time == pytest.approx(many.LOCK, rel=1e-12)
    ramp = many.RAMP * 2.0
    for i in range(n + 1):
        speed = run[f"s{i}.speed"]
        falling = many.RATE * (i - n / 2) * 0.25 + many.SLIP * (n - i)
        # round-off grows with the largest speed
        assert speed == pytest.approx([falling, many.SLIP * n / 2, many.SLIP * n / 2], abs=1e-11 * many.SLIP * n)
    for i in range(1, n + 1):
        held = ramp * many.INERTIA * i * (n - i + 1) / 2
        torque = run[f"c{i}.torque"]
        assert np.abs(torque) == pytest.approx([many.kinetic(n, i), 0.0, held], abs=1e-10 * many.kinetic(n, n // 2))


def test_a_row_breaks_away_where_it_must() -> None:
    """All contacts reach their limits together; the first that slips relieves the others."""
    run = many.row(64).simulate(many.BREAK + 1e-3)
    (event,) = list(run.events)[64:]
    assert event.time == pytest.approx(many.BREAK, rel=1e-9)
    assert event.before == "locked"
    place = int(event.element[1:])
    assert abs(event.torque_before) == pytest.approx(many.SHARE * many.kinetic(64, place), rel=1e-9)


@pytest.mark.parametrize("n", [14, 64])
def test_all_clutches_on_a_hub_lock_and_break_away_at_once(n: int) -> None:
    """None of them can hold what the others have let go."""
    run = many.star(n).simulate(2.5, times=[2.0, 2.5])
    names = [f"c{i}" for i in range(1, n + 1)]
    locks, breaks = list(run.events)[:n], list(run.events)[n:]
    assert [(event.element, event.after) for event in locks] == [(name, "locked") for name in names]
    # each clutch pulls with 10 N m at an inertia J, all of them at a hub of 10 J
    time = many.SLIP / (10.0 / many.INERTIA + n * 10.0 / (10.0 * many.INERTIA))
    assert [event.time for event in locks] == pytest.approx([time] * n, rel=1e-12)
    assert sorted(event.element for event in breaks) == sorted(names)
    assert [event.time for event in breaks] == pytest.approx([2.0] * n, rel=1e-9)
    # afterwards 10 N m drive each shaft, the rest of the ramp the hub
    common = n * many.SLIP / (n + 10.0)
    drive = many.SHARE * 10.0 * (10.0 + n)
    before = common + drive * 0.5 / ((10.0 + n) * many.INERTIA)
    assert run["s1.speed"] == pytest.approx([before, before + 0.5 * 10.0 / many.INERTIA], rel=1e-9)
    hub = (drive * (1.0 * 0.5 + 0.125) - n * 10.0 * 0.5) / (10.0 * many.INERTIA)
    assert run["hub.speed"][-1] == pytest.approx(before + hub, rel=1e-9)

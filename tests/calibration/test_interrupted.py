"""Ctrl-C keeps the best so far, and a file goes on from there."""

from __future__ import annotations

import json
import warnings

import pytest

import clutchwork as cw
from support.engagement import discs, least_torque
from support.launches import Launch, draws

# one that takes several steps
SLOW = list(draws(2))[1]


class StopAt:
    """Progress that is interrupted after so many points."""

    def __init__(self, points):
        self.points, self.seen = points, []

    def __call__(self, done, most):
        self.seen.append((done, most))
        if done >= self.points:
            raise KeyboardInterrupt


def test_the_best_so_far_is_kept():
    with pytest.raises(cw.CalibrationInterrupted) as caught:
        SLOW.least_heat(15, progress=StopAt(6))
    found = caught.value.calibration
    assert not found.finished
    assert not found.solved
    assert "interrupted" in found.message
    assert found.goal[1] < found.goal[0]
    assert found.run().finished


def test_a_file_goes_on_from_there(tmp_path):
    path, launch = tmp_path / "launch.json", SLOW
    whole = launch.least_heat(15, starts=2)
    with pytest.raises(cw.CalibrationInterrupted):
        launch.least_heat(15, starts=2, file=path, progress=StopAt(5))
    first = json.loads(path.read_text(encoding="utf-8"))["starts"]
    assert first[0]["ended"] is False
    found = launch.least_heat(15, starts=2, file=path)
    assert found.solved
    assert found.goal[1] == pytest.approx(whole.goal[1], rel=1e-7)
    # what has ended is not searched for again
    counted = StopAt(10_000)
    again = launch.least_heat(15, starts=2, file=path, progress=counted)
    assert again.goal[1] == found.goal[1]
    assert len(counted.seen) == 0


def test_a_file_of_something_else_is_refused(tmp_path):
    path = tmp_path / "launch.json"
    Launch().least_heat(15, file=path)
    with pytest.raises(cw.UseError, match="belongs to another model, goal, limit or setting"):
        Launch(speed=90.0).least_heat(15, file=path)
    path.write_text("{}", encoding="utf-8")
    with pytest.raises(cw.UseError, match="holds no calibration"):
        Launch().least_heat(15, file=path)


def test_threads_find_the_same():
    launch = SLOW
    one, two = (launch.least_heat(15, starts=3, threads=threads) for threads in (1, 2))
    assert one.x.tobytes() == two.x.tobytes()
    assert [outcome.number for outcome in two.outcomes] == [0, 1, 2]


def test_more_iterations_on_a_file_that_is_not_solved_go_on(tmp_path):
    file = tmp_path / "shift.json"
    first = least_torque(1.0, file=file)
    data = json.loads(file.read_text())
    # as if a solver had been stopped on its way
    data["starts"][0] |= {"residual": 0.1, "iterations": 3}
    file.write_text(json.dumps(data))
    same = least_torque(1.0, file=file, iterations=3)
    assert same.outcomes[0].residual == 0.1
    more = least_torque(1.0, file=file, iterations=50)
    assert more.outcomes[0].iterations == 50
    assert more.outcomes[0].residual < 1e-3
    assert more.goal[1] == pytest.approx(first.goal[1], rel=1e-6)


def test_limits_that_are_all_linear_give_no_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = cw.calibrate(
            discs(),
            5.0,
            free={"c1.pressure.values[2:]": (1e4, 9e5)},
            minimise=cw.at("c1.torque", 0.1),
            subject_to=cw.limit(cw.slope("c1.pressure"), 1e5, 1e5),
        )
    assert found.feasible
    assert found["c1.pressure.values[2]"] == pytest.approx(3e5, rel=1e-6)

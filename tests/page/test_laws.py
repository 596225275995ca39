"""The live page of every friction law is Python with the same numbers, wherever its sliders stand."""

from __future__ import annotations

import sys
import warnings
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.page.page import quiet_data
from support.project import ROOT

sys.path.append(str(ROOT / "tools"))

import law_pages

SHOWN = ("sweep.torque", "loop.torque", "disc.speed")
# over the largest value: as in test_parity
SAME = 1e-13


@pytest.mark.parametrize("kind", law_pages.kinds())
def test_a_law_on_its_page_is_that_of_python(kind: str, engine: Any) -> None:
    random, times = np.random.default_rng(15), np.linspace(0.0, 2.5, 101)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        system = law_pages.driveline(kind).assemble()
        data = quiet_data(system, float(times[-1]), cw.Options(), law_pages.wanted(kind))
        asked: list[dict[str, Any]] = [{}]
        for _ in range(2):
            places = {str(i): float(random.choice(one["values"])) for i, one in enumerate(data["sliders"])}
            asked.append({"values": places})
        jobs = [one | {"times": times.tolist(), "signals": list(SHOWN)} for one in asked]
        for job, found in zip(jobs, engine(data, jobs), strict=True):
            turned = [(data["sliders"][int(i)], value) for i, value in job.get("values", {}).items()]
            changes = {name: value for one, value in turned for name in one["names"]}
            run = cw.simulate(system.changed(changes), float(times[-1]), times=times)
            assert found["count"] == len(run.time)
            for name in SHOWN:
                scale = float(np.abs(run[name]).max())
                assert np.abs(np.array(found["signals"][name]) - run[name]).max() <= SAME * scale, (name, changes)

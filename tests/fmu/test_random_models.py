"""FMUs of random models of everything, oil and formulas among them, end as `simulate` does."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fmpy.validation import validate_fmu

import clutchwork as cw
from support.amount import amount
from support.any_model import agree, judge, model
from support.fmus import Fmu


def ends_alike(seed: int, folder: Path) -> bool:
    """Compare the outputs at the end of the model of a seed; False where it has no end or cannot leave Python."""
    made = model.model(seed)
    end = made["simulation"]["t_end"]
    run = agree.run(made, rtol=1e-8, atol=1e-10)
    if run.status != "done" or judge.explodes(run):
        return False
    driveline = model.driveline(made)
    path = driveline.to_fmu(
        folder / f"model{seed}.fmu", version="3.0" if seed % 2 else "2.0", picture=False, rtol=1e-8, atol=1e-10
    )
    assert validate_fmu(str(path)) == [], f"seed {seed}"
    fmu = Fmu(path, folder / f"unpacked{seed}")
    names = [name for name, one in fmu.variables.items() if one.causality == "output" and one.variability != "discrete"]
    begin = float(made["simulation"].get("t_start", 0.0))
    with fmu.running(start=begin) as instance:
        instance.step(begin, end - begin)
        for name, got in zip(names, instance.get(names), strict=True):
            wanted = run[name.replace("'", "")]
            # such as the way to an end that a stop has not
            if not np.isfinite(wanted).all():
                continue
            scale = float(np.max(np.abs(wanted))) or 1.0
            assert got == pytest.approx(float(wanted[-1]), abs=1e-4 * scale), f"seed {seed}: {name}"
    return True


@pytest.mark.random
def test_random_models(tmp_path: Path) -> None:
    alike = 0
    for seed in range(amount(60)):
        try:
            alike += ends_alike(seed, tmp_path)
        except cw.UseError:
            # an FMU of such a model is refused by name: tests/fmu/test_archive.py
            continue
    assert alike > amount(60) // 3

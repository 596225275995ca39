"""Sobol indices: closed forms of a linear and of a product model, intervals that hold them, what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support import scattered

pytest.importorskip("SALib")
pytest.importorskip("scipy")

# the speed of a disc of 2 kg m2 after 1 s under two torques, N m
TORQUES = {"a.torque": cw.uniform(0.0, 6.0), "b.torque": cw.normal(5.0, 1.0), "c.torque": cw.uniform(1.0, 2.0)}


def disc() -> cw.System:
    d = cw.Driveline("disc")
    shaft = d.shaft("disc", inertia=2.0)
    for name in ("a", "b", "c"):
        d.add(cw.Torque(name, shaft=shaft, torque=1.0))
    return d.assemble()


def swept(vary: dict[str, Any], outputs: Any, count: int = 256, **how: Any) -> cw.Sweep:
    return cw.sweep(disc(), 1.0, vary=cw.design(vary, count, method="saltelli", **how), outputs=outputs)


def test_a_sum_has_the_shares_of_its_variances() -> None:
    found = cw.sobol_indices(swept(TORQUES, "disc.speed"), "disc.speed")
    variances = np.array([36.0 / 12.0, 1.0, 1.0 / 12.0])
    shares = variances / variances.sum()
    assert found.names == tuple(TORQUES)
    # no interaction; a Sobol sequence of 256 points is far better than the intervals, which take it as random
    assert np.allclose(found.first, shares, atol=0.02)
    assert np.allclose(found.total, shares, atol=0.02)
    assert (np.abs(found.first - shares) <= found.first_interval).all()
    assert (np.abs(found.total - shares) <= found.total_interval).all()
    assert found.variance == pytest.approx(variances.sum() / 4.0, rel=0.02)


def test_a_product_has_a_share_of_the_pair() -> None:
    """x y with means 1 and variances v: first order v/(2 v + v^2) each, the pair v^2/(2 v + v^2)."""

    # the clutch slips all the time, so that the load takes up gain times pressure
    vary = cw.design({"c1.gain": (1e-12, 1e-3), "c1.pressure": (0.0, 4e5)}, 1024, method="saltelli", second_order=True)
    found = cw.sobol_indices(cw.sweep(scattered.discs(), 0.3, vary=vary, outputs="load.speed"), "load.speed")
    variance = 1.0 / 3.0
    alone, pair = (share / (2.0 * variance + variance**2) for share in (variance, variance**2))
    assert found.second is not None
    assert np.allclose(found.first, alone, atol=0.02)
    assert np.allclose(found.total, alone + pair, atol=0.02)
    assert found.second[0, 1] == pytest.approx(pair, abs=0.03)
    assert "c1.gain with c1.pressure" in str(found)


def test_of_a_study_as_of_a_sweep(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    vary = cw.design(scattered.VARY, 64, method="saltelli")
    on_disk = cw.study(scattered.discs(), 3.0, vary=vary, outputs=[cw.lock("c1")], folder=tmp_path)
    in_memory = cw.sweep(scattered.discs(), 3.0, vary=vary, outputs=[cw.lock("c1")])
    one, other = (cw.sobol_indices(found, "lock(c1)") for found in (on_disk, in_memory))
    assert str(one) == str(other)
    assert one.to_pandas().equals(other.to_pandas())
    assert "<table" in one._repr_html_()
    pytest.importorskip("matplotlib").use("agg")
    one.plot(tmp_path / "x.png")
    assert (tmp_path / "x.png").stat().st_size > 10_000


def test_what_is_refused(tmp_path: Path) -> None:
    made = swept(TORQUES, ["disc.speed", "c.torque"], 4)
    other = cw.sweep(disc(), 1.0, vary={"a.torque": [1.0, 2.0]}, outputs="disc.speed")
    with pytest.raises(cw.UseError, match="'given', which gives no indices; draw it with"):
        cw.sobol_indices(other, "disc.speed")
    with pytest.raises(cw.UseError, match="neither a study nor a sweep"):
        cw.sobol_indices(3, "disc.speed")  # type: ignore[arg-type]
    with pytest.raises(cw.UnknownName, match=r"no output 'disc\.sped'"):
        cw.sobol_indices(made, "disc.sped")
    never = {"c1.gain": cw.uniform(1e-6, 8e-4), "c1.pressure": cw.uniform(1e5, 3e5)}
    vary = cw.design(never, 32, method="saltelli")
    late = cw.sweep(scattered.discs(), 3.0, vary=vary, outputs=[cw.lock("c1"), "c1.state", "engine.inertia"][:2])
    with pytest.raises(cw.UseError, match=r"no value in \d+ of 128 variants; say with missing="):
        cw.sobol_indices(late, "lock(c1)")
    assert cw.sobol_indices(late, "lock(c1)", missing=3.0).total[0] > 0.5
    with pytest.raises(cw.UseError, match="holds words"):
        cw.sobol_indices(late, "c1.state")
    same = swept({"a.torque": cw.discrete([1.0])}, "disc.speed", 4)
    with pytest.raises(cw.UseError, match="is the same in all variants"):
        cw.sobol_indices(same, "disc.speed")

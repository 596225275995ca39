"""The table of guide/why-events.md: derivatives with events, and of a time stepping."""

from __future__ import annotations

import runpy

import numpy as np

from support.project import ROOT

# central differences of runs with events at 1e-11, three widths alike to 6 digits; rad/s
DIFFERENCES = np.array([0.424596, -0.367267, -0.196858, -0.107560])
# automatic differentiation of the same time stepping in JAX
STEPPED = 0.3116


def test_the_table() -> None:
    found = runpy.run_path(str(ROOT / "benchmarks" / "why_events.py"))["table"]((1e-3,))
    # six digits are given
    np.testing.assert_allclose(found["with events"], DIFFERENCES, atol=5.1e-7, rtol=0)
    np.testing.assert_allclose(found["time stepping, 0.001 s"][0], STEPPED, atol=5.1e-5, rtol=0)
    page = (ROOT / "docs" / "guide" / "why-events.md").read_text(encoding="utf-8")
    for values in found.values():
        assert all(f"{value:.6f}" in page for value in values)

"""Schematics are drawn by packages that users may lack."""

from __future__ import annotations

import pytest

pytest.importorskip("matplotlib").use("agg")
pytest.importorskip("scipy")

"""The public face: names, a fast import, the refusal of a stale core."""

from __future__ import annotations

import subprocess
import sys

import pytest

import clutchwork as cw


def _python(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)


def test_names_are_there():
    for name in cw.__all__:
        assert getattr(cw, name) is not None
        assert name in dir(cw)


def test_unknown_name_gets_a_near_match():
    with pytest.raises(AttributeError, match="did you mean 'Clutch'"):
        _ = cw.Clutsh


def test_import_takes_numpy_and_the_core_alone():
    code = """
import sys
import clutchwork
heavy = ("pydantic", "matplotlib", "pandas", "scipy", "xarray", "tomllib", "argparse")
print([name for name in heavy if name in sys.modules])
"""
    done = _python(code)
    assert done.stdout.strip() == "[]", done.stderr


@pytest.mark.parametrize(
    ("core", "words"),
    [
        ("types.SimpleNamespace(schema_hash=lambda: 1)", "was built from other declarations; build it"),
        ("None", "cannot be loaded"),
    ],
)
def test_stale_or_missing_core_is_refused_with_the_remedy(core, words):
    done = _python(f"import sys, types; sys.modules['clutchwork._core'] = {core}; import clutchwork")
    assert done.returncode == 1
    assert "ImportError" in done.stderr
    assert words in done.stderr
    assert "pip install -e ." in done.stderr


def test_housing_is_where_nothing_moves():
    assert cw.Driveline().housing.fixed

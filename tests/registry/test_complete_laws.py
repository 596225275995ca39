"""What a friction law of ours has beside its two files, asked for by name.

A law that is not among OURS works without any of it. It is tested by all that iterates over the registry, and the
reason of its skipped test below says what it lacks to become one of ours.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from clutchwork.declare.schema import REGISTRY, Role
from clutchwork.rig import PRESETS
from reference.friction import closed_forms, sets
from reference.friction.build import COUNTERPARTS
from support import samples

LAWS = REGISTRY[Role.LAW]
ROOT = Path(__file__).resolve().parents[2]
# the laws that ship; what they go without stands behind their name, with the reason
OURS: dict[str, dict[str, str]] = {
    "coefficient_table": {"source": "a table"},
    "coulomb": {"source": "older than any doi"},
    "dahl": {},
    "dynamic_formula": {"source": "whoever writes the formula has it", "presets": "a formula has its own numbers"},
    "elastoplastic": {},
    "exponential": {"source": "Tustin's curve, older than any doi"},
    "formula": {"source": "whoever writes the formula has it", "presets": "a formula has its own numbers"},
    "friction_map": {},
    "friction_table": {},
    "gms": {},
    "karnopp": {},
    "leuven": {},
    "lugre": {},
    "mykhalevych": {"source": "no doi"},
    "naive_sign": {"source": "a demonstration", "drift test": "no solution at rest"},
    "regularised_stribeck": {},
    "stribeck": {},
    "tanh": {},
    "temperature_table": {},
}


def _has_a_source(cls: Any) -> bool:
    return any("doi:10." in (base.__doc__ or "") for base in cls.__mro__)


def _has_a_section(cls: Any) -> bool:
    theory = (ROOT / "docs" / "theory" / "friction-laws.md").read_text(encoding="utf-8")
    return f'\n<a id="law-{cls.kind}"></a>\n## ' in theory


def _sticks(cls: Any) -> bool:
    return bool(cls.sticks) and cls.kind in samples.over_slip()


def _is_compliant(cls: Any) -> bool:
    return not cls.sticks


def _is_over_slip(cls: Any) -> bool:
    return cls.kind in samples.over_slip()


def _any(_: Any) -> bool:
    return True


# name, where it belongs, which laws need it, which have it
NEEDS: tuple[tuple[str, str, Callable[[Any], bool], Callable[[Any], bool]], ...] = (
    ("source", 'a "doi:10..." in its docstring', _any, _has_a_source),
    ("theory", 'a section <a id="law-{kind}"></a> in docs/theory/friction-laws.md', _any, _has_a_section),
    (
        "closed form",
        "numbers and the time to stop in tests/reference/friction/closed_forms.py",
        _sticks,
        lambda cls: cls.kind in sets.kinds(closed_forms.LAWS),
    ),
    (
        "counterpart",
        "an independent one in tests/reference/friction/build.py, and numbers in ALL of sets.py",
        _is_compliant,
        lambda cls: cls.kind in COUNTERPARTS and cls.kind in sets.kinds(sets.ALL),
    ),
    (
        "drift test",
        "numbers in DRIFT of tests/reference/friction/sets.py",
        _is_compliant,
        lambda cls: cls.kind in sets.kinds(sets.DRIFT),
    ),
    (
        "dissipation",
        "numbers in PASSIVE or SWINGS of tests/reference/friction/sets.py",
        _is_compliant,
        lambda cls: cls.kind in sets.kinds(sets.PASSIVE | sets.SWINGS),
    ),
    (
        "gearbox",
        "numbers in SHIFT of tests/reference/friction/sets.py",
        _is_over_slip,
        lambda cls: cls.kind in sets.SHIFT,
    ),
    (
        "presets",
        "numbers in src/clutchwork/rig/presets.py that make it comparable",
        _is_over_slip,
        lambda cls: all(cls.kind in preset.fields for preset in PRESETS.values()),
    ),
)


def lacking(cls: Any) -> dict[str, str]:
    """What a law has not, and where that belongs."""
    return {name: where.format(kind=cls.kind) for name, where, needed, has in NEEDS if needed(cls) and not has(cls)}


@pytest.mark.parametrize("kind", LAWS)
def test_a_law_of_ours_is_complete(kind: str) -> None:
    missing = lacking(LAWS[kind])
    listed = "; ".join(f"{name}: {where}" for name, where in missing.items() if name not in OURS.get(kind, {}))
    if kind not in OURS:
        pytest.skip(f"{kind} is not listed in OURS and lacks {listed or 'nothing else'}")
    assert not listed, f"{kind} lacks {listed}"
    # a reason that holds no longer
    assert [name for name in OURS[kind] if name not in missing] == []


def test_every_law_of_ours_is_there() -> None:
    assert [kind for kind in OURS if kind not in LAWS] == []


def test_what_a_bare_law_lacks_is_all_named() -> None:
    class Bare:
        """A law with its two files and nothing else."""

        kind, sticks = "bare", False

    assert set(lacking(Bare)) == {"source", "theory", "counterpart", "drift test", "dissipation"}
    assert '"law-bare"' in lacking(Bare)["theory"]

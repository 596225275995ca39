"""The core computes with its own elementary functions, never with those of a library, whose last bits differ."""

from __future__ import annotations

import re

from support.project import ROOT

LIBRARY = re.compile(
    r"(?:std|\s)::(?:exp2?|expm1|log(?:2|10|1p)?|pow|a?sinh?|a?cosh?|a?tanh?|atan2|cbrt|hypot|fma|erf|tgamma)\("
)


def test_no_function_of_a_library_whose_bits_differ() -> None:
    sources = list((ROOT / "cpp").rglob("*.[hc]pp"))
    assert len(sources) > 100
    found = {path.name: LIBRARY.findall(path.read_text(encoding="utf-8")) for path in sources}
    assert {name: calls for name, calls in found.items() if calls} == {}
    assert LIBRARY.search("x = std::tanh(y)")

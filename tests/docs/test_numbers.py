"""Numbers in docs/theory/contacts.md and events.md are those of the core: each one with the line that has it."""

from __future__ import annotations

import re

import pytest

from support.pages import page
from support.project import ROOT

CORE = " ".join(
    " ".join(path.read_text(encoding="utf-8") for path in sorted((ROOT / "cpp" / "include").rglob("*.hpp"))).split()
)

# words of the page, lines of the core
CONTACTS = {
    "within $10^{-12}$ of that step": "inline constexpr double at_once = 1e-12;",
    "limited to $20 n + 50$ steps": "round < 20 * p.n + 50",
    r"R_{cc} = 10^{-10} \, G_{cc}": "double small = 1e-10",
    r"\min\!\left( \frac{T_{\max}}{T_c}, 10^6 \right)": "ratio < 1e6 ? ratio : 1e6",
    "$10^{-12}$ of what all torques together cause, or $10^{-10}$": "larger(1e-10 * scale, 1e-12 * ",
    "leaves the tolerance of within a millisecond": "return arrived ? larger(round_off, 1e3 * tolerance)",
    "within a microsecond, or, of one that passes zero, within a second": "return (arrived ? 1.0 : 1e6) * tolerance",
    r"one that more than $2 \cdot 10^{-12}$ of all torques makes": "return larger(round_off, 2e-12 * ws.decision.pull",
    "at most $4 n + 5$ rounds": "round <= 4 * ws.sys.contacts + 4",
    "while time does not advance, to $10^{-9}$ s": "ws.time - instant <= 1e-9",
    r"0 \le \alpha \le 2": "ample = 2",
    "at most $20 n + 50$": "raise(*this, 50 + 20 * set.n)",
    "A price below $10^{-9}$ of the largest": "> 1e-9 * most",
    "more than $10^{-10}$ of the kinetic energy": "constexpr double least = 1e-10;",
    "in at most 60 steps": "round < 60 && miss",
    r"|\sigma_c| \le 10^{-10} \left( 1 + \max |v| \right)": "return roundoff<T>(1e-10, 4e-6) * (1 + largest)",
}
EVENTS = {
    "that starts within $10^{-9}$ of its end": "fresh = 1e-9",
    r"Coefficients above $-10^{-9} \max_j |\beta_j|$": "larger(1e-9 * scale, noise)",
    r"$10^{-10} (1 + \max |v|)$ beyond zero": "return roundoff<T>(1e-10, 4e-6) * (1 + largest)",
    r"most $1.5/\omega$ long": "resolves_work(ws) ? 0.5 : 1.5) / fastest",
    r"and $0.5/\omega$ where the work is integrated": "resolves_work(ws) ? 0.5 : 1.5) / fastest",
    "after 25 time constants a decay has ended": "* s > 25 ?",
    "Above 0.3 of the tolerance": "most_cut_error = 0.3",
    "repeated at most four times to land": "most_landings = 4",
    "may be $10^{-3}$ of the tolerance": "most_light_error = 1e-3",
    r"loses more than half of its slip is checked at $\theta = 0.7$ in the same way": "inner = 0.7,",
    "above ten times the tolerance": "most_inner_error = 10",
    "that of $10^{-9}$ s later": "constexpr double soon = 1e-9;",
    r"$\alpha^* \le 10^{12}$": "constexpr double most = 1e12;",
    "only when it is $10^{-11}$ of its largest size": "load_noise = 1e-11",
    "below $-10^{-12}$": "noise = 1e-12",
    "when it is $10^{-7}$ inside": "slack = 1e-7",
    "at most half a radian": "0.5 / sqrt(square)",
    "more than 40 within 800 steps": "window = 800, most = 40",
    "More than 50 events of one contact, or 50 knots of one signal, within a microsecond": "int most = 50; if (",
    "starts with a quarter of the last full step": "restart = 0.25",
    "half of it where steps are explicit": "restart = 0.5",
    "down to $10^{-9}$ of the time": "static constexpr double shortest = 1e-9;",
}
CLAIMS = [("theory/contacts.md", *claim) for claim in CONTACTS.items()]
CLAIMS += [("theory/events.md", *claim) for claim in EVENTS.items()]


def prose(name: str) -> str:
    """A page on one line, without sources, labels, tables and words that count its own parts."""
    text = page(name).partition("\n## Sources")[0]
    text = re.sub(r"^\|.*$|^\d+\. ", "", text, flags=re.MULTILINE)
    text = re.sub(
        r"\[\([\w-]+\)\]\([^)]*\)|\$\$ \([\w-]+\)|`[^`]*`|\brules? \d+|\*\*Rule \d+\.\*\*",
        "",
        text,
        flags=re.IGNORECASE,
    )
    return " ".join(text.split())


@pytest.mark.parametrize(("name", "words", "line"), CLAIMS)
def test_a_number_of_the_page_is_in_the_core(name: str, words: str, line: str) -> None:
    assert " ".join(words.split()) in prose(name)
    assert line in CORE


@pytest.mark.parametrize(("name", "claims"), [("theory/contacts.md", CONTACTS), ("theory/events.md", EVENTS)])
def test_every_number_of_the_page_is_held(name: str, claims: dict[str, str]) -> None:
    text = prose(name)
    for words in sorted(claims, key=len, reverse=True):
        text = text.replace(words, "")
    # powers of ten, decimals, and whole numbers above four, which are no indices or degrees
    left = re.findall(r".{30}(?:10\^\{?-?\d+|\b\d+\.\d+|(?<![\w^_{.-])(?:[5-9]|[1-9]\d+)\b(?!\}))", text)
    assert left == []

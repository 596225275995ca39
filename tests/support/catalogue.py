"""Kinematics and torques of gearbox files, apart from clutchwork: rows of sets, null spaces, least squares."""

from __future__ import annotations

import itertools
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

import clutchwork.gearbox

FOLDER = Path(clutchwork.gearbox.__file__).parent / "catalogue"
NAMES = sorted(path.stem for path in FOLDER.glob("*.toml"))
# with a row in which two speeds are free
SPLITS = ("gm-2ml70", "toyota-p112", "toyota-p410")
# with two clutches and a synchroniser for each gear: the shaft whose clutch is open turns freely
DUAL = ("vw-dq200", "vw-dq250")
# singular values of these small matrices lie above 1e-3 of the largest, or at rounding
SMALL = 1e-9

Row = list[tuple[str, float]]


def data(name: str) -> dict[str, Any]:
    """The plain content of a file of the catalogue."""
    return tomllib.loads((FOLDER / f"{name}.toml").read_text(encoding="utf-8"))


def set_rows(entry: Mapping[str, Any]) -> Iterator[Row]:
    """Terms of speeds that add up to zero: the text-book equation of each kind of set."""
    kind = entry["type"]
    zs, zr = entry.get("teeth_sun", 1), entry.get("teeth_ring", entry.get("ratio", 1))
    if kind in ("single", "stepped"):
        zs, zr = zs * entry.get("teeth_planet_ring", 1), zr * entry.get("teeth_planet_sun", 1)
        yield [(entry["sun"], zs), (entry["ring"], zr), (entry["carrier"], -zs - zr)]
    elif kind == "double":
        yield [(entry["ring"], zr), (entry["sun"], -zs), (entry["carrier"], zs - zr)]
    elif kind == "two_suns":
        a = entry["teeth_second_sun"] * entry["teeth_planet_sun"]
        b = entry["teeth_sun"] * entry["teeth_planet_second_sun"]
        yield [(entry["second_sun"], a), (entry["sun"], -b), (entry["carrier"], b - a)]
    elif kind == "ravigneaux":
        large, small = entry["teeth_large_sun"], entry["teeth_small_sun"]
        yield [(entry["large_sun"], large), (entry["ring"], zr), (entry["carrier"], -large - zr)]
        yield [(entry["ring"], zr), (entry["small_sun"], -small), (entry["carrier"], small - zr)]
    else:
        assert kind == "gear", kind
        sizes = (1.0, entry["ratio"]) if "ratio" in entry else (entry["teeth_first"], entry["teeth_second"])
        yield [(entry["first"], sizes[0]), (entry["second"], sizes[1])]


class Box:
    """The matrices of a gearbox file."""

    def __init__(self, content: Mapping[str, Any]) -> None:
        self.content = content
        self.elements = {n: e["members"] if isinstance(e, dict) else e for n, e in content.get("elements", {}).items()}
        self.kinds = {
            name: entry["type"] if isinstance(entry, dict) else "brake" if "housing" in entry else "clutch"
            for name, entry in content.get("elements", {}).items()
        }
        sets = [row for entry in content["sets"].values() for row in set_rows(entry)]
        named = [content["input"], content["output"], *(m for row in sets for m, _ in row)]
        named += [member for pair in self.elements.values() for member in pair]
        self.members = [member for member in dict.fromkeys(named) if member != "housing"]
        self.sets = np.array([self.row(row) for row in sets])

    def row(self, terms: Row) -> np.ndarray:
        made = np.zeros(len(self.members))
        for member, value in terms:
            if member != "housing":
                made[self.members.index(member)] += value
        return made / np.abs(made).max()

    def slip(self, name: str) -> np.ndarray:
        """The row of an element: follower over base."""
        first, second = self.elements[name]
        if self.kinds[name] == "brake":
            return self.row([(first if second == "housing" else second, 1.0)])
        return self.row([(second, 1.0), (first, -1.0)])

    def matrix(self, closed: list[str]) -> np.ndarray:
        return np.vstack([self.sets, *(self.slip(name) for name in closed)])

    def motions(self, closed: list[str]) -> np.ndarray:
        """Columns that span the speeds left free."""
        _, sizes, vectors = np.linalg.svd(self.matrix(closed))
        rank = int((sizes > SMALL).sum())
        return vectors[rank:].T

    def classified(self, closed: list[str]) -> tuple[str, int, int, float | None]:
        """Kind, degrees of freedom, redundant rows, ratio of a combination of closed elements."""
        free = self.motions(closed)
        dof = free.shape[1]
        redundant = len(self.sets) + len(closed) - (len(self.members) - dof)
        moves = [bool(dof and np.abs(free[place]).max() > SMALL) for place in (0, 1)]
        if not all(moves):
            kind = {(False, False): "tie-up", (False, True): "input held", (True, False): "output held"}[tuple(moves)]
            return kind, dof, redundant, None
        if np.linalg.matrix_rank(free[:2], tol=SMALL) > 1:
            return "neutral", dof, redundant, None
        ratio = float(free[0] @ free[1] / (free[1] @ free[1]))
        return "gear", dof, redundant, ratio

    def ratio(self, gear: str) -> float:
        """As its maker says it."""
        ratio = self.classified(self.content["gears"][gear])[3]
        assert ratio is not None, gear
        return 1.0 / ratio if self.content.get("ratio_form") == "out/in" else ratio

    def misses(self) -> dict[str, float]:
        """How far each ratio is from the published one."""
        return {gear: abs(self.ratio(gear) - wanted) for gear, wanted in self.content["published"].items()}

    def allowed(self, gear: str) -> float:
        wanted = abs(self.content["published"][gear])
        return max(self.content.get("tolerance", 0.001), self.content.get("tolerance_relative", 0.0) * wanted)

    def torques(self, gear: str) -> tuple[dict[str, float], float]:
        """Torque on the follower of each closed element, and that on the output, at torque 1 of the input."""
        closed = self.content["gears"][gear]
        known, load = np.zeros(len(self.members)), np.zeros((1, len(self.members)))
        known[0], load[0, 1] = -1.0, 1.0
        system = np.vstack([self.matrix(closed), load]).T
        found, *_ = np.linalg.lstsq(system, known, rcond=None)
        assert np.abs(system @ found - known).max() < 1e-12
        return dict(zip(closed, found[len(self.sets) :], strict=False)), float(found[-1])

    def combinations(self) -> Iterator[list[str]]:
        for size in range(len(self.elements) + 1):
            yield from (list(some) for some in itertools.combinations(self.elements, size))

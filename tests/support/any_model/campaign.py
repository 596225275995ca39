"""Very many random models: what fails by kind, with the smallest seed of each, and that model made smaller.

PYTHONPATH=tests python -m support.any_model.campaign --models 20000 --seed 0 --jobs 2 --shrink 30
PYTHONPATH=tests python -m support.any_model.campaign --models 10000 --small --depth 1
"""

from __future__ import annotations

import argparse
import json
import signal
import time
import warnings
from collections import defaultdict
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import clutchwork as cw
from support.any_model import judge, model, shrink

# s that one model may take with all of its twins
PATIENCE = 60
# of models whose faults a tighter run does not have: no finding, but their number should not grow
EXCUSED = "excused"
Found = tuple[int, str, str]


class TooSlowError(Exception):
    """A model takes too long."""


def examined(seed: int, depth: int, drawn: str = "model") -> list[Found]:
    """What is wrong with the model of a seed: (seed, kind, words)."""

    def late(*_: Any) -> None:
        raise TooSlowError

    signal.signal(signal.SIGALRM, late)
    signal.alarm(PATIENCE)
    model.CRASHES.clear()
    judge.EXCUSED.clear()
    try:
        made = getattr(model, drawn)(seed)
        found = [(fault.key, fault.words) for fault in judge.faults(made, seed, depth)]
    except (TooSlowError, KeyboardInterrupt, cw.Interrupted):
        found = [("hangs", f"more than {PATIENCE} s")]
    finally:
        signal.alarm(0)
    found += [(EXCUSED, ", ".join(judge.EXCUSED))] if judge.EXCUSED else []
    found += [
        (f"check raises {text.split(':')[0]} {made['element'][-1]['type']}", text) for text, made in model.CRASHES
    ]
    return [(seed, key, words) for key, words in found]


def _some(seeds: list[int], depth: int, drawn: str) -> list[Found]:
    warnings.simplefilter("ignore")
    return [one for seed in seeds for one in examined(seed, depth, drawn)]


def campaign(first: int, count: int, jobs: int, depth: int, drawn: str) -> Iterator[list[Found]]:
    """Findings chunk by chunk."""
    chunks = [list(range(at, min(at + 20, first + count))) for at in range(first, first + count, 20)]
    if jobs == 1:
        yield from (_some(chunk, depth, drawn) for chunk in chunks)
        return
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(_some, chunks, [depth] * len(chunks), [drawn] * len(chunks))


def smaller(seed: int, key: str, depth: int, drawn: str, seconds: float) -> str:
    """The model of a seed made smaller while it fails in the same way, as TOML."""
    fails = lambda made: any(fault.key == key for fault in judge.faults(made, seed, depth, key))  # noqa: E731
    return shrink.toml(shrink.shrunk(getattr(model, drawn)(seed), fails, seconds))


def main() -> None:
    """Run it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--models", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--depth", type=int, default=2, help="0: rows alone, 1: tolerances too, 2: twins too")
    parser.add_argument("--small", action="store_true", help="models of one to three elements")
    parser.add_argument("--shrink", type=float, default=0.0, help="seconds for each kind")
    parser.add_argument("--only", default="", help="kinds that hold this word")
    parser.add_argument("--out", default="", help="a file for all findings, a line of JSON each")
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    drawn = "small" if given.small else "model"
    kinds: dict[str, list[tuple[int, str]]] = defaultdict(list)
    began, broken, excused = time.monotonic(), set[int](), set[int]()
    for found in campaign(given.seed, given.models, given.jobs, given.depth, drawn):
        for seed, key, words in found:
            if key == EXCUSED:
                excused.add(seed)
                continue
            kinds[key].append((seed, words))
            broken.add(seed)
        if given.out:
            with Path(given.out).open("a", encoding="utf-8") as file:
                file.writelines(json.dumps(one) + "\n" for one in found)
    took, seeds = time.monotonic() - began, ", ".join(map(str, sorted(excused)[:10]))
    print(f"{given.models} models in {took:.0f} s, {len(broken)} with findings of {len(kinds)} kinds")
    print(f"{len(excused)} excused by a tighter run, of the seeds {seeds or '-'}")
    for key, cases in sorted(kinds.items(), key=lambda item: -len(item[1])):
        seed, words = min(cases)
        print(f"{len({s for s, _ in cases}):6d}  {key}\n        seed {seed}: {words}")
        if given.shrink and given.only in key:
            print(
                "\n".join(
                    f"        | {line}" for line in smaller(seed, key, given.depth, drawn, given.shrink).splitlines()
                )
            )


if __name__ == "__main__":
    main()

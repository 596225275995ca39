"""Derivatives of random models of everything: values and numbers of many kinds, compared with differences of runs.

With some dozen values of each model, 4 numbers make 50 pairs. 300 models:
PYTHONPATH=tests python -m support.any_model.gradients --models 300 --seed 0 --numbers 4
"""

from __future__ import annotations

import argparse
import re
import signal
import warnings
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

import clutchwork as cw
from clutchwork.gradients.parameters import Tunable
from clutchwork.sweeps.outputs import Output, asked
from support import by_differences, free_numbers, gradient_cases
from support.any_model import agree, judge, model
from support.compared_gradients import Tally, compared, stated, summed, told

# s of computing that one model may take with all of its runs
PATIENCE = 120
# after so many models each it is said how it stands
TOLD = 25
# what signals end with that values are made of: their last value, their integral, their extremes
ENDS = ("work", "heat", "angle", "position", "temperature", "energy", "elastic", "load", "wear", "twist")
INTEGRALS = ("power", "speed", "acceleration")
EXTREMES = ("torque", "force", "acceleration", "speed", "power", "slip", "deflection", "temperature", "capacity")
# values of which a millionth is less than the absolute tolerance of the runs are zero but for that, in any unit
ROUND_OFF = 1e-6
ENTRY = re.compile(r"\[.*|^[^.]*\.")


class TooSlowError(Exception):
    """A model takes too long."""


def examined(seed: int, count: int) -> Tally:
    """What became of the derivatives of the model of a seed, by some of its numbers."""

    def late(*_: Any) -> None:
        raise TooSlowError

    signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, PATIENCE)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return checked(model.model(seed), seed, count)
    except (TooSlowError, KeyboardInterrupt, cw.Interrupted):
        return Tally(whole=[f"more than {PATIENCE} s"])
    except cw.ClutchworkError as error:
        return Tally(wrong=[f"{type(error).__name__}: {str(error)[:300]}"])
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)


def checked(made: model.Plain, seed: int, count: int) -> Tally:
    """Derivatives of a model by some of its numbers."""
    tally, rng = Tally(), np.random.default_rng([seed, 76])
    run = agree.run(made, rtol=1e-8, atol=1e-10)
    if run.status != "done" or judge.explodes(run):
        return tally
    wanted = outputs(run, rng)
    system = model.driveline(made).assemble()
    scales = np.maximum(by_differences.scales(run, wanted), ROUND_OFF)
    compared(tally, system, made["simulation"]["t_end"], wanted, scales, numbers(system, rng, count), loose=True)
    return tally


def outputs(run: cw.Trajectory, rng: np.random.Generator) -> dict[str, Output]:
    """Values of many kinds: those of random drivelines, ends of states and energies, an integral, two extremes."""
    found: list[Any] = list(gradient_cases.outputs(run, rng).values())
    found += _some(run, rng, ENDS, 3)
    sums = [cw.integral(name) for name in _some(run, rng, INTEGRALS, 1)]
    found += [one for one in sums if one.kept_as(run)]
    found += [rng.choice([cw.maximum, cw.minimum])(name) for name in _some(run, rng, EXTREMES, 2)]
    return asked(list(dict.fromkeys(found)))


def _some(run: cw.Trajectory, rng: np.random.Generator, ends: tuple[str, ...], count: int) -> list[str]:
    """Signals of different endings."""
    known: dict[str, list[str]] = {end: [] for end in ends}
    for name in run.names:
        end = name.rpartition(".")[2].split("_")[0]
        if end in known:
            known[end].append(name)
    kinds = [own for own in known.values() if own]
    return [str(rng.choice(kinds[k])) for k in rng.permutation(len(kinds))[:count]]


def numbers(system: cw.System, rng: np.random.Generator, count: int) -> tuple[Tunable, ...]:
    """Numbers of different kinds first, so that points of tables do not crowd out others."""
    known = free_numbers.free(system)
    order, seen = [known[k] for k in rng.permutation(len(known))], Counter[str]()
    ranks = dict[str, int]()
    for one in order:
        kind = ENTRY.sub("", one.name)
        seen[kind] += 1
        ranks[one.name] = seen[kind]
    found = list[Tunable]()
    for one in sorted(order, key=lambda one: ranks[one.name]):
        # a number inside of another one goes with it
        if not any(one.name.startswith(f"{k.name}.") or k.name.startswith(f"{one.name}.") for k in found):
            found.append(one)
    return tuple(found[:count])


def campaign(first: int, models: int, count: int) -> Iterator[tuple[int, Tally]]:
    """The models of many seeds."""
    for seed in range(first, first + models):
        yield seed, examined(seed, count)


def arguments(about: str | None) -> argparse.Namespace:
    """What the command line asks of a comparison of derivatives."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--models", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--numbers", type=int, default=5, help="numbers of each model")
    warnings.simplefilter("ignore")
    return parser.parse_args()


def main() -> None:
    """Run it."""
    given, tallies = arguments(__doc__), list[Tally]()
    for seed, tally in campaign(given.seed, given.models, given.numbers):
        tallies.append(tally)
        for what, words in told(tally):
            print(f"seed {seed} {what.upper()} {words}", flush=True)
        if len(tallies) % TOLD == 0:
            print("\n".join(["up to here:", *stated(summed(iter(tallies)))]), flush=True)
    print("\n".join(stated(summed(iter(tallies)))))


if __name__ == "__main__":
    main()

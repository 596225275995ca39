"""Every public function and method, called without what it needs and with a keyword that it does not know."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from tempfile import TemporaryDirectory
from typing import Any

import pytest

import clutchwork as cw


def held() -> list[Any]:
    """One of each of what users hold."""
    d = cw.Driveline("braked")
    disc = d.shaft("disc", inertia=1.0, speed=10.0)
    d.add(cw.Brake("b", shaft=disc, friction=cw.Coulomb(static=0.3, kinetic=0.2), gain=1.0, normal_force=50.0))
    run = d.simulate(0.5)
    sim = cw.Simulator(d)
    sweep = cw.sweep(d, 0.1, vary={"b.normal_force": [10.0, 50.0]}, outputs=["disc.speed"])
    lin = cw.linearise(d)
    return [
        d, d.assemble(), run, run.events, run.energy, sweep, sim, sim.save(), lin, lin.modes, d.hints(), d.draw(),
        cw.Options(), disc, *studied(d),
    ]  # fmt: skip


def studied(d: cw.Driveline) -> list[Any]:
    """A design, a study and its indices."""
    vary = cw.design({"b.normal_force": (10.0, 50.0)}, 2, method="saltelli")
    with TemporaryDirectory() as folder:
        study = cw.study(d, 0.1, vary=vary, outputs="disc.speed", folder=folder)
        return [vary, study, cw.sobol_indices(study, "disc.speed")]


def ours(function: Any) -> bool:
    """Whether it is made here, and not what Python gives to every sequence."""
    return str(getattr(function, "__module__", "")).startswith("clutchwork")


# what calls return, and what declarations are made of: nobody calls these
MADE_HERE = {
    cw.Calibration, cw.Design, cw.Differentiable, cw.Domain, cw.Element, cw.EnergyBalance, cw.Event, cw.Events,
    cw.Gradient, cw.Hint, cw.Hints, cw.Law, cw.Linear, cw.Loss, cw.Losses, cw.Moment, cw.Moments, cw.Problem, cw.Signal,
    cw.SobolIndices, cw.State, cw.Study, cw.Sweep, cw.System, cw.Trajectory,
}  # fmt: skip


def of_results(thing: Any) -> bool:
    """Whether it is a class that users do not make things of."""
    return isinstance(thing, type) and (issubclass(thing, BaseException) or thing in MADE_HERE)


def calls() -> Iterator[tuple[str, Callable[..., Any]]]:
    """All public functions of the package and methods of what users hold, by name."""
    for name in dir(cw):
        thing = getattr(cw, name)
        if not name.startswith("_") and callable(thing) and ours(thing) and not of_results(thing):
            yield f"cw.{name}", thing
    for thing in held():
        for name in dir(type(thing)):
            static = inspect.getattr_static(type(thing), name)
            if not name.startswith("_") and not isinstance(static, property):
                method = getattr(thing, name)
                if callable(method) and ours(method):
                    yield f"{type(thing).__name__}.{name}", method


CALLS = dict(calls())


def needs(function: Callable[..., Any]) -> bool:
    """Whether it has an argument that must be given."""
    given = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
    try:
        parameters = inspect.signature(function).parameters.values()
    except ValueError:
        return False
    return any(p.default is p.empty and p.kind not in given for p in parameters)


def test_there_are_many() -> None:
    wanted = {"cw.simulate", "Driveline.add", "System.save", "Trajectory.at", "Events.to_csv", "Sweep.run"}
    wanted |= {"Simulator.set", "State.save", "Linear.plot", "cw.lock", "cw.load_run", "cw.Clutch"}
    assert wanted <= set(CALLS)


@pytest.mark.parametrize("name", [name for name, call in CALLS.items() if needs(call)])
def test_without_what_it_needs(name: str) -> None:
    with pytest.raises(cw.UseError, match=r"is missing; (give \w|\w)"):
        CALLS[name]()


@pytest.mark.parametrize("name", CALLS)
def test_with_an_unknown_keyword(name: str) -> None:
    with pytest.raises((cw.UseError, cw.OptionError), match=r"no_such_field|is missing"):
        CALLS[name](no_such_field=3)

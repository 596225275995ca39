"""The translator of the reference cases: every form of CONVENTIONS.md by itself."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from clutchwork.signals.bases.waveform import value
from reference.msl import compare
from reference.msl.model import translate
from reference.msl.pieces import UnsupportedError, at, integral
from reference.msl.signals import first_value, pieces, signal

T_END = 3.0
SINE = {"type": "sine", "amplitude": 2.0, "f": 1.5, "phase": 0.3, "offset": 0.5, "start_time": 0.4}
RAMP = {"type": "ramp", "height": 4.0, "duration": 2.0, "offset": -1.0, "start_time": 0.5}
PULSE = {"type": "pulse", "amplitude": 3.0, "width": 20, "period": 0.5, "offset": 1.0, "start_time": 0.25}
TABLE = {"type": "table", "points": [[0.0, 1.0], [1.0, 3.0], [1.0, -2.0], [2.5, 0.0]]}


def sine(t: float) -> float:
    return 0.5 + (t >= 0.4) * 2.0 * math.sin(2 * math.pi * 1.5 * (t - 0.4) + 0.3)


def ramp(t: float) -> float:
    return -1.0 + 4.0 * min(max((t - 0.5) / 2.0, 0.0), 1.0)


def table(t: float) -> float:
    return 1.0 + 2.0 * t if t < 1.0 else min(-2.0 + 2.0 * (t - 1.0) / 1.5, 0.0)


def pulse(t: float) -> float:
    return 1.0 + 3.0 * (t >= 0.25 and (t - 0.25) % 0.5 < 0.1)


FORMS: dict[str, tuple[dict[str, Any], Any]] = {
    "constant": ({"type": "constant", "k": 7.0}, lambda t: 7.0),
    "step": ({"type": "step", "height": 2.0, "offset": 1.0, "start_time": 0.7}, lambda t: 1.0 + 2.0 * (t >= 0.7)),
    "step before the start": ({"type": "step", "height": 2.0, "start_time": -1.0}, lambda t: 2.0),
    "ramp": (RAMP, ramp),
    "ramp that has begun": (
        {"type": "ramp", "height": 4.0, "duration": 2.0, "start_time": -1.0},
        lambda t: min(2.0 * (t + 1.0), 4.0),
    ),
    "table with a jump, held outside": (TABLE, table),
    "pulse, width in percent": (PULSE, pulse),
    "pulse of no width": ({**PULSE, "width": 0}, lambda t: 1.0),
    "pulse that never ends": ({**PULSE, "width": 100}, lambda t: 1.0 + 3.0 * (t >= 0.25)),
    "sine": (SINE, sine),
    "sine that has begun": (
        {**SINE, "start_time": -0.2},
        lambda t: 0.5 + 2.0 * math.sin(2 * math.pi * 1.5 * (t + 0.2) + 0.3),
    ),
    "damped sine": (
        {**SINE, "type": "exp_sine", "damping": 0.8},
        lambda t: 0.5 + (sine(t) - 0.5) * math.exp(-0.8 * (t - 0.4)),
    ),
    "gain": ({"type": "gain", "k": -3.0, "input": "ramp"}, lambda t: -3.0 * ramp(t)),
    "gain of a sine": ({"type": "gain", "k": 2.0, "u": "sine"}, lambda t: 2.0 * sine(t)),
    "gain of a pulse": ({"type": "gain", "k": 2.0, "input": "pulse"}, lambda t: 2.0 * pulse(t)),
    "product of lines": ({"type": "product", "inputs": ["ramp", "table"]}, lambda t: ramp(t) * table(t)),
    "product by keys": ({"type": "product", "u1": "ramp", "u2": "pulse"}, lambda t: ramp(t) * pulse(t)),
    "product with a sine": ({"type": "product", "inputs": ["sine", "pulse"]}, lambda t: sine(t) * pulse(t)),
    "product of sines": ({"type": "product", "inputs": ["sine0", "wave"]}, lambda t: math.sin(9 * t) * math.cos(5 * t)),
    "product with a number": ({"type": "product", "inputs": ["ramp", 3.0]}, lambda t: 3.0 * ramp(t)),
    "difference": ({"type": "difference", "plus": "ramp", "minus": "table"}, lambda t: ramp(t) - table(t)),
    "difference as a list": ({"type": "difference", "inputs": ["sine", "ramp"]}, lambda t: sine(t) - ramp(t)),
    "difference of sines": ({"type": "difference", "u1": "sine", "u2": "wave"}, lambda t: sine(t) - math.cos(5 * t)),
    "in place": ({"type": "difference", "plus": {"type": "constant", "k": 2.0}, "minus": 0.5}, lambda t: 1.5),
    "gain_sin_atan": (
        {"type": "gain_sin_atan", "k": 9.0, "input": "pulse"},
        lambda t: 9.0 * math.sin(math.atan(pulse(t))),
    ),
}
OTHERS = {
    "sine": SINE,
    "ramp": RAMP,
    "table": TABLE,
    "pulse": PULSE,
    "sine0": {"type": "sine", "amplitude": 1.0, "f": 4.5 / math.pi},
    "wave": {"type": "sine", "amplitude": 1.0, "f": 2.5 / math.pi, "phase": math.pi / 2},
}
# between all knots
TIMES = [0.0137 + 0.0731 * k for k in range(40)]


@pytest.mark.parametrize("name", FORMS)
def test_signal(name: str) -> None:
    form, wanted = FORMS[name]
    signals = {**OTHERS, "it": form}
    made = pieces(signals, "it", T_END)
    ours = signal(signals, "it", T_END, 2.0)
    for time in TIMES:
        assert at(made, time)(time) == pytest.approx(wanted(time), abs=1e-12)
        known = value(ours, time) if isinstance(ours, cw.Signal) else ours
        assert known == pytest.approx(2.0 * wanted(time), abs=1e-12)
    assert first_value(signals, "it") == pytest.approx(wanted(0.0), abs=1e-12)


@pytest.mark.parametrize("name", FORMS)
def test_the_core_follows_it(name: str) -> None:
    form, wanted = FORMS[name]
    case = small({"t": {"type": "torque", "tau": "it"}}, [["t.flange", "j.flange_a"]], {**OTHERS, "it": form})
    run = translate(case).driveline.simulate(T_END, times=TIMES)
    assert run["t.torque"] == pytest.approx([wanted(t) for t in TIMES], abs=1e-9)


def test_what_no_signal_can_be_is_said() -> None:
    for form in (
        {"type": "gain_sin_atan", "k": 1.0, "input": "ramp"},
        {"type": "product", "inputs": ["ramp", "sine"]},
        {"type": "noise"},
        {**TABLE, "extrapolation": "linear"},
    ):
        with pytest.raises(UnsupportedError):
            pieces(OTHERS, form, T_END)


def small(
    elements: dict[str, Any], connections: list[list[str]], signals: Any = None, **initial: float
) -> dict[str, Any]:
    """A case with an inertia "j" of 2 kg m2 and some elements."""
    return {
        "name": "small",
        "stop_time": T_END,
        "elements": {"j": {"type": "inertia", "J": 2.0}, **elements},
        "connections": connections,
        "signals": signals or {},
        "initial": {"j.phi": 0.0, "j.w": 0.0} | {f"j.{name}": x for name, x in initial.items()},
        "outputs": [{"csv": "j.w", "signal": "j.w"}, {"csv": "j.phi", "signal": "j.phi"}],
    }


def simulated(case: dict[str, Any]) -> tuple[Any, np.ndarray, np.ndarray]:
    """The run of a case, and j.w and j.phi as the case names them."""
    model = translate(case)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        run = model.driveline.simulate(case["stop_time"], times=TIMES, rtol=1e-10, atol=1e-12)
    assert run.status == "done", run.message
    return run, model.outputs["j.w"](run), model.outputs["j.phi"](run)


def solved(slope: Any, start: list[float], times: Any = TIMES) -> np.ndarray:
    found = solve_ivp(slope, (0.0, T_END), start, t_eval=times, rtol=1e-10, atol=1e-12, max_step=0.01)
    return found.y


@pytest.mark.parametrize("form", ["sine", "ramp", "pulse", "it"])
def test_speed_behind_its_filter(form: str) -> None:
    damped = {**SINE, "type": "exp_sine", "damping": 0.8}
    wanted = {"sine": sine, "ramp": ramp, "pulse": pulse, "it": FORMS["damped sine"][1]}[form]
    start = wanted(0.0)
    source = {"s": {"type": "speed", "exact": False, "f_crit": 1.2, "w_ref": form}}
    _, w, phi = simulated(small(source, [["s.flange", "j.flange_a"]], {**OTHERS, "it": damped}, w=start))
    reference = solved(lambda t, y: [(wanted(t) - y[0]) * 2 * math.pi * 1.2, y[0]], [start, 0.0])
    # jumps of the pulse cost the reference some 1e-5
    assert w == pytest.approx(reference[0], abs=2e-3 if form == "pulse" else 1e-6)
    assert phi == pytest.approx(reference[1], abs=2e-3 if form == "pulse" else 1e-6)


@pytest.mark.parametrize("exact", [True, False])
def test_position(exact: bool) -> None:
    form = {"type": "sine", "amplitude": 2.0, "f": 0.7, "phase": 0.3, "offset": 0.5}
    source = {"p": {"type": "position", "exact": exact, "f_crit": 2.0, "phi_ref": "it"}}
    case = small(source, [["p.flange", "j.flange_a"]], {"it": form})
    place = lambda t: 0.5 + 2.0 * math.sin(2 * math.pi * 0.7 * t + 0.3)  # noqa: E731
    case["initial"] = {} if exact else {"j.w": 1.0}
    _, w, phi = simulated(case)
    if exact:
        assert phi == pytest.approx([place(t) for t in TIMES], abs=1e-9)
        return
    wc, af, bf = 2 * math.pi * 2.0, 1.3617, 0.6180
    reference = solved(lambda t, y: [y[1], ((place(t) - y[0]) * wc - af * y[1]) * (wc / bf)], [place(0.0), 1.0])
    assert phi == pytest.approx(reference[0], abs=1e-7)
    assert w == pytest.approx(reference[1], abs=1e-6)


@pytest.mark.parametrize("form", ["sine", "ramp", "pulse"])
def test_accelerate(form: str) -> None:
    wanted = {"sine": sine, "ramp": ramp, "pulse": pulse}[form]
    source = {"a": {"type": "accelerate", "a_ref": form}}
    _, w, phi = simulated(small(source, [["a.flange", "j.flange_a"]], OTHERS, w=1.5))
    made = integral(pieces(OTHERS, form, T_END), 1.5)
    assert w == pytest.approx([at(made, t)(t) for t in TIMES], abs=1e-9)
    reference = solved(lambda t, y: [wanted(t), y[0]], [1.5, 0.0])
    assert w == pytest.approx(reference[0], abs=1e-4 if form == "pulse" else 1e-7)
    assert phi == pytest.approx(reference[1], abs=1e-4 if form == "pulse" else 1e-7)


@pytest.mark.parametrize("key", ["w_fixed", "v_fixed", "w"])
def test_constant_speed(key: str) -> None:
    _, w, _ = simulated(small({"s": {"type": "constant_speed", key: 4.0}}, [["s.flange", "j.flange_a"]], w=4.0))
    assert w == pytest.approx(4.0)


LOADS: dict[str, tuple[dict[str, Any], Any]] = {
    "constant": ({"type": "constant_torque", "tau_constant": -3.0}, lambda w: -3.0),
    "quadratic, odd": (
        {"type": "quadratic_speed_dependent_torque", "tau_nominal": -5.0, "w_nominal": 4.0, "same_direction": False},
        lambda w: -5.0 * (w / 4.0) * abs(w / 4.0),
    ),
    "quadratic, even": (
        {"type": "quadratic_speed_dependent_torque", "tau_nominal": -5.0, "w_nominal": 4.0, "same_direction": True},
        lambda w: -5.0 * (w / 4.0) ** 2,
    ),
    "linear, odd": (
        {"type": "linear_speed_dependent_torque", "tau_nominal": -5.0, "w_nominal": 4.0, "same_direction": False},
        lambda w: -5.0 * w / 4.0,
    ),
    "linear, even": (
        {"type": "linear_speed_dependent_torque", "tau_nominal": -5.0, "w_nominal": 4.0, "same_direction": True},
        lambda w: -5.0 * abs(w / 4.0),
    ),
    "sign": (
        {"type": "sign_torque", "tau_nominal": -8.0, "reg": "exp", "w0": 10.0},
        lambda w: -8.0 * (2.0 / (1.0 + math.exp(-w / 0.1)) - 1.0),
    ),
    "sign, driving": (
        {"type": "sign_torque", "tau_nominal": 1.0, "reg": "exp", "w0": 10.0},
        lambda w: 2.0 / (1.0 + math.exp(-w / 0.1)) - 1.0,
    ),
    "rolling resistance": (
        {"type": "rolling_resistance", "fWeight": 40.0, "cr": 0.3, "inclination": 0.5, "reg": "linear", "v0": 0.4},
        lambda w: -12.0 * math.cos(math.atan(0.5)) * max(-1.0, min(1.0, w / 0.4)),
    ),
}


@pytest.mark.parametrize("name", LOADS)
def test_load(name: str) -> None:
    """From 3 rad/s, and from -1 rad/s, which a load of one sign drives on."""
    element, torque = LOADS[name]
    for start in (3.0, -1.0):
        _, w, _ = simulated(small({"l": element}, [["l.flange", "j.flange_a"]], w=start))
        assert w == pytest.approx(solved(lambda t, y: [torque(y[0]) / 2.0], [start])[0], abs=1e-6)


def test_torque_between_two_flanges_and_its_sign() -> None:
    second = {"k": {"type": "inertia", "J": 1.0}, "t": {"type": "torque2", "tau": "ramp"}}
    case = small(second, [["j.flange_b", "t.flange_a"], ["t.flange_b", "k.flange_a"]], {"ramp": RAMP})
    case["initial"] |= {"k.w": 0.0}
    case["outputs"].append({"csv": "k.w", "signal": "k.w"})
    run, w, _ = simulated(case)
    given = integral(pieces(OTHERS, "ramp", T_END), 0.0)
    assert w == pytest.approx([-at(given, t)(t) / 2.0 for t in TIMES], abs=1e-9)
    assert run["k.speed"] == pytest.approx([at(given, t)(t) for t in TIMES], abs=1e-9)


def test_friction_that_is_continued_linearly_and_its_peak() -> None:
    """A bearing of 1 + 0.5 w N m, also beyond its last point; at rest it holds 1.5 times its value there."""
    bearing = {"type": "bearing_friction", "tau_pos": [[0, 1.0], [2, 2.0]], "peak": 1.5}
    _, w, _ = simulated(small({"b": bearing}, [["b.flange_a", "j.flange_a"]], w=5.0))
    assert w == pytest.approx(solved(lambda t, y: [-(1.0 + 0.5 * y[0]) / 2.0], [5.0])[0], abs=1e-8)
    load = {"type": "torque", "tau": "push"}
    rising = {"push": {"type": "ramp", "height": 3.0, "duration": 3.0}}
    run, _, _ = simulated(
        small({"b": bearing, "l": load}, [["b.flange_a", "j.flange_a"], ["l.flange", "j.flange_a"]], rising)
    )
    assert [(e.time, e.after) for e in run.events.changes()] == [(pytest.approx(1.5, abs=1e-9), "forward")]


def test_a_bearing_that_is_viscous_only() -> None:
    bearing = {"type": "bearing_friction", "tau_pos": [[0, 0.0], [2, 2.0]], "peak": 1.0}
    _, w, _ = simulated(small({"b": bearing}, [["b.flange_a", "j.flange_a"]], w=5.0))
    assert w == pytest.approx([5.0 * math.exp(-t / 2.0) for t in TIMES], abs=1e-8)


def test_a_lossy_gear_with_and_without_efficiencies() -> None:
    """Ideal, with a torque of its own that opposes the input, or with less torque at the driven side."""
    elements = {
        "g": {"type": "lossy_gear", "ratio": 2.0, "loss_table": [[0, 1, 1, 0, 0]]},
        "k": {"type": "inertia", "J": 1.0},
    }
    joined = [["j.flange_b", "g.flange_a"], ["g.flange_b", "k.flange_a"]]
    case = small(elements, joined, w=4.0)
    run, w, _ = simulated(case)
    assert w == pytest.approx(4.0)
    assert run["k.speed"] == pytest.approx(2.0)
    elements["g"] = {**elements["g"], "loss_table": [[0, 1, 1, 0.5, 0.5], [1, 1, 1, 1.5, 1.5]]}
    run, w, _ = simulated(small(elements, joined, w=4.0))
    assert w == pytest.approx(solved(lambda t, y: [-(0.5 + y[0]) / 2.25], [4.0])[0], abs=1e-8)
    assert translate(case | {"elements": case["elements"] | elements}).contacts == ("g",)
    elements["g"]["loss_table"] = [[0, 0.9, 0.8, 0, 0]]
    elements["push"] = {"type": "constant_torque", "tau_constant": 3.0}
    run, w, _ = simulated(small(elements, [*joined, ["push.flange", "j.flange_a"]], w=4.0))
    # T into the gear: 2 w' = 3 - T, and w'/2 = 2 (0.9 T) behind it
    assert w == pytest.approx([4.0 + 3.0 / (2.0 + 0.25 / 0.9) * t for t in TIMES], abs=1e-8)
    elements["push"] = {"type": "constant_torque", "tau_constant": -3.0}
    run, w, _ = simulated(small(elements, [*joined, ["push.flange", "j.flange_a"]], w=4.0))
    # the output drives as long as it turns forward: w'/2 = 2 T/0.8
    ahead = [t for t in TIMES if 4.0 - 3.0 / (2.0 + 0.25 * 0.8) * t > 0.0]
    assert w[: len(ahead)] == pytest.approx([4.0 - 3.0 / (2.0 + 0.25 * 0.8) * t for t in ahead], abs=1e-8)


COLUMNS = {
    "c.mode": np.array([0.0, 0.0, 0.0, 1.0, 1.0]),
    "c.startForward": np.array([0.0, 0.0, 1.0, 0.0, 0.0]),
    "c.startBackward": np.zeros(5),
}


def test_a_mode_alone_and_with_its_flags() -> None:
    alone = {"c.mode": COLUMNS["c.mode"]}
    assert compare.effective_modes(alone, "c").tolist() == [0, 0, 0, 1, 1]
    assert compare.effective_modes(COLUMNS, "c").tolist() == [0, 0, 1, 1, 1]
    one = {name: COLUMNS[name] for name in ("c.mode", "c.startForward")}
    assert compare.effective_modes(one, "c").tolist() == [0, 0, 1, 1, 1]
    backward = {"c.mode": np.array([0.0, -1.0]), "c.startBackward": np.array([1.0, 0.0])}
    assert compare.effective_modes(backward, "c").tolist() == [-1, -1]
    assert compare.effective_modes({"c.stuck": np.array([1.0, 0.0])}, "c").tolist() == [0, 1]
    assert compare.effective_modes({"c.w_rel": np.zeros(2)}, "c") is None

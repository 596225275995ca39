"""Laws with numbers, by kind: those of the drift test, and others that reach every word and flag of a declaration."""

from __future__ import annotations

from typing import Any

import clutchwork as cw

# unit mass; N, m, s
CURVE: dict[str, float] = {"static": 1.0, "kinetic": 0.7, "speed": 0.01, "viscous": 0.4}
BRISTLE: dict[str, float] = {**CURVE, "stiffness": 1e4, "damping": 200.0}
# the second set of the drift test
CURVE_2: dict[str, float] = {"static": 1.0, "kinetic": 0.8, "speed": 1e-3, "viscous": 0.4}
BRISTLE_2: dict[str, float] = {**CURVE_2, "stiffness": 1e4, "damping": 100.0}
WOUND: dict[str, float] = {"static": 1.0, "kinetic": 0.7, "elastic": 1e-4, "speed": 0.01, "viscous": 1.0}

# weak elements bring the mass to rest, stiff ones carry the load
MANY = (
    (2e-6, 0.03), (5e-6, 0.05), (1e-5, 0.07), (2e-5, 0.1), (4e-5, 0.15), (8e-5, 0.2), (1.3e-4, 0.15), (2e-4, 0.15),
    (3e-4, 0.1),
)  # fmt: skip
FEW = ((1e-5, 0.15), (5e-5, 0.25), (1e-4, 0.3), (2e-4, 0.3))

# LuGre friction as a formula
BENDING = "v - abs(v)*z/(kinetic + (static - kinetic)*exp(-(v/speed)**2))"
WRITTEN: dict[str, Any] = {
    "expression": f"z + damping*({BENDING}) + viscous*v",
    "rates": {"z": f"stiffness*({BENDING})"},
    "at_rest": "static",
}

DRIFT: dict[str, cw.Law] = {
    "tanh": cw.Tanh(kinetic=0.7, speed=1e-3),
    "regularised_stribeck": cw.RegularisedStribeck(static=1.0, kinetic=0.7, speed=0.01, width=1e-3),
    "dahl": cw.Dahl(kinetic=0.7, stiffness=1e4),
    "lugre": cw.LuGre(**BRISTLE),
    "dynamic_formula": cw.DynamicFormula(**WRITTEN, **BRISTLE),
    "elastoplastic": cw.ElastoPlastic(**BRISTLE, elastic=4.9e-5),
    "leuven": cw.Leuven(**CURVE, elements=FEW, order=50.0, damping=200.0),
    "gms": cw.GMS(**CURVE, elements=FEW),
    "mykhalevych": cw.Mykhalevych(**WOUND),
    "mykhalevych clip": cw.Mykhalevych(**WOUND, reset="clip"),
    "mykhalevych literal": cw.Mykhalevych(**WOUND, reset="literal"),
    "mykhalevych passive": cw.Mykhalevych(**WOUND, passive=True),
}

# what slides with several times the Stribeck speed meets every part of a law
OTHERS: dict[str, cw.Law] = {
    "naive_sign": cw.NaiveSign(**CURVE),
    "naive_sign tustin": cw.NaiveSign(**CURVE, shape="tustin"),
    "regularised_stribeck lorentz": cw.RegularisedStribeck(**CURVE, shape="lorentz", width=2e-3),
    "dahl square": cw.Dahl(kinetic=0.7, stiffness=1e4, exponent=2.0),
    "dahl steep": cw.Dahl(kinetic=0.7, stiffness=1e4, exponent=1.5),
    "lugre tustin": cw.LuGre(**BRISTLE | {"damping": 60.0}, shape="tustin"),
    "lugre power": cw.LuGre(**BRISTLE | {"damping": 60.0}, shape="power", exponent=1.4),
    "elastoplastic lorentz": cw.ElastoPlastic(
        **BRISTLE | {"damping": 60.0}, elastic=3e-5, plastic=6e-5, shape="lorentz"
    ),
    "leuven linear": cw.Leuven(**CURVE, elements=FEW, order=1.0),
    "leuven square": cw.Leuven(**CURVE, elements=(*FEW[:2], (2e-4, 0.8)), order=2.0, damping=30.0),
    "gms quick": cw.GMS(**CURVE, elements=FEW, attraction=2000.0),
    "gms damped": cw.GMS(**CURVE, elements=FEW, damping=30.0),
    "mykhalevych narrow": cw.Mykhalevych(**WOUND, range=1.5),
}

ALL = DRIFT | OTHERS

# within the bounds of docs/theory/friction-laws.md (17), (23): damping <= viscous/(static/kinetic - 1)
GENTLE: dict[str, float] = {**BRISTLE, "damping": 0.9}
EVEN: dict[str, float] = {**CURVE, "kinetic": 1.0}
# laws that store no more than was put in, whatever the motion
PASSIVE: dict[str, cw.Law] = {
    "tanh": DRIFT["tanh"],
    "regularised_stribeck": DRIFT["regularised_stribeck"],
    "naive_sign": cw.NaiveSign(**CURVE),
    "dahl": DRIFT["dahl"],
    "dahl square": OTHERS["dahl square"],
    "lugre": cw.LuGre(**GENTLE),
    "dynamic_formula": cw.DynamicFormula(**WRITTEN, **GENTLE),
    "elastoplastic": cw.ElastoPlastic(**GENTLE, elastic=4.9e-5),
    "leuven": cw.Leuven(**CURVE, elements=FEW, order=20.0),
    "leuven linear": cw.Leuven(**CURVE, elements=FEW, order=1.0, damping=0.9),
    "gms even": cw.GMS(**EVEN, elements=FEW),
    "gms damped": cw.GMS(**EVEN, elements=FEW, damping=30.0),
}
# laws that hold this only for swings there and back at like speeds, see (26) and (31)
SWINGS: dict[str, cw.Law] = {
    "gms": DRIFT["gms"],
    "gms quick": OTHERS["gms quick"],
    "mykhalevych": cw.Mykhalevych(**WOUND | {"viscous": 1.52 * 0.3}),
    "mykhalevych clip": cw.Mykhalevych(**WOUND | {"viscous": 1.52 * 0.3}, reset="clip"),
    "mykhalevych passive": cw.Mykhalevych(**WOUND | {"viscous": 0.1}, passive=True),
}

# the coefficient of the example without its step at rest: 0.065 + 0.075 exp(-slip/12.56)
FALLING: dict[str, Any] = {"static": 0.14, "kinetic": 0.065, "speed": 12.555180016171073, "shape": "tustin"}
# deflection at break-away 1e-4 rad
STIFF = FALLING | {"stiffness": 1400.0, "damping": 0.05}
LAYERS = [[2e-5, 0.1], [5e-5, 0.2], [1e-4, 0.3], [2e-4, 0.4]]
SHIFT: dict[str, dict[str, Any]] = {
    "exponential": {"static": 0.16, "slow": 0.14, "fast": 0.065, "speed": FALLING["speed"]},
    "stribeck": FALLING,
    "karnopp": FALLING | {"band": 0.05},
    "regularised_stribeck": FALLING | {"width": 0.05},
    "naive_sign": FALLING,
    "lugre": STIFF,
    "formula": {"expression": "mu + fall*exp(-v/speed)", "mu": 0.065, "fall": 0.075, "speed": FALLING["speed"]},
    "dynamic_formula": {
        **{key: one for key, one in STIFF.items() if key != "shape"},
        "expression": "z + damping*(v - abs(v)*z/(kinetic + (static - kinetic)*exp(-abs(v)/speed)))",
        "rates": {"z": "stiffness*(v - abs(v)*z/(kinetic + (static - kinetic)*exp(-abs(v)/speed)))"},
        "at_rest": "static",
    },
    "elastoplastic": STIFF | {"elastic": 3e-5},
    "leuven": FALLING | {"elements": LAYERS, "order": 20.0},
    "gms": FALLING | {"elements": LAYERS},
    "mykhalevych": {"static": 0.14, "kinetic": 0.065, "elastic": 1e-4, "speed": FALLING["speed"], "viscous": 1.0},
    "coefficient_table": {"static": 0.14, "kinetic": [[0.0, 0.14], [12.0, 0.0938], [40.0, 0.0681], [400.0, 0.065]]},
    # no fall: the mean of the others
    "coulomb": {"static": 0.14, "kinetic": 0.1},
    "tanh": {"kinetic": 0.1, "speed": 0.1},
    "dahl": {"kinetic": 0.1, "stiffness": 1400.0},
}


def kinds(laws: dict[str, Any]) -> set[str]:
    """Kinds of which there is at least one law."""
    return {type(law).kind for law in laws.values()}

"""The launches of two discs by nosnoc: finite elements with switch detection and complementarity, solved by IPOPT.

A. Nurkanović, M. Diehl, NOSNOC: a software package for numerical optimal control of nonsmooth systems,
doi:10.1109/LCSYS.2022.3181800.
"""

from __future__ import annotations

import contextlib
import io
import time
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from support.launches import JERK, LOCKED_BY, MOST, WEIGHT, Launch

MISSING = "not installed: pip install nosnoc"


class Solved(NamedTuple):
    """What one problem took."""

    success: bool
    cost: float  # as it says
    torques: NDArray[np.float64]  # at the knots [N m]
    seconds: float  # processor time


def available() -> Any:
    """`solve`; ImportError where nosnoc is not installed."""
    import nosnoc  # noqa: F401

    return solve


def solve(launch: Launch, goal: str, pieces: int) -> Solved:
    """One of the two goals: "heat" or "jerk"."""
    import casadi as ca
    import nosnoc

    engine, load, torque, heat, rate = (ca.SX.sym(name) for name in ("engine", "load", "torque", "heat", "rate"))

    def slope(sign: float) -> Any:
        # signs of friction: the engine is faster, or slower
        push = sign * torque
        motion = ((launch.torque - push) / launch.engine, (push - launch.drag * load) / launch.load)
        return ca.vertcat(*motion, rate, push * (engine - load))

    model = nosnoc.NosnocModel(
        x=ca.vertcat(engine, load, torque, heat),
        F=[ca.horzcat(slope(1.0), slope(-1.0))],
        S=[np.array([[1.0], [-1.0]])],
        c=[engine - load],
        x0=np.array([launch.speed, 0.0, 0.0, 0.0]),
        u=rate,
    )
    none, bound = np.inf, JERK * launch.load if goal == "heat" else 1e3
    locked = (launch.torque - torque) / launch.engine - (torque - launch.drag * load) / launch.load
    ocp = nosnoc.NosnocOcp(
        lbu=np.array([-bound]),
        ubu=np.array([bound]),
        u_guess=np.array([40.0 if goal == "heat" else 10.0]),
        f_q=WEIGHT * rate**2 if goal == "heat" else 1e-3 * (rate / launch.load) ** 2,
        f_terminal=heat if goal == "heat" else ca.SX(0.0),
        lbx=np.array([-none, -none, 0.0, -none]),
        ubx=np.array([none, none, MOST if goal == "heat" else none, none]),
        g_terminal=engine - load if goal == "heat" else ca.vertcat(engine - load, locked),
    )
    options = nosnoc.NosnocOpts()
    options.terminal_time, options.N_stages, options.N_finite_elements, options.n_s = LOCKED_BY, pieces, 2, 2
    options.comp_tol, options.print_level, options.homotopy_update_slope = 1e-6, 0, 0.1
    options.step_equilibration = nosnoc.StepEquilibrationMode.L2_RELAXED_SCALED
    begun = time.process_time()
    with contextlib.redirect_stdout(io.StringIO()):
        found = nosnoc.NosnocSolver(options, model, ocp).solve()
    taken = time.process_time() - begun
    rates = np.array([float(np.ravel(one)[0]) for one in found["u_list"]])
    torques = np.append(0.0, np.cumsum(rates)) * LOCKED_BY / pieces
    return Solved("SUCCESS" in str(found["status"]), float(found["cost_val"]), torques, taken)

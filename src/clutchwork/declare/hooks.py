"""Optional functions of a C++ header, which a declaration names as its `hooks`.

Standard library only: the build imports it and asserts that a header has the functions that its declaration names, and
no others of these.
"""

from __future__ import annotations

from clutchwork.base import dataclass


@dataclass(frozen=True)
class Hook:
    """Functions of a header that belong together."""

    names: tuple[str, ...]
    concept: str  # that they fulfil, in components/component.hpp
    roles: tuple[str, ...]  # of the components that may have them
    doc: str  # when a component has them


HOOKS = (
    Hook(("edges", "edge"), "Kinked", ("torque", "law", "contact"), "kinks over the rate or the slip"),
    Hook(("margin", "cross", "turns"), "SwitchingLaw", ("torque", "law"), "pieces that its states or inputs switch"),
    Hook(("margin", "cross"), "SwitchingProcess", ("process", "flow"), "pieces that its states and inputs switch"),
    Hook(("corner",), "CorneredProcess", ("process",), "corners at which what it follows may rest"),
    Hook(("drawn",), "DrawingProcess", ("process",), "flows that it draws from what gives its inputs"),
    Hook(("freed",), "Freeing", ("torque",), "stored energy that becomes heat where a piece is left"),
    Hook(("settle",), "Settling", ("torque", "law"), "pieces that follow from where it is, after a jump too"),
    Hook(("pace",), "Paced", ("torque",), "an oscillation of its own that steps resolve, and pieces"),
    Hook(("runs_on",), "RunningOn", ("law",), "pieces that may be left on the way back"),
    Hook(("ratio",), "TransmissionElement", ("torque",), "a varying ratio that ties its two ways, in place of torques"),
    Hook(("heat",), "HeatingElement", ("torque",), "heat that is not -torque rate"),
    Hook(("outside",), "BoundedLaw", ("law",), "tables that can be left"),
    Hook(("fits",), "FittedLaw", ("law", "torque", "contact"), "tables whose sizes belong together"),
    Hook(("count",), "Sized", ("torque", "law"), "fewer states in use by its parameters"),
    Hook(("chatters",), "ChatteringLaw", ("law",), "a jump with the sign of the slip, without rest"),
    Hook(("gain",), "ShapedContact", ("contact",), "a torque per load that is not the coefficient"),
    Hook(("limit",), "LimitedContact", ("contact",), "a static torque of its own"),
    Hook(("bound",), "LoadedContact", ("contact",), "a capacity that follows the torque of its own gear row"),
    Hook(("holding",), "YieldingContact", ("contact",), "a freewheel that gives way"),
    Hook(("end", "restitution", "rest_speed"), "StopContact", ("contact",), "a stop, which holds at its ends alone"),
    Hook(("fault", "fault_kind", "fault_report"), "FaultyContact", ("contact",), "a contact that can fail"),
)


def hooks_of(role: str) -> tuple[Hook, ...]:
    """The hooks that components of a role may have."""
    return tuple(hook for hook in HOOKS if role in hook.roles)


def hook_problems(role: str, names: tuple[str, ...]) -> list[str]:
    """What is wrong with the hooks that a declaration names: unknown ones, and ones without their companions."""
    known = [name for hook in hooks_of(role) for name in hook.names]
    found = [f"hooks: no {name!r}{_near(name, known)}; {_offer(role, known)}" for name in names if name not in known]
    for hook in hooks_of(role):
        missing = [name for name in hook.names if name not in names]
        if missing and len(missing) < len(hook.names):
            given = " and ".join(name for name in hook.names if name in names)
            found.append(f"hooks: {given} without {' and '.join(missing)}; name all of {', '.join(hook.names)}")
    return found


def _near(name: str, known: list[str]) -> str:
    from difflib import get_close_matches

    close = get_close_matches(name, known, n=1)
    return f", did you mean {close[0]!r}?" if close else ""


def _offer(role: str, known: list[str]) -> str:
    return f"a {role} may have {', '.join(known)}" if known else f"a {role} has none"

"""A model file of two discs and a clutch, for tests of what reads one."""

from __future__ import annotations

MODEL = """
name = "two discs"
[[shaft]]
name = "engine"
inertia = 0.2
speed = 100.0
[[shaft]]
name = "load"
inertia = 0.8
[[element]]
name = "c1"
type = "clutch"
base = "engine"
follower = "load"
gain = 1.0
normal_force = 100.0
friction = {type = "coulomb", static = 0.1, kinetic = 0.1}
[simulation]
t_end = 2.0
"""

"""Friction laws that share no code with clutchwork: numpy and SciPy alone, made to be compared with.

Every law is a set of smooth branches. `solve` integrates a branch with Radau, locates the instant at which the law
changes its branch, and starts anew there; nothing integrates across a kink.
"""

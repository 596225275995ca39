"""Derivatives of what a run gives by its numbers: `cw.differentiable`, and what `run.gradient` calls."""

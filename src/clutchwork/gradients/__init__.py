"""Derivatives of the outputs of a run by its parameters: `cw.differentiable`, `run.gradient`."""

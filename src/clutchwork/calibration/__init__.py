"""Calibration: parameters that minimise an objective under constraints, by exact gradients."""

"""Driveline: build, check, run and draw a model."""

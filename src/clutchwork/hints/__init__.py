"""Hints: what an expert would say of a model or a run that is allowed, and perhaps not meant."""

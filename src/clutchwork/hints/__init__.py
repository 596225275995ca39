"""Hints: automatic diagnostics of a model or a run that is allowed, and perhaps not meant."""

"""Pictures of a run; matplotlib is imported when the first one is drawn."""

from clutchwork.results.plot.picture import picture

__all__ = ["picture"]

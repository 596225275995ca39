"""Linear systems of drivelines, for control design and vibration (docs/theory/linearisation.md)."""

"""Gearboxes from teeth and a shift table: what they are, what follows from it, those that are known."""

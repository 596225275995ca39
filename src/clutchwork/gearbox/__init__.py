"""Gearboxes from teeth and a shift table: ratios, torques, and the catalogue."""

"""Schematics of drivelines in the symbols of the field, laid out automatically."""

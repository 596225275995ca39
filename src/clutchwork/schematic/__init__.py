"""Schematics: a driveline with the symbols of the field, laid out by itself."""

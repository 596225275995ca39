"""The public face: Driveline, and the names of the package."""

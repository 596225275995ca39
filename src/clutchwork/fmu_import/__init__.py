"""FMUs of other people inside a driveline: read with care, and run in a process of their own."""

"""The 3-4 shift by other programs: SciPy, CVODE, a loop in numba, and one written by hand for this model alone."""

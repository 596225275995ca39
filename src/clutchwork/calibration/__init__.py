"""Calibration: numbers of a driveline so that a goal is least and limits hold, by gradients that are exact."""

"""Environments for learning and tuning: a driveline that an agent steps."""

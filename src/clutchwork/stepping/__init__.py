"""Runs that are advanced step by step, and set from outside between the steps."""

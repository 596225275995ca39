"""Errors that name the remedy, values as messages quote them, safe writing of files."""

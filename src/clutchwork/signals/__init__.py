"""Signals, one file each; every public file in this folder is a signal."""

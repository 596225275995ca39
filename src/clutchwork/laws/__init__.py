"""Friction laws, one file each; every file in this folder is a law."""

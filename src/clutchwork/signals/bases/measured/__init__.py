"""Columns of files that other programs wrote: MDF, MAT, Parquet, NetCDF, and CSV."""

from clutchwork.signals.bases.measured.listing import read_columns as read_columns

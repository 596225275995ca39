"""Damaged model files, CSV files and saved systems, and a process that reads them under limits."""

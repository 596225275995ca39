"""Designs of experiments, and studies of very many runs in data sets on disk."""

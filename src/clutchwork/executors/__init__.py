"""Executors of many runs: threads of this process, or processes of Ray or Dask."""

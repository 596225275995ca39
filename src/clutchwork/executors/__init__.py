"""Where many tasks run: threads of this process, processes of Ray or of Dask, here or on other machines."""

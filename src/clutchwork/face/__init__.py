"""The public face: the names of the package, and who does the verbs of things from lower rooms."""

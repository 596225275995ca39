"""What a driveline gives, with its derivatives, as a function of other people's frameworks: JAX and PyTorch."""

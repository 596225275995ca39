"""Drivelines as differentiable functions of JAX and PyTorch."""

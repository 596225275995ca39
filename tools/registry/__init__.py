"""What tools/gen_registry.py writes and asks for, one module each."""

"""What a run computed: signals, events, energies and tables."""

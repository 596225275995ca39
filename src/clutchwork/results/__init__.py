"""What a run computed: signals, events, energies, tables and pictures."""

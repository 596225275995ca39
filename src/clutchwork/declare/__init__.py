"""What a component may say of itself: fields, units, nodes, roles. The layout of the core and the options of a run."""
